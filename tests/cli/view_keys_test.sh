#!/bin/sh
# Keys of the viewer that say how rays are traced and what is painted: by replay, on states and hit
# identities.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
SMALL="--size 96x64"

# ---- How rays are traced: another way to the same hits ----

# shellcheck disable=SC2086
play "traversal, builders, instances" "$SCENES/spin.json" $SMALL <<END
still
state start
press T
still
state sign
press T
still
state basic
press T
still
state round
press Shift+T
still
state back
press T
press K
still
state sweep
press K
still
state spatial
press K
still
state median
press K
still
state binned
press O
still
state instances
press O
still
state flat
press O
still
state again
press M
still
state exact
press M
still
state fast
press M
still
state watertight
END
for at in "sign traversal|sign" "basic traversal|basic" "round traversal|distance" \
    "back traversal|basic" "sweep tree|builder|sweep" "spatial tree|builder|spatial" \
    "median tree|builder|median" "binned tree|builder|binned" "instances instance|tree|on" \
    "flat instance|tree|off" "again instance|tree|auto" "exact numerics|exact" "fast numerics|fast" \
    "watertight numerics|watertight"; do
    state=${at%% *}
    key=${at#* }
    is "$state" "keys.$(echo "${key%|*}" | tr '|' ' ')" "${key##*|}"
    is "$state" frame.whole true
done
for state in sign basic round back sweep spatial median binned instances again exact watertight; do
    same frame.ids start $state
    is $state change.other_ids 0
    is $state change.pixels 6144
done
for state in sign basic round back sweep spatial median binned; do
    same frame.pixels start $state
done
is sign change.what "traversal distance -> sign"
is median change.what "builder spatial -> median"
# Where `fast` leaks, the window says on how many pixels: as many as two pictures of `whit render`.
INSIDE="--camera 0,0,0,1,0,0,0,1,0,90 --size 161x121"
for level in watertight fast; do
    # shellcheck disable=SC2086
    expect 0 "hits of $level" render "$CUBE" -o "$OUT/x.pfm" --ids "$OUT/$level.exr" \
        --numerics $level $INSIDE --quiet
done
run compare "$OUT/watertight.exr" "$OUT/fast.exr"
leaks=$(sed -n 's/.*(\([0-9]*\) of 19481 pixels not the same.*/\1/p' "$OUT/stdout")
check "\`fast\` leaks here (on $leaks pixels)" test "$leaks" -gt 0
# shellcheck disable=SC2086
play "leaks" "$CUBE" $INSIDE <<END
still
press M
press M
still
state fast
END
is fast change.what "numerics watertight -> fast"
is fast change.other_ids "$leaks"
is fast change.pixels 19481

# Without trees: the same again, and back.
# shellcheck disable=SC2086
play "no trees" "$CUBE" $SMALL <<END
still
state start
press G
still
state off
press G
still
state on
END
is off keys.trees off
is on keys.trees on
same frame.ids start off
same frame.pixels start off
is off change.other_ids 0

# Where there is too much to test it is refused, and the tree stays.
# shellcheck disable=SC2086
play "no trees, too much" "$SCENES/54k.json" $SMALL <<END
still
state placed
press G
until keys.trees = on
still
state refused
END
is refused keys.trees on
same frame.number placed refused
same frame.pixels placed refused
is refused toast "$SCENES/54k.json: without trees every ray tests every primitive, and 54450 over all instances are too many: 40000 are possible, fewer in thousands of instances"

# ---- Bounces and samples, and what is painted ----

# shellcheck disable=SC2086
play "bounces, samples, views" "$SCENES/balls.json" --size 48x32 <<END
still
state start
press B
still
state depth
press Shift+B
still
state visits
press Shift+B
press Shift+B
press Shift+B
still
state stack
press Shift+B
still
state again
press B
still
state color
press V
still
state v
key ] down
key ] up
still
state twice
key [ down
key [ up
key [ down
key [ up
still
state half
key \\ down
key \\ up
still
state own
press B
press Minus
still
state seven
press Minus
press Minus
press Minus
press Minus
press Minus
press Minus
still
state one
press Minus
still
state zero
press Minus
still
state lowest
press Equal
still
state up
press A
still
state four
press A
press A
still
state sixtyfour
press A
still
state adaptive
press A
still
state single
END
is start "keys.bounces" 8
is seven "keys.bounces" 7
is one "keys.bounces" 1
is zero "keys.bounces" 0
is lowest "keys.bounces" 0
is up "keys.bounces" 1
is zero change.what "bounces 1 -> 0"
same frame.ids start zero
differs frame.pixels start zero
same frame.pixels one up
is four frame.samples 4
is sixtyfour frame.samples 64
is adaptive "keys.anti-aliasing" adaptive
is adaptive words "--size 48x32 --aa adaptive:0.05 --depth 1"
is single frame.samples 1
same frame.pixels up single
differs frame.pixels four sixtyfour

for at in "start color" "depth depth" "visits visits" "stack stack" "again depth" "color color" "v depth"; do
    is "${at% *}" frame.view "${at#* }"
done
same frame.pixels start color
same frame.pixels depth again
same frame.pixels depth own
differs frame.pixels depth visits
differs frame.pixels own twice
differs frame.pixels twice half
is own "keys.twice the scale" "by the picture"
for at in depth visits stack; do
    same frame.ids start $at
done
finish
