#!/bin/sh
# tools/contact_sheet: one tile a scene, a dark one for a scene that fails.
#     contact_sheet_test.sh CONTACT_SHEET PICTURE_CHECK SCENES
set -eu
sheet=$1
check=$2
scenes=$3
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cp "$scenes/cube.json" "$scenes/spotlight.json" "$out"
echo '{ "other": "no scene" }' >"$out/other.json"
"$sheet" "$out" -o "$out/sheet.png" --size 96x72 --aa 1 >"$out/list"
grep -q '^ *1 .*fine.*/cube.json$' "$out/list" || grep -q '^ *1 .*ok.*/cube.json$' "$out/list" ||
    { cat "$out/list"; exit 1; }
grep -q '^.*: 2 scenes, 0 failed$' "$out/list"
"$check" "$out/sheet.png" 192 96
"$sheet" "$out/cube.json" "$out/sheet.png" -o "$out/second.png" --size 96x72 --aa 1 >"$out/list"
grep -q '^.*: 2 scenes, 0 failed$' "$out/list"
"$check" "$out/second.png" 192 96
rm "$out/second.png"

echo '{ "objects": 3 }' >"$out/broken.json"
code=0
"$sheet" "$out/broken.json" "$out/cube.json" -o "$out/sheet.png" --size 96x72 --aa 1 \
    >"$out/list" 2>"$out/errors" || code=$?
cat "$out/list" "$out/errors"
[ "$code" -eq 1 ]
grep -q ': 2 scenes, 1 failed$' "$out/list"
grep -q 'broken.json:1' "$out/errors"
"$check" "$out/sheet.png" 192 96

code=0
"$sheet" "$out" 2>/dev/null || code=$?
[ "$code" -eq 2 ]
