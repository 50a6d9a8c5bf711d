#!/usr/bin/env bash
# Installs what a release consists of where there is nothing else of it, and drives, replays and reads with each part: in an
# empty home, without the variables of whoever calls, and in two minutes.
#
# Usage: try.sh RELEASE
set -euo pipefail

release=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# clean COMMAND...: in an environment that holds nothing.
clean() {
	env -i HOME="$work/home" XDG_RUNTIME_DIR="$work/home" PATH=/usr/bin:/bin timeout 120 "$@"
}

# tried NAME: says how long a part took, which two minutes are enough for.
tried() {
	echo "$1: drives and verifies, $((SECONDS - began)) s"
	[ $((SECONDS - began)) -le 120 ]
}

(cd "$release" && sha256sum --check --quiet SHA256SUMS)
for part in "$release"/*.tar.gz; do
	began=$SECONDS
	name=$(basename "$part" .tar.gz)
	mkdir -m 700 home
	tar --extract --file "$part"
	# A released program says its version, which the tarball's name holds, and writes it into recordings.
	version=$(clean "$name/aeye" --version)
	[[ $name == "aeye-${version#aeye }-"* ]]
	clean "$name/aeye" drive --headless --map city --checkpoint early --max-time 5s --record "$name/drive.mcap"
	clean "$name/aeye" verify "$name/drive.mcap"
	clean "$name/aeye" --json inspect "$name/drive.mcap" | grep --quiet "\"program\":\"$version\""
	for file in README.md LICENSE-MIT LICENSE-APACHE LICENCES-OF-LIBRARIES.txt docs/recording.md man/aeye.1; do
		[ -s "$name/$file" ]
	done
	tried "$name"
	rm -rf home
done

began=$SECONDS
mkdir -m 700 home
python3 -m venv venv
# pip keeps the variables of whoever calls, which may say where packages come from.
HOME=$work/home venv/bin/python -m pip install --quiet --disable-pip-version-check "$release"/*.whl
clean venv/bin/python - "$work" <<'END'
import importlib.metadata
import pathlib
import sys

import aeye

out = pathlib.Path(sys.argv[1], "drives")
run = aeye.campaign("early", out, maps="city", runs=1, max_time=10)["runs"][0]
recording = aeye.open(out / run["file"])
assert recording.verify()["ok"] and recording.inspect()["provenance"]["program"] == f"aeye {aeye.__version__}"
assert {"LICENSE-MIT", "LICENSE-APACHE"} <= {file.name for file in importlib.metadata.files("aeye")}
END
tried "$(basename "$release"/*.whl)"
