#!/bin/sh
# Checks `whit probe`: its text, JSON, exit codes, options. sh probe_test.sh WHIT SCENES LEAKY
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
needs jq
LEAKY=$3
mkdir "$OUT/files"
J=$OUT/files/probe.json
GLASS=$SCENES/whitted.json
S="--size 64x48"

expect 0 "a pixel" probe "$GLASS" $S --pixel 32,20 --quiet --json "$J"
check "nothing else is said" test ! -s "$OUT/stderr"
for line in "pixel      32,20 of 64 x 48, 1 sample, watertight" "instance   1 glass ball" "primitive  0" \
    "material   1 glass, .*whitted.json:12" "position   " "normal     " "depth      5" \
    "rays       1 primary, .* reflected, .* not recorded" "twin       differs in 0 of "; do
    check "says \`$line\`" grep -q "^$line" "$OUT/stdout"
done
check "the tree begins with the camera ray" grep -q "^primary  .*hit, goes on .*glass ball, glass" "$OUT/stdout"
check "what comes of it is below it" grep -q "^  refracted  .*its hollow" "$OUT/stdout"
check "with shadow rays" grep -q "^ *shadow, lamp, point 0 .* passed " "$OUT/stdout"
check "and bounces that were used up" grep -q "^ *re[a-z]*  .*bounces used up" "$OUT/stdout"
rows=$(sed -n '/^ray /,$p' "$OUT/stdout" | tail -n +2 | wc -l)
check "JSON has as many rays ($rows)" jq -e ".rays | length == $rows" "$J"
check "JSON has one camera ray" jq -e '[.rays[] | select(.parent == null)] | length == 1' "$J"
check "JSON says where" jq -e '.pixel.x == 32' "$J"
check "JSON has the material's line" jq -e '.pixel.material.line == 12' "$J"
cp "$J" "$OUT/first.json"
expect 0 "the same once more" probe "$GLASS" $S --pixel 32,20 --quiet --json "$J"
check "is the same" cmp -s "$J" "$OUT/first.json"
probed=$(sed -n 's/^colour *\(.*\) linear.*/\1/p' "$OUT/stdout")

# The pixel in the file: row 20 from above is row 27 from below; a pixel has 12 bytes, behind the head.
expect 0 "the picture" render "$GLASS" $S --quiet -o "$OUT/whitted.pfm"
head=$(($(wc -c <"$OUT/whitted.pfm") - 64 * 48 * 12))
picture=$(od -An -tf4 -j $((head + (27 * 64 + 32) * 12)) -N 12 "$OUT/whitted.pfm")
check "has that colour ($picture; $probed)" sh -c 'echo "$1 $2" | awk "{
    for (i = 1; i <= 3; i++) { d = \$i - \$(i + 3); if (d * d > 1e-12 * \$i * \$i) exit 1 }
    exit NF != 6 || \$1 + \$2 + \$3 == 0 }"' sh "$picture" "$probed"
shows "at exact" "^exact      differs in 0 of [1-9]" probe "$CUBE" $S --pixel 32,24 --quiet --numerics exact
check "to the last bit" grep -q "^primary .* =  *=  *1 1 1" "$OUT/stdout"
shows "the sky" "^instance   none" probe "$CUBE" $S --pixel 0,0 --quiet
shows "without bounces" " 0 reflected, 0 refracted, 2 not traced" probe "$GLASS" $S --pixel 32,20 --depth 0 --quiet
# The lines `why` name the sources of the light, the lights that reach the hit, and the blockers of others.
# why SCENE X,Y SENTENCE [OPTIONS...]: SENTENCE is a regular expression.
why() {
    scene=$SCENES/$1.json pixel=$2 sentence=$3
    shift 3
    shows "why a pixel of $scene is as it is" "^why        $sentence\$" probe "$scene" $S --pixel "$pixel" --quiet "$@"
}
why whitted 32,20 "its light: 1[0-9] % reflected, 8[0-9] % transmitted; \`lamp\` adds nothing"
why default 50,36 "its light: 9[0-9] % direct, [0-9] % reflected; \`sun\` reaches it; [67][0-9] % of \`fill\` reaches it"
why 34k 22,40 "its light: 100 % ambient or emitted; \`warm\` does not reach it, behind \`hat\`; .*; \`top\` does not .*, behind \`hat\`"
for without in "--shadows none" "--effects -shadows"; do
    # shellcheck disable=SC2086
    why 34k 22,40 "its light: 100 % direct; no light is blocked, as there are no shadows" $without
