#!/bin/sh
# sh view_random_test.sh WHIT SCENES SECONDS [SEED]: random events cause no crash and no error. If SECONDS is more than
# two minutes, the clock is the real one, and from the first minute on memory grows by less than 5 %. Else pauses take
# no time, and long ones wait for a picture.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
SECONDS_LONG=$3
SEED=${4:-1}
mkdir "$OUT/work"
cd "$OUT/work" || exit 1

# events SECONDS SEED REAL: prints a replay; events without a pause come as fast as the viewer takes them.
events() {
    awk -v end="$1" -v state="$2" -v real="$3" -v scenes="$SCENES" '
        function random(n) { # Lewis, Goodman and Miller 1969; by doubles, exactly
            state = (state * 16807) % 2147483647
            return int(state / 2147483647 * n)
        }
        # The viewer is in the same state at each mark, so that only memory that it did not free can
        # differ: the settings of the start, no panels, no B (after U there is one in any case), and
        # only one scene in the sessions that are kept.
        function mark() {
            print "press Escape\npress U\npress I\ndrop start.view"
            print "drop", scenes "/cube.json\nsize 240 160"
            for (i = 0; i < 5; ++i) print "press R\nstill"
            print "state mark" ++marks
        }
        function pause(most) {
            ms = random(most)
            left -= ms
            print "wait", ms
            if (!real && ms >= 200) print "picture"
        }
        BEGIN {
            if (real) print "clock real"
            keys = split("T Shift+T K M O Minus Equal Y B Shift+B V [ ] \\ Home 0 1 2 3 4 5 6 " \
                "Space Comma Period L 9 Shift+9 R H F1 F2 X I U N J Shift+J G F I U Ctrl+C Ctrl+S Tab Left Right F12", key, " ")
            names = split("cube 8k spin balls whitted default lens layers glass-of-water", name, " ")
            state = state % 2147483646 + 1
            random(2)
            left = end * 1000
            next_mark = left - 60000
            while (left > 0) {
                what = random(100)
                if (left < next_mark) {
                    mark()
                    next_mark -= 60000
                }
                if (what < 40) print "press", key[1 + random(keys)]
                else if (what < 55) { # a drag
                    print "move", random(300), random(200)
                    b = random(3); b = b == 0 ? "left" : b == 1 ? "right" : "middle"
                    print "button", b, "down"
                    for (i = random(12); i >= 0; --i) { print "move", random(300), random(200); pause(30) }
                    print "button", b, "up"
                } else if (what < 65) print "wheel", random(3) - 1, random(7) - 3
                else if (what < 73) print "click", random(300), random(200)
                else if (what < 76) print "size", 1 + random(500), 1 + random(400)
                else if (what < 78) print "drop", scenes "/" name[1 + random(names)] ".json"
                else if (what < 79) print "drop", "/nowhere/" random(10) ".json"
                else if (what < 80) { print "press F11"; pause(300); print "press F11"; print "size 240 160" }
                else if (what < 82) { k = substr("WASDQE", 1 + random(6), 1); print "button right down"
                    print "key", k, "down"; pause(200); print "key", k, "up"; print "button right up" }
                else if (what < 84) print "char", 32 + random(90)
                else pause(what < 97 ? 100 : 1500)
            }
            mark()
        }'
}

echo "--size 240x160" >start.view
long=0
if [ "$SECONDS_LONG" -gt 120 ]; then
    long=1
    unset WHIT_VALIDATION # the layers keep ever more of their own: 199 to 226 MB in six minutes
    LIMIT_S=$((2 * SECONDS_LONG))
fi
events "$SECONDS_LONG" "$SEED" $long >events
echo "$(wc -l <events) events, seed $SEED"
EXPECTED="^whit: error: /nowhere/.*: there is no such file$"
play "random events" "$CUBE" --size 240x160 <events
jq -r '"\(.at): \(.memory_kb.all) kB, \(.memory_kb.own) its own"' "$OUT/states"
marks=$(wc -l <"$OUT/states")
early=$(value mark1 memory_kb.all)
last=$(value "mark$marks" memory_kb.all)
if [ -n "${ASAN_OPTIONS:-}" ]; then # its allocator keeps what was freed
    echo "memory: $early kB after the first minute, $last kB at the end; not judged under sanitizers"
elif [ $long = 1 ]; then
    check "memory: $early kB after the first minute, $last kB at the end" \
        test $((last * 100)) -lt $((early * 105)) -a "$marks" -gt 2
fi
finish
