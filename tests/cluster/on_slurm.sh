#!/usr/bin/env bash
# A campaign as an array job of docs/slurm.sbatch, on the cluster of slurm.sh, one of whose nodes goes down meanwhile.
#
# Usage: on_slurm.sh ARGUMENT_OF_CAMPAIGN... --out OUT
set -euo pipefail

script=$(cd "$(dirname "$0")/../../docs" && pwd)/slurm.sbatch
out=${*: -1}
export SHARDS=$out.shards

job=$(sbatch --parsable --array=1-6 --cpus-per-task=1 --mem=2G --output="$out-%a.log" "$script" "${@:1:$#-2}")

# The task on the second node, once it has driven something.
for _ in $(seq 600); do
	task=$(squeue --noheader --states=running --nodelist=two --format=%K)
	[ -n "$task" ] && compgen -G "$SHARDS/$task/*.mcap" >/dev/null && break
	sleep 0.2
done
scontrol update NodeName=two State=DOWN Reason=test
sleep 3
scontrol update NodeName=two State=RESUME
grep -q "NODE FAILURE" "$out-$task.log"

# Slurm lets a task that it puts back wait for two minutes.
scontrol update JobId="${job}_$task" StartTime=now
for _ in $(seq 1800); do
	[ -z "$(squeue --noheader)" ] && break
	sleep 0.5
done
"${AEYE:-aeye}" campaign --collect "$SHARDS" --out "$out"
