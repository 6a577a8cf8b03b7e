#!/bin/sh
# An error that a kernel reports gives exit code 1, one line, and no picture: sh status_test.sh WHIT SCENES
# SMALL_STACKS. SMALL_STACKS is a whit whose stacks are too small: those of the real program never overflow.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
SMALL=$(cd "$(dirname "$3")" && pwd)/$(basename "$3")
mkdir "$OUT/pictures"
cd "$OUT/pictures" || exit 1

# distrust WHAT PATTERN ARGUMENT...: rendering fails with PATTERN, and the old picture stays.
distrust() {
    whom=$1
    report=$2
    shift 2
    echo old >p.exr
    refuse 1 "$whom" "the result is not to be trusted: .*$report" render "$@" -o p.exr --quiet
    check "$whom: the old picture is there" test "$(cat p.exr)" = old
    check "$whom: nothing else is" test "$(ls -A)" = p.exr
}

# Two mirrors that multiply light by 10^12 reflect each other in a sky of 10^12, so that radiance overflows.
cat >"$OUT/mirrors.json" <<END
{ "environment": 1e12, "ambient": 0, "camera": { "eye": [0.01, 0, 0], "target": [1, 0, 0], "fov": 20 },
  "lights": [{ "kind": "directional", "direction": [0, -1, 0], "intensity": 1e-6 }],
  "materials": { "m": { "diffuse": 0, "reflection": 1e12 } },
  "objects": [
    { "shape": "box", "size": [0.1, 9, 9], "translation": [2, 0, 0], "material": "m" },
    { "shape": "box", "size": [0.1, 9, 9], "translation": [-2, 0, 0], "material": "m" } ] }
END
where="radiance is not finite: in [1-9][0-9]* pixels\{0,1\} so far, the first at [0-9]*,[0-9]*$"
for options in "" "--aa 4" "--aa adaptive:0.1" "--build none" "--effects all"; do
    distrust "infinite radiance $options" "$where" "$OUT/mirrors.json" --size 16x16 $options
done
expect 0 "the same mirrors without a second bounce" \
    render "$OUT/mirrors.json" -o p.exr --size 16x16 --depth 1 --quiet
rm p.exr

# Boxes of glass in each other: the list of a ray holds eight media.
nest() {
    awk -v n="$1" 'BEGIN {
        printf "{ \"environment\": 1, \"camera\": { \"eye\": [0, 0, 20], \"target\": [0, 0, 0] },"
        printf "\"materials\": {"
        for (i = 0; i < n; ++i)
            printf "%s\"g%d\": { \"diffuse\": 0, \"transmission\": 1, \"ior\": %g }", i ? "," : "", i, 1.1 + i / 50
        printf "}, \"objects\": ["
        for (i = 0; i < n; ++i)
            printf "%s{ \"shape\": \"box\", \"size\": %g, \"material\": \"g%d\" }", i ? "," : "", 9 - i / 2, i
        printf "] }" }'
}
nest 9 >"$OUT/nine.json"
distrust "nine media" "more media at once" "$OUT/nine.json" --size 8x8 --depth 20
nest 8 >"$OUT/eight.json"
expect 0 "eight media" render "$OUT/eight.json" -o p.exr --size 8x8 --depth 20 --quiet
rm p.exr

# The lights have more points than the iterations that a driver allows a loop (lavapipe 65,535). It works, because each
# light has a dispatch of its own.
awk 'BEGIN {
    printf "{ \"camera\": { \"eye\": [0, 2, 3], \"target\": [0, 0, 0] }, \"lights\": ["
    for (i = 0; i < 1100; ++i)
        printf "%s{ \"kind\": \"rectangle\", \"position\": [0, 2, 0], \"u\": [1, 0, 0], \"v\": [0, 0, 1] }", i ? "," : ""
    printf "], \"objects\": [{ \"shape\": \"plane\", \"size\": 4 }] }" }' >"$OUT/lights.json"
expect 0 "many points of lights" \
    render "$OUT/lights.json" -o p.exr --size 8x8 --shadows none --light-samples 64 --quiet
