#!/bin/sh
# The first picture of a model in the window, a small one, is close to the whole picture: the model is recognised.
#     view_first_look_test.sh WHIT SCENES
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
[ -n "${WHIT_MODELS:-}" ] || { echo "SKIPPED: WHIT_MODELS names no folder of models"; exit 77; }
FLIP_MAX=0.25 # its mean
WIDTH_MIN=160

printf 'picture\nstate first\nshot first.png\nstill\nstate last\nshot last.png\n' >"$OUT/look.replay"
cd "$OUT" || exit 1
find "$WHIT_MODELS" -type f \( -iname '*.obj' -o -iname '*.gltf' -o -iname '*.glb' -o -iname '*.ply' -o -iname '*.stl' \) |
    sort >models
check "there are models in $WHIT_MODELS" test -s models
while read -r model; do
    run view "$model" --size 1280x720 --replay look.replay --quiet --at-rest stay
    name=$(basename "$model")
    if ! jq -e 'select(.at == "last") | .frame.whole' "$OUT/stdout" >/dev/null; then
        echo "        $name: nothing to draw ($(head -n 1 "$OUT/stderr"))"
        continue
    fi
    width=$(jq 'select(.at == "first") | .frame.width' "$OUT/stdout")
    "$WHIT" compare first.png last.png --metric flip --json compare.json --quiet >/dev/null 2>&1
    flip=$(jq '.flip.mean' compare.json)
    check "$name: $width pixels wide at first, FLIP $flip" holds "$width >= $WIDTH_MIN && $flip <= $FLIP_MAX"
done <models
finish
