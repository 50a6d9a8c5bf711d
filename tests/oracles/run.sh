#!/usr/bin/env bash
# Runs every oracle: what programs of others make of the same files must be what `aeye` says.
#
# Usage: run.sh AEYE FOLDER
# AEYE is the program; below FOLDER go a Python environment and, anew each time, what the oracles need
# and make. An oracle is a file *.py beside this one, which fails where the two differ.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
aeye=$(realpath "$1")
mkdir -p "$2"
folder=$(cd "$2" && pwd)
venv=$folder/venv
work=$folder/work

if ! cmp -s "$here/requirements.txt" "$venv/installed.txt"; then
	python3 -m venv --clear "$venv"
	"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"
	cp "$here/requirements.txt" "$venv/installed.txt"
fi
export PATH="$venv/bin:$PATH"
rm -rf "$work"
mkdir "$work"

python "$here/cityscapes_eval.py" "$aeye" "$work"

"$aeye" drive --headless --map city --max-time 20s --record "$work/drive.mcap"
"$aeye" campaign --checkpoint early --seed 5 --cases 1 --out "$work/drives"
python "$here/recording_reader.py" "$aeye" "$work/drive.mcap" "$work"/drives/*.mcap
python "$here/export_readers.py" "$aeye" "$work/drive.mcap" "$work"/drives/*.case.mcap

"$aeye" dataset natural --scenes 2 --val-scenes 1 --test-scenes 1 --frames 4 --test-frames 2 --out "$work/natural"
"$aeye" dataset cases "$work/drives" --out "$work/cases"
python "$here/cityscapes_layout.py" "$work/natural" "$work/cases"
