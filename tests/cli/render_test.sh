#!/bin/sh
# Pictures are written as a whole, have the same bytes for the same inputs, and contain their recipe.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/pictures"
cd "$OUT/pictures" || exit 1

# has_text FILE TEXT: the file, which may have zero bytes, has the text.
has_text() {
    tr -d '\000' <"$1" | grep -aqF "$2"
}

expect 0 "render" render "$CUBE" -o a.png --size 96x64 --ids a.exr
check "the picture is a PNG" test "$(head -c 4 a.png | tail -c 3)" = PNG
check "only the pictures are there" test "$(ls -A | tr '\n' ' ')" = "a.exr a.png "
check "it says what it did" grep -q "^whit: a.png: 96 x 64, rendered in" "$OUT/stderr"
expect 0 "again, under another name" render "$CUBE" -o b.png --size 96x64 --ids b.exr --quiet
check "--quiet prints nothing" test ! -s "$OUT/stderr"
check "two runs give the same picture" cmp a.png b.png
check "two runs give the same identities" cmp a.exr b.exr
if part 0 2; then
    for tile in 16 32 512; do
        expect 0 "--tile-size $tile" render "$CUBE" -o b.png --size 96x64 --tile-size $tile --quiet
        check "tiles of $tile give the same picture" cmp a.png b.png
    done
    # The tests scene_* draw with `--effects all`.
    for option in "--build median" \
        "--build spatial+opt --leaf 1 --traversal sign --instance-build median" "--threads 1" \
        "--load-path texel" "--stats json"; do
        # shellcheck disable=SC2086
        expect 0 "$option" render "$CUBE" -o b.png --size 96x64 $option --quiet
        check "$option gives the same picture" cmp a.png b.png
    done
    # The validation layers check each access to trees in storage buffers; scene_*_validated check texel buffers.
    WHIT_VALIDATION=1 expect 0 "--load-path storage" render "$CUBE" -o b.png --size 96x64 --load-path storage --quiet
    check "--load-path storage gives the same picture" cmp a.png b.png
    expect 0 "other bounces" render "$CUBE" -o b.png --size 96x64 --shadows none --quiet
    check "another option is another file" sh -c '! cmp -s a.png b.png'
fi

command="whit render $CUBE --size 96x64 --aa 1 --depth 8 -o whit.png"
check "the recipe has the command" has_text a.png "$command"
check "the recipe has the options" has_text a.png '"width":96,"height":64'
check "the recipe has the counters" has_text a.png '"rays":{"primary":6144,'
for key in Software whit:device whit:driver whit:scene whit:scene_hash; do
    check "the recipe has $key" has_text a.png $key
done
# Every option that a picture can be made with is a key of the recipe, and in the table of the docs.
expect 0 "all options of a recipe" render "$SCENES/default.json" -o all.png --size 8x8 --quiet --depth 2 \
    --shadows opaque --light-samples 4 --fresnel schlick --effects all,-textures --texture-limit 64 \
    --instances on --numerics fast
listed=$(sed -n 's/^| `whit:options` | //p' "$SCENES/../docs/cli.md")
options=$(grep -a -o '{"width":8,[^}]*}' all.png)
check "the recipe has twenty-nine keys" test "$(echo "$options" | jq 'keys | length')" -eq 29
for key in $(echo "$options" | jq -r 'keys[]'); do
    check "docs/cli.md names $key" sh -c 'echo "$1" | grep -q "\b$2\b"' - "$listed" "$key"
done
cp "$CUBE" "it's a cube.json"
expect 0 "a name with a quote" render "it's a cube.json" -o q.exr --size 8x8 --quiet
check "is quoted for the shell" has_text q.exr "whit render 'it'\\''s a cube.json' --size 8x8 --aa 1 --depth 8 -o whit.exr"
HOSTILE=$(printf "it's \033]0;t\007\342\200\256\377.json")
cp "$CUBE" "$HOSTILE"
expect 0 "a name that steers terminals" render "$HOSTILE" -o q.exr --size 8x8 --quiet
check "is shown" has_text q.exr 'it'\''s \u001b]0;t\u0007\u202e\xff.json'
quoted="'it'\\''s '\$'\\x1b'']0;t'\$'\\x07'''\$'\\xe2\\x80\\xae'''\$'\\xff''.json'"
check "is in the command without what steers" has_text q.exr "whit render $quoted --size 8x8 --aa 1 --depth 8 -o whit.exr"
if command -v bash >/dev/null; then
    check "and the same word to bash" test "$(bash -c "printf %s $quoted")" = "$HOSTILE"
