#!/bin/sh
# At rest the window's picture is refined: it is, byte for byte, that of `whit render` with the same number of samples.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work" && cd "$OUT/work" || exit 1
SCENES=$(realpath "$SCENES")
# With a small object in the picture refining ends soon, because few samples are enough for a picture that stays.
camera="--camera 1.6,1.3,2.4,0,0,0,0,1,0"

# shellcheck disable=SC2086
play "refined" "$SCENES/cube.json" --size 48x36 --aa 4 $camera,90 <<END
start: | frame.samples = 4 | frame.estimates = 2
refined
better: | frame.samples > 4 | frame.pixels not as start | frame.ids as start | words as start | frame.whole = true
    | frame.number > 2 | frame.estimates > 1 | frame.error > 0.0001
press F12
copied: press Ctrl+C | frame.pixels as better
sharp: press T | change.pairs = 0 | frame.samples as better | frame.pixels as better | frame.ids as start | change.other_colors = 0
refined
measured: | change.pairs > 5 | change.number as sharp | frame.pixels as better | frame.samples as better
back: press Shift+T | frame.pixels as better | change.pairs = 0
picked: click 24 18 | picked = true
other: press Equal | frame.samples = 4 | frame.estimates = 2
less: press Minus | frame.samples = 4 | frame.pixels as start
refined
again: | frame.pixels as better | frame.samples as better
split: press I | frame.samples = 4 | frame.pixels as start | compare.known = true
    | compare.other_colors = 0 | compare.b.pixels is frame.pixels of start
refined
both: | compare.known = true | compare.other_colors = 0 | compare.other_ids = 0 | frame.pixels as better
    | frame.samples as better | compare.b.pixels is frame.pixels of better
alone: press I | compare.mode = off
refined
third: | frame.pixels as better
depth: press B | frame.samples = 1
refined
costs: | frame.pixels as depth | frame.samples = 1
END
samples=$(value better frame.samples)
check "the estimate is of what is shown" test "$(value better frame.error_samples)" -eq "$samples"
doublings=$(awk -v n="$samples" 'BEGIN { while (n > 1) { n /= 2; k++ } print k }')
check "one estimate each time that samples were doubled" test "$(value better frame.estimates)" -eq "$doublings"
# shellcheck disable=SC2086
expect 0 "the same picture" render "$SCENES/cube.json" --size 48x36 $camera,90 --aa "$samples" -o same.png --quiet
expect 0 "F12 saved it" compare same.png whit-0001.png --metric largest --tolerance 0
check "with the rays of all samples" test "$(grep -ao '"primary":[0-9]*' whit-0001.png)" = '"primary":'$((48 * 36 * samples))
check "with its samples in the recipe" grep -aq -- "whit render .*--aa $samples " whit-0001.png
check "the line of Ctrl+C names them" grep -q -- "--aa $samples -o" <<END
$(value copied render)
END
# A new picture is shown for each fourfold number of samples and not more often: 4 16 64 ...
rounds=$(awk -v n="$samples" 'BEGIN { while (n > 4) { n /= 4; k++ } print k }')
check "a picture for each step ($rounds)" \
    test $(($(value better frame.number) - $(value start frame.number))) -eq "$rounds"

cat >mirror.json <<'END'
{ "camera": { "eye": [0, 1, 4], "target": [0, 0.5, 0], "fov": 60 },
  "materials": { "mirror": { "reflection": 0.8 } },
  "objects": [ { "shape": "box", "translation": [0.6, 0.5, 0] },
    { "shape": "box", "material": "mirror", "translation": [-0.6, 0.5, 0], "rotation": [0, 30, 0] } ] }
END
play "A and B that differ" "$PWD/mirror.json" --size 24x18 --aa 4 <<END
start: press I | compare.known = true | compare.other_colors = 0
changed: press Minus x8 | frame.samples = 4 | compare.b.samples = 4 | compare.other_colors > 10
refined
apart: | frame.samples > 4 | compare.known = true | compare.other_colors > 10 | compare.other_ids = 0
END
check "B goes as far as A" test "$(value apart compare.b.samples)" -eq "$(value apart frame.samples)"

# The picture of a user's path tracer, whose rays are random, is refined in the same way.
PATHS=$SCENES/../shaders/examples/paths.glsl
# shellcheck disable=SC2086
play "paths" "$SCENES/cube.json" --size 24x18 --shader "$PATHS" $camera,90 <<END
start: | frame.samples = 1 | shader.files = 1
refined
better: | frame.samples > 4 | frame.whole = true | frame.pixels not as start | frame.ids as start
press F12
END
samples=$(value better frame.samples)
# shellcheck disable=SC2086
expect 0 "paths of $samples samples" render "$SCENES/cube.json" --size 24x18 --shader "$PATHS" $camera,90 --aa "$samples" \
    -o paths.png --quiet
expect 0 "are the window's" compare paths.png whit-0002.png --metric largest --tolerance 0

# Lines are drawn over the picture of each step, and do not go into the sum of samples.
# shellcheck disable=SC2086
play "lines" "$SCENES/cube.json" --size 48x36 --aa 16 --edges objects --grid on $camera,60 <<END
start: | frame.samples = 16 | frame.whole = true
press F12
refined
better: | frame.samples > 16 | frame.pixels not as start | frame.ids as start
press F12
END
save=2
for samples in 16 "$(value better frame.samples)"; do
    save=$((save + 1))
    # shellcheck disable=SC2086
    expect 0 "$samples samples below lines" render "$SCENES/cube.json" --size 48x36 --edges objects --grid on $camera,60 \
        --aa "$samples" -o lines.png --quiet
    expect 0 "are the window's" compare lines.png "whit-000$save.png" --metric largest --tolerance 0
done

# With --at-rest stay the picture is not refined.
play "left alone" "$SCENES/cube.json" --size 48x36 --at-rest stay <<END
start: | frame.samples = 1
refined
stays: | frame.samples = 1 | frame.number as start | frame.pixels as start
END
check "the words of a state name it" test "$(value stays words | grep -c -- "--at-rest stay")" -eq 1
check "and no line that renders" test "$(value stays render | grep -c -- at-rest)" -eq 0

# With all figures shown, the stages are timed, for which the picture is drawn again, and the estimated errors are drawn
# as a curve over time.
# shellcheck disable=SC2086
play "a curve" "$SCENES/cube.json" --size 320x480 $camera,10 <<END
start: | hud = small | frame.stages_ms = -1
plain: press F2 | hud = full | frame.estimates = 0 | frame.pixels as start | frame.stages_ms > 0
refined
curve: | frame.estimates > 1
small: press F2 x2 | hud = small | frame.number as curve
again: press F2 | hud = full | frame.pixels as curve | frame.samples as curve | change.number = 0
END
bottom() {
    value "$1" panels.figures | cut -d ' ' -f 4
}
grown=$(($(bottom curve) - $(bottom plain)))
check "figures are longer by it ($grown pixels)" test "$grown" -gt 70

finish
