#!/bin/sh
# `whit scene` lists the contents of a scene as text, JSON and triangles.
. "$(dirname "$0")/common.sh"
needs jq
mkdir "$OUT/files"

shows "scene" "triangles    12 " scene "$CUBE"
check "lists the camera" grep -q "0  camera .*35 degrees" "$OUT/stdout"
check "lists the light" grep -q "0  lamp .*point at 2 4 3" "$OUT/stdout"
check "lists the material" grep -q "0  cube .*phong" "$OUT/stdout"
check "says why there are shadows" grep -Eq "^  shadows +yes +light .lamp." "$OUT/stdout"
check "has what is not called for" grep -Eq "^  refraction +- " "$OUT/stdout"
echo '{"lights": [{"kind": "rectangle", "name": "window", "position": [0, 3, 0], "u": [1, 0, 0], "v": [0, 0, 2]}],
    "objects": [{"shape": "box"}]}' >"$OUT/window.json"
shows "a rectangle by its centre, as files have it" "window  *rectangle at 0 3 0 towards 0 -1 0" scene "$OUT/window.json"
expect 0 "scene --json" scene "$CUBE" --json
cp "$OUT/stdout" "$OUT/first"
expect 0 "scene --json again" scene "$CUBE" --json
check "JSON is stable" cmp "$OUT/first" "$OUT/stdout"