fi
expect 0 "a PFM" render "$CUBE" -o a.pfm --size 8x8 --quiet
check "has its header" test "$(head -n 1 a.pfm)" = PF

for camera in camera 0 1.6,1.3,2.4,0,0,0,0,1,0,35; do
    expect 0 "--camera $camera" render "$CUBE" -o b.pfm --size 8x8 --camera "$camera" --quiet
    check "--camera $camera is the first camera" cmp a.pfm b.pfm
done
expect 0 "another camera" render "$CUBE" -o b.pfm --size 8x8 --camera 1,1,2.4,0,0,0,0,1,0,35 --quiet
check "another camera is another picture" sh -c '! cmp -s a.pfm b.pfm'
expect 0 "an animation" render "$SCENES/spin.json" -o a.pfm --size 16x16 --time 0.5 --quiet
expect 0 "by frame" render "$SCENES/spin.json" -o b.pfm --size 16x16 --frame 12 --quiet
check "frame 12 is at 0.5 s" cmp a.pfm b.pfm
expect 0 "by frame and rate" render "$SCENES/spin.json" -o b.pfm --size 16x16 --frame 1 --fps 2 --quiet
check "frame 1 of 2 a second is at 0.5 s" cmp a.pfm b.pfm
expect 0 "at the start" render "$SCENES/spin.json" -o b.pfm --size 16x16 --quiet
check "things have moved" sh -c '! cmp -s a.pfm b.pfm'

expect 0 "--stats json" render "$CUBE" -o b.png --size 96x64 --stats json
check "as many primary rays as pixels" jq -e '.rays.primary == 6144' "$OUT/stdout"
# The second tile is timed, and then one tile in eight.
expect 0 "--stats json, several tiles" render "$CUBE" -o b.png --size 96x64 --tile-size 16 --stats json
check "camera rays have a price" \
    jq -e '.stages[] | select(.name == "camera") | .rays == 6144 and .ms > 0' "$OUT/stdout"
check "so have sums of pixels" jq -e '.stages[] | select(.name == "resolve") | .ms > 0' "$OUT/stdout"
check "shadow rays are those of the lights" \
    jq -e '([.stages[] | select(.name | startswith("shadows")) | .rays] | add) == .rays.shadow and .rays.shadow > 0' "$OUT/stdout"
expect 0 "--stats text" render "$CUBE" -o b.png --size 96x64 --stats text --tile-size 16
check "stats as text" grep -Eq "^  primary +6144" "$OUT/stdout"
check "prices of stages as text" grep -Eq "^  camera +[0-9.]+ +6144 +[0-9.]+$" "$OUT/stdout"

# The device is opened while the scene loads: whichever fails, whit prints one line.
export WHIT_FAULT=vkCreateDevice:1
refuse 2 "a device that fails" "vkCreateDevice" render "$CUBE" -o fails.png --size 8x8
refuse 2 "a scene that fails, and a device" "nowhere.json" render nowhere.json -o fails.png
refuse 2 "a camera that is not there, and a device" "no camera" render "$CUBE" -o fails.png --camera x
unset WHIT_FAULT
refuse 3 "a device that is not there" "no Vulkan device" render "$CUBE" -o fails.png --device nobody
refuse 2 "a scene that fails" "nowhere.json" render nowhere.json -o fails.png
check "nothing is written then" test ! -e fails.png
cp a.png sky.png
refuse 2 "a picture in place of its sky" "-o and --environment name the same file" \
    render "$CUBE" -o ./sky.png --environment sky.png
echo old >keep.png
refuse 2 "a render that fails" "there is no camera" render "$CUBE" -o keep.png --camera nobody
check "leaves the old file alone" test "$(cat keep.png)" = old
check "no hidden file is left" test -z "$(find . -name '.*' -type f)"

