#!/bin/sh
# `whit scene --kernels` lists each kernel of a picture on lavapipe, and, where Mesa's driver for AMD is installed, also
# with that driver's compiler, which needs no GPU for that.
. "$(dirname "$0")/common.sh"
needs jq

refuse 2 "both listings" "give one of them" scene "$CUBE" --kernels --effects
refuse 2 "--numerics without a listing" "for the pictures of" scene "$CUBE" --numerics exact
refuse 3 "no such device" "." scene "$CUBE" --kernels --device "no such device"

W=$SCENES/whitted.json
expect 0 "of a small picture" scene "$W" --kernels --size 64x48 --json
check "one for all materials, and for all generations" \
    test "$(jq -r '[.kernels[].name] | join(", ")' "$OUT/stdout")" = "closest, shade, shadow later, resolve later"
expect 0 "as JSON" scene "$W" --kernels --size 480x320 --json
check "all stages of whitted, with one kernel for all shadow rays, which go without packets" \
    test "$(jq -r '[.kernels[].name] | join(", ")' "$OUT/stdout")" = \
    "camera, closest, shade glass, shade and light, shadow later, resolve, resolve later"
check "each was made" jq -e 'all(.kernels[]; .instructions > 100 and .create_ms > 0)' "$OUT/stdout"
cat > "$OUT/dark.json" <<'END'
{"lights": [{"kind": "point", "position": [-3, 6, 4], "intensity": 40}],
 "materials": {"dark": {"diffuse": 0, "ambient": 0, "transmission": 1, "ior": 1.3}},
 "objects": [{"shape": "plane", "size": 16}, {"shape": "ball", "translation": [0, 1, 0], "material": "dark"}]}
END
dark="camera, closest, shade glass, shade and light, resolve, resolve later"
expect 0 "glass that no light is seen on" scene "$OUT/dark.json" --kernels --size 480x320 --json
check "no hit asks for light later, so there is no kernel for that" \
    test "$(jq -r '[.kernels[].name] | join(", ")' "$OUT/stdout")" = "$dark"
expect 0 "exact" scene "$OUT/dark.json" --kernels --size 480x320 --numerics exact --json
check "some of the floor's shadow rays are deferred" jq -e 'any(.kernels[]; .name == "shadow later")' "$OUT/stdout"
for level in watertight exact; do
    expect 0 "$level" render "$OUT/dark.json" -o "$OUT/many.pfm" --size 480x320 --numerics $level
    expect 0 "$level, stages timed" \
        render "$OUT/dark.json" -o "$OUT/timed.pfm" --size 480x320 --numerics $level --stats text
    expect 0 "$level, one kernel" \
        render "$OUT/dark.json" -o "$OUT/one.pfm" --size 480x320 --numerics $level --classes one
    check "$level: the same picture" cmp "$OUT/many.pfm" "$OUT/one.pfm"
    check "$level: the same picture, timed" cmp "$OUT/many.pfm" "$OUT/timed.pfm"
done
expect 0 "with packets" scene "$SCENES/34k.json" --kernels --size 480x320 --json
sum=$(jq '[.kernels[].instructions] | add' "$OUT/stdout")
shows "the picture" "^  $sum of " render "$SCENES/34k.json" -o "$OUT/w.pfm" --size 480x320 --stats text --quiet
expect 0 "as text" scene "$CUBE" --kernels --size 64x48
check "cube calls for no second generation" test "$(grep -c 'to make$' "$OUT/stdout")" -eq 4
expect 0 "exact" scene "$CUBE" --kernels --numerics exact --size 64x48
check "with kernels for deferred rays, but none for shading, which traces none" \
    test "$(grep ', deferred rays$' "$OUT/stdout" | tr -d '\n')" = "  camera, deferred rays  shadow, deferred rays"

radeon=$(ls /usr/share/vulkan/icd.d/radeon_icd*.json 2>/dev/null | head -n 1)
if [ -z "$radeon" ]; then
    [ "$FAILED" -eq 0 ] || finish
    echo "SKIPPED, the compiler for AMD: its driver is not installed (Debian: mesa-vulkan-drivers)"
    exit 77
fi
export VK_ICD_FILENAMES="$radeon" VK_DRIVER_FILES="$radeon" RADV_FORCE_FAMILY=navi21
unset VK_LOADER_DRIVERS_SELECT VK_LOADER_DRIVERS_DISABLE
for scene in whitted room sphereflake; do
    expect 0 "$scene by AMD's compiler" scene "$SCENES/$scene.json" --kernels --no-cache --json
    check "$scene: subgroups are not of 8 lanes" \
        jq -e 'all(.kernels[]; .driver["lanes of a subgroup"] >= 32)' "$OUT/stdout"
    check "$scene: registers suffice, and no stack is in memory" \
        jq -e 'all(.kernels[]; .driver["VGPRs"] > 0 and .driver["Spilled VGPRs"] == 0 and
            .driver["Scratch size"] == 0)' "$OUT/stdout"
done
finish
