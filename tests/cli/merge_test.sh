#!/bin/sh
# Parts of pictures (tiles and runs of samples), drawn in any order, merge to the bytes of one run. The third argument
# is a program that writes parts without drawing. With `all` five scenes at three levels of numerics, and pictures of
# 32768 x 32768 pixels.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/parts"
cd "$OUT/parts" || exit 1
PARTS=$3

# spread N DRAW ARGUMENT...: calls DRAW I ARGUMENT... for each I from N down to 1, in three processes.
spread() {
    parts=$1 draw=$2
    shift 2
    for process in 0 1 2; do
        for i in $(seq "$parts" -1 1); do
            [ $((i % 3)) -ne $process ] || "$draw" "$i" "$@" || echo "part $i failed"
        done &
    done
    wait
}

# draw_tile I EXTENSION N OPTION...: draws tile I of N, with its hit identities.
draw_tile() {
    i=$1 extension=$2 count=$3
    shift 3
    "$WHIT" render "$@" --tile "$i/$count" -o "t$i.$extension" --ids "i$i.exr" -q
}

# draw_samples I EXTENSION N OPTION...: draws part I of N of the samples.
draw_samples() {
    i=$1 extension=$2 count=$3
    shift 3
    "$WHIT" render "$@" --samples-part "$i/$count" -o "s$i.$extension" -q
}

# tiles EXTENSION N WHAT OPTION...: merged tiles are the picture of one run, and so are their identities.
tiles() {
    extension=$1 count=$2 what=$3
    shift 3
    rm -f t*.* i*.exr
    "$WHIT" render "$@" -o "one.$extension" --ids one-ids.exr -q
    spread "$count" draw_tile "$extension" "$count" "$@"
    files=$(seq "$count" | sort -k1.1r | sed "s/.*/t&.$extension/")
    expect 0 "$what: $count tiles" merge $files -o "merged.$extension"
    check "$what: $count tiles are the $extension of one run" cmp "one.$extension" "merged.$extension"
    expect 0 "$what: identities of $count tiles" merge $(seq "$count" | sed 's/.*/i&.exr/') -o merged-ids.exr
    check "$what: so are their identities" cmp one-ids.exr merged-ids.exr
}

# bound NAME: prints the bailout_bound of the picture's counters; -1 if it is unknown.
bound() {
    grep -a -o '"bailout_bound":[-0-9.e]*' "$1.$extension" | cut -d : -f 2 | grep . || echo -1
}

# samples EXTENSION N WHAT OPTION...: merged runs of samples are the picture of one run.
samples() {
    extension=$1 count=$2 what=$3
    shift 3
    rm -f s*.*
    "$WHIT" render "$@" -o "one.$extension" -q
    spread "$count" draw_samples "$extension" "$count" "$@"
    files=$(seq "$count" | sort -k1.1r | sed "s/.*/s&.$extension/")
    expect 0 "$what: $count runs of samples" merge $files -o "merged.$extension"
    expect 0 "$what: they are compared" compare "one.$extension" "merged.$extension" --metric differing --tolerance 0
    check "$what: what may be missing for --bailout is no less than in one run" holds "$(bound merged) >= $(bound one)"
}

# large SIDE TILES EXTENSION MIB: whit merges the parts of a large picture with at most MIB of memory.
large() {
    rm -f p*.*
    "$PARTS" "$1" "$2" "$3" || echo "no parts"
    expect 0 "$1 x $1 of $2 tiles" merge p*.$3 -o "large.$3" --stats json
    peak=$(jq '.memory.host_peak_bytes / 1048576 | ceil' "$OUT/stdout")
    [ -n "${ASAN_OPTIONS:-}" ] || # its allocator keeps what was freed
        check "$1 x $1 of $2 tiles, $3: within $4 MiB (got $peak)" test "$peak" -le "$4"
    rm -f p*.*
}

if [ "${4:-}" = all ]; then
    for scene in balls cube lens spotlight room; do
        for level in fast watertight exact; do
            options="$SCENES/$scene.json --size 150x130 --aa 16 --numerics $level"
            tiles png 4 "$scene, $level" $options
            tiles exr 7 "$scene, $level" $options
            samples exr 4 "$scene, $level" $options
            samples pfm 16 "$scene, $level" $options
        done
    done
    large 32768 512 png 200
    large 32768 512 exr 200
fi

tiles png 4 cube "$CUBE" --size 90x120
if part 0 2; then
    tiles pfm 7 balls "$SCENES/balls.json" --size 60x120 --aa 2
    samples exr 4 balls "$SCENES/balls.json" --size 60x40 --aa 16
fi
if part 1 2; then
    tiles exr 3 lens "$SCENES/lens.json" --size 60x40 --aa 4
    tiles png 2 "a user's functions" "$CUBE" --size 60x48 --shader "$SCENES/../shaders/examples/occlusion.glsl"
    samples pfm 4 balls "$SCENES/balls.json" --size 60x40 --aa 4
fi

# Tiles and runs of samples together, drawn by three processes in any order.
both="$SCENES/lens.json --size 60x40 --aa 16"
expect 0 "one run" render $both -o one.exr -q
for i in 2 1 3; do
    for k in 4 2 1 3; do
        "$WHIT" render $both --tile $i/3 --samples-part $k/4 -o "b$i$k.exr" -q
    done &