if part 1 2; then
    # Edges are drawn over the picture, and nothing else changes.
    black() {
        tail -c $((64 * 48 * 12)) "$1.pfm" | od -An -v -tx4 -w12 | grep -c '^ 00000000 00000000 00000000$'
    }
    for edges in off objects triangles; do
        expect 0 "--edges $edges" render "$CUBE" -o $edges.pfm --size 64x48 --edges $edges --quiet
        tail -c $((64 * 48 * 12)) $edges.pfm | od -An -v -tx4 -w12 >$edges.pixels
    done
    expect 0 "no word of edges" render "$CUBE" -o usual.pfm --size 64x48 --quiet
    check "--edges off is the usual picture" cmp usual.pfm off.pfm
    objects=$(black objects) triangles=$(black triangles)
    check "more edges of triangles ($triangles) than of objects ($objects)" \
        test "$objects" -gt 20 -a "$triangles" -gt $((objects + 20)) -a "$(black off)" -eq 0
    for edges in objects triangles; do
        check "what is no edge is as it was" test "$(paste -d '|' off.pixels $edges.pixels |
            awk -F '|' '$1 != $2 && $2 != " 00000000 00000000 00000000"' | wc -l)" -eq 0
    done

    # A grid on the ground is drawn over the picture too, but behind the cube, which glows.
    cat >glows.json <<X
{ "camera": { "eye": [1.2, 1.4, 1.6], "target": [0, 0, 0], "fov": 60 }, "environment": "#000000", "ambient": 0,
  "materials": { "m": { "emission": [7, 0, 0] } }, "objects": [ { "shape": "box", "size": 1, "material": "m" } ] }
X
    for grid in off on; do
        expect 0 "--grid $grid" render glows.json -o grid-$grid.pfm --size 64x48 --grid $grid --quiet
        tail -c $((64 * 48 * 12)) grid-$grid.pfm | od -An -v -tf4 -w12 >grid-$grid.pixels
    done
    lines=$(grep -cv '^ *[07] *0 *0$' grid-on.pixels)
    check "lines are drawn ($lines pixels), and nothing else" test "$lines" -gt 100 -a \
        "$(grep -cv '^ *[07] *0 *0$' grid-off.pixels)" -eq 0
    check "what stands before them is as it was" test "$(grep -c '^ *7 ' grid-off.pixels)" -gt 60 -a \
        "$(grep -c '^ *7 *0 *0$' grid-on.pixels)" -eq "$(grep -c '^ *7 ' grid-off.pixels)"
    expect 0 "edges of costs" render "$CUBE" -o costs.png --size 64x48 --edges objects --grid on --view visits --quiet
    check "are none" sh -c '! grep -aq -e "--edges" -e "--grid" costs.png'
fi

# whit FILE, without a command.
mkdir "$OUT/alone" && cp "$CUBE" "$OUT/alone/some.cube.json"
alone() {
    (cd "$OUT/alone" && env -u DISPLAY -u WAYLAND_DISPLAY "$WHIT" "$@") >"$OUT/stdout" 2>"$OUT/stderr"
    status=$?
}
alone some.cube.json --size 8x8
check "without a display it is rendered (got $status)" test "$status" -eq 0 -a -s "$OUT/alone/some.cube.png"
check "and said" grep -q "there is no display: rendering some.cube.png" "$OUT/stderr"
cp "$OUT/alone/some.cube.png" "$OUT/alone/kept"
alone some.cube.json --size 9x9
check "what is there is kept (got $status)" \
    sh -c 'test "$1" -eq 2 && cmp "$2/kept" "$2/some.cube.png"' - "$status" "$OUT/alone"
alone some.cube.json --size 8x8 -o mine.png
check "another name is taken (got $status)" test "$status" -eq 0 -a -s "$OUT/alone/mine.png"
alone some.cube.json --size 8x8 -qo yours.png
check "behind another letter too (got $status)" test "$status" -eq 0 -a -s "$OUT/alone/yours.png"
check "and nothing said of this one" test "$(grep -c some.cube.png "$OUT/stderr")" -eq 0
alone nothing.json
check "what is no file is no command (got $status)" test "$status" -eq 2
check "and said" grep -q "there is no command or file .nothing.json." "$OUT/stderr"
finish
