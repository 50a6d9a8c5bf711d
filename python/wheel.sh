#!/usr/bin/env bash
# Builds the wheel from the libraries of the whole workspace, so that no dependency is built twice.
#
# Usage: wheel.sh FOLDER [skip|check]
# FOLDER gets an environment of Python with maturin, and in wheels/ the wheel. With `check`, its name says which C library
# it needs at least (manylinux_2_35: Ubuntu 22.04, Debian 12), and that it needs no other; else it is this machine's alone.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
folder=$(cd "$1" && pwd)
cd "$here/.."

python3 -m venv --clear "$folder/build"
grep '^maturin' "$here/requirements.txt" |
	"$folder/build/bin/python" -m pip install --quiet --disable-pip-version-check --requirement /dev/stdin
rm -rf "$folder/wheels"
CARGO=$here/workspace_cargo.sh "$folder/build/bin/maturin" build --release --locked --manifest-path "$here/Cargo.toml" \
	--auditwheel "${2:-skip}" --out "$folder/wheels"
