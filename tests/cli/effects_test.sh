#!/bin/sh
# --effects of `whit render` and `whit scene`: names, prices, promises. The third argument is a whit in whose pictures
# the effect WHIT_TEST_CHANGED_EFFECT changes a pixel.
. "$(dirname "$0")/common.sh"
needs jq
CHANGED=$3

P=$OUT/picture.pfm
refuse 2 "a misspelt effect" "did you mean .shadows." render "$CUBE" -o "$P" --effects -shadow
refuse 2 "an unknown effect" "no effect .caustics." render "$CUBE" -o "$P" --effects +caustics
refuse 2 "geometry cannot be left out" "instances. cannot be left out" \
    render "$CUBE" -o "$P" --effects -instances
refuse 2 "a name without a sign" "auto, all, or names" render "$CUBE" -o "$P" --effects shadows
refuse 2 "added and left out" "both added and left out" \
    render "$CUBE" -o "$P" --effects +shadows,-shadows
refuse 2 "--size without --effects" "for the pictures of --effects" scene "$CUBE" --size 64x48
refuse 3 "no such device" "." scene "$CUBE" --effects --device "no such device"

small="--size 48x36 --quiet"
expect 0 "auto" render "$CUBE" -o "$OUT/auto.pfm" $small
# The tests scene_* draw every scene with `all` alone, which gives the same picture.
expect 0 "one more" render "$CUBE" -o "$OUT/more.pfm" $small --effects +textures,+environment-map
check "more is the same" cmp "$OUT/auto.pfm" "$OUT/more.pfm"
expect 0 "one less" render "$CUBE" -o "$OUT/less.pfm" $small --effects -point-lights --stats json
check "less is another picture" test "$(cmp "$OUT/auto.pfm" "$OUT/less.pfm" | wc -l)" -eq 1
check "its recipe says so" jq -e '.picture.effects == "-point-lights"' "$OUT/stdout"
expect 0 "all but one" render "$CUBE" -o "$OUT/less2.pfm" $small --effects all,-point-lights
check "left out of the general kernel too" cmp "$OUT/less.pfm" "$OUT/less2.pfm"
expect 0 "--stats" render "$CUBE" -o "$OUT/auto.pfm" --size 48x36 --stats text
check "the kernel's size" grep -Eq "^  [0-9]+ of [0-9]+ instructions, [0-9]+ in the largest, [0-9]+ of [0-9]+ bindings" \
    "$OUT/stdout"

# json_test.sh checks the effects that a shader asks for.
echo 'vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.ns; }' >"$OUT/plain.glsl"
refuse 2 "--shader without --effects" "for the pictures of --effects" scene "$CUBE" --shader "$OUT/plain.glsl"

# The table, with an effect that changes the picture though the scene does not call for it. Validation layers are off:
# json_test.sh runs the same kernels with them.
if part 0 2; then
    WHIT=$CHANGED
    unset WHIT_VALIDATION
    export WHIT_TEST_CHANGED_EFFECT=normal-maps
    refuse 1 "scene --effects" \
        "normal-maps: the scene does not call for it, yet it changes 1 pixels" \
        scene "$CUBE" --effects --size 32x24 --quiet
    check "names the device" grep -q "^  device    ." "$OUT/stdout"
    check "names the kernel" grep -Eq "^  kernel +[0-9]+ of [0-9]+ instructions, [0-9]+ of " "$OUT/stdout"
    check "what is compiled has a price and a reason" \
        grep -Eq "^  point-lights +yes +[-+][0-9.]+ +[-+][0-9.]+ +[-+][0-9.]+ .*pixels, by up to .*lamp" \
        "$OUT/stdout"
    check "what is not compiled has a price" \
        grep -Eq "^  refraction +- +[-+][0-9.]+ +[-+][0-9.]+ +[-+][0-9.]+" "$OUT/stdout"
    check "kinds of cameras have none" grep -Eq "^  panorama +- +- *$" "$OUT/stdout"
    check "its row says so" grep -Eq "^  normal-maps +- .* NOT THE SAME PICTURE" "$OUT/stdout"
    check "no other row does" test "$(grep -c "NOT THE SAME" "$OUT/stdout")" -eq 1
fi
finish
