#!/bin/sh
# The viewer's window: cameras, time, sizes, ways to present pictures and to end.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1
SLOW=$3
SMALL="--size 96x64"
WIDE=${WHIT_TEST_SCREEN%x*}
HIGH=${WHIT_TEST_SCREEN#*x}

# ---- Cameras ----

if part 0 2; then
    play "cameras" "$SCENES/spin.json" $SMALL <<END
start:
around: move 40 30, button left down, move 60 40, button left up | keys.next camera = by hand
aside: move 40 30, button middle down, move 60 40, button middle up
near: wheel 0 1
far: wheel 0 -1 | words as aside | frame.ids as aside
look: button right down, move 50 45, button right up
fly: key W down, wait 60, key W up
fit: press S, still, press Home
file: press 0 | frame.ids as start | words = --size 96x64 | keys.next camera = camera
front: press 1
right: press 2
above: press 3
behind: press 4
left: press 5
below: press 6
same: press W, press D | words as below
END
    before=start
    for at in around aside near look fly fit file front right above behind left below; do
        differs words $before $at
        differs frame.ids $before $at
        is $at frame.whole true
        before=$at
    done
    # along NAME AXIS SIGN: the camera looks along an axis, so that eye and target differ in that coordinate alone.
    along() {
        value "$1" words | sed 's/.*--camera //' | awk -F, -v axis="$2" -v sign="$3" '
            function size(x) { return x < 0 ? -x : x }
            { for (i = 0; i < 3; ++i) { d[i] = $(i + 1) - $(i + 4); far += i != axis ? size(d[i]) : 0 }
              exit !(d[axis] * sign > 0 && far <= 0.1 * size(d[axis])) }'
    }
    for at in "front 2 1" "right 0 1" "above 1 1" "behind 2 -1" "left 0 -1" "below 1 -1"; do
        check "at ${at%% *}: the camera looks along its axis" along $at
    done
fi

# Home stays in a room, where whit's own camera is.
if part 0 2; then
    printf 'v %s\n' '-3 0 -2' '3 0 -2' '3 0 2' '-3 0 2' '-3 3 -2' '3 3 -2' '3 3 2' '-3 3 2' >room.obj
    printf 'f %s\n' '4 3 2 1' '5 6 7 8' '2 6 5 1' '4 8 7 3' '1 5 8 4' '3 7 6 2' >>room.obj
    play "a room" room.obj $SMALL <<END
start:
near: wheel 0 3
home: press Home | frame.ids as start
END
    differs frame.ids start near
fi

# While the camera is dragged the window is drawn when there is a new picture, not at each move of the mouse.
if part 0 2; then
    play "a drag" "$SCENES/spin.json" $SMALL <<END
start: move 40 30, button left down
$(for i in 1 2 3 4 5 6 7 8 9 10 11 12; do echo "move $((40 + i)) $((40 - i))"; echo picture; done)
dragged!
END
    drawn=$(value dragged measure.drawn) pictures=$(value dragged measure.gap_ms.count)
    check "each move has a picture ($pictures)" test "$pictures" -ge 8
    check "the window is drawn once a picture ($drawn)" test "$drawn" -le "$((pictures + 4))"

    # Small pictures leave out rays of little weight, which the window says; at rest nothing is left out.
    play "a drag that is too fast" "$SCENES/balls.json" $SMALL --fps-goal 1000 <<END
start: move 40 30, button left down
move 45 30
picture
small! | quality has of the size, 1 sample, bailout 1/64
rest: button left up | quality = full size, 1 sample
END
fi

# ---- Time ----

if part 1 2; then
    # A camera of the file that moves: the user goes on from where it is.
    cat >"$OUT/moves.json" <<JSON
{ "objects": [ { "shape": "plane", "size": 10 } ], "camera": { "eye": [0, 2, 6],
  "animation": { "translation": { "times": [0, 4], "values": [[0, 0, 0], [4, 0, 0]] } } } }
JSON
    play "a camera that moves" "$OUT/moves.json" $SMALL --time 1 <<END
start:
near: wheel 0 1 | words has --camera 1,1.
file: press 0 | words not as near
later: press Space, wait 1500, press Space, still, wheel 0 1 | words has --camera 2.5,1.
END

    play "animation" "$SCENES/spin.json" $SMALL --fps 10 <<END
start:
two: press Period x2 | time_s = 0.2 | frame.ids not as start
one: press Comma | time_s = 0.1
last: press Comma x2 | time_s = 4
first: press Period | time_s = 0 | frame.ids as start
slow! press L, press 9 | keys.animation runs = once | keys.double speed = x 0.5
fast! press Shift+9 x2 | keys.double speed = x 2
later: press Space, wait 300, press Space | playing = false
end: press Shift+9 x3, press Space, wait 900 | playing = false | time_s = 4
END
    check "300 ms at double speed are 0.6 s ($(value later time_s))" \
        about 0.6 "$(value later time_s)"
fi

# ---- Sizes ----

if part 0 2; then
    play "sizes" "$CUBE" --size 200x100 <<END
start:
tall: size 90 120 | window_width = 90 | frame.width = 90 | frame.height = 120 | frame.whole = true
back: size 200 100 | frame.ids as start | frame.pixels as start
full: press F11 | window_width = $WIDE | frame.height = $HIGH | keys.full screen = on
window: shot full.png, press F11 | window_width = 200 | frame.ids as start
END
    check "a picture of the full screen" test "$(od -An -tu1 -j16 -N8 full.png | tr -s ' ')" = \
        "$(printf ' 0 0 %d %d 0 0 %d %d' $((WIDE / 256)) $((WIDE % 256)) $((HIGH / 256)) $((HIGH % 256)))"
    play "full screen from the start" "$CUBE" --size 200x100 --fullscreen <<END
full: | window_width = $WIDE
window: press F11 | window_width = 200
END
fi

# ---- Ways to the screen ----

if part 1 2; then
    # Without figures over it, the window shows exactly the picture.
    for way in vsync no-vsync; do
        option=
        [ "$way" = vsync ] || option=--$way
        play "$way" "$CUBE" --size 200x100 $option <<END
shown! press F2 x2, still, shot $way.png | hud = off | frame.whole = true
END
    done
    expect 0 "the same picture" render "$CUBE" --size 200x100 -o render.png --quiet
    for way in vsync no-vsync; do
        expect 0 "$way and \`whit render\`" compare $way.png render.png --tolerance 0 --metric largest
    done
fi

# ---- Help and figures ----

play "help, figures, Escape twice" "$CUBE" $SMALL <<END
start: | help = false
still! press Space | playing = false | toast = nothing moves in this scene
help: press H | help = true
closed: press Escape | help = false
f1! press F1 | help = true
full! press F1, press F2 | hud = full
off! press F2 | hud = off
small! press F2 | hud = small | frame.ids as start
once! press Escape | toast = Escape once more quits
late! wait 1600, press Escape | toast = Escape once more quits
told! wait 3900 | toast = Escape once more quits
silent! wait 200 | toast =
press Escape
press Escape
wait 60000
END

# ---- Slow kernels and pictures ----

if part 0 2; then
    # Escape, or switching back, stops the compilation of another kernel, which this whit would never finish.
    patient=$WHIT
    WHIT=$SLOW
    export WHIT_TEST_SLOW=kernel
    play "a switch that is stopped" "$CUBE" $SMALL <<END
start:
working! press G, until work = compiling the kernel | keys.trees = off
stopped: press Escape | toast = stopped: as it was | keys.trees = on | work = | words as start | frame.number as start
back: press G, until work, press G | keys.trees = on | work = | words as start | frame.number as start
once! press Escape | toast = Escape once more quits
END

    # A closed window does not wait for a driver.
    export WHIT_TEST_SLOW=driver
    LIMIT_S=30 play "a kernel that is never done" "$CUBE" $SMALL <<END
start:
working! press G, until work = compiling the kernel | keys.trees = off
close
END

    # The window shows the progress of a slow picture, and the user can switch back before it is done.
    export WHIT_TEST_SLOW=picture
    play "a slow picture" "$CUBE" $SMALL <<END
start:
slow! press G, until part, until panels.work | keys.trees = off | frame.ids as start
back: press G | frame.ids as start
END
    unset WHIT_TEST_SLOW
    WHIT=$patient
    part=$(value slow part)
    check "it says which part is done ($part)" holds "$part > 0 && $part < 1"
    check "at slow: it is shown" test "$(value slow panels.work)" != "(no panels.work)"
fi

# ---- Ways to end ----

play "close" "$CUBE" $SMALL <<END
still
close
wait 60000
END
expect 0 "--frames" view "$CUBE" --size 96x64 --frames 3
check "--frames: nothing to complain of" test ! -s "$OUT/stderr"
refuse 2 "--frames 0" "1" view "$CUBE" --frames 0

# What was added to a model is said once, also if the scene is made again for another setting.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$OUT/dark.obj"
printf 'still\npress Tab\nstill\nchoose up\nstill\nchoose z\nstill\n' >"$OUT/turned"
expect 0 "a model without light" view "$OUT/dark.obj" --size 640x480 --replay "$OUT/turned"
check "its light is said" test "$(grep -c "^whit: note: no light in the file: a directional one was added" "$OUT/stderr")" -eq 1
expect 0 "the same quietly" view "$OUT/dark.obj" --size 96x64 --frames 1 --quiet
check "nothing is said" test ! -s "$OUT/stderr"

# ---- No window ----

# A display that goes away while the window is open.
mkfifo "$OUT/number" "$OUT/shown"
printf 'still\nstate shown\nwait 600000\n' >"$OUT/waits"
Xvfb -displayfd 3 -screen 0 320x240x24 -nolisten tcp 3>"$OUT/number" 2>"$OUT/server" </dev/null >"$OUT/server" &
server=$!
read -r number <"$OUT/number"
DISPLAY=:$number "$WHIT" view "$CUBE" $SMALL --remember no --replay "$OUT/waits" >"$OUT/shown" 2>"$OUT/stderr" &
viewer=$!
exec 5<"$OUT/shown"
read -r line <&5
kill -9 $server
cat <&5 >"$OUT/rest"
wait $viewer
status=$?
wait $server
exec 5<&-
check "the display is gone ($line): exit code 3 (got $status)" test "$status" -eq 3
check "the display is gone: says so" grep -q "the display of the window is gone.*whit render" "$OUT/stderr"
export WHIT_FAULT=vkCreateSurface:1
run view "$CUBE" --frames 1
check "no surface: exit code 2 or 3 (got $status)" test "$status" -eq 2 -o "$status" -eq 3
check "no surface: says so" grep -q "the window's surface" "$OUT/stderr"
unset WHIT_FAULT
finish
