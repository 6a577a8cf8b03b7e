#!/bin/sh
# Runs whit's own suite on every device, vector width and number of threads of this machine. Prints a row for each, with
# the number of cases that differ from the golden (0 is expected everywhere), and names the rows that are left out.
#     sh check_everywhere_test.sh WHIT SCENES [installed | second [DRIVER.json] | gpu]
# installed: lavapipe as it is set up here; second: another lavapipe (tools/second-driver); gpu: each usable device that
# is no CPU; without a word: all. If rows are left out and none fails, the exit code is 77, ctest's "skipped".
. "$(dirname "$0")/common.sh"
needs jq
unset MESA_SHADER_CACHE_DIR # whit's own folders: Mesa's keys do not tell vector widths apart
ROOT=$SCENES/..
what=${3:-all}
second=${4:-$ROOT/build/second-driver/lvp_icd.json}
sum=0 drawn=0 out=0

# row NAME [OPTION...]: runs the suite in the present environment.
row() {
    name=$1
    shift
    "$WHIT" check "$ROOT/tests/check/whit.suite" --root "$ROOT" --quiet --json "$OUT/report.json" "$@" \
        >"$OUT/stdout" 2>"$OUT/stderr"
    status=$?
    cases=$(jq '.cases | length' "$OUT/report.json")
    other=$(jq '[.cases[] | select(.verdict != "ok")] | length' "$OUT/report.json")
    printf '%-64s %4s of %s differ\n' "$name" "$other" "$cases"
    check "$name: exit code 0 (got $status)" test $status -eq 0
    check "$name: all cases were drawn" test "$cases" -eq "$("$WHIT" check "$ROOT/tests/check/whit.suite" \
        --root "$ROOT" --list | wc -l)"
    sum=$((sum + other)) drawn=$((drawn + 1))
    rm -f "$OUT/report.json"
}

left_out() { # NAME WHY
    printf '%-64s SKIPPED: %s\n' "$1" "$2"
    out=$((out + 1))
}

# widths DRIVER [WHY]: runs all rows of a lavapipe, or leaves them out for the reason WHY.
widths() {
    for width in 128 256 512; do
        for threads in 0 1 2 7; do
            export LP_NATIVE_VECTOR_WIDTH=$width LP_NUM_THREADS=$threads
            name="$1 width $width, $threads threads"
            if [ -n "${2:-}" ]; then left_out "$name" "$2"; else row "$name"; fi
        done
    done
    unset LP_NATIVE_VECTOR_WIDTH LP_NUM_THREADS
}

case $what in installed | all)
    widths installed
    export WHIT_STAGING=1 WHIT_OWN_DIVISION=0 WHIT_OWN_COMPARISON=0
    row "installed, with memory, division and comparisons as on a GPU"
    unset WHIT_STAGING WHIT_OWN_DIVISION WHIT_OWN_COMPARISON
    ;;
esac
case $what in second | all)
    if [ -f "$second" ]; then
        export VK_DRIVER_FILES="$second" VK_ICD_FILENAMES="$second"
        widths second
    else
        widths second "there is no $second: ./tools/second-driver unpacks one"
    fi
    ;;
esac
case $what in gpu | all)
    unset VK_DRIVER_FILES VK_ICD_FILENAMES
    "$WHIT" devices --json 2>"$OUT/stderr" | jq -r '.devices[] | select(.usable and .kind != "cpu") | "\(.index) \(.name)"' >"$OUT/devices"
    while read -r index name; do
        row "$name" --device "$index"
    done <"$OUT/devices"
    [ -s "$OUT/devices" ] || left_out GPU "no device but a CPU is usable here"
    ;;
esac
echo "$sum cases differ in $drawn rows; $out rows are left out"
check "none differs" test "$sum" -eq 0
[ $out -eq 0 ] || [ "$FAILED" -ne 0 ] || exit 77
finish