rm p.exr

# A ray meets more nodes than that number of iterations. In the usual order it visits the nearest first and stops.
awk 'BEGIN {
    n = 40000
    for (i = 0; i < n; ++i)
        printf "v -1 -1 %d\nv 1 -1 %d\nv 0 1 %d\n", i, i, i
    for (i = 0; i < n; ++i)
        printf "f %d %d %d\n", 3 * i + 1, 3 * i + 2, 3 * i + 3 }' >"$OUT/pile.obj"
camera="--camera 0,0,99999,0,0,0,0,1,0,0.0001 --up y"
# cut WHAT TEXT ARGUMENTS...: as distrust, on a driver that ends long loops: Mesa 22. Others draw the picture.
"$WHIT" devices >"$OUT/devices"
cut() {
    if grep -q "Mesa 22\." "$OUT/devices"; then
        distrust "$@"
    else
        what=$1
        shift 2
        expect 0 "$what" render "$@" -o p.exr --quiet
    fi
}
cut "too many nodes" "a traversal was cut short" \
    "$OUT/pile.obj" --size 8x8 --leaf 1 --traversal basic --shadows none $camera
expect 0 "the nearest first" render "$OUT/pile.obj" -o p.exr --size 8x8 --leaf 1 --shadows none $camera --quiet
rm p.exr

# Loops of a user's functions count together with each other and with the traversals that these call.
for i in 1 2 3 4 5; do
    echo "//@ aov a$i"
    echo "vec4 a$i(Surface s) { float n = 0.0; for (int i = 0; i < 25000; i++) n += fract(s.p.x); return vec4(n); }"
done >"$OUT/loops.glsl"
sed -i '1s/^/\/\/@ fuel 30000\n/' "$OUT/loops.glsl"
cut "loops of a shader" "loops of the shader, .* all loops of a kernel together .*:3, .*:5, .*:7, .*loops.glsl:9 and 1 more" \
    "$SCENES/cube.json" --size 8x8 --shader "$OUT/loops.glsl"
rm p.exr

# `whit trace` fails in the same way for a ray from z = 65536 along -z. The float mirror on the CPU has no such limit.
ZERO='\000\000\000\000'
printf "$ZERO$ZERO\000\000\200\107$ZERO$ZERO$ZERO\000\000\200\277\000\000\200\177" >"$OUT/ray"
echo old >p.exr
if grep -q "Mesa 22\." "$OUT/devices"; then
    refuse 1 "trace through too many nodes" "not to be trusted: a traversal was cut short" \
        trace "$OUT/pile.obj" --input "$OUT/ray" -o p.exr --leaf 1 --traversal basic --quiet
    check "leaves the old hits" test "$(cat p.exr)" = old
fi
expect 0 "on the CPU" \
    trace "$OUT/pile.obj" --input "$OUT/ray" -o p.exr --leaf 1 --traversal basic --quiet --on cpu
check "gives a hit" test "$(wc -c <p.exr)" -eq 32
rm p.exr

WHIT=$SMALL
expect 0 "stacks as they should be" render "$SCENES/default.json" -o p.exr --size 32x24 --quiet
SMALL_STACKS=nodes
export SMALL_STACKS
distrust "a small node stack" "the node stack overflowed" "$SCENES/default.json" --size 32x24
SMALL_STACKS=packets
distrust "a small stack of packets" "the node stack overflowed" "$SCENES/default.json" --size 32x24 \
    --packets on
SMALL_STACKS=nodes
refuse 1 "trace with a small node stack" "not to be trusted: the node stack overflowed" \
    trace "$OUT/pile.obj" --input "$OUT/ray" -o p.exr --quiet
check "leaves the old hits" test "$(cat p.exr)" = old
refuse 1 "hard rays without an answer" "[1-9][0-9]* of [1-9][0-9]* rows: the device gave no answer" \
    hard --case spikes --quick --quiet --numerics watertight
check "the table says so" grep -q " no answer$" "$OUT/stdout"
check "and that nothing is broken" grep -q "^promises   0 of " "$OUT/stdout"
finish
