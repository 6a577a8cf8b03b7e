#!/bin/sh
# --stages draws with the stages of a checkout in place of those that are built in: the same pictures from the same
# files, other pictures from changed files, and errors.
. "$(dirname "$0")/common.sh"
SHADERS=$(cd "$SCENES/../shaders" && pwd)
mkdir "$OUT/here" && cd "$OUT/here" && cp -r "$SHADERS" st || exit 1
draw() { # WHAT OUTPUT SCENE OPTION...
    what=$1 output=$2 scene=$3
    shift 3
    expect 0 "$what" render "$SCENES/$scene.json" --size 48x32 --quiet "$@" -o "$output"
}
# Stages are compiled before the scene is known; this scene calls for all of them.
draw "media" a.pfm glass-of-water
draw "media by the same stages" b.pfm glass-of-water --stages st
check "the same bytes of media" cmp a.pfm b.pfm
draw "exact" a.pfm cube --numerics exact --aa adaptive:0.1
draw "exact, by the same stages" b.pfm cube --numerics exact --aa adaptive:0.1 --stages st/
check "the same bytes, exact" cmp a.pfm b.pfm
echo 'vec3 post(ivec2 at, vec3 color) { return 0.5 * color; }' >half.glsl
draw "with functions" a.pfm cube --shader half.glsl
draw "with functions and the same stages" b.pfm cube --shader half.glsl --stages st
check "the same bytes, with functions" cmp a.pfm b.pfm

# broken NAME FILE LINE REASON: with the text on standard input as line 3 of the file, whit refuses it.
broken() {
    { head -2 "st/$2" && cat && tail -n +3 "$SHADERS/$2"; } >new
    mv new "st/$2"
    refuse 2 "$1" "st/$2:$3: $4" render "$CUBE" --size 8x8 --stages st -o no.png
    cp "$SHADERS/$2" "st/$2"
}
echo 'float x = nope;' | broken "a name" lib/optics.glsl 3 "'nope': undeclared identifier"
printf '\nfloat x( { }\n' | broken "no syntax" bind/camera.glsl 4 "syntax error"
echo 'float last = nope;' >>st/kernel/resolve.comp
refuse 2 "behind conditions" "st/kernel/resolve.comp:$(wc -l <st/kernel/resolve.comp): 'nope'" \
    render "$CUBE" --size 8x8 --stages st -o no.png
cp "$SHADERS/kernel/resolve.comp" st/kernel/
sed -i '/user.glsl/d' st/kernel/hook.comp
refuse 2 "no place for functions" "st/kernel/hook.comp: it does not include hook/user.glsl" \
    render "$CUBE" --size 8x8 --stages st --shader half.glsl -o no.png
cp "$SHADERS/kernel/hook.comp" st/kernel/
: >st/kernel/resolve.comp
refuse 2 "an empty stage" "st/kernel/resolve.comp: it is empty" render "$CUBE" --size 8x8 --stages st -o no.png
cp "$SHADERS/kernel/resolve.comp" st/kernel/
echo '#include "no.glsl"' | broken "no file" bind/hook.glsl 3 '#include "bind/no.glsl": there is no such file'
cp half.glsl ..
echo '#include "../../half.glsl"' | broken "a file above" lib/spawn.glsl 3 '#include .*: it lies outside'
echo >>st/abi/spec.h
refuse 2 "another abi" "st/abi/spec.h: .* takes a build" render "$CUBE" --stages st -o no.png
cp "$SHADERS/abi/spec.h" st/abi/
refuse 2 "no folder" "none: there is no such folder" render "$CUBE" --stages none -o no.png
refuse 2 "a goal" "the reference, which has no --stages" render "$CUBE" --stages st --max-error 1 -o no.png
check "no picture of any" test ! -e no.png

# A stage may include a new file, which changes the picture.
echo 'vec3 dimmed(vec3 c) { return 0.5 * c; }' >st/lib/dimmed.glsl
echo 'vec3 miss(vec3 dir) { return 0.5 * environment(dir); }' >dim.glsl
sed -i 's|^vec3 miss(|#include "../lib/dimmed.glsl"\n&|; s|return environment(dir)|return dimmed(environment(dir))|' st/hook/miss.glsl
draw "a dim sky" a.pfm cube --shader dim.glsl
draw "in a stage" b.pfm cube --stages st
expect 0 "is as dark" compare a.pfm b.pfm --metric over --tolerance 0
draw "usual" c.pfm cube
run compare b.pfm c.pfm --metric over --tolerance 0
check "and darker than it was" test "$status" -eq 1
finish