done
why room 40,40 "no light comes from it; the scene has no light but its surroundings" --light none
why cube 0,0 "nothing is there but the surroundings"
expect 0 "little room" probe "$GLASS" $S --pixel 32,20 --rays 3
check "is said" grep -q "^whit: warning: [1-9][0-9]* of $rows rays had no room" "$OUT/stderr"
check "and shown" grep -q " $((rows - 3)) not recorded" "$OUT/stdout"

L="--camera 0,0,5,0,0,0,0,1,0,40 --size 641x481 --pixel 321,240 --quiet"
expect 0 "a ray to the cube" probe "$CUBE" $L
"$LEAKY" probe "$CUBE" $L >"$OUT/stdout" 2>"$OUT/stderr"
check "a twin that loses rays: exit code 1" test $? -eq 1
check "says so" grep -q "^whit: error: the device and its twin differ in 1 of" "$OUT/stderr"
check "and where" grep -q "^primary .* at .* nothing " "$OUT/stdout"
"$LEAKY" probe "$CUBE" $L --numerics fast >"$OUT/stdout" 2>"$OUT/stderr"
check "which fast promises not: exit code 0" test $? -eq 0

# With a shader that reads no normals, they are not compiled into pictures, but a probe reports them all the same.
R="$SCENES/8k.json --size 16x12 --pixel 9,8 --quiet"
echo 'vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.ng; }' >"$OUT/flat.glsl"
expect 0 "a smooth surface" probe $R --json "$J"
jq -c .rays[0].normal "$J" >"$OUT/normal"
expect 0 "the same with a flat shader" probe $R --json "$J" --shader "$OUT/flat.glsl"
check "its normal is the smooth one" test "$(jq -c .rays[0].normal "$J")" = "$(cat "$OUT/normal")"
check "and the shader had the flat one" jq -e '.pixel | (.color[0] - .normal[0] | fabs) > 0.001' "$J"

rm "$J"
refuse 2 "no pixel" "which pixel" probe "$CUBE"
refuse 2 "a pixel outside" "pixel 640,10: outside of the picture of 640 x 480" probe "$CUBE" --pixel 640,10
refuse 2 "a pixel below" "pixel 3,48: outside" probe "$CUBE" --size 64x48 --pixel 3,48
for pixel in 12 12, ,12 1,2,3 -1,2 1.5,2 a,b "1, 2"; do
    refuse 2 "pixel \`$pixel\`" "two numbers X,Y" probe "$CUBE" --pixel="$pixel"
done
refuse 2 "adaptive" "4, 16 or 64" probe "$CUBE" --pixel 1,1 --aa adaptive:0.1
refuse 2 "too many rays" "1 to 16383" probe "$CUBE" --pixel 1,1 --rays 20000
expect 0 "JSON on standard output" probe "$CUBE" $S --pixel 1,1 --quiet --json /dev/stdout
check "is nothing else" jq -e .rays "$OUT/stdout"
refuse 2 "JSON to a pipe" "/dev/stdout" probe "$CUBE" --pixel 1,1 --json -
refuse 2 "JSON nowhere" "nowhere/x" probe "$CUBE" --pixel 1,1 --json "$OUT/nowhere/x"
refuse 2 "no such camera" "no camera" probe "$CUBE" --pixel 1,1 --camera nobody --quiet
check "no file was left" is_empty "$OUT/files"
finish
