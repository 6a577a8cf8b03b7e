#!/bin/sh
# The viewer's window and what moves in it: cameras, time, sizes, ways to show and to end.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1
SLOW=$3
SMALL="--size 96x64"
WIDE=${WHIT_TEST_SCREEN%x*}
HIGH=${WHIT_TEST_SCREEN#*x}

# ---- Cameras ----

# shellcheck disable=SC2086
play "cameras" "$SCENES/spin.json" $SMALL <<END
still
state start
move 40 30
button left down
move 60 40
button left up
still
state around
move 40 30
button middle down
move 60 40
button middle up
still
state aside
wheel 0 1
still
state near
wheel 0 -1
still
state far
button right down
move 50 45
still
state look
key W down
wait 60
key W up
still
state fly
press S
button right up
still
press Home
still
state fit
press 0
still
state file
press 1
still
state front
press 2
still
state right
press 3
still
state above
press 4
still
state behind
press 5
still
state left
press 6
still
state below
press W
press D
still
state same
END
before=start
for at in around aside near look fly fit file front right above behind left below; do
    differs words $before $at
    differs frame.ids $before $at
    is $at frame.whole true
    before=$at
done
same words aside far
same frame.ids aside far
same frame.ids start file
is file words "--size 96x64"
is file "keys.next camera of the file" camera
is around "keys.next camera of the file" "by hand"
same words below same
# Along an axis: the eye differs from the target in that coordinate alone.
along() {
    value "$1" words | sed 's/.*--camera //' | awk -F, -v axis="$2" -v sign="$3" '
        function size(x) { return x < 0 ? -x : x }
        { for (i = 0; i < 3; ++i) { d[i] = $(i + 1) - $(i + 4); far += i != axis ? size(d[i]) : 0 }
          exit !(d[axis] * sign > 0 && far <= 0.1 * size(d[axis])) }'
}
for at in "front 2 1" "right 0 1" "above 1 1" "behind 2 -1" "left 0 -1" "below 1 -1"; do
    # shellcheck disable=SC2086
    check "at ${at%% *}: the camera looks along its axis" along $at
done

# ---- Time ----

# shellcheck disable=SC2086
play "animation" "$SCENES/spin.json" $SMALL --fps 10 <<END
still
state start
press Period
press Period
still
state two
press Comma
still
state one
press Comma
press Comma
still
state last
press Period
still
state first
press L
press 9
state slow
press Shift+9
press Shift+9
state fast
press Space
wait 300
press Space
still
state later
press Shift+9
press Shift+9
press Shift+9
press Space
wait 900
still
state end
END
is two time_s 0.2
is one time_s 0.1
is last time_s 4
is first time_s 0
same frame.ids start first
differs frame.ids start two
is slow "keys.animation runs" once
is slow "keys.double speed" "x 0.5"
is fast "keys.double speed" "x 2"
is later playing false
check "300 ms at double speed are 0.6 s ($(value later time_s))" \
    awk -v t="$(value later time_s)" 'BEGIN { exit !(t > 0.599999 && t < 0.600001) }'
is end playing false
is end time_s 4

# ---- Sizes ----

play "sizes" "$CUBE" --size 200x100 <<END
still
state start
size 90 120
still
state tall
size 200 100
still
state back
press F11
still
state full
shot full.png
press F11
still
state window
END
is tall window_width 90
is tall frame.width 90
is tall frame.height 120
is tall frame.whole true
same frame.ids start back
same frame.pixels start back
is full window_width "$WIDE"
is full frame.height "$HIGH"
is full "keys.full screen" on
is window window_width 200
same frame.ids start window
check "a picture of the full screen" test "$(od -An -tu1 -j16 -N8 full.png | tr -s ' ')" = \
    "$(printf ' 0 0 %d %d 0 0 %d %d' $((WIDE / 256)) $((WIDE % 256)) $((HIGH / 256)) $((HIGH % 256)))"
play "full screen from the start" "$CUBE" --size 200x100 --fullscreen <<END
still
state full
press F11
still
state window
END
is full window_width "$WIDE"
is window window_width 200

# ---- Ways to the screen ----

# What the window shows, without figures over it, is the picture.
for way in direct blit "no-vsync"; do
    option=
    [ "$way" = direct ] || option=--$way
    # shellcheck disable=SC2086
    play "$way" "$CUBE" --size 200x100 $option <<END
press F2
press F2
still
shot $way.png
state shown
END
    is shown hud off
    is shown frame.whole true
done
is shown direct true
check "--blit copies" test "$(grep -c '"direct":false' "$OUT/states")" -eq 0
expect 0 "the same picture" render "$CUBE" --size 200x100 -o render.png --quiet
for way in direct blit no-vsync; do
    expect 0 "$way and \`whit render\`" compare $way.png render.png --tolerance 0 --metric largest
done

# ---- Help and figures ----

# shellcheck disable=SC2086
play "help, figures, Escape twice" "$CUBE" $SMALL <<END
still
state start
press Space
state still
press H
still
state help
press Escape
still
state closed
press F1
state f1
press F1
press F2
state full
press F2
state off
press F2
state small
press Escape
state once
wait 1600
press Escape
state late
wait 3900
state told
wait 200
state silent
press Escape
press Escape
wait 60000
END
is still playing false
is still toast "nothing moves in this scene"
is start help false
is help help true
is closed help false
is f1 help true
is full hud full
is off hud off
is small hud small
same frame.ids start small
is once toast "Escape once more quits"
is late toast "Escape once more quits"
is told toast "Escape once more quits"
is silent toast ""

# ---- What takes long ----

# Another kernel in the making is stopped by Escape, or by taking the switch back: it would go on
# until then.
patient=$WHIT
WHIT=$SLOW
export WHIT_TEST_SLOW=kernel
# shellcheck disable=SC2086
play "a switch that is stopped" "$CUBE" $SMALL <<END
still
state start
press G
until work = compiling the kernel
state working
press Escape
still
state stopped
press G
until work
press G
still
state back
press Escape
state once
END
is working "keys.trees" off
is stopped toast "stopped: as it was"
for at in stopped back; do
    is $at "keys.trees" on
    is $at work ""
    same words start $at
    same frame.number start $at
    same frame.pixels start $at
done
is once toast "Escape once more quits"

# A slow picture says how far it is, and can be left.
export WHIT_TEST_SLOW=picture
# shellcheck disable=SC2086
play "a slow picture" "$CUBE" $SMALL <<END
still
state start
press G
picture
until part
until panels.work
state slow
press G
still
state back
END
unset WHIT_TEST_SLOW
WHIT=$patient
is slow "keys.trees" off
is slow frame.whole false
part=$(value slow part)
check "it says which part is done ($part)" awk -v p="$part" 'BEGIN { exit !(p > 0 && p < 1) }'
check "at slow: it is shown" test "$(value slow panels.work)" != "(no panels.work)"
same frame.ids start back

# ---- Ways to end ----

# shellcheck disable=SC2086
play "close" "$CUBE" $SMALL <<END
still
close
wait 60000
END
expect 0 "--frames" view "$CUBE" --size 96x64 --frames 3
check "--frames: nothing to complain of" test ! -s "$OUT/stderr"
refuse 2 "--frames 0" "1" view "$CUBE" --frames 0

# ---- No window ----

(
    unset DISPLAY
    refuse 3 "no display" "whit render" view "$CUBE" --frames 1
    exit $FAILED
) || FAILED=1
export WHIT_FAULT=vkCreateSurface:1
run view "$CUBE" --frames 1
check "no surface: exit code 2 or 3 (got $status)" test "$status" -eq 2 -o "$status" -eq 3
check "no surface: says so" grep -q "the window's surface" "$OUT/stderr"
unset WHIT_FAULT
finish
