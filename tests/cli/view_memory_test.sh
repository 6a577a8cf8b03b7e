#!/bin/sh
# sh view_memory_test.sh WHIT SCENES: the memory of thousands of drawn boxes of trees is freed once they are gone from
# the window.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"

play "boxes" "$SCENES/34k.json" --size 240x160 <<END
before:
boxes: press N, press J x13 | keys.boxes of trees = of meshes
after: press N x2 | keys.boxes of trees = off
END
before=$(value before memory_kb.own)
boxes=$(value boxes memory_kb.own)
after=$(value after memory_kb.own)
if [ -n "${ASAN_OPTIONS:-}" ]; then # its allocator keeps what was freed
    echo "memory: $before, $boxes, $after kB; not judged under sanitizers"
    finish
fi
check "boxes take memory ($before, $boxes kB)" test "$boxes" -gt $((before + 20000))
check "and give it back ($after kB)" test $(((after - before) * 4)) -lt $((boxes - before))
finish
