#!/bin/sh
# tools/contact_sheet draws one tile for each scene, and a dark tile for a scene that fails.
#     contact_sheet_test.sh WHIT SCENES CONTACT_SHEET PICTURE_CHECK
. "$(dirname "$0")/common.sh"
WHIT=$3

# sheet CODE SUM FILE...: contact_sheet exits with CODE, prints a list that ends in SUM, and writes a sheet of two
# tiles.
sheet() {
    code=$1 sum=$2
    shift 2
    expect "$code" "a sheet of $*" "$@" -o "$OUT/sheet.png" --size 96x72 --aa 1
    check "says $sum" grep -q ": $sum$" "$OUT/stdout"
    check "two tiles" "$PICTURE_CHECK" "$OUT/sheet.png" 192 96
}

PICTURE_CHECK=$4
mkdir "$OUT/scenes"
cp "$CUBE" "$SCENES/spotlight.json" "$OUT/scenes"
echo '{ "other": "no scene" }' >"$OUT/scenes/other.json"
sheet 0 "2 scenes, 0 failed" "$OUT/scenes"
check "cube is fine" grep -Eq '^ *1 .*(fine|ok).*/cube.json$' "$OUT/stdout"
mv "$OUT/sheet.png" "$OUT/first.png"
sheet 0 "2 scenes, 0 failed" "$CUBE" "$OUT/first.png"
echo '{ "objects": 3 }' >"$OUT/broken.json"
sheet 1 "2 scenes, 1 failed" "$OUT/broken.json" "$CUBE"
check "which names it" grep -q 'broken.json:1' "$OUT/stderr"
# With --check models have to look right. A grey box does, and a glow that is exposed less, and a box whose file makes
# it white or black; a grey box with too much light, or with none, does not.
box() {
    printf 'newmtl m\n%s\n' "$2" >"$OUT/$1.mtl"
    {
        printf 'mtllib %s.mtl\nusemtl m\n' "$1"
        for z in 0 1; do printf 'v 0 0 %s\nv 1 0 %s\nv 1 1 %s\nv 0 1 %s\n' $z $z $z $z; done
        printf 'f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n'
    } >"$OUT/$1.obj"
}
lit() {
    printf '{ "objects": [{ "shape": "box", "material": {"diffuse": 0.5} }], "ambient": %s,
        "lights": [{ "kind": "directional", "direction": [-1, -2, -1.5], "color": %s }] }' "$2" "$2" >"$OUT/$1.json"
}
box grey 'Kd 0.7 0.7 0.7'
box glow 'Ke 40 40 40'
box lamp 'Ke 1 1 1'
box coal 'Kd 0 0 0'
# The camera of this file sees a box from far away.
printf '{ "objects": [{ "shape": "box" }], "camera": { "eye": [0, 4, 40], "target": [0, 0, 0] } }' >"$OUT/far.json"
# A flat board shows no relief, in whichever direction it faces.
printf 'v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 1\nf 1 2 3 4\n' >"$OUT/board.obj"
lit bright 60
lit dark 0
sheet 0 "2 scenes, 0 failed" "$OUT/grey.obj" "$OUT/glow.obj" --check yes
check "both are right" test "$(grep -c ' right ' "$OUT/stdout")" -eq 2
sheet 0 "2 scenes, 0 failed" "$OUT/lamp.obj" "$OUT/coal.obj" --check yes
check "a lamp is not burnt, coal is not black" test "$(grep -c ' 0.0 % burnt *0.0 % black ' "$OUT/stdout")" -eq 2
sheet 1 "2 scenes, 2 failed" "$OUT/bright.json" "$OUT/dark.json" --check yes
check "a grey box burns" grep -Eq '(100|[5-9][0-9])\.. % burnt .* WRONG .*bright.json$' "$OUT/stdout"
check "a grey box in the dark is black" grep -q '100.0 % black .* WRONG .*dark.json$' "$OUT/stdout"
sheet 1 "2 scenes, 1 failed" "$OUT/far.json" "$OUT/grey.obj" --check yes
check "a box far away is too small" grep -Eq ' [0-4]\.[0-9] % covered .* WRONG .*far.json$' "$OUT/stdout"
sheet 0 "2 scenes, 0 failed" "$OUT/board.obj" "$OUT/grey.obj" --check yes
check "the board is flat" grep -q ' flat relief .*board.obj$' "$OUT/stdout"
mkdir "$OUT/empty" "$OUT/models"
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >"$OUT/models/a.off" && cp "$OUT/grey.obj" "$OUT/grey.mtl" "$OUT/models/"
sheet 0 "2 scenes, 0 failed" "$OUT/models"
expect 2 "a folder without models" "$OUT/empty" -o "$OUT/sheet.png"
check "is named" grep -q "empty: there is no scene and no model in it" "$OUT/stderr"
expect 2 "no output" "$OUT/scenes"
expect 2 "a size and more" "$CUBE" -o "$OUT/sheet.png" --size 96x72junk
TMPDIR=$OUT/nowhere expect 1 "no folder for temporary files" "$CUBE" -o "$OUT/sheet.png" --size 96x72 --aa 1 --check yes
check "says so" grep -q "error: no temporary file can be written" "$OUT/stderr"
finish
