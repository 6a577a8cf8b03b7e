#!/bin/sh
# tools/contact_sheet: one tile a scene, a dark one for a scene that fails.
#     contact_sheet_test.sh WHIT SCENES CONTACT_SHEET PICTURE_CHECK
. "$(dirname "$0")/common.sh"
WHIT=$3

# sheet CODE SUM FILE...: leaves with CODE a list that ends in SUM, and a sheet of two tiles.
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
expect 2 "no output" "$OUT/scenes"
finish
