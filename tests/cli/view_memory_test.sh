#!/bin/sh
# sh view_memory_test.sh WHIT SCENES: what thousands of boxes of trees took is given back once they are
# gone from the window.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"

{
    printf 'still\nwait 500\nstate before\nwait 2500\npress N\n'
    for level in 1 2 3 4 5 6 7 8 9 10 11 12 13; do echo "press J"; done
    printf 'still\nwait 500\nstate boxes\nwait 2500\npress N\npress N\nstill\nwait 500\nstate after\nwait 2500\n'
} >"$OUT/boxes.replay"
"$WHIT" view "$SCENES/34k.json" --size 240x160 --quiet --replay "$OUT/boxes.replay" \
    >"$OUT/states" 2>"$OUT/stderr" &
viewer=$!
turns=0
# own STATE: kB of the viewer's own, a second after that state.
own() {
    until grep -q "\"at\":\"$1\"" "$OUT/states" || [ $turns -gt 900 ]; do
        turns=$((turns + 1))
        sleep 0.1
    done
    sleep 1
    sed -n 's/^RssAnon:[^0-9]*\([0-9]*\) kB/\1/p' "/proc/$viewer/status" 2>/dev/null
}
before=$(own before)
boxes=$(own boxes)
after=$(own after)
[ $turns -le 900 ] || kill $viewer
wait $viewer
status=$?
check "exit code 0 (got $status)" test $status -eq 0
check "nothing to complain of" test ! -s "$OUT/stderr"
is boxes "keys.boxes of trees" "of meshes"
is after "keys.boxes of trees" off
if [ -n "${ASAN_OPTIONS:-}" ]; then # its allocator keeps what was freed
    echo "memory: $before, $boxes, $after kB; not judged under sanitizers"
    finish
fi
check "boxes take memory ($before, $boxes kB)" test "$boxes" -gt $((before + 20000))
check "and give it back ($after kB)" test $(((after - before) * 4)) -lt $((boxes - before))
finish
