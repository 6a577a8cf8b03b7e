#!/bin/sh
# `whit bench view`: the table and its figures, on small pictures; no display.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/files" "$OUT/tmp"
TMPDIR=$OUT/tmp
export TMPDIR

J=$OUT/files/figures.json
expect 0 "the viewer, quick" bench view --quick --scenes "$SCENES" --json "$J"
check "says nothing on a pipe" test ! -s "$OUT/stderr"
for row in "cube, full" "34k, with shadows" "34k, full" "54k, full"; do
    check "a row of $row" grep -q "^| $row" "$OUT/stdout"
done
check "how busy the machine is" grep -q "Load average" "$OUT/stdout"
check "the figures as JSON" grep -q '"bench":"view".*"tables":\[{"table":"view"' "$J"
for key in first_ms idle_share whole_ms quick_ms gap_ms gaps_over_100_ms latency_ms present_ms; do
    check "with $key" grep -q "\"$key\":" "$J"
done
# Each time is one, and the idle window leaves the machine alone.
sane=$(awk -F'|' '/^\| (cube|34k|54k), / { ++rows; if ($3 > 0 && $4 > 0 && $5 > 0 && $6 > 0 && $10 + 0 > 0 && $12 + 0 < 50) ++sane }
    END { print (rows == 4 && sane == 4) }' "$OUT/stdout")
check "every figure is one" test "$sane" = 1
check "no scratch files stay" is_empty "$OUT/tmp"
unset DISPLAY
expect 3 "no display" bench view --quick --scenes "$SCENES" --json "$OUT/files/never"
check "and no file" test "$(ls -A "$OUT/files")" = figures.json
check "no scratch files stay" is_empty "$OUT/tmp"
finish
