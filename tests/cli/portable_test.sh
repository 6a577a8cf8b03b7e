#!/bin/sh
# --portable: pictures have the same bytes with the device's own operations and with whit's functions in their place, as
# on a GPU: at every level of numerics (exact hits and layers of glass only with `all`), and with functions of users.
# Functions without a portable form are refused. sh portable_test.sh WHIT SCENES LEAKY [all]
. "$(dirname "$0")/common.sh"
LEAKY=$3

# both NAME SCENE OPTIONS...: draws the picture twice with the same bytes; the second time without the device's own
# division, square root and comparisons, and with buffers that the host cannot access.
both() {
    name=$1
    scene=$2
    shift 2
    set -- render "$scene" --size 48x36 --portable on -q "$@"
    expect 0 "$name" "$@" -o "$OUT/own.pfm" --ids "$OUT/own.exr"
    WHIT_STAGING=1 WHIT_OWN_DIVISION=0 WHIT_OWN_COMPARISON=0 expect 0 "$name as on a GPU" "$@" -o "$OUT/functions.pfm" \
        --ids "$OUT/functions.exr"
    check "$name: the same colours" cmp "$OUT/own.pfm" "$OUT/functions.pfm"
    check "$name: the same ids" cmp "$OUT/own.exr" "$OUT/functions.exr"
}
if part 0 2; then both fast "$CUBE" --numerics fast; fi
if part 1 2; then both watertight "$SCENES/balls.json"; fi
if [ "${4:-}" = all ]; then
    both layers "$SCENES/layers.json"
    both exact "$CUBE" --numerics exact
fi

# All functions of GLSL that Vulkan leaves to drivers and that have a portable form.
cat >"$OUT/all.glsl" <<'END'
vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    vec3 p = s.p, q = p / (abs(p.zxy) + 0.3), r = sqrt(abs(p)) + inversesqrt(abs(q) + 0.1);
    r += exp(q) + exp2(-q) + log(abs(p) + 0.01) + log2(abs(q) + 0.01) + pow(abs(p), abs(q));
    r += sin(p * 9.0) + cos(q) + tan(q) + asin(fract(q)) + acos(fract(p)) + atan(p) + atan(p, q);
    r += mod(p, vec3(0.37)) + mix(p, q, r) + smoothstep(p, p + 1.0, q) + round(p) + sign(q);
    r += clamp(p, min(p, q), max(p, q)) + fma(p, q, r) + radians(p) + degrees(q) * 0.01;
    r += normalize(p) + reflect(p, s.ns) + refract(normalize(p), s.ns, 0.9) + cross(p, q);
    r += faceforward(p, q, r) + length(p) + distance(p, q) + dot(p, q) + vec3(ivec3(p * 40.0));
    r += step(p, q) + vec3(lessThan(p, q)) + vec3(equal(p, p.yzx)) + vec3(notEqual(q, q.zxy)) + vec3(p.x >= q.y);
    r += vec3(lessThanEqual(q, p)) + vec3(greaterThan(p, q.yzx)) + vec3(greaterThanEqual(p, q.zxy));
    mat3 m = mat3(p, q, r);
    r = fract(m * (q * m) + (m * m)[1] + unpackUnorm4x8(uint(abs(p.x) * 1e6)).xyz);
    return mix(r, vec3(0.25), isnan(r));
}
END
both "all functions" "$CUBE" --shader "$OUT/all.glsl"

for call in 'determinant(mat3(s.p, s.ns, s.p))' 'ldexp(s.p.x, 2)'; do
    name=${call%%(*} at=none
    [ "$name" = ldexp ] && at=included
    printf '%s\n' "vec3 unused(vec3 p) { return sinh(p); }" '' "vec3 other(Surface s) {" "    return vec3($call);" '}' >"$OUT/$at.glsl"
    [ $at = none ] || echo "#include \"$at.glsl\"" >"$OUT/none.glsl"
    echo "vec3 shade(Surface s, Optics o, vec3 to_eye) { return other(s); }" >>"$OUT/none.glsl"
    set -- render "$CUBE" --size 16x16 -q --shader "$OUT/none.glsl" -o "$OUT/none.pfm"
    refuse 2 "$name" "$at.glsl:4: $name has no portable form" "$@" --portable on
    check "$name: no picture" test ! -e "$OUT/none.pfm"
done

# A probe and `whit trace` are as portable as the picture.
echo 'vec3 shade(Surface s, Optics o, vec3 to_eye) { return sin(s.p * 9.0); }' >"$OUT/sin.glsl"
set -- "$CUBE" --size 48x36 -q --shader "$OUT/sin.glsl" --portable on
expect 0 "a picture of sines" render "$@" -o "$OUT/sin.pfm"
at=$(($(wc -c <"$OUT/sin.pfm") - (18 * 48 + 24) * 12)) # of 24,18: rows are from below
drawn=$(od -An -tf4 -j $at -N 12 "$OUT/sin.pfm")
expect 0 "a probe of it" probe "$@" --pixel 24,18
probed=$(sed -n 's/^colour *\(.*\) linear.*/\1/p' "$OUT/stdout")
check "has its colour, to the digits that are printed ($probed;$drawn)" sh -c 'echo "$1 $2" | awk "{
    for (i = 1; i <= 3; i++) { d = \$i - \$(i + 3); if (d * d > 9e-16) exit 1 }
    exit NF != 6 }"' sh "$drawn" "$probed"
printf '\0\0\0\0\0\0\200\100\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\277\0\0\0\0\0\0\200\177' >"$OUT/rays"
set -- trace "$CUBE" --input "$OUT/rays" -o "$OUT/hits" -q
"$LEAKY" "$@" 2>"$OUT/stderr"
check "rays: exit code 0" test $? -eq 0
rm "$OUT/hits"
WHIT_TEST_REFUSED=1 "$LEAKY" "$@" --portable on 2>"$OUT/stderr"
status=$?
check "rays by portable kernels, which this library refuses: exit code 2 or 3 ($status)" test $status -eq 2 -o $status -eq 3
check "says so" grep -q "portable kernels are refused" "$OUT/stderr"
exit $FAILED
