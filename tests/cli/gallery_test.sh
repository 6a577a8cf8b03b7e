#!/bin/sh
# docs/gallery.md and docs/scenes.md: their scenes render and call for their effects, their pictures exist, and
# tools/gallery makes each of them.
#     gallery_test.sh WHIT SCENES CONTACT_SHEET
. "$(dirname "$0")/common.sh"
needs jq
SHEET=$3
ROOT=$SCENES/..
GALLERY=$ROOT/docs/gallery.md
PAGE=$ROOT/docs/scenes.md
SCHEMA=$ROOT/docs/scene.schema.json

# ---- Each picture has a command, and each command a picture ----

# A copy of the tree, and a whit that only writes down its arguments.
mkdir "$OUT/tree" "$OUT/tree/tools" "$OUT/tree/docs" "$OUT/tree/scenes"
cp "$ROOT/tools/gallery" "$OUT/tree/tools"
cp "$GALLERY" "$PAGE" "$OUT/tree/docs"
cp -r "$SCENES/gallery" "$OUT/tree/scenes"
# shellcheck disable=SC2016
printf '#!/bin/sh\necho "$*" >>"%s"\n' "$OUT/asked" >"$OUT/says"
chmod +x "$OUT/says"
check "tools/gallery runs" "$OUT/tree/tools/gallery" "$OUT/says"
sed -n 's/.* -o \(docs[^ ]*\) .*/\1/p' "$OUT/asked" | sort >"$OUT/made"
sed -n 's/.*!\[[^]]*\](\(images[^)]*\)).*/docs\/\1/p' "$GALLERY" "$PAGE" | sort >"$OUT/shown"
check "it makes the $(grep -c . "$OUT/shown") pictures that the pages show" cmp "$OUT/made" "$OUT/shown"
check "of which none is missing" test -z "$(cd "$ROOT" && xargs ls <"$OUT/shown" 2>&1 >/dev/null)"
sed -n 's/^    whit \(.*\)/\1 --quiet/p' "$GALLERY" | grep -v NAME >"$OUT/printed"
check "the commands are those that are printed" test -z "$(grep -vxFf "$OUT/asked" "$OUT/printed")"

# ---- Scenes and their effects ----

# $OUT/effects has a line for each effect: its name, and the scene of its picture.
awk '/^## / { effect = "" } match($0, /effect `[a-z-]+`/) { effect = substr($0, RSTART + 8, RLENGTH - 9) }
    /^    whit render/ && effect && /docs\/images/ { print effect, $3 }' "$GALLERY" >"$OUT/effects"
check "eleven effects or more" test "$(grep -c . "$OUT/effects")" -ge 11
# described FILE: `whit scene` lists the scene; its JSON is added to $OUT/described.
described() {
    expect 0 "$1" scene "$1" --json
    cat "$OUT/stdout" >>"$OUT/described"
}
no_warnings='[.[].notes[] | select(.level != "info")] == []'
cd "$ROOT" || exit 1
set --
while read -r _ scene; do
    described "$scene"
    grep -q "^ of $scene " "$ROOT/tests/check/whit.golden" || set -- "$@" "$scene"
done <"$OUT/effects"
missing=$(jq -r -s --rawfile names "$OUT/effects" '[., ($names | split("\n") | map(split(" ")[0]))] | transpose[] |
    . as [$scene, $name] | select($scene and all($scene.effects[]; .name != $name or (.called | not))) |
    $scene.file + " " + $name' "$OUT/described")
check "each calls for the effect that it is there for $missing" test -z "$missing"
check "none has warnings" jq -e -s "$no_warnings" "$OUT/described"
# Scenes that whit's own suite draws are checked there.
# shellcheck disable=SC2016
check "the $# others render" sh -c '"$@" >"$0" 2>&1' "$OUT/stderr" "$SHEET" "$@" -o "$OUT/sheet.png" --size 64x48 --aa 1

# The maps in the repository are those that the commands make.
mv "$OUT/tree/scenes/gallery"/*.png "$OUT"
# shellcheck disable=SC2016
check "tools/gallery makes the maps" sh -c '"$@" >"$0" 2>&1' "$OUT/stderr" \
    "$OUT/tree/tools/gallery" "$WHIT" gallery/lattice gallery/studs
for map in lattice studs; do
    expect 0 "$map is as it was" compare "$OUT/$map.png" "$OUT/tree/scenes/gallery/$map.png" \
        --metric largest --tolerance 0.01
done
# ---- Pictures are made from the present scenes and commands ----

# Two pictures are made again: their textures have more texels than the picture shows.
mkdir -p "$OUT/tree/docs/images/materials"
fresh=docs/images/materials
# shellcheck disable=SC2016
check "tools/gallery makes pictures" sh -c '"$@" >"$0" 2>&1' "$OUT/stderr" \
    "$OUT/tree/tools/gallery" "$WHIT" materials/checker materials/bumps
for name in checker bumps; do
    expect 0 "$name is as it was" compare "$fresh/$name.png" "$OUT/tree/$fresh/$name.png" --metric over --tolerance 0.002
done
# Each picture has a recipe. recipe FILE PICTURE: prints a line of JSON with the recipe and with the present command.
recipe() {
    LC_ALL=C tr -c '[:print:]' '\n' <"$1" >"$OUT/text"
    sed -n '/whit:scene_hash$/{n;s/^\([0-9a-f]\{16\}\).*/"\1"/p;}; s/^whit \(render .* -o whit.png\).*/"\1"/p
        s/^\({"width":[^}]*}\).*/\1/p' "$OUT/text" | jq -c -s --arg picture "$2" --arg asked "$(grep -F " -o $2 " "$OUT/asked")" \
        '{ $picture, $asked, command: .[0], hash: .[1], options: .[2] }'
}
cut -d ' ' -f 2 "$OUT/asked" | sort -u | while read -r scene; do
    "$WHIT" scene "$scene" --json --quiet | jq -c --arg scene "$scene" '{ $scene, hash }'
