#!/bin/sh
# The README as it is read: its C program makes a picture, and with `tour` each command of its tour ends
# within 20 s. tour_test.sh WHIT SCENES EXAMPLE [tour]
. "$(dirname "$0")/common.sh"
EXAMPLE=$3
README=$SCENES/../README.md
mkdir "$OUT/here" && cd "$OUT/here" && ln -s "$SCENES" scenes || exit 1
# It ends at once, and leaves to the system what it made.
check "the C program of the README ends well" \
    env "ASAN_OPTIONS=${ASAN_OPTIONS:-}:detect_leaks=0" "$EXAMPLE"
expect 0 "the picture by the program" render scenes/cube.json -o own.png --quiet
expect 0 "is the same" compare cube.png own.png --metric differing --tolerance 0
[ "${4:-}" = tour ] || finish

PATH=$(dirname "$WHIT"):$PATH
export PATH
sed -n '/^## A tour/,/^## /s/^    \(whit [^#]*\).*/\1/p' "$README" >commands
check "the tour has ten commands or more" test "$(grep -c . commands)" -ge 10
check "and 25 lines at most" test "$(sed -n '/^## A tour/,/^## /s/^    //p' "$README" | grep -c .)" -le 25
grep -v "^whit view" commands >ended
while read -r line; do
    # shellcheck disable=SC2086
    check "$line" timeout 20 $line >said 2>&1 </dev/null
    cat said >>"$OUT/stderr"
    grep -E "^(ok|FAILED)" said
    grep -q "^FAILED" said && FAILED=1
done <ended
finish
