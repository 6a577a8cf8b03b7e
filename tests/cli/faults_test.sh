#!/bin/sh
# Shortages around the program, and signals to it: sh faults_test.sh WHIT SCENES MODELS [long].
# MODELS is a folder with model.obj and the files that it names. docs/reliability.md lists all of these faults.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
MODELS=$(cd "$3" && pwd)
LONG=${4:-}
mkdir "$OUT/files"
cd "$OUT/files" || exit 1
cp "$MODELS"/model.* .
small="--size 16x16 --quiet"

# skip WHAT: prints the check that is not possible here.
skip() {
    echo "skipped $1"
}

# judge WHAT PATTERN: if whit failed, it printed one error with PATTERN, and its exit code is 2; counts errors in
# $errors.
judge() {
    case $status in
    0) ;;
    127) # The system could not load the program.
        check "$1: that is the system's" grep -q "error while loading shared" "$OUT/stderr" ;;
    *)
        errors=$((errors + 1))
        check "$1: exit code 2 (got $status)" test "$status" -eq 2
        check "$1: one error" test "$(grep -c "^whit: error: " "$OUT/stderr")" -eq 1
        check "$1: says $2" grep -qi "^whit: error: .*$2" "$OUT/stderr" ;;
    esac
}

# ---- Few descriptors ----

# with_files MOST COMMAND...: runs whit with at most MOST file descriptors, including the standard ones.
with_files() (
    exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-
    ulimit -n "$1"
    shift
    exec "$WHIT" "$@"
) >"$OUT/stdout" 2>"$OUT/stderr"

errors=0
for most in 4 5 6 7 8; do
    for command in "scene model.obj" "render model.gltf -o a.pfm $small"; do
        with_files $most $command
        status=$?
        judge "$command with $most descriptors" "too many open files"
    done
done
check "the last has enough" test $status -eq 0
# It varies which number is enough, because files of the driver and of the model are opened at the same time.
check "the first have not" test $errors -ge 1
with_files 4 scene model.obj
check "what cannot be opened names the model too" \
    grep -q "^whit: error: model.obj: .*: Too many open files" "$OUT/stderr"
rm -f a.pfm

# ---- Little memory ----

# with_memory KBYTES COMMAND...: runs whit with this limit on its address space.
with_memory() (
    ulimit -v "$1"
    shift
    exec "$WHIT" "$@"
) >"$OUT/stdout" 2>"$OUT/stderr"

# little_memory FROM STEP TO COMMAND...: runs whit with limits from FROM to TO MB, STEP MB apart.
little_memory() {
    at=$1 step=$2 to=$3
    shift 3
    while [ "$at" -le "$to" ]; do
        with_memory "${at}000" "$@"
        status=$?
        judge "$* in $at MB" "memory"
        at=$((at + step))
    done
}
errors=0
if [ "$LONG" ]; then
    for command in "render $SCENES/cube.json -o a.pfm $small" "render model.obj -o a.pfm $small" \
        "render $SCENES/default.json -o a.pfm --size 320x240 --quiet" \
        "trace $SCENES/swarm.json --input $MODELS/one.rays -o a.pfm --quiet"; do
        little_memory 30 15 900 $command
        check "$command: the last has enough" test $status -eq 0
    done
    little_memory 30 1 120 scene model.obj
    little_memory 30 1 120 scene "$SCENES/swarm.json"
    little_memory 30 2 200 bvh "$SCENES/swarm.json" --no-trace --runs 1
else
    # Limits that are too small for a driver, or with which some drivers crash.
    little_memory 150 120 390 render "$SCENES/cube.json" -o a.pfm $small
    little_memory 40 20 80 scene model.obj
fi
check "some have too little" test $errors -gt 1
printf '%s model.obj --size 16x12\n' before behind >room.whit && sed -i '1a large model.obj --size 16384x16384' room.whit
with_memory 3000000 check room.whit --on reference
check "a picture without room is the only one of a suite that cannot be drawn" \
    grep -qx "3 cases, 2 new, 1 broken" "$OUT/stdout"
rm -f a.pfm room.whit

# ---- No space, no permission, no HOME, no /tmp ----

# in_mounts COMMAND: runs the shell command as root with mounts of its own; it may mount on /mnt.
in_mounts() {
    unshare -rm sh -c "$1" >"$OUT/stdout" 2>"$OUT/stderr" 9<"$WHIT"
}
if in_mounts "mount -t tmpfs -o size=16k tmpfs /mnt"; then
    in_mounts "mount -t tmpfs -o size=16k tmpfs /mnt && echo old >/mnt/t &&
        $WHIT scene $SCENES/default.json --triangles /mnt/t --quiet
        test \$? -eq 2 && test \"\$(ls -A /mnt)\" = t && test \"\$(cat /mnt/t)\" = old"
    check "a full disk: exit code 2, the old file and nothing else" test $? -eq 0
    check "a full disk: says so" \
        grep -q "^whit: error: /mnt/t: cannot write: No space left on device" "$OUT/stderr"
    in_mounts "unset MESA_SHADER_CACHE_DIR; mount -t tmpfs -o size=200k tmpfs /mnt
        head -c 300000 /dev/zero >/mnt/fill 2>/dev/null; XDG_CACHE_HOME=/mnt $WHIT devices"
    check "a full disk for caches: Mesa keeps nothing, and whit runs" test $? -eq 0
    in_mounts "mount -t tmpfs -o ro tmpfs /mnt; XDG_CACHE_HOME=/mnt $WHIT devices"
    check "a read-only disk for caches: why there is none" \
        grep -q "/mnt/whit: not used: Read-only file system$" "$OUT/stdout"
    # The current folder stays usable when another file system is mounted over /tmp.
    in_mounts "unset TMPDIR MESA_SHADER_CACHE_DIR; mount -t tmpfs -o ro tmpfs /tmp &&
        /proc/self/fd/9 render model.obj -o a.pfm $small"
    check "no /tmp: a picture" test $? -eq 0 -a -s a.pfm
    check "no /tmp: nothing to say" test ! -s "$OUT/stderr"
