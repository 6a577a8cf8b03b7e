#!/bin/sh
# Pictures as projects: whit repeats the recipe of a picture, and ignores or refuses options that no picture may set.
. "$(dirname "$0")/common.sh"
EXAMPLES=$(cd "$SCENES/../shaders/examples" && pwd)
mkdir -p "$OUT/here/scenes" "$OUT/here/my/part" "$OUT/else" && cd "$OUT/here" || exit 1
cp "$CUBE" scenes/ && cp "$CUBE" "$OUT/else/"
SMALL="--size 40x30 --quiet"
said() { check "$1" grep -qF -e "$2" "$OUT/stderr"; }
same() { expect 0 "$1" compare "$2" "$3" --metric over --tolerance 0; }
printf '%s\n' '#include "part/tint.glsl"' '//@ slider bright 0 2 1' '// \file \end é' \
    'vec3 post(ivec2 at, vec3 color) { return tint(color) * bright; }' >my/a.glsl
printf 'vec3 tint(vec3 c) { return c * vec3(1.0, 0.5, 0.2); }\r\n' >my/part/tint.glsl

# ---- The same picture again ----

# shellcheck disable=SC2086
for kind in png exr; do
    expect 0 "a .$kind" render scenes/cube.json $SMALL --shader my/a.glsl --set bright=0.5 --camera 0 --aa 4 -o a.$kind
    mv my hidden
    expect 0 "again from the .$kind" render a.$kind --yes -o again.$kind
    said "it shows the scene" "scenes/cube.json"
    said "it shows the functions" "part/tint.glsl, 1 line"
    expect 0 "the same pixels of the .$kind" compare a.$kind again.$kind --metric differing --tolerance 0
    expect 0 "and from that one" render again.$kind --yes --quiet -o third.$kind
    expect 0 "the same once more" compare a.$kind third.$kind --metric differing --tolerance 0
    check "nothing is said when quiet" test ! -s "$OUT/stderr"
    for picture in a third; do
        grep -a -o 'whit render [^"]* -o whit\.\|{"width":[^}]*}' $picture.$kind >$picture.said
    done
    check "what the .$kind says of itself is the same" cmp a.said third.said
    mv hidden my
done
expect 0 "with a slider of one's own" render a.png --yes --set bright=1.5 --quiet -o other.png
run compare a.png other.png --metric differing --tolerance 0
check "the command line has the last word" test "$status" -eq 1
expect 0 "functions alone" render scenes/cube.json --size 40x30 --quiet --shader a.exr --set bright=0.5 --camera 0 --aa 4 -o b.exr
expect 0 "are the same functions" compare a.exr b.exr --metric differing --tolerance 0
expect 0 "no functions" render scenes/cube.json --size 40x30 --quiet -o plain.png
expect 0 "repeated without functions" render plain.png --yes --quiet -o plain2.png
check "the same bytes" cmp plain.png plain2.png
expect 0 "by another path" render ./scenes/cube.json --size 40x30 --quiet -o plain3.png
expect 0 "repeated from another folder" render ./plain3.png --yes --quiet -o plain4.png
check "the path stays as it was" cmp plain3.png plain4.png

sed 's/"intensity": 24/"intensity": 12/' scenes/cube.json >other.json && mv other.json scenes/cube.json
expect 0 "of another scene" render plain.png --yes -o other.png
said "which is said" "scenes/cube.json is not as it was when the picture was made"
cp "$CUBE" scenes/
expect 0 "of the same scene with other options" render plain.png --yes --light none --environment plain3.png -o other.png
check "nothing is said of it" test "$(grep -c "not as it was" "$OUT/stderr")" -eq 0

# ---- Asking ----

rm -f no.png
expect 2 "no terminal" render a.png --quiet -o no.png </dev/null
said "politely" "no terminal to ask at; --yes says yes"
check "no picture" test ! -e no.png
echo 'vec3 post(ivec2 at, vec3 color) { return color.bgr; }' >other.glsl
expect 0 "other functions" render scenes/cube.json --size 40x30 --quiet --shader other.glsl -o other.png
if command -v script >/dev/null; then
    for answer in y n; do
        echo $answer | script -qec "$WHIT render a.png -o $answer.png" /dev/null >"$OUT/asked"
        check "it asks once" test "$(grep -c 'Load and compile it' "$OUT/asked")" -eq 1
    done
    check "yes draws" test -e y.png
    check "no draws nothing" test ! -e n.png
    # A picture that is replaced by another one while the question stands is not drawn.
    cp a.png swapped.png
    : >"$OUT/asked"
    {
        until grep -q 'Load and compile it' "$OUT/asked"; do sleep 0.1; done
        cp other.png swapped.png
        echo y
    } | script -qec "$WHIT render swapped.png -o no.png" /dev/null >>"$OUT/asked"
    check "says so" grep -q 'swapped.png: its functions are others than those that were shown' "$OUT/asked"
    check "draws nothing" test ! -e no.png
