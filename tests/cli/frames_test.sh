#!/bin/sh
# Sequences: every frame is the same picture as when it is drawn alone, and finished frames stay. The third argument is
# a whit whose clock moves only while a picture is drawn.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
TURNED=$3
needs script
mkdir "$OUT/frames"
cd "$OUT/frames" || exit 1
SWARM=$SCENES/swarm.json

count() {
    ls -A "$1" | wc -l
}

expect 0 "a sequence" render "$SWARM" --frames 8-11 -o a.####.png --ids i.#.exr --size 64x48
check "one picture a frame, and no other file" \
    test "$(ls -A | tr '\n' ' ')" = "a.0008.png a.0009.png a.0010.png a.0011.png i.10.exr i.11.exr i.8.exr i.9.exr "
check "it says what it did" grep -q "^whit: a.####.png: frames 8 to 11, 64 x 48, rendered in" "$OUT/stderr"
for frame in 08 11; do
    expect 0 "frame $frame alone" render "$SWARM" --frame $frame -o one.png --ids one.exr --size 64x48 -q
    check "is that of the sequence, recipe and all" cmp one.png a.00$frame.png
    check "so are the identities" cmp one.exr i.${frame#0}.exr
done
check "things have moved" sh -c '! cmp -s a.0008.png a.0011.png'
way=0
for option in "--instance-update refit" "--instance-build median" "--instance-build median --instance-update refit"; do
    way=$((way + 1))
    part $way 3 || continue
    expect 0 "$option" render "$SWARM" --frames 8-11 -o b.####.png --size 64x48 $option --quiet
    check "$option is quiet" test ! -s "$OUT/stderr"
    for frame in 08 09 10 11; do
        check "$option gives the same frame $frame" cmp a.00$frame.png b.00$frame.png
    done
done
expect 0 "another rate" render "$SWARM" --frames 4-4 --fps 12 -o c.#.pfm --size 64x48 -q
expect 0 "the same time" render "$SWARM" --frames 8-8 -o d.###.pfm --size 64x48 -q
check "frame 4 of 12 a second is frame 8 of 24" cmp c.4.pfm d.008.pfm
expect 0 "past the end" render "$SCENES/spin.json" --frames 95-98 -o e.##.png --size 8x8
check "says so" grep -q "the animation ends at 4 s: nothing moves in frames 96 to 98" "$OUT/stderr"
expect 0 "frames of a scene that never moves" render "$CUBE" --size 8x8 --frames 0-1 -o t.#.png
check "say nothing of an animation" test "$(grep -c animation "$OUT/stderr")" -eq 0
refuse 2 "--fps alone" "--fps is for --frame and --frames" render "$SWARM" --fps 12 -o r.#.png
refuse 2 "of a scene" "--fps is for --frame" scene "$SWARM" --fps 12
mkdir "run#1"
expect 0 "marks in the folder's name" render "$SWARM" --frames 0-0 -o "run#1/x#y##.pfm" --size 8x8 -q
check "only the last marks are replaced" test -f "run#1/x#y00.pfm"
expect 0 "without --frames" render "$SWARM" -o "x#.pfm" --size 8x8 -q
check "a mark is a mark" test -f "x#.pfm"

expect 0 "--stats json" render "$SWARM" --frames 0-2 -o s.#.png --size 16x16 --stats json
check "stats have every frame" jq -e '[.frames.each[].frame] == [0, 1, 2]' "$OUT/stdout"
check "stats have times of frames and their median" \
    jq -e 'all(.times, .frames.median, .frames.each[]; .build_instances_ms >= 0)' "$OUT/stdout"
check "rays are summed up" jq -e '.rays.primary == 768' "$OUT/stdout"
check "stages have times, though not every frame has a tile that was timed" jq -e 'all(.stages[]; .ms > 0)' "$OUT/stdout"
check "and shares of materials" jq -e 'all(.stages[] | select(.name == "shade"); (.shares | map(.share) | add) - 1 | fabs < 1e-9)' "$OUT/stdout"

# Numbers of cut rays and of pixels by samples are sums over the frames; of weights and bounds the largest is kept,
# which here is that of the first frame.
for option in "--depth 1" "--bailout 0.05"; do
    way=$((way + 1))
    part $way 2 || continue
    cut="$SWARM --size 40x30 $option --aa adaptive:0.05 --fps 1 --stats json"
    expect 0 "frames with $option" render $cut --frames 0-1 -o t.#.png
    jq '[.rays.cut_by_depth, .rays.cut_by_bailout, .rays.bailout_bound, .pixels_by_samples]' \
        "$OUT/stdout" >sums
    for frame in 0 1; do
        expect 0 "frame $frame alone" render $cut --frame $frame -o t.png
        jq '[.rays.cut_by_depth, .rays.cut_by_bailout, .rays.bailout_bound, .pixels_by_samples]' \
            "$OUT/stdout" >"single$frame"
    done
    check "$option: less is cut in the second frame" jq -es \
        '(.[0][0].weight_of_a_pixel + .[0][1].weight_of_a_pixel) as $first
         | (.[1][0].weight_of_a_pixel + .[1][1].weight_of_a_pixel) as $second
         | $first > $second and $second > 0 and .[0][3]."64" > 0' single0 single1
    check "$option: cut rays, weights, bound and samples are of all frames" jq -es '
        def all(a; b): [range(2) as $i | {rays: (a[$i].rays + b[$i].rays),
            weight_of_a_pixel: ([a[$i].weight_of_a_pixel, b[$i].weight_of_a_pixel] | max)}]
            + [([a[2], b[2]] | max)]
            + [a[3] as $x | b[3] as $y | $x | to_entries
               | map({key, value: (.value + $y[.key])}) | from_entries];
        .[0] == all(.[1]; .[2])' sums single0 single1
done

expect 0 "--stats text" render "$SWARM" --frames 0-2 -o s.#.png --size 16x16 --stats text
check "a row a frame" test "$(grep -Ec '^  [0-2] ( +[0-9.]+){4}$' "$OUT/stdout")" -eq 3
check "and one for the median" grep -Eq '^  median ( +[0-9.]+){4}$' "$OUT/stdout"

for frames in 3 3- -3 a-b 1-2x 0-9999999999 1..2; do
    refuse 2 "--frames $frames" "A-B is needed" render "$SWARM" --frames=$frames -o r.#.png
done
refuse 2 "--frames 5-3" "before the first" render "$SWARM" --frames 5-3 -o r.#.png
refuse 2 "no marks" "r.png: .*needs #" render "$SWARM" --frames 0-3 -o r.png
refuse 2 "marks in the folder alone" "needs #" render "$SWARM" --frames 0-3 -o "run#1/r.png"
refuse 2 "no marks for identities" "r.exr: .*needs #" render "$SWARM" --frames 0-3 -o r.#.png --ids r.exr
refuse 2 "--frames and --time" "all of these frames or one" render "$SWARM" --frames 0-3 --time 1 -o r.#.png
refuse 2 "--frames and --frame" "all of these frames or one" render "$SWARM" --frames 0-3 --frame 1 -o r.#.png
refuse 2 "no such folder" "nowhere/r.0.png" render "$SWARM" --frames 0-3 -o nowhere/r.#.png
check "nothing came of these" sh -c '! ls -A | grep -q "^\.\|^r\."'

# From frame 1 on the position is out of range.
cat >far.json <<'JSON'
{ "camera": { "eye": [0, 0, 5], "target": [0, 0, 0] },
  "objects": [ { "name": "large", "scale": 1e15, "children": [ { "name": "larger", "scale": 1e15, "children": [
    { "name": "rocket", "scale": 1e-15,
      "animation": { "translation": { "times": [0, 1], "values": [[0, 0, 0], [0, 1e18, 0]] } },
      "children": [ { "name": "nose", "shape": "cone", "scale": 1e-15 } ] } ] } ] } ] }
JSON
mkdir far
expect 2 "a frame that fails" render far.json --frames 0-3 -o far/f.#.png --size 8x8
check "is named" grep -q "far.json: instance 0 .nose.*at 0.0416667 s" "$OUT/stderr"
check "how many are there is said" grep -q "1 of 4 frames were written" "$OUT/stderr"
check "these stay" test "$(ls -A far)" = f.0.png

# Each of these pictures moves the clock by 0.375 s.
mkdir late
REAL=$WHIT
WHIT=$TURNED
expect 5 "--time-limit" render "$SWARM" --frames 0-9999 -o late/f.####.png --size 80x60 --time-limit 3.75
WHIT=$REAL
check "holds over the sequence, with frames finished: $(count late)" test "$(count late)" -eq 10
check "says how many" grep -q "$(count late) of 10000 frames were written" "$OUT/stderr"

for time in 1 2 3; do
    echo "'$SWARM' --time $time --size 320x240 -o late/$time.png" # several tiles
done >lines
TERM=xterm script -qec "'$TURNED' batch lines" /dev/null >bar
check "a bar over all lines" \
    test "$(tr '\r' '\n' <bar | sed -n '/2.png/,$p' | grep -c ' \(6[7-9]\|[7-9][0-9]\) % .* s left')" -ge 1

mkdir stop
"$WHIT" render "$SWARM" --frames 0-9999 -o stop/f.####.png --size 64x48 2>"$OUT/stderr" &
interrupted $! test -f stop/f.0002.png
check "Ctrl+C: finished frames stay, and no other file" test "$(ls -A stop | grep -c '^f\.[0-9]*\.png$')" -eq "$(count stop)"
check "Ctrl+C: says how many" grep -q "interrupted, $(count stop) of 10000 frames were written" "$OUT/stderr"
expect 0 "a frame before the stop" render "$SWARM" --frame 2 -o one.png --size 64x48 -q
check "is whole" cmp one.png stop/f.0002.png
finish
