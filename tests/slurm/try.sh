#!/usr/bin/env bash
# Tries `bench --slurm` on a cluster of one node: this machine, Debian's slurm-wlm, munge with a key of its own, everything
# on the loopback. Needs root and `apt-get install slurm-wlm munge`; not part of ./dev test.
#   tests/slurm/try.sh [build/halfplane]
# Submits a small space, kills a task under way, submits again, and compares the gathered figures with local ones.
set -euo pipefail
program=$(realpath "${1:-build/halfplane}")
for tool in slurmctld slurmd sbatch squeue munged mungekey; do
  command -v "$tool" >/dev/null || PATH=$PATH:/usr/sbin
  command -v "$tool" >/dev/null || { echo "try.sh: there is no $tool; apt-get install slurm-wlm munge" >&2; exit 3; }
done
((EUID == 0)) || { echo "try.sh: slurmd wants root" >&2; exit 3; }

work=$(mktemp -d)
daemons=()
finish() {
  for pid in "${daemons[@]}"; do kill "$pid" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap finish EXIT

mkdir "$work"/{munge,state,spool,log}
chmod 700 "$work/munge"
mungekey --create --keyfile="$work/munge/key"
socket=$work/munge/socket
munged --foreground --force --key-file="$work/munge/key" --socket="$socket" --pid-file="$work/munge/pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" 2>"$work/log/munged" &
daemons+=($!)

host=$(hostname -s)
export SLURM_CONF=$work/slurm.conf
cat >"$SLURM_CONF" <<END
ClusterName=try
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$socket
CredType=cred/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/ctld.pid
SlurmdPidFile=$work/d.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
CommunicationParameters=NoCtldInAddrAny
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
slurmctld -D >"$work/log/ctld" 2>&1 &
daemons+=($!)
slurmd -D >"$work/log/d" 2>&1 &
daemons+=($!)
for ((i = 0; i < 60; i++)); do
  [[ $(sinfo -h -o %T 2>/dev/null) != idle ]] || break
  sleep 1
done
[[ $(sinfo -h -o %T) == idle ]] || { echo "try.sh: the node does not come up:" >&2; tail -n 5 "$work"/log/* >&2; exit 1; }
echo "== a node: $(sinfo -h -o '%N %T, %c cores'), Slurm $(sinfo --version | cut -d' ' -f2)"

space=(bench city --size 320x240 --space --vary depth.bits=16,24 --vary stamp.size=1,2,4 --vary cache.lines=64,256)
(cd "$work" && "$program" "${space[@]}" --slurm job)
drained() { while [[ -n $(squeue -h) ]]; do sleep 0.5; done; }
job=$(sbatch --parsable "$work/job/job.sh")
scancel "${job}_12"  # a task ends as when a node dies
drained
missing=$("$program" bench --collect "$work/job" --json --quiet | sed -n 's/.*"missing": \([0-9]*\).*/\1/p')
echo "== job $job, task 12 cancelled: $missing missing"
((missing >= 1))
rm "$work/job/points/00005.json"
kept=$(stat -c %Y.%i "$work/job/points/00001.json")
sbatch --wait "$work/job/job.sh"
drained
[[ $(stat -c %Y.%i "$work/job/points/00001.json") == "$kept" ]] || { echo "try.sh: a point was made twice" >&2; exit 1; }
"$program" bench --collect "$work/job" --json="$work/gathered.json" -o "$work/space.html" --quiet
"$program" "${space[@]}" --json="$work/here.json" --quiet
python3 - "$work/gathered.json" "$work/here.json" <<'END'
import json, sys
gathered, here = (json.load(open(path, encoding='utf-8')) for path in sys.argv[1:])
assert gathered['missing'] == 0 and len(gathered['points']) == 12, gathered['missing']
assert gathered['points'] == here['points'] and gathered['front_axes'] == here['front_axes']
print(f"== 12 points gathered, equal to those measured here; {sum(p['on_front'] for p in here['points'])} on the front")
END
if command -v parallel >/dev/null; then
  rm "$work"/job/points/*
  (cd "$work/job" && parallel --will-cite <tasks)
  "$program" bench --collect "$work/job" --json --quiet | grep -q '"missing": 0'
  echo '== GNU parallel did the same tasks'
fi
