#!/bin/sh
# Views of many cameras (--cameras): each is the picture that the scene's own camera of the same words makes.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
needs jq
cd "$OUT" || exit 1
cat >cameras.json <<'END'
[{"eye": [3, 2.5, 4], "target": [0, 0.6, 0], "fov": 35}, {"eye": [3, 2.5, 4], "target": [0, 0.6, 0], "lens": 0.2, "focus": 4.5},
 {"eye": [3, 2.5, 4], "target": [0, 0.6, 0], "height": 3}, {"eye": [0.1, 1, 0.5], "target": [0, 0.6, 0], "panorama": true}]
END
jq -c '.[]' cameras.json | sed 's/$/\n/' >cameras.jsonl
jq --slurpfile cameras cameras.json 'del(.camera) | .cameras = $cameras[0]' "$CUBE" >scene.json
size="--size 20x13"
expect 0 "views" render scene.json --cameras cameras.json -o v.##.pfm --ids i.#.exr --distances d.#.exr $size --aa 4
check "it says what it did" grep -q "^whit: v.##.pfm: views 0 to 3, 20 x 13, rendered in" "$OUT/stderr"
check "without a warning" test "$(grep -c . "$OUT/stderr")" -eq 1
expect 0 "one a line" render scene.json --cameras cameras.jsonl -o l.##.pfm $size --aa 4 -q
for i in 0 1 2 3; do
    expect 0 "camera $i" render scene.json --camera $i -o c.pfm --ids c.exr $size --aa 4 -q
    check "view $i is its picture" cmp c.pfm v.0$i.pfm
    check "one a line too" cmp c.pfm l.0$i.pfm
    expect 0 "what view $i meets" compare c.exr i.$i.exr
    check "no file is missing" test -s d.$i.exr
done
expect 0 "a recipe" render scene.json --cameras cameras.json -o r.#.png $size -q --tile-size 16 --stats json
check "stages have times" jq -e 'all(.stages[]; .ms > 0)' "$OUT/stdout"
expect 0 "of a pinhole draws the view again" render r.0.png -o again.png --yes -q
expect 0 "the same" compare r.0.png again.png
for i in 1 2 3; do
    check "view $i has its camera, and no command for another" \
        sh -c 'grep -aq "whit:camera" "$1" && ! grep -aqE "whit:command|\"camera\"" "$1"' - r.$i.png
done
refuse 2 "another kind" "r.1.png: its camera is one that --camera has no words for" render r.1.png -o again.png --yes

lines() {
    printf '%s\n' "$1" >bad.json
    refuse 2 "$1" "$2" render scene.json --cameras bad.json -o x.#.png
}
lines '[]' "bad.json: there is no camera in it"
lines '{"eye": [NaN, 0, 1]}' "bad.json:1:12: invalid token near 'NaN'"
lines '[{"eye": [1, 2]}]' 'bad.json:1:3: \[0\].eye: 3 numbers in \[ \] are expected'
lines '{"eye": [1, 2, 3]}
{"eye": [0, 0, 0]}' "bad.json:2:1: .eye. and .target. are the same point"
lines '{"fovv": 3}' "bad.json:1:2: fovv: unknown key; did you mean .fov."
lines '{"animation": {}}' "bad.json:1:2: animation: cameras of views stand still"
for option in "--camera 0" "--frames 0-1" "--tile 1/2" "--resume" "--aa adaptive:0.1" "--view depth" "--shader x.glsl" "--stages x"; do
    refuse 2 "$option" "--cameras and ${option%% *}.* do not go together" render scene.json --cameras cameras.json -o x.#.png $option
done
refuse 2 "no number" "-o x.png: with --cameras its name needs # for the number of the view" render scene.json --cameras cameras.json -o x.png
refuse 2 "distances alone" "--distances is for the views of --cameras" render scene.json -o x.png --distances x.exr
check "nothing was written" test "$(find . -name 'x*' | wc -l)" -eq 0
finish
