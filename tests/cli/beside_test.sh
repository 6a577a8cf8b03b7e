#!/bin/sh
# Functions of a user together with other options of pictures: the options that work with them, and those that are
# refused by name.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
needs jq
cd "$OUT" || exit 1
cat >own.glsl <<'END'
//@ slider dark 0 1 0.25
vec3 miss(vec3 dir) { return vec3(step(0.0, sin(40.0 * dir.x)) * dark, random(3u), 0.5); }
END
echo 'vec3 post(ivec2 at, vec3 color) { return 2.0 * color; }' >post.glsl
draw() { # OUTPUT SCENE OPTION...
    output=$1 scene=$2
    shift 2
    expect 0 "$scene $*" render "$SCENES/$scene.json" --size 32x24 -o "$output" --shader own.glsl --quiet "$@"
}

# For each row two pictures are drawn with the functions; they differ by at most LIMIT of METRIC.
while IFS='|' read -r what scene a b metric limit; do
    draw a.pfm $scene $a
    draw b.pfm $scene $b
    run compare a.pfm b.pfm --metric $metric --tolerance $limit
    check "$what: $metric is at most $limit" test $status -eq 0
done <<'END'
exact numerics|cube|--numerics exact|--numerics watertight|over|0
fast numerics|cube|--numerics fast|--numerics watertight|over|0
adaptive samples|cube|--aa 64|--aa adaptive:0.001|rmse|0.05
END
draw one.pfm cube --aa 1
run compare one.pfm b.pfm --metric rmse --tolerance 0.05
check "adaptive samples are more than one" test $status -eq 1

# A frame of a sequence is the picture of that frame alone.
draw "s.#.png" swarm --frames 3-4
for frame in 3 4; do
    draw one.png swarm --frame $frame
    check "frame $frame of a sequence" cmp one.png s.$frame.png
done

# --refine draws more samples until the error is small enough.
expect 0 "refined" render "$SCENES/cube.json" --size 32x24 -o r.exr --shader own.glsl --refine 0.05 --stats json
samples=$(jq .refine.samples stdout)
check "it took more than one ($samples)" test "$samples" -gt 1
draw a.exr cube --aa "$samples"
expect 0 "as of as many samples" compare r.exr a.exr --metric differing --tolerance 0

refuse 2 "an error" "max-error is measured against the reference, which has no --shader" \
    render "$CUBE" --shader own.glsl --max-error 0.1 -o no.png
refuse 2 "a budget" "budget-ms is measured against the reference, which has no --shader" \
    render "$CUBE" --shader own.glsl --budget-ms 10 -o no.png
refuse 2 "prices" "--shader. is not of cost: .* the reference, which has no functions" cost "$CUBE" --shader own.glsl
refuse 2 "refining what post makes of it" "post" render "$CUBE" --shader post.glsl --refine 0.1 -o no.png
check "no picture of any" test ! -e no.png
finish
