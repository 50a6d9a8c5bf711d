#!/usr/bin/env bash
# Drives the same towns with the kernel and with SUMO, one after the other, and prints both speeds.
#
# Usage: run.sh WORLD_SPEED FOLDER [SECONDS]
# WORLD_SPEED is the program of `benches`; below FOLDER go a Python environment, the maps and what SUMO makes of them.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
mkdir -p "$2"
folder=$(cd "$2" && pwd)
venv=$folder/venv

if ! cmp -s "$here/requirements.txt" "$venv/installed.txt"; then
	python3 -m venv --clear "$venv"
	"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"
	cp "$here/requirements.txt" "$venv/installed.txt"
fi
"$venv/bin/python" "$here/sumo.py" "$program" "$folder/work" "${@:3}"
