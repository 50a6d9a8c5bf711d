#!/usr/bin/env bash
# Builds the wheel, installs it where there is nothing else of this workspace, and runs the tests of the package.
#
# Usage: test.sh FOLDER
# FOLDER gets two fresh environments of Python and the wheel.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
cd "$here/.."
target=$(realpath "${CARGO_TARGET_DIR:-target}")

# With the packages of that file, or some of them.
environment() {
	python3 -m venv --clear "$folder/$1"
	"$folder/$1/bin/python" -m pip install --quiet --disable-pip-version-check --requirement /dev/stdin
}

cargo build --release --workspace --bins
"$here/wheel.sh" "$folder"

{ grep -v '^maturin' "$here/requirements.txt" && ls "$folder"/wheels/*.whl; } | environment try
cd "$folder"
export PYTHONDONTWRITEBYTECODE=1
AEYE=$target/release/aeye "$folder/try/bin/python" -m pytest -p no:cacheprovider --quiet "$here/tests"
