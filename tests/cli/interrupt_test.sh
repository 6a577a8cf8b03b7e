#!/bin/sh
# Ctrl+C and --time-limit stop a long render within a limit of time, on a machine that does nothing else. This test is
# long. The tests fault_stop_* need no clock: they stop whit at any place, and check the files that it leaves.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/pictures"

now_ms() {
    echo $(($(date +%s%N) / 1000000))
}

# 48 million pixels with 16 samples each: minutes on any machine.
set -- render "$SCENES/default.json" -o "$OUT/pictures/long.png" --size 8000x6000 --aa 16

# stop_after SECONDS SIGNAL CODE ARGUMENT...: sends the signal to whit; it ends with CODE and leaves no file.
stop_after() {
    seconds=$1 signal=$2 expected=$3
    shift 3
    "$WHIT" "$@" 2>"$OUT/stderr" &
    pid=$!
    sleep "$seconds"
    start=$(now_ms)
    kill "-$signal" "$pid"
    wait "$pid"
    code=$?
    spent=$(($(now_ms) - start))
    check "SIG$signal after $seconds s: exit code $expected (got $code)" \
        test "$code" -eq "$expected"
    # 0.2 s is the promise; a busy machine may need some more to tear the process down.
    check "SIG$signal after $seconds s: stops at once ($spent ms)" test "$spent" -lt 600
    check "SIG$signal after $seconds s: leaves no file" is_empty "$OUT/pictures"
    check "SIG$signal after $seconds s: says so" grep -q "interrupted" "$OUT/stderr"
}

stop_after 2 INT 130 "$@"
stop_after 0.3 INT 130 "$@"
stop_after 1 TERM 143 "$@"

start=$(now_ms)
expect 5 "time limit" "$@" --time-limit 1
spent=$(($(now_ms) - start))
check "time limit of 1 s: stops soon ($spent ms)" test "$spent" -lt 2500
check "time limit: leaves no file" is_empty "$OUT/pictures"
check "time limit: says so" grep -q "time limit" "$OUT/stderr"
finish
