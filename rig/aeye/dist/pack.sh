#!/usr/bin/env bash
# Builds what a release consists of: the headless and the full program as tarballs, the wheel, and SHA256SUMS of all three.
#
# Usage: pack.sh FOLDER OUT
# FOLDER gets what is made on the way, among it an environment of Python with maturin; OUT the release, anew.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
rm -rf "$2"
mkdir -p "$2"
out=$(cd "$2" && pwd)
cd "$here/../../.."
built=$(realpath "${CARGO_TARGET_DIR:-target}")/release/aeye
target=$(rustc -vV | sed -n 's/^host: //p')
date=$(git log -1 --format=@%ct)

# pack KIND FEATURES...: the program that was built last, as it was built with these features.
pack() {
	local kind=$1 name
	shift
	name=aeye-$("$built" --version | cut -d' ' -f2)-$kind-${target%%-*}-linux
	rm -rf "${folder:?}/$name"
	mkdir -p "$folder/$name/docs" "$folder/$name/man"
	cp "$built" README.md DETERMINISM.md LICENSE-APACHE LICENSE-MIT "$folder/$name"
	cp -r docs/. "$folder/$name/docs"
	"$built" man --out "$folder/$name/man"
	"$built" completions bash >"$folder/$name/aeye.bash"
	python3 "$here/licences.py" "$target" "$@" >"$folder/$name/LICENCES-OF-LIBRARIES.txt"
	tar --create --directory "$folder" --sort=name --owner=0 --group=0 --numeric-owner --mtime="$date" "$name" |
		gzip --no-name --best >"$out/$name.tar.gz"
}

cargo build --release --locked -p aeye --no-default-features
pack headless --no-default-features
# The whole workspace, as everything else is built; the program is then that with windows again.
cargo build --release --locked --workspace --bins
pack full

"$here/../../../python/wheel.sh" "$folder" check
cp "$folder"/wheels/*.whl "$out"
cd "$out"
sha256sum -- * >"$folder/SHA256SUMS"
mv "$folder/SHA256SUMS" .
ls -l