done
wait
expect 0 "tiles of runs" merge b??.exr -o merged.exr --stats json
check "all rays are told" jq -e '.parts == 12 and .tiles == 3 and .samples_parts == 4 and .rays.primary == 38400' "$OUT/stdout"
expect 0 "tiles of runs are the picture" compare one.exr merged.exr --metric differing --tolerance 0
expect 0 "a part draws itself again" render "$SCENES/lens.json" --recipe b23.exr --yes -o again.exr -q
check "the same bytes" cmp again.exr b23.exr

# Automatic exposure is that of the whole picture.
cat >box.obj <<'OBJ'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 1
f 1 2 3
f 1 3 4
OBJ
tiles png 2 "a model" box.obj --size 40x40

large 2048 32 png 32

# A part may have been drawn where the scene has another name.
mkdir elsewhere && cp "$CUBE" elsewhere/same.json
"$WHIT" render "$CUBE" --size 64x64 -o one.png -q
spread 4 draw_tile png 4 "$CUBE" --size 64x64
draw_tile 3 png 4 elsewhere/same.json --size 64x64
expect 0 "a scene by two names" merge t1.png t2.png t3.png t4.png -o merged.png
check "the picture is that of the first part" cmp one.png merged.png

# A set of parts that is not complete is refused, and nothing is written.
rm -f merged*
spread 4 draw_tile png 4 "$CUBE" --size 64x64
refuse 2 "a part that is missing" "1 of 4 parts are missing: tile 3/4" merge t1.png t2.png t4.png -o merged.png
refuse 2 "a part that is doubled" "are both tile 2/4" merge t1.png t2.png t2.png t3.png t4.png -o merged.png
"$WHIT" render "$CUBE" --size 64x64 --depth 3 --tile 3/4 -o other.png -q
refuse 2 "other settings" "are of different settings" merge t1.png t2.png other.png t4.png -o merged.png
"$WHIT" render "$SCENES/balls.json" --size 64x64 --tile 3/4 -o other.png -q
refuse 2 "another scene" "are of different scenes" merge t1.png t2.png other.png t4.png -o merged.png
"$WHIT" render "$CUBE" --size 64x64 -o whole.png -q
refuse 2 "a whole picture" "whole.png: no part of a picture" merge t1.png t2.png whole.png t4.png -o merged.png
head -c 700 t3.png >short.png
refuse 2 "a part that is cut short" "short.png: " merge t1.png t2.png short.png t4.png -o merged.png
refuse 2 "another kind of file" "a file of its parts' kind, which alone" merge t1.png t2.png t3.png t4.png -o merged.exr
refuse 2 "a part as the picture" "PART and -o name the same file" merge t1.png t2.png t3.png t4.png -o ./t2.png
"$WHIT" render "$CUBE" --size 32x32 --tile 1/2 -o p1.pfm -q
"$WHIT" render "$CUBE" --size 32x32 --tile 2/2 -o p2.pfm -q
cp p1.pfm keep.pfm && head -c 100 /dev/zero | dd of=p1.pfm bs=1 seek=200 conv=notrunc 2>/dev/null
refuse 2 "a PFM that its recipe does not know" "not the recipe of p1.pfm as it is" merge p1.pfm p2.pfm -o merged.pfm
"$PARTS" 100 4 exr grey || echo "no parts"
refuse 2 "runs of samples of one channel" "p1.exr: colours have 3 channels, not 1" merge p?.exr -o merged.exr
rm p2.pfm.part && mv keep.pfm p1.pfm
refuse 2 "a PFM without its recipe" "p2.pfm.part" merge p1.pfm p2.pfm -o merged.pfm
check "nothing was written" test -z "$(find . -name 'merged*')"

refuse 2 "no tile" "I/N is needed" render "$CUBE" -o x.png --tile 0/4
refuse 2 "a tile behind the last" "I/N is needed" render "$CUBE" -o x.png --tile 5/4
refuse 2 "more tiles than rows allow" "no more than 4 tiles" render "$CUBE" -o x.png --size 64x64 --tile 1/5
refuse 2 "adaptive samples" "--tile and --aa adaptive" render "$CUBE" -o x.png --tile 1/2 --aa adaptive:0.1
for option in "--edges objects" "--grid on" "--view visits" "--refine 0.1" "--counters" "--thumbnail 64"; do
    refuse 2 "$option" "only the whole picture" render "$CUBE" -o x.png --tile 1/2 $option
done
for parts in 1/3 1/2 1/64; do
    refuse 2 "samples $parts" "a power of 4" render "$CUBE" -o x.exr --aa 16 --samples-part $parts
done
refuse 2 "12 samples" "a power of 2" render "$CUBE" -o x.exr --aa 12 --samples-part 1/4
refuse 2 "sums in a PNG" "need .exr or .pfm" render "$CUBE" -o x.png --aa 16 --samples-part 1/4
refuse 2 "identities of later samples" "of the first sample" render "$CUBE" -o x.exr --ids y.exr --aa 16 --samples-part 2/4
check "nothing was drawn" test -z "$(find . -name 'x.*')"
finish