fi

# ---- Files ----

expect 0 "extract" shader extract a.png
check "whole" sh -c 'cmp my/a.glsl a/a.glsl && cmp my/part/tint.glsl a/part/tint.glsl'
check "and told" test "$(cat "$OUT/stdout")" = "a/a.glsl
a/part/tint.glsl"
echo mine >a/a.glsl
refuse 2 "not over files" "is there already" shader extract a.png
check "what was there is there" test "$(cat a/a.glsl)" = mine
ln -s "$OUT/else" link
refuse 2 "not into a link" "is there already" shader extract a.exr --into link
expect 0 "into a folder" shader extract a.exr --into taken/
check "whole too" cmp my/part/tint.glsl taken/part/tint.glsl
mkdir empty
expect 0 "into an empty one" shader extract a.exr --into empty
refuse 2 "no folder above" "cannot be made" shader extract a.exr --into none/x
refuse 2 "a picture without any" "without .whit:shader." shader extract plain.png
refuse 2 "no picture" "" shader extract my/a.glsl
check "nothing is left beside" test "$(find . -name '.*' ! -name . | wc -l)" -eq 0

# A picture with two texts of functions: those that are shown are those that are compiled and extracted.
at() { LC_ALL=C grep -abo "$1" "$2" | head -1 | cut -d : -f 1; }
text=$(at tEXtwhit:shader other.png)
bytes=$(od -An -tu1 -j $((text - 4)) -N 4 other.png | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4 + 12 }')
{
    head -c $(($(at IDAT a.png) - 4)) a.png
    tail -c +$((text - 3)) other.png | head -c "$bytes"
    tail -c +$(($(at IDAT a.png) - 3)) a.png
} >twice.png
expect 0 "two texts" render twice.png --yes -o again.png
check "the first one is shown" sh -c 'grep -q "functions  a.glsl" "$1" && ! grep -q other.glsl "$1"' - "$OUT/stderr"
expect 0 "and compiled" compare a.png again.png --metric differing --tolerance 0
expect 0 "and extracted" shader extract twice.png
check "alone" test "$(ls twice)" = "a.glsl
part"

# ---- Options and scenes that no picture may set ----

# forge FROM TO: makes bad.exr of a.exr, with TO in the place of FROM in its recipe, padded to the same length.
forge() {
    check "$2 fits" test ${#2} -le ${#1}
    LC_ALL=C sed "s|$1|$(printf "%-${#1}s" "$2")|" a.exr >bad.exr
    check "the picture says $2" grep -aqF -e "$2" bad.exr
}
PLACE='--size 40x30 --camera 0 --aa 4 --depth 8'
for options in "--allow-path=/ --trust --no-cache" "--memory-limit=900G --import-limit=1e5" \
    "--require-sandbox --time-limit=1" "--stages=x --validation --quiet"; do
    forge "$PLACE" "$options"
    expect 0 "a picture with $options" render bad.exr --yes --size 8x8 -o bad2.exr
    said "they are not taken" "not taken  $(echo "$options" | sed 's/=[^ ]*//g'):"
    for option in $options; do
        check "$option is not passed on" sh -c '! grep -aq -e "$1" bad2.exr' - "${option%=*}"
    done
    check "nor done" test ! -s "$OUT/stdout"
done
for words in "--environment /etc/passwd" "--environment ../x.hdr" "--size 0x0" --nonsense --size "'--size"; do
    forge "$PLACE" "$words"
    refuse 2 "a picture with $words" bad.exr render bad.exr --yes --quiet -o no.png
done
mkdir moved && cp a.png moved/
# The names of these scenes are at most as long as scenes/cube.json.
ln -s ../../else/cube.json scenes/out.json
cp "$CUBE" ../c.js
for scene in ../c.js moved/../../c.js /etc/passwd /dev/zero - scenes scenes/out.json scenes/no.json; do
    forge "render scenes/cube.json" "render $scene"
    refuse 2 "a picture with the scene $scene" "its scene .*; name it: .whit render SCENE --recipe bad.exr" \
        render bad.exr --yes --quiet -o no.png
done
check "no picture of any" test ! -e no.png

refuse 2 "a scene that is not below" "there is no such file; name it" render moved/a.png --yes --quiet -o no.png
expect 0 "with the scene named" render scenes/cube.json --recipe moved/a.png --yes --quiet -o again.png
same "it is the same" a.png again.png
finish