trees=$(for scene in "$SCENES"/*.json; do
    "$WHIT" scene "$scene" --json 2>/dev/null | jq -r "select(.one_tree) | .file | split(\"/\") | last"
done | tr '\n' ' ')
check "these are one tree by themselves: $trees" test "$trees" = "34k.json 8k.json default.json \
glass-of-water.json lens.json spotlight.json strands.json whitted.json "
shows "one of them" "^  trees        one, in world space" scene "$SCENES/lens.json"

T=$OUT/files/triangles
expect 0 "at another time" scene "$SCENES/spin.json" --time 1
check "says that it lists another" grep -q "places are listed as they are at 0 s" "$OUT/stderr"
expect 0 "scene --triangles" scene "$CUBE" --triangles "$T" --quiet
check "12 records of 44 bytes" test "$(wc -c <"$T")" -eq 528
ids=$(od -An -v -tu4 -w44 "$T" | awk '{ printf "%s:%s ", $10, $11 }')
check "instance 0, primitives 0 to 11" \
    test "$ids" = "0:0 0:1 0:2 0:3 0:4 0:5 0:6 0:7 0:8 0:9 0:10 0:11 "
corners=$(od -An -v -tf4 -w44 "$T" | awk '{ for (i = 1; i <= 9; ++i) print ($i < 0 ? -$i : $i) }' |
    sort -u)
check "every coordinate is half an edge" test "$corners" = 0.5
rm "$T"

# An object that would need too much memory is refused by name before the memory is allocated. With sanitizers there is
# no limit on the address space, because they reserve terabytes.
SANITIZED=${3-}
too_much() { # NAME PATTERN LIMIT OBJECTS
    printf '{"objects":[%s]}' "$4" >"$OUT/files/much.json"
    ([ -n "$SANITIZED" ] || ulimit -v 400000
    "$WHIT" scene "$OUT/files/much.json" --memory-limit "$3") \
        >"$OUT/stdout" 2>"$OUT/stderr"
    check "$1 too large: exit code" test $? -eq 2
    check "$1 too large: one error, with the option" test "$(grep -c . "$OUT/stderr")" -eq 1
    check "$1 too large: what it is" grep -Eq "objects\[0\].*$2 would take .* MiB of memory, .*the \
limit is .* MiB \(--memory-limit\)" "$OUT/stderr"
}
too_much "copies" "999999 copies of 1 instances" 1G \
    '{"shape":"box","repeat":{"count":[1000,1000,1]}}'
too_much "a terrain" "its terrain" 1G '{"shape":"terrain","steps":2000}'
too_much "an icosphere" "its icosphere" 300M '{"shape":"icosphere","level":8}'
too_much "a sphereflake" "its sphereflake of 597871 spheres" 400M '{"shape":"sphereflake","level":6}'
too_much "balls" "its sphereflake" 100M '{"shape":"sphereflake","level":6,"balls":true}'
expect 0 "within the limit" scene "$OUT/files/much.json" --memory-limit 1G
rm "$OUT/files/much.json"
head -c 400000 /dev/zero >"$OUT/b.bin"
buffers=$(yes ',{"uri":"b.bin","byteLength":400000}' | head -60 | tr -d '\n')
printf '{"asset":{"version":"2.0"},"buffers":[%s]}' "${buffers#,}" >"$OUT/buffers.gltf"
refuse 2 "one file in 60 buffers" 'buffer `b.bin` would take .* MiB of memory, .*--memory-limit' \
    scene "$OUT/buffers.gltf" --memory-limit 8M
for size in 0 -1 1T 1KK "" 99999999999G; do
    refuse 2 "--memory-limit '$size'" "a number of bytes is needed" scene "$CUBE" --memory-limit "$size"
done

ln -s loop.obj "$OUT/loop.obj"
refuse 2 "a link to itself" "loop.obj: Too many levels of symbolic links" scene "$OUT/loop.obj"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n' >"$OUT/bare.obj"
[ -n "$SANITIZED" ] || # its children have no limit
    refuse 2 "an importer that wants too much" "asked for more than .* MiB of memory, half of --memory-limit" \
    scene "$OUT/bare.obj" --memory-limit 400
shows "a model without camera and light" "no camera in the file" scene "$OUT/bare.obj"
check "says that a light was added" grep -q "no light in the file" "$OUT/stdout"
expect 0 "notes as JSON" scene "$OUT/bare.obj" --json
check "the JSON has them with their levels" jq -e '(.notes | length >= 3) and
    all(.notes[]; .level == "info" or .level == "warning") and
    any(.notes[]; .text | test("no camera in the file"))' "$OUT/stdout"
expect 0 "the degenerate triangle is gone" scene "$OUT/bare.obj" --triangles "$T" --quiet
check "one record is left" test "$(wc -c <"$T")" -eq 44
rm "$T"

mkdir "$OUT/model" "$OUT/maps"
printf 'mtllib ../maps/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n' >"$OUT/model/a.obj"
printf 'newmtl red\nKd 1 0 0\n' >"$OUT/maps/a.mtl"
expect 0 "a model that names a file outside of its folder" scene "$OUT/model/a.obj"
check "names the reference and what allows it" grep -q \
    "\`../maps/a.mtl\`: it lies outside .*--allow-path $(realpath "$OUT/maps") lets" "$OUT/stdout"
expect 0 "as JSON" scene "$OUT/model/a.obj" --json
check "has not read it" jq -e '.materials[0].diffuse != [1, 0, 0]' "$OUT/stdout"
expect 0 "--allow-path" scene "$OUT/model/a.obj" --json --allow-path "$OUT" --allow-path "$OUT/maps"
check "has read it" jq -e '.materials[0].diffuse == [1, 0, 0]' "$OUT/stdout"
refuse 2 "a folder that is not there" "nowhere: cannot be allowed: No such file" \
    scene "$OUT/model/a.obj" --allow-path "$OUT/nowhere"
refuse 2 "an empty folder name" "--allow-path takes a folder" scene "$CUBE" --allow-path ""

# ---- A model's lights, its axis that points up, and its background ----

# A tall slab with a lamp on top.
cat >"$OUT/slab.gltf" <<'JSON'
{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [ 0, 1 ] } ],
  "nodes": [ { "mesh": 0 }, { "translation": [0, 5, 1], "extensions": { "KHR_lights_punctual": { "light": 0 } } } ],
  "extensionsUsed": [ "KHR_lights_punctual" ],
  "extensions": { "KHR_lights_punctual": { "lights": [ { "type": "point", "intensity": 9 } ] } },
  "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 } } ] } ],
  "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
    "min": [0, 0, 0], "max": [1, 4, 0] } ],
  "bufferViews": [ { "buffer": 0, "byteLength": 36 } ],
  "buffers": [ { "byteLength": 36, "uri":
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgEAAAAAA" } ] }
JSON
# lights_are NAMES OPTION...: the scene has lights of these kinds, with `+` behind those that whit made.
lights_are() {
    names=$1
    shift
    expect 0 "$*" scene "$OUT/slab.gltf" --json "$@"
    check "has the lights $names" jq -e --arg names "$names" \
        '[.lights[] | .kind + if .made_by_whit then "+" else "" end] | join(" ") == $names' "$OUT/stdout"
}
lights_are point --light auto
lights_are point --light file
lights_are "" --light none
lights_are directional+ --light key
# bounds_are Y Z OPTION...: the scene has this extent along y and z.
bounds_are() {
    high=$1 deep=$2
    shift 2
    expect 0 "$*" scene "$OUT/slab.gltf" --triangles "$T" --quiet "$@"
    check "is $high high and $deep deep" test "$(od -An -tf4 -w4 -v "$T" | awk -v high="$high" -v deep="$deep" '
        (NR - 1) % 11 < 9 { n = (NR - 1) % 11 % 3; if ($1 > most[n]) most[n] = $1; if ($1 < least[n]) least[n] = $1 }
        END { print most[1] - least[1] == high && most[2] - least[2] == deep }')" -eq 1
    rm "$T"
}
bounds_are 4 0 --up auto
bounds_are 4 0 --up=-y
bounds_are 0 4 --up z
bounds_are 1 0 --up x
# A pyramid that lies on its side.
printf 'OFF\n5 5 0\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n0 0 3\n4 3 2 1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n' >"$OUT/pyramid.off"
for up in auto y; do
    expect 0 "a lying pyramid, --up $up" scene "$OUT/pyramid.off" --up $up --json
    check "stands with --up auto" jq -e --arg up $up '.bounds | (.hi[1] == 3) == ($up == "auto")' "$OUT/stdout"
done
refuse 2 "no such axis" "auto, x, y, z" scene "$OUT/slab.gltf" --up w
sky="--camera 0,0,9,0,0,99,0,1,0,40 --size 8x8 --quiet"
# shellcheck disable=SC2086
{
    expect 0 "a background" render "$OUT/slab.gltf" -o "$OUT/behind.pfm" $sky --background '#ff8000'
    expect 0 "a picture of it" render "$OUT/slab.gltf" -o "$OUT/all.pfm" $sky --environment "$OUT/behind.pfm" --stats json
    check "what is cut has the map's light at most" jq -e '.rays.bailout_bound != null' "$OUT/stdout"
    expect 0 "is the same all around" compare "$OUT/behind.pfm" "$OUT/all.pfm" --metric largest --tolerance 1e-6
    expect 0 "the sky" render "$OUT/slab.gltf" -o "$OUT/sky.pfm" $sky --background env
    check "is another" sh -c '! cmp -s "$1/sky.pfm" "$1/behind.pfm"' - "$OUT"
    refuse 2 "a sky that is not there" "nowhere.hdr" render "$OUT/slab.gltf" -o "$OUT/never.pfm" $sky \
        --environment "$OUT/nowhere.hdr"
    for color in '#ff80' '#ff80000' ff8000 '#gg8000' '# 12345' ''; do
        refuse 2 "the colour '$color'" "background" render "$OUT/slab.gltf" -o "$OUT/never.pfm" $sky \
            --background "$color"
    done
}

refuse 2 "an import limit of nothing" "import-limit" scene "$OUT/model/a.obj" --import-limit 0
expect 0 "an import limit that is not reached" scene "$OUT/model/a.obj" --import-limit 30
run scene "$OUT/model/a.obj" --require-sandbox
check "a required sandbox is there, or an error" \
    test "$status" -eq "$(if grep -q sandbox "$OUT/stderr"; then echo 2; else echo 0; fi)"

refuse 2 "triangles into no folder" "nowhere/t" scene "$CUBE" --triangles "$OUT/nowhere/t"
check "no file was left" is_empty "$OUT/files"
finish
