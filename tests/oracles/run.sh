#!/usr/bin/env bash
# Runs every oracle: what programs of others make of the same files must be what `aeye` says.
#
# Usage: run.sh AEYE FOLDER
# AEYE is the program; below FOLDER go a Python environment and, anew each time, what the oracles need
# and make. An oracle is a file *.py beside this one, which fails where the two differ. With TORCH=1 also those of PyTorch, whose
# packages take 5 GB of disk.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
aeye=$(realpath "$1")
mkdir -p "$2"
folder=$(cd "$2" && pwd)
venv=$folder/venv
work=$folder/work

# environment FOLDER REQUIREMENTS
environment() {
	cmp -s "$2" "$1/installed.txt" && return
	python3 -m venv --clear "$1"
	"$1/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$2"
	cp "$2" "$1/installed.txt"
}

environment "$venv" "$here/requirements.txt"
export PATH="$venv/bin:$PATH"
rm -rf "$work"
mkdir "$work"

python "$here/cityscapes_eval.py" "$aeye" "$work"

"$aeye" drive --headless --map city --max-time 20s --record "$work/drive.mcap"
# A story in which a takeover through `early` is the rule; anywhere else one may be long in coming.
"$aeye" campaign --scenario adult_runs_from_the_left --vary 4 --checkpoint early --seed 5 --out "$work/drives"
python "$here/recording_reader.py" "$aeye" "$work/drive.mcap" "$work"/drives/*.mcap
python "$here/export_readers.py" "$aeye" "$work/drive.mcap" "$work"/drives/*.case.mcap
for case in "$work"/drives/*.case.mcap; do
	python "$here/format_readers.py" "$aeye" "$work/drive.mcap" "$case" "${case%.case.mcap}.mcap"
done

# In an environment of its own: its packages ask for other versions.
environment "$folder/osi" "$here/requirements_osi.txt"
"$aeye" drive --headless --scenario "$here/stories/slower_ahead.xosc" --checkpoint truth --max-time 15s --record "$work/slower_ahead.mcap"
"$aeye" drive --headless --map old_town --seed 3 --max-time 10s --record "$work/old_town.mcap"
"$folder/osi/bin/python" "$here/osi_readers.py" "$aeye" "$work/slower_ahead.mcap" "$work/old_town.mcap" "$work"/drives/*.case.mcap

"$aeye" dataset natural --scenes 2 --val-scenes 1 --test-scenes 1 --frames 4 --test-frames 2 --out "$work/natural"
"$aeye" dataset cases "$work/drives" --out "$work/cases"
python "$here/cityscapes_layout.py" "$work/natural" "$work/cases"
if [ -n "${TORCH:-}" ]; then
	environment "$folder/torch" "$here/requirements_torch.txt"
	"$folder/torch/bin/python" "$here/torch_readers.py" "$work/natural" "$work/cases"
else
	echo "torch_readers.py: left out; TORCH=1 runs it"
fi
