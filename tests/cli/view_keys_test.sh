#!/bin/sh
# Keys of the viewer for tracing rays and for heat maps, by replay: states and hit identities.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
SMALL="--size 96x64"

# ---- How rays are traced: another way to the same hits ----

if part 0 2; then
    # Two boxes of one mesh. Light and materials are simple, so that kernels are short and soon compiled.
    cat >"$OUT/boxes.json" <<'JSON'
{ "camera": { "eye": [1.6, 1.3, 2.4], "target": [0, 0, 0], "fov": 45 }, "ambient": 0.12,
  "lights": [ { "kind": "point", "position": [2, 4, 3], "intensity": 24 } ],
  "objects": [ { "shape": "box", "size": 1, "translation": [0.3, 0, 0] },
    { "shape": "box", "size": 1, "translation": [-0.8, 0.2, -0.4], "rotation": [20, 30, 10] } ] }
JSON
    play "traversal, builders, instances" "$OUT/boxes.json" $SMALL <<END
start:
sign: press T | keys.traversal = sign | change.what = traversal distance -> sign
basic: press T | keys.traversal = basic
round: press T | keys.traversal = distance
back: press Shift+T | keys.traversal = basic
sweep: press T, press K | keys.tree builder = sweep | frame.builder = sweep
spatial: press K | keys.tree builder = spatial
median: press K | keys.tree builder = median | change.what = tree builder spatial -> median
binned: press K | keys.tree builder = binned
instances: press O | keys.instance tree = on
flat: press O | keys.instance tree = off | frame.whole = true
again: press O | keys.instance tree = auto
exact: press M | keys.numerics = exact
fast: press M | keys.numerics = fast | frame.whole = true
watertight: press M | keys.numerics = watertight
held: key Escape down, key Escape down, key Escape up | toast = Escape once more quits
END
    for state in sign basic round back sweep spatial median binned instances again exact watertight; do
        same frame.ids start $state
        is $state frame.whole true
        is $state change.other_ids 0
        is $state change.pixels 6144
    done
    for state in sign basic round back sweep spatial median binned; do
        same frame.pixels start $state
    done
fi
if part 1 2; then
    # Where `fast` leaks, the window shows the number of pixels that differ: the same as between two pictures of
    # `whit render`.
    INSIDE="--camera 0,0,0,1,0,0,0,1,0,90 --size 161x121"
    for level in watertight fast; do
        expect 0 "hits of $level" render "$CUBE" -o "$OUT/x.pfm" --ids "$OUT/$level.exr" \
            --numerics $level $INSIDE --quiet
    done
    run compare "$OUT/watertight.exr" "$OUT/fast.exr"
    leaks=$(sed -n 's/.*(\([0-9]*\) of 19481 pixels not the same.*/\1/p' "$OUT/stdout")
    check "\`fast\` leaks here (on $leaks pixels)" test "$leaks" -gt 0
    play "leaks" "$CUBE" $INSIDE <<END
fast: still, press M x2 | change.what = numerics watertight -> fast | change.pixels = 19481 | change.other_ids = $leaks
END
fi

if part 0 2; then
    # F frames one of the two boxes; 0 switches to the next camera.
    play "framed" "$OUT/boxes.json" $SMALL <<END
start:
frame: move 28 32, press F, until probe.number = 1, still | words has ,-0.8,0.2,-0.4,
file: press 0 | words = --size 96x64
own: press 0 | keys.next camera = by hand | toast = whit's own camera | words has --camera
again: press 0 | words = --size 96x64
side: press 2 | toast = from the right
nothing: move 1 1, press F, until toast = nothing is there to frame | toast = nothing is there to frame
END
    # A model in one piece is not framed: the point under the mouse becomes the target, at half the former distance.
    play "nearer" "$CUBE" --size 97x65 --camera 0,0,4,0,0,0,0,1,0,40 <<END
start:
near: move 48 32, press F, until probe.number = 1, still | words has --camera 0,0,2.5,0,0,0.5,0,1,0,40
END
    # The only object under a sky, which whit's own camera shows alone, is framed all the same.
    cat >"$OUT/sky.json" <<'JSON'
{ "ambient": 0.2, "objects": [ { "shape": "icosphere", "level": 3, "radius": 60 },
    { "shape": "box", "translation": [3, 1, -2] } ] }
JSON
    play "under a sky" "$OUT/sky.json" $SMALL <<END
start:
frame: move 40 28, press F, until probe.number = 1, still | words has ,3,1,-2,
END
    # Without trees the picture is the same, and with trees again.
    play "no trees" "$CUBE" $SMALL <<END
start:
off: press G | keys.trees = off | frame.ids as start | frame.pixels as start | change.other_ids = 0
on: press G | keys.trees = on
END
fi

if part 1 2; then
    # If there are too many primitives to test each, `no trees` is refused, and the tree stays.
    play "no trees, too much" "$SCENES/54k.json" $SMALL <<END
placed:
refused: press G, until keys.trees = on | keys.trees = on | frame.number as placed | frame.pixels as placed
    | toast = $SCENES/54k.json: without trees every ray tests every primitive, and 54450 over all instances are too many: 40000 are possible, fewer in thousands of instances
END

    # ---- Bounces and samples, and what is painted ----

    play "upright, light and background" "$CUBE" --size 48x32 <<END
x: press 7 | keys.up = x | words = --size 48x32 --up x
file: press 8 | keys.light = the file's | words = --size 48x32 --up x --light file
white: press Slash | keys.background = white | words has --background
back: press Shift+7, press Shift+8, press Shift+Slash | words = --size 48x32
END

    # A model that is turned has another camera of whit's, from which the user goes on: its middle was at x = 5.
    printf 'v %s\n' '4 -1 0' '6 -1 0' '5 1 0' >"$OUT/aside.obj"
    echo 'f 1 2 3' >>"$OUT/aside.obj"
    play "a turned model" "$OUT/aside.obj" --size 48x32 <<END
start: | words = --size 48x32
turned: press 7, still, press 1 | words has ,0,5,0,0,1,0, | words has --up x
END

    play "bounces, samples, views" "$SCENES/balls.json" --size 48x32 <<END
start: | keys.bounces = 8 | frame.view = color
depth: press B | frame.view = depth | frame.ids as start
visits: press Shift+B | frame.pixels not as depth | frame.view = visits | frame.ids as start
stack: press Shift+B x3 | frame.view = stack | frame.ids as start
again: press Shift+B | frame.pixels as depth | frame.view = depth
color: press B | frame.pixels as start | frame.view = color
v: press V | frame.view = depth
twice: key ] down, key ] up
half: key [ down, key [ up, key [ down, key [ up | frame.pixels not as twice
own: key \\ down, key \\ up | frame.pixels as depth | frame.pixels not as twice
    | keys.twice the scale = by the picture
seven: press B, press Minus | keys.bounces = 7
one: press Minus x6 | keys.bounces = 1
zero: press Minus | keys.bounces = 0 | change.what = bounces 1 -> 0 | frame.ids as start | frame.pixels not as start
lowest: press Minus | keys.bounces = 0
up: press Equal | keys.bounces = 1 | frame.pixels as one
four: press Y | frame.samples = 4
sixtyfour: press Y x2 | frame.samples = 64 | frame.pixels not as four
adaptive: press Y | keys.anti-aliasing = adaptive | words = --size 48x32 --aa adaptive:0.05 --depth 1
single: press Y | frame.samples = 1 | frame.pixels as up
END

fi
finish
