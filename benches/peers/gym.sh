#!/usr/bin/env bash
# Steps aeye/Drive-v0 of the wheel, a plain loop in Rust and environments of others in turns, and prints how fast each is.
#
# Usage: gym.sh EPISODE_SPEED FOLDER [DRIVES [REPEATS]]
# EPISODE_SPEED is the program of `benches`; below FOLDER go the wheel and a Python environment.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
mkdir -p "$2"
folder=$(cd "$2" && pwd)

"$here/../../python/wheel.sh" "$folder"
python3 -m venv --clear "$folder/gym"
"$folder/gym/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$here/gym.txt" \
	"$folder"/wheels/*.whl
SDL_VIDEODRIVER=dummy "$folder/gym/bin/python" "$here/gym.py" "$program" "${@:3}"
