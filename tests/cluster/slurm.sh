#!/usr/bin/env bash
# Runs a command beside a Slurm cluster of its own: two nodes of this machine, of one CPU each, with all files in a folder.
#
# Usage: slurm.sh FOLDER COMMAND...
# FOLDER is new. COMMAND finds SLURM_CONF set, and nodes called one and two.
set -euo pipefail

mkdir "$1"
folder=$(cd "$1" && pwd)
shift
user=$(id -un)
host=$(hostname -s)
PATH=$PATH:/usr/sbin
export SLURM_CONF=$folder/slurm.conf

# Three ports that nobody listens on.
ports() {
	python3 -c 'import socket
taken = [socket.create_server(("127.0.0.1", 0)) for _ in range(3)]
print(*[each.getsockname()[1] for each in taken])'
}
read -r control first second <<<"$(ports)"

cat >"$SLURM_CONF" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$control
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
CryptoType=crypto/munge
AuthInfo=socket=$folder/munge.socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/%n.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2
KillWait=2
ReturnToService=1
NodeName=one NodeHostname=$host NodeAddr=127.0.0.1 Port=$first CPUs=1 RealMemory=4096
NodeName=two NodeHostname=$host NodeAddr=127.0.0.1 Port=$second CPUs=1 RealMemory=4096
PartitionName=all Nodes=one,two Default=YES MaxTime=INFINITE State=UP
END
mkdir "$folder/state" "$folder/one" "$folder/two"
# munged asks that nobody else can write where its socket is.
chmod go-w "$folder"
(umask 077 && head -c 1024 /dev/urandom >"$folder/munge.key")

daemons=()
stop() {
	for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
	wait
}
trap stop EXIT

munged --foreground --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
	--log-file="$folder/munged.log" --seed-file="$folder/munged.seed" >"$folder/munged.out" 2>&1 &
daemons+=($!)
slurmctld -D >"$folder/slurmctld.out" 2>&1 &
daemons+=($!)
for node in one two; do
	slurmd -D -N "$node" >"$folder/$node.out" 2>&1 &
	daemons+=($!)
done

# Nodes report for duty within seconds.
for _ in $(seq 60); do
	[ "$(sinfo --noheader --Node --states=idle 2>/dev/null | wc -l)" = 2 ] && break
	sleep 0.5
done
sinfo --Node --long
if [ "$(sinfo --noheader --Node --states=idle | wc -l)" != 2 ]; then
	tail "$folder"/*.log "$folder"/*.out >&2
	exit 1
fi
"$@"
