#!/bin/sh
# whit's own suite on every driver, vector width and number of threads that lavapipe has here: prints how
# many of its cases are other than the golden, which is to be 0 everywhere.
#     sh check_everywhere_test.sh WHIT SCENES [SECOND-DRIVER.json]
. "$(dirname "$0")/common.sh"
needs jq
unset MESA_SHADER_CACHE_DIR # whit's own folders: Mesa's keys do not tell vector widths apart
ROOT=$SCENES/..
second=${3:-}
sum=0

# row NAME: the suite under what the environment says.
row() {
    "$WHIT" check "$ROOT/tests/check/whit.suite" --root "$ROOT" --quiet --json "$OUT/report.json" \
        >"$OUT/stdout" 2>"$OUT/stderr"
    status=$?
    cases=$(jq '.cases | length' "$OUT/report.json")
    other=$(jq '[.cases[] | select(.verdict != "ok")] | length' "$OUT/report.json")
    printf '%-64s %4s of %s differ\n' "$1" "$other" "$cases"
    check "$1: exit code 0 (got $status)" test $status -eq 0
    check "$1: all cases were drawn" test "$cases" -eq "$("$WHIT" check "$ROOT/tests/check/whit.suite" \
        --root "$ROOT" --list | wc -l)"
    sum=$((sum + other))
    rm -f "$OUT/report.json"
}

for driver in "" $second; do
    [ -z "$driver" ] || export VK_DRIVER_FILES="$driver" VK_ICD_FILENAMES="$driver"
    for width in 128 256 512; do
        for threads in 0 1 2 7; do
            export LP_NATIVE_VECTOR_WIDTH=$width LP_NUM_THREADS=$threads
            row "${driver:-installed} width $width, $threads threads"
        done
    done
done
echo "$sum cases differ in all"
check "none differs" test "$sum" -eq 0
finish
