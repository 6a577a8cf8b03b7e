#!/bin/sh
# If an output cannot be written, or the space ends in the middle, whit exits with 2 and one line that names the file,
# keeps the old file, and leaves no other file.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/files"
cd "$OUT/files" || exit 1
ZERO='\000\000\000\000'
printf "\000\000\000\076\000\000\200\100$ZERO$ZERO$ZERO\000\000\200\277$ZERO\000\000\200\177" >"$OUT/ray"
for i in 0 1 2 3 4 5 6 7 8 9; do
    cat "$OUT/ray" "$OUT/ray" "$OUT/ray" "$OUT/ray" "$OUT/ray" "$OUT/ray" "$OUT/ray" "$OUT/ray"
done >"$OUT/rays"

# no_place EXTENSION ARGUMENT...: the last argument is followed by the name of an output where no file can be. One
# option of each command is enough, because a command opens all of its outputs in the same way.
no_place() {
    end=$1
    shift
    option="$1 ... $(for last; do :; done; echo "$last")"
    mkdir "folder$end"
    echo old >file
    refuse 2 "$option: a folder" "folder$end: cannot write: Is a directory" "$@" "folder$end"
    refuse 2 "$option: a file for a folder" "file/x$end: cannot write: Not a dir" "$@" "file/x$end"
    refuse 2 "$option: too long a name" "xx$end: cannot write: File name too long" \
        "$@" "$(printf '%0300d' 0 | tr 0 x)$end"
    rmdir "folder$end"
    rm file
    check "$option: nothing is left" is_empty .
}

# one_option EXTENSION ARGUMENT...: the last argument is followed by the name of an output that cannot be written. whit
# may also write ok.pfm.
one_option() {
    end=$1
    shift
    option="$1 ... $(for last; do :; done; echo "$last")"
    refuse 2 "$option: no such folder" "nowhere/x$end: cannot write: No such" "$@" "nowhere/x$end"
    if [ -c /dev/full ]; then
        ln -s /dev/full "full$end"
        refuse 2 "$option: a full device" "full$end: cannot write: No space" "$@" "full$end"
        rm "full$end"
    fi
    echo old >"x$end"
    (
        ulimit -f 1 # of 512 or 1024 bytes, by shell
        "$WHIT" "$@" "x$end" >"$OUT/stdout" 2>"$OUT/stderr"
    )
    status=$?
    check "$option: no space left: exit code 2 (got $status)" test $status -eq 2
    check "$option: says which file" grep -q "^whit: error: .*x$end: cannot write: " "$OUT/stderr"
    check "$option: in one line" test "$(grep -c . "$OUT/stderr")" -eq 1
    check "$option: the old file is there" test "$(cat "x$end")" = old
    rm -f "x$end" ok.pfm
    check "$option: nothing is left" is_empty .
}

small="--size 96x64 --quiet"
no_place .png render "$CUBE" $small -o
no_place "" trace "$CUBE" --input "$OUT/rays" --on cpu --quiet -o
no_place "" scene "$SCENES/spin.json" --quiet --triangles
for end in .png .exr .pfm; do
    one_option $end render "$CUBE" $small -o
done
one_option .exr render "$CUBE" $small -o ok.pfm --ids
one_option .png render "$CUBE" $small --view visits -o
one_option "" trace "$CUBE" --input "$OUT/rays" --on cpu --quiet -o
one_option "" scene "$SCENES/spin.json" --quiet --triangles

refuse 2 "bench --json: no such folder" "nowhere/x: cannot write: No such" \
    bench report --quick --scenes "$SCENES" --json nowhere/x
mkdir folder
refuse 2 "bench --json: a folder" "folder: cannot write: Is a directory" \
    bench report --quick --scenes "$SCENES" --json folder
rmdir folder

# No command writes over what it reads, by whatever name, nor two outputs into one file.
cp "$SCENES/cube.json" c.json
"$WHIT" shader new shade >hit.comp
cp hit.comp "$OUT/shade"
ln -s c.json link
refuse 2 "probe over its scene" "./c.json: SCENE and --json name the same file" probe c.json --pixel 1,1 --json ./c.json
refuse 2 "probe over its shader" "--json and --shader name the same file" \
    probe c.json --pixel 1,1 --shader hit.comp --json "$PWD/hit.comp"
refuse 2 "probe over its sky" "--json and --environment name the same file" \
    probe c.json --pixel 1,1 --environment sky.exr --json sky.exr
refuse 2 "hard over its scene" "SCENE and --json name the same file" hard link --json c.json
refuse 2 "scene over its scene" "SCENE and --triangles name the same file" scene c.json --triangles link
refuse 2 "render over its recipe" "-o and --recipe name the same file" render c.json --recipe a.png -o ./a.png
refuse 2 "a frame over the sky" "sky.1.exr: -o and --environment name the same file" \
    render "$SCENES/spin.json" --frames 0-1 --environment sky.1.exr -o sky.#.exr
refuse 2 "in a folder with a mark" "run#1/sky.1.exr: -o and --environment name the same file" \
    render "$SCENES/spin.json" --frames 0-1 --environment run#1/sky.1.exr -o run#1/sky.#.exr
refuse 2 "frames over frames" "-o and --ids name the same file" \
    render "$SCENES/spin.json" --frames 0-1 -o p.#.exr --ids p.##.exr
refuse 2 "bench over its model" "MODEL and --json name the same file" bench look c.json --json c.json
refuse 2 "bench: one file for two" "--json and --plot name the same file" bench rays --json x --plot ./x
refuse 2 "a dump over the shader" "./hit.comp: is a file of the shader" shader hit.comp --dump .
check "the scene is as it was" cmp c.json "$SCENES/cube.json"
check "the shader is as it was" cmp hit.comp "$OUT/shade"
rm c.json link hit.*

# In a sequence, frames before the one that fails stay.
mkdir p.1.pfm
expect 2 "the second of two frames" render "$SCENES/spin.json" --frames 0-1 --size 96x64 -o p.#.pfm
check "says which" grep -q "^whit: error: p.1.pfm: cannot write: Is a directory" "$OUT/stderr"
check "says how many there are" grep -q "1 of 2 frames were written" "$OUT/stderr"
check "the first is whole" test "$(head -c 2 p.0.pfm)" = PF
rm -r p.0.pfm p.1.pfm
mkdir p.1.png
expect 2 "of two frames with recipes" render "$SCENES/spin.json" --frames 0-1 --size 8x8 -o p.#.png
check "says how to go on" grep -q "^whit: to go on: whit render .* --frames 0-1 .* --resume$" "$OUT/stderr"
rm -r p.0.png p.1.png

# Standard output that cannot be written.
if [ -c /dev/full ]; then
    echo 'vec3 post(ivec2 at, vec3 color) { return color; }' >post.glsl
    for command in "shader post.glsl" "shader post.glsl --json" "scene $CUBE" "scene $CUBE --json" "devices --json" "bvh $CUBE --no-trace --runs 1" \
        "render --help" "render $CUBE --size 8x8 -o ok.pfm --stats json" "--version"; do
        "$WHIT" $command >/dev/full 2>"$OUT/stderr"
        status=$?
        check "$command to a full device: exit code 2 (got $status)" test $status -eq 2
        check "$command: says so" \
            grep -q "^whit: error: standard output: cannot write: No space" "$OUT/stderr"
    done
    rm -f ok.pfm post.glsl
fi
check "nothing is left" is_empty .
finish
