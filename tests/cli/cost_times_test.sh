#!/bin/sh
# Times by the clocks of the machine: `whit cost` finds 10 % more work, and only in its row; `whit bench` finds that
# pictures with trees are faster than without. This test is long. The third argument is a whit with the fault that
# WHIT_TEST_WRONG names.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/cost_common.sh"
PLAIN=$WHIT WHIT=$WRONG
WHIT_TEST_CLOCK=real
export WHIT_TEST_CLOCK
C=$OUT/files/right.csv
D=$OUT/files/slow.csv

# Rays that a convex body reflects meet nothing, so that 16 bounces take as long as 8.
sed 's/"specular": 0.3/"reflection": 0.3/' "$CUBE" >"$OUT/mirror.json"
deep="$OUT/mirror.json --size 160x120 --quick --rays 0 --quiet --knobs depth --reference-samples 4 --spend 8"
expect 0 "as it is" cost $deep --csv "$C"
wrong slow expect 0 "10 % slower" cost $deep --csv "$D"
right=$(value "$C" depth 16 ratio) slowed=$(value "$D" depth 16 ratio)
check "16 bounces cost about what 8 do (x $right)" holds "0.9 < $right && $right < 1.1"
check "10 % more work is found (x $slowed)" test "$(value "$D" depth 16 verdict)" = 1
check "about as much as it is" holds "0.05 < $slowed - $right && $slowed - $right < 0.15"
check "and in no other row" test "$(value "$D" depth 4 verdict)" != 1

WHIT=$PLAIN # which has whit-bench beside it
[ -x "$(dirname "$WHIT")/whit-bench" ] || finish
expect 0 "the report, quick" bench report --quick --scenes "$SCENES" --json "$OUT/files/figures.json"
slow=$(awk -F'|' '/^\| 34k, tree/ { tree = $5 } /^\| 34k, no tree/ { none = $5 }
    END { print (none + 0 > 2 * (tree + 0)) }' "$OUT/stdout")
check "34k is slower without a tree" test "$slow" = 1
finish