done >"$OUT/hashes"
{
    recipe "$OUT/tree/$fresh/checker.png" $fresh/checker.png
    sed -n 's/.* -o \([^ ]*\) .*/\1/p' "$OUT/asked" | while read -r picture; do
        recipe "$picture" "$picture"
    done
} >"$OUT/recipes.json"
stale=$(jq -r -s --slurpfile hashes "$OUT/hashes" '
    def pairs: [scan("--[a-z-]+ [^ ]+")];
    def rest: (.command | pairs) - (.asked | pairs);
    .[0] as $fresh | ($fresh.options | del(.width, .height, .aa, .camera)) as $now | .[1:][] |
    . as $at | (.asked | split(" ")[1]) as $scene |
    select((.command | split(" ")[1]) != $scene or (.asked | pairs) - (.command | pairs) != [] or
        rest != ($fresh | rest) or all($hashes[]; .scene != $scene or .hash != $at.hash) or
        any($now | to_entries[]; . as $option | ($at.options | has($option.key)) and
            $at.options[$option.key] != $option.value)) | " " + .picture' "$OUT/recipes.json" | tr -d '\n')
check "scenes and commands are those of $(grep -c . "$OUT/asked") pictures; to be made again:$stale" test -z "$stale"

# shellcheck disable=SC2016
check "a picture that no command makes is refused" sh -c '! "$@" 2>"$0"' "$OUT/stderr" \
    "$OUT/tree/tools/gallery" "$WHIT" nowhere

# ---- Shapes and materials ----

sed -n 's/^| !\[\([a-z]*\)\](images\/shapes\/\1.png) | `\1` |.*/"\1"/p' "$PAGE" >"$OUT/shapes"
check "every shape has a picture, by a camera that looks at it" jq -e -n --slurpfile schema "$SCHEMA" \
    --slurpfile scene "$SCENES/gallery/shapes.json" '[inputs] as $rows |
    [$schema[] | .. | .shape? | .const? // empty] | length > 10 and . - $rows == [] and all(.[]; . as $name |
        [$scene[0].cameras[] | select(.name == $name).target[0]] as [$x] |
        any($scene[0].objects[]; .shape == $name and ((.translation[0] // -9) - $x | fabs) < 3))' "$OUT/shapes"
# $OUT/rows has a line of JSON for each row: name, material.
sed -n 's/^| !\[\([a-z-]*\)\](images\/materials\/\1.png) | `\(.*\)` | .*|$/["\1", \2]/p' "$PAGE" >"$OUT/rows"
check "materials are as they are in materials.json" jq -e -n --slurpfile scene "$SCENES/gallery/materials.json" \
    '[inputs] | length > 15 and all(.[]; . as [$name, $is] | $scene[0].materials[$name] == $is and
        any($scene[0].cameras[]; .name == $name))' "$OUT/rows"
# A kind of material is recognized by the keys that no other kind has.
check "every kind of material has a picture" jq -e -n --slurpfile schema "$SCHEMA" \
    '[inputs[1] | keys] as $rows | [$schema[0]["$defs"].material.anyOf[].properties | keys] as $kinds |
    all(range($kinds | length); . as $n | ($kinds[$n] - ($kinds[:$n] + $kinds[$n + 1:] | add)) as $own |
        any($rows[]; . - (. - $own) != []))' "$OUT/rows"

# ---- Recipes ----

mkdir "$OUT/recipes" && cd "$OUT/recipes" || exit 1
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >mine.obj
cp "$OUT/studs.png" photo.png
awk '/^## / { recipe = /Recipes/ } /^```/ { file = 0 } recipe && file { print >("recipe" count ".json") }
    /^```json/ { file = 1; ++count }' "$PAGE"
set -- *.json
check "seven recipes or more" test $# -ge 7
rm "$OUT/described"
for recipe in "$@"; do
    described "$recipe"
done
check "none has warnings" jq -e -s "$no_warnings" "$OUT/described"
finish
