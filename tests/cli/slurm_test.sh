#!/bin/sh
# tools/slurm/submit (the third argument) on a cluster of one node, which needs no rights and leaves no files: a job
# array of 24 parts makes the picture of one run, although a part is requeued while it draws, and the node dies during
# another part. This test is long. It needs Debian's slurm-wlm and munge:
#     apt-get install --no-install-recommends slurm-wlm munge
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
PATH=$PATH:/usr/sbin:/sbin
SUBMIT=$(cd "$(dirname "$3")" && pwd)/$(basename "$3")
for program in munged slurmctld slurmd sbatch; do
    needs $program
done
NODE=$OUT/node
mkdir -m 711 "$NODE"
chmod 711 "$OUT"
cd "$NODE" || exit 1
PARTS=24

stop_node() {
    for file in slurmd slurmctld munged; do
        [ ! -e "$NODE/$file.pid" ] || kill "$(cat "$NODE/$file.pid")" 2>/dev/null
    done
    sleep 1
    rm -rf "$OUT"
}
trap stop_node EXIT
trap 'exit 130' INT TERM

# ---- A cluster of one node ----

head -c 1024 /dev/urandom >munge.key
chmod 600 munge.key
port=$((20000 + $$ % 20000))
cat >slurm.conf <<CONF
ClusterName=one
SlurmctldHost=$(hostname -s)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthInfo=socket=$NODE/munge.socket
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$NODE
SlurmdSpoolDir=$NODE/spool
SlurmctldPidFile=$NODE/slurmctld.pid
SlurmdPidFile=$NODE/slurmd.pid
SlurmctldLogFile=$NODE/slurmctld.log
SlurmdLogFile=$NODE/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
BatchStartTimeout=1
MessageTimeout=2
MpiDefault=none
SlurmdParameters=config_overrides
NodeName=$(hostname -s) CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF="$NODE/slurm.conf" WHIT
munged --force --key-file="$NODE/munge.key" --socket="$NODE/munge.socket" --pid-file="$NODE/munged.pid" \
    --log-file="$NODE/munged.log" --seed-file="$NODE/munge.seed" 2>"$OUT/stderr"
slurmctld -c
slurmd
ready() {
    sinfo -h -o %T 2>/dev/null | grep -q -e idle -e mixed -e allocated
}
tries=0
until ready || [ $tries -ge 60 ]; do
    tries=$((tries + 1))
    sleep 0.5
done
if ! ready; then
    tail -n 5 munged.log slurmctld.log slurmd.log
    check "the node is up" false
    finish
fi

# ---- The array ----

options="$SCENES/room.json --size 480x400 --aa 16"
expect 0 "one run" render $options -o one.exr -q
jobs=$("$SUBMIT" tile $PARTS merged.exr $options)
array=${jobs% *}
check "two jobs" test -n "$array" -a "${jobs#* }" != "$jobs"

# drawing NOT: prints the number of a part other than NOT that is being drawn.
drawing() {
    find merged.exr.parts -name '*.lock' 2>/dev/null | sed 's|.*/\([0-9]*\)\.exr\.lock|\1|' | grep -v -x "$1" | head -n 1
}
# await COMMAND...: waits until the command succeeds, at most ten minutes; Slurm waits two minutes before it starts a
# part again.
await() {
    until=$(($(date +%s) + 600))
    until "$@" || [ "$(date +%s)" -ge $until ]; do
        sleep 0.1
    done
}
draws() {
    test -n "$(drawing "$1")"
}
await draws none
requeued=$(drawing none)
check "part $requeued is requeued while it is drawn" scontrol requeue "${array}_$requeued"
waits() {
    test "$(squeue -h -o %t -j "${array}_$requeued" 2>/dev/null)" = PD
}
await waits

# The node dies: its daemon and its processes are killed at once. The controller notices when the daemon starts again.
await draws "$requeued"
died=$(drawing "$requeued")
jobs_here=$(scontrol listpids 2>/dev/null | awk 'NR > 1 && $1 > 0 { print $1 }')
steps=$(for pid in $jobs_here; do ps -o ppid= -p "$pid"; done | sort -u | grep -v -w 1)
kill -9 "$(cat slurmd.pid)" $steps $jobs_here 2>/dev/null
check "the node died with part $died" test ! -e "merged.exr.parts/$died.time"
sleep 6 # a start of the machine; the controller thinks that younger jobs are only about to begin
slurmd -b -c
ended() {
    test -z "$(squeue -h 2>/dev/null)"
}
await ended
check "its part is found missing" grep -q "JobId=${array}_$died.* missing from batch node" slurmctld.log
check "no file is left of what was killed" sh -c "! ls -A merged.exr.parts | grep -q -e '^\\.' -e lock"
check "the merged picture is that of one run" cmp one.exr merged.exr
cat merged.exr.parts/merge.log
check "times are told" grep -q "^$PARTS parts: .* s in all parts together" merged.exr.parts/merge.log

# The same command again keeps all parts.
rm merged.exr
"$SUBMIT" tile $PARTS merged.exr $options >again.txt
await ended
check "again: the same picture" cmp one.exr merged.exr
check "again: parts are kept" test "$(grep -l "was kept" merged.exr.parts/*.log | wc -l)" -eq $PARTS

# An array whose parts are runs of samples.
"$SUBMIT" samples-part 4 samples.exr $options >samples.txt
await ended
expect 0 "runs of samples are the picture" compare one.exr samples.exr --metric differing --tolerance 0

# An array of frames, three for each task.
frames="$SCENES/swarm.json --size 96x72"
expect 0 "frames of one run" render $frames --frames 0-8 -o f.#.png -q
sbatch --array=0-6:3 --requeue --output=frames.log --wrap "\"\$WHIT\" render $frames -o a.#.png --resume \
    --frames \$SLURM_ARRAY_TASK_ID-\$((SLURM_ARRAY_TASK_ID + 2))" >frames.txt
await ended
for i in 0 1 2 3 4 5 6 7 8; do
    check "frame $i is that of one run" cmp "f.$i.png" "a.$i.png"
done
[ "$FAILED" -eq 0 ] || tail -n 20 slurmctld.log slurmd.log merged.exr.parts/*.log
finish
