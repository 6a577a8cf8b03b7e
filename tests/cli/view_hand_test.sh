#!/bin/sh
# sh view_hand_test.sh WHIT SCENES HAND: the viewer with a window manager and real events is minimised and restored,
# used by hand, recorded and replayed, and closed. The program HAND is the window manager and makes the events.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
HAND=$3
mkfifo "$OUT/orders" "$OUT/answers" "$OUT/recorded"

# hand [DPI]: starts HAND, and waits until it is ready for a window; it takes orders from file descriptor 4.
hand() {
    timeout $((100 * ${WHIT_TEST_PATIENCE:-1})) "$HAND" "$@" <"$OUT/orders" >"$OUT/answers" &
    hand=$!
    exec 4>"$OUT/orders" 6<"$OUT/answers"
    read -r ready <&6
    check "the hand is $ready" test "$ready" = ready
}
# rest: waits until HAND has ended, once its window is gone.
rest() {
    exec 4>&-
    wait $hand
    cat <&6 >"$OUT/hand"
    exec 6<&-
}

hand
play "minimise, restore" "$CUBE" --size 96x64 <<END
start: | window_width = 96
minimised: minimise | window_width = 0 | window_height = 0
hidden! press T, still, wait 1000 | keys.traversal = sign | frame.number as minimised | measure.drawn = 0
back: restore | window_width = 96 | frame.whole = true | change.other_ids = 0 | frame.ids as start
END
rest

# Full screen by the window manager, and minimised from there.
hand
play "full screen" "$CUBE" --size 96x64 <<END
start:
full: press F11 | window_width = 1280 | frame.height = 1024 | frame.whole = true | keys.full screen = on
minimised: minimise | window_width = 0
again: restore | window_width = 1280
back: press F11 | window_width = 96 | keys.full screen = off | frame.ids as start
END
rest
check "it was the window manager that did it" grep -q "^full$" "$OUT/hand"
check "and undid it" grep -q "^window$" "$OUT/hand"

# The size of text follows the X resource that desktops set, and the option --ui-scale.
for dpi in 96 144 192; do
    hand $dpi
    play "a screen of $dpi dots an inch" "$CUBE" --size 640x480 <<END
shown:
END
    rest
    is shown ui_scale "$(awk -v d=$dpi 'BEGIN { print d / 96 }')"
    value shown panels.figures >"$OUT/figures.$dpi"
done
wide() {
    awk '{ print $3 - $1 }' "$OUT/figures.$1"
}
check "figures are larger on a finer screen ($(wide 96), $(wide 192) pixels)" \
    holds "$(wide 192) > 1.6 * $(wide 96) && $(wide 192) < 2.4 * $(wide 96)"
hand 192
play "the option has the last word" "$CUBE" --size 96x64 --ui-scale 1 <<END
shown: | ui_scale = 1
END
rest

# A recorded session and its replay end in the same state. Each order waits for the first picture or for the record of
# the orders before. The window's title shows control characters as escapes.
# recorded LINE: waits until the viewer has handled and recorded this event.
recorded() {
    while read -r line <&5; do
        echo "$line" >>"$OUT/record"
        [ "$line" != "$1" ] || break
    done
}
NAMED=$OUT/$(printf 'c\033\302\233\377.json')
cp "$CUBE" "$NAMED"
hand
timeout $((100 * ${WHIT_TEST_PATIENCE:-1})) "$WHIT" view "$NAMED" --size 96x64 --quiet \
    --record "$OUT/recorded" >"$OUT/stdout" 2>"$OUT/stderr" &
viewer=$!
exec 5<"$OUT/recorded"
printf 'title c\\u001b\\u009b\\xff.json\nkey t\nkey k\nmove 40 30\nbutton 1 down\nmove 50 34\n' >&4
recorded "move 50 34"
printf 'move 60 38\nbutton 1 up\nbutton 4 down\nbutton 4 up\nclose\n' >&4
recorded close
wait $viewer
status=$?
exec 5<&-
rest
check "closed by its cross: exit code 0 (got $status)" test "$status" -eq 0
check "nothing to complain of" test ! -s "$OUT/stderr"
for line in "clock real" "key T down" "key T up" "key K down" "button left down" "button left up" \
    "wheel 0 1" close; do
    check "\`$line\` was recorded" grep -q "^$line$" "$OUT/record"
done
check "and where the mouse was" grep -q "^move 60 38$" "$OUT/record"
{
    echo still # the scene is there, as it was for him
    sed -e '/^close$/d' -e '/^clock real$/d' "$OUT/record"
    printf 'still\nstate end\n'
} >"$OUT/again"
for turn in 1 2; do
    play "replay $turn" "$CUBE" --size 96x64 <"$OUT/again"
    value end words >"$OUT/words.$turn"
    value end frame.ids >"$OUT/ids.$turn"
    is end "keys.traversal" sign
    is end "keys.tree builder" sweep
    is end "keys.next camera" "by hand"
done
check "two replays end in the same words" cmp "$OUT/words.1" "$OUT/words.2"
check "and hits" cmp "$OUT/ids.1" "$OUT/ids.2"
# A replay with other moves, but the same drag of 20 x 8 pixels and notch of the wheel, gives the same words.
cp "$OUT/words.1" "$OUT/hand.words"
play "by replay alone" "$CUBE" --size 96x64 <<END
end: still, press T, press K, move 40 30, button left down, move 50 34, move 60 38, button left up, wheel 0 1
END
check "the record holds what was done ($(value end words))" \
    test "$(value end words)" = "$(cat "$OUT/hand.words")"
finish