else
    skip "a full disk, no /tmp: there are no mounts to be had"
fi
echo rubbish >rubbish.json
VK_DRIVER_FILES=$PWD/rubbish.json refuse 3 "a driver's manifest that is none" "no usable device: .* VK_DRIVER_FILES names" \
    devices --json
check "there is JSON" grep -q '"devices": \[\]' "$OUT/stdout"
rm rubbish.json
TMPDIR=/nowhere
export TMPDIR
expect 0 "TMPDIR leads nowhere" scene model.obj
unset TMPDIR
rm -f a.pfm

# Root may write everywhere, unless it gives up that capability.
mkdir read-only
echo old >read-only/old
echo old >kept
chmod a-w read-only kept
plain=
[ -w read-only ] && plain="setpriv --bounding-set=-dac_override,-dac_read_search"
if $plain test ! -w read-only 2>/dev/null; then
    for file in read-only/new read-only/old kept; do
        $plain "$WHIT" scene "$SCENES/cube.json" --triangles $file --quiet 2>"$OUT/stderr"
        check "$file: exit code 2" test $? -eq 2
        check "$file: says why" \
            grep -q "^whit: error: $file: cannot write: Permission denied" "$OUT/stderr"
    done
    HOME=$PWD/read-only XDG_CACHE_HOME= $plain "$WHIT" devices >"$OUT/stdout" 2>/dev/null
    check "a home without permission: why there is no cache" \
        grep -q "/.cache/whit: not used: Permission denied$" "$OUT/stdout"
    check "nothing is changed" test "$(ls -A read-only; cat read-only/old kept)" = "old
old
old"
else
    skip "a folder without permission: root may do all"
fi
chmod u+w read-only
rm -rf read-only kept

for home in "" /nowhere /dev/null; do
    (
        unset XDG_CACHE_HOME HOME
        [ "$home" ] && export HOME="$home"
        exec "$WHIT" render "$SCENES/cube.json" -o a.pfm $small
    ) 2>"$OUT/stderr"
    check "HOME ${home:-unset}: a picture" test $? -eq 0 -a -s a.pfm
    rm -f a.pfm
done

# ---- SIGPIPE ----

# into_nothing COMMAND...: runs whit with a standard output that is a pipe without a reader.
mkfifo pipe
into_nothing() {
    exec 5<>pipe 6>pipe 5<&-
    "$WHIT" "$@" >&6 2>"$OUT/stderr" 6>&-
    status=$?
    exec 6>&-
}
for command in "scene $SCENES/default.json --all" "scene model.obj --json" "--help"; do
    into_nothing $command
    check "$command | head: ends of SIGPIPE (got $status)" test $status -eq 141
    check "$command | head: without a word" test ! -s "$OUT/stderr"
done
trap '' PIPE
into_nothing scene model.obj
trap - PIPE
check "SIGPIPE ignored: exit code 2 (got $status)" test $status -eq 2
check "SIGPIPE ignored: one error" \
    test "$(cat "$OUT/stderr")" = "whit: error: standard output: cannot write: Broken pipe"

# ---- Signals and two writers, while whit waits for rays ----

# begin_trace NUMBER: starts a whit that reads rays from the pipe raysNUMBER.
begin_trace() {
    mkfifo "rays$1"
    ulimit -c 0
    "$WHIT" trace "$SCENES/cube.json" --input "rays$1" -o hits --on cpu --quiet 2>"$OUT/stderr" &
}
# sent SIGNAL: sends the signal to whit while it waits; sets $status to its exit code.
sent() {
    begin_trace 7
    exec 7>rays7
    kill -"$1" $!
    wait $! 2>/dev/null
    status=$?
    exec 7>&-
    rm rays7
}
echo old >hits
for signal in HUP:129 TERM:143 INT:130; do
    sent "${signal%:*}"
    check "SIG${signal%:*}: exit code ${signal#*:} (got $status)" test $status -eq "${signal#*:}"
    check "SIG${signal%:*}: says so" \
        test "$(cat "$OUT/stderr")" = "whit: interrupted, nothing was written"
    check "SIG${signal%:*}: the old file" test "$(cat hits)" = old
done
# Where nothing is short, whit does not report a crash as an error of its own.
sent SEGV
check "SIGSEGV: dies of it (got $status)" test $status -eq 139
check "SIGSEGV: without a word of whit's" test ! -s "$OUT/stderr"
trap '' HUP # as nohup does
begin_trace 7
exec 7>rays7
kill -HUP $!
cat "$MODELS/one.rays" >&7
exec 7>&-
wait $!
check "SIGHUP under nohup: goes on (got $?)" test $? -eq 0
trap - HUP
one=$(wc -c <hits)
rm rays7

begin_trace 7
first=$!
begin_trace 8
exec 7>rays7 8>rays8
cat "$MODELS/one.rays" >&7
cat "$MODELS/one.rays" "$MODELS/one.rays" >&8
exec 7>&- 8>&-
wait $first
check "two writers: the first succeeds (got $?)" test $? -eq 0
wait $!
check "two writers: the second succeeds (got $?)" test $? -eq 0
size=$(wc -c <hits)
check "two writers: one of the two, whole ($size)" test "$size" -eq "$one" -o "$size" -eq $((2 * one))
rm -f hits rays* pipe model.*
check "nothing is left" is_empty .
finish
