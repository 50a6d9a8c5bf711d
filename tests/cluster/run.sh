#!/usr/bin/env bash
# One campaign in four ways: alone, as shards of which one is killed, on Ray with a worker killed, and as a Slurm array with a
# node set down. All must leave the same files. An experiment is done alone and in pieces on Ray, to the same files.
#
# Usage: run.sh AEYE FOLDER
# AEYE is the program; FOLDER gets an environment of Python with the wheel, and, anew each time, what is driven.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
AEYE=$(realpath "$1")
export AEYE
mkdir -p "$2"
folder=$(cd "$2" && pwd)
work=$folder/work
export PYTHONDONTWRITEBYTECODE=1

"$here/../../python/wheel.sh" "$folder"
python3 -m venv --clear "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet --disable-pip-version-check "$(ls "$folder"/wheels/*.whl)[ray]"
rm -rf "$work"
mkdir "$work"
cd "$work"

runs=40
campaign=(--checkpoint early --runs "$runs" --seed 7 --pedestrians 300 --hazards raised --max-time 10s)

# way NAME: ends a way, whose result is in a folder of that name, and says how long it took.
way() {
	diff -r alone "$1"
	printf '%-8s the same %s files in %s s\n' "$1" "$(find "$1" -type f | wc -l)" $((SECONDS - began))
	began=$SECONDS
}
began=$SECONDS

# Ends with an error where a command does not hold within so many seconds.
within() {
	local end=$((SECONDS + $1))
	shift
	until "$@"; do
		if [ $SECONDS -ge $end ]; then
			echo "$* did not come true in time" >&2
			exit 1
		fi
		sleep 0.2
	done
}

timeout 1200 "$AEYE" campaign "${campaign[@]}" --out alone
way alone

shard() { timeout 600 "$AEYE" campaign "${campaign[@]}" --shard "$1/4" --out "shards/$1"; }
shard 3
"$AEYE" campaign "${campaign[@]}" --shard 2/4 --out shards/2 &
killed=$!
within 120 test -e shards/2/early-0001.mcap
kill -KILL $killed
wait $killed && exit 1
test ! -e "shards/2/early-$(printf %04d $((runs - 3))).mcap"
shard 1
shard 4
shard 2
timeout 120 "$AEYE" campaign --collect shards/4 shards/2 shards/1 shards/3 --out parted
way parted

timeout 900 "$folder/venv/bin/python" "$here/on_ray.py" ray
way ray

timeout 900 "$AEYE" experiment --recipe "$here/recipe.toml" --out experiment
timeout 900 "$folder/venv/bin/python" "$here/experiment_on_ray.py" "$here/recipe.toml" experiment-on-ray
diff -r experiment experiment-on-ray
printf '%-8s the same experiment, alone and on Ray, in %s s\n' pieces $((SECONDS - began))
began=$SECONDS

timeout 900 "$here/slurm.sh" "$work/slurm-daemons" "$here/on_slurm.sh" "${campaign[@]}" --out slurm
way slurm
