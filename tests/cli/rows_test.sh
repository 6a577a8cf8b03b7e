#!/bin/sh
# Pictures and their hits have the same bytes whether rows are written in words of 64 or of 32 bits, which whit chooses by the
# processor.
. "$(dirname "$0")/common.sh"
needs jq

# by WIDE WHAT ARGUMENT...: runs whit with wide rows (1) or narrow ones (0).
by() {
    WHIT_WIDE_ROWS=$1
    export WHIT_WIDE_ROWS
    shift
    expect 0 "$@"
}

for wide in 0 1; do
    by "$wide" "kernels, $wide" scene "$SCENES/whitted.json" --kernels --size 64x48 --json
    jq '[.kernels[].instructions] | add' "$OUT/stdout" >"$OUT/kernels.$wide"
done
if cmp -s "$OUT/kernels.0" "$OUT/kernels.1"; then
    echo "SKIPPED: the device has no wide rows (it is no CPU, or has no 64-bit integers)"
    exit 77
fi
for picture in whitted,watertight balls,exact default,watertight; do
    scene=${picture%,*}
    numerics=${picture#*,}
    for wide in 0 1; do
        by "$wide" "$scene, $numerics, $wide" render "$SCENES/$scene.json" --size 64x48 --numerics "$numerics" --aa 2 \
            --classes many -o "$OUT/$wide.pfm" --ids "$OUT/$wide.exr" --quiet
    done
    check "the same colours" cmp -s "$OUT/0.pfm" "$OUT/1.pfm"
    check "the same hits" "$WHIT" compare "$OUT/0.exr" "$OUT/1.exr" --metric differing --tolerance 0 -q
done
finish
