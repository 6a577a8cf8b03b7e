#!/bin/sh
# Scenes and models from standard input give the same pixels as from a file, and one clear error if they cannot be read.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/models" "$OUT/pictures"
M=$OUT/models
P=$OUT/pictures/x.pfm

# number BYTES: prints a number below 65536 as 32 bits, little-endian.
number() {
    printf "\\$(printf %o $(($1 & 255)))\\$(printf %o $(($1 >> 8 & 255)))\\0\\0"
}
# corners: prints (0,0,0) (1,0,0) (0,1,0) as floats.
corners() {
    printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0'
}
# document BUFFER: prints the JSON of a glTF with these corners, padded to a multiple of 4 bytes.
document() {
    json="{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36$1}],\"bufferViews\":[{\"buffer\":0,\
\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\
\"min\":[0,0,0],\"max\":[1,1,0]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\
\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}"
    while [ $((${#json} % 4)) -ne 0 ]; do json="$json "; done
    printf %s "$json"
}
document ",\"uri\":\"data:application/octet-stream;base64,$(corners | base64)\"" >"$M/a.gltf"
document ',"uri":"away.bin"' >"$M/away.gltf"
corners >"$M/away.bin"
document '' >"$OUT/json"
size=$(wc -c <"$OUT/json")
{
    printf glTF
    number 2
    number $((28 + size + 36))
    number "$size"
    printf JSON
    cat "$OUT/json"
    number 36
    printf 'BIN\0'
    corners
} >"$M/a.glb"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$M/a.obj"
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z
element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >"$M/a.ply"
{
    printf '%80s' ''
    number 1
    number 0 && number 0 && number 0
    corners
    printf '\0\0'
} >"$M/a.stl"
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >"$M/a.off"
cp "$CUBE" "$M/a.json"

for kind in json gltf glb obj ply stl off; do
    expect 0 "$kind" render "$M/a.$kind" -o "$OUT/file.pfm" --size 32x24
    expect 0 "$kind from standard input" render - -o "$OUT/input.pfm" --size 32x24 <"$M/a.$kind"
    check "$kind: the same pixels" cmp "$OUT/file.pfm" "$OUT/input.pfm"
done
cat "$M/a.glb" | "$WHIT" render - -o "$OUT/pipe.png" --size 32x24 --quiet
check "a pipe" test -s "$OUT/pipe.png"
check "the recipe says where it is from" grep -aq "render - " "$OUT/pipe.png"

# Other commands.
shows "scene" "1 triangle" scene - <"$M/a.ply"
shows "scene --json" '"file": "-"' scene - --json <"$M/a.ply"
shows "probe" "stdin.obj" probe - --pixel 4,3 --size 8x6 <"$M/a.obj"
(
    cd "$OUT/pictures" || exit 1
    unset DISPLAY WAYLAND_DISPLAY
    expect 0 "no command" - --size 32x24 <"$M/a.stl"
    check "it is called as standard input is" test -s stdin.png
    rm -f stdin.png
    exit "$FAILED"
) || FAILED=1

# Files that standard input names are not found, even if they are in the working folder.
cd "$M" || exit 1
refuse 2 "a buffer of its own" "stdin.gltf: .*away.bin.: what standard input names has no folder; --allow-path" \
    render - -o "$P" <away.gltf
expect 0 "a folder that is allowed" render - --allow-path . -o "$OUT/input.pfm" --size 32x24 <away.gltf
"$WHIT" render a.gltf -o "$OUT/file.pfm" --size 32x24 --quiet
check "the same pixels" cmp "$OUT/file.pfm" "$OUT/input.pfm"
printf 'newmtl red\nKd 1 0 0\n' | tee stdin.mtl >red.mtl
{ printf 'mtllib red.mtl\nusemtl red\n' && cat a.obj; } >red.obj
expect 0 "a material of its own" render - -o "$OUT/input.pfm" --size 32x24 <red.obj
check "is a warning" grep -q "warning: stdin.obj: material library .red.mtl.: what standard input" "$OUT/stderr"
expect 0 "no material" render - -o "$OUT/input.pfm" --size 32x24 <a.obj
check "none is looked for by the name" test "$(grep -c "stdin.mtl" "$OUT/stderr")" -eq 0
printf '{ "objects": [ { "model": "a.obj" } ] }' >places.json
refuse 2 "a model of its own" "stdin.json:1:.*a.obj.: what standard input names" render - -o "$P" <places.json
printf '{ "objects": [ { "model": "-" } ] }' >itself.json
refuse 2 "itself" "no model" render - -o "$P" <itself.json
cd "$OUT" || exit 1

# Standard input that is no scene and no model.
refuse 2 "nothing" "standard input: there is nothing in it" render - -o "$P" </dev/null
refuse 2 "no format" "standard input: it begins like no" render - -o "$P" <"$OUT/pipe.png"
refuse 2 "a damaged scene" "stdin.json:1:" render - -o "$P" <<X
{ "objects": oops
X
refuse 2 "a folder" "standard input: " render - -o "$P" <"$M"
refuse 2 "none at all" "standard input: there is nothing in it" render - -o "$P" <&-
refuse 2 "a terminal" "standard input: it is a terminal" render - -o "$P" </dev/ptmx
head -c 268435457 /dev/zero >"$OUT/large"
refuse 2 "too much" "standard input: more than 256 MiB" render - -o "$P" <"$OUT/large"
check "no file was left" is_empty "$OUT/pictures"
finish
