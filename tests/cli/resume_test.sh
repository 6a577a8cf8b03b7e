#!/bin/sh
# Work that is stopped at any moment can be continued to the same bytes, and processes can share it. With `all` whit is
# killed at twenty random moments of 50 frames, and at one moment of each of 8 tiles.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1
SWARM=$SCENES/swarm.json
moments="1 4"
last=11
tiles=2
random=
if [ "${3:-}" = all ]; then
    moments=$(seq 2 2 40)
    last=49
    tiles=8
    random=yes
fi
frames="$SWARM --frames 0-$last --size 96x72 --aa 4"

# files N: at least N pictures exist.
files() {
    test "$(find . -name 'a.*.png' | wc -l)" -ge "$1"
}

# killed COMMAND...: kills the process $pid once the command succeeds; with `all` at a random moment of the next 0.2 s.
killed() {
    wait_for "$pid" "$@"
    [ -z "$random" ] || sleep "0.$(shuf -i 0-199 -n 1 | awk '{ printf "%03d", $1 }')"
    kill -9 "$pid" 2>/dev/null
    wait "$pid" 2>/dev/null
}

# same WHAT: all frames are those of one run, and no other file is left.
same() {
    for i in $(seq 0 $last); do
        number=$(printf %03d "$i")
        cmp "one.$number.png" "a.$number.png" || return 1
        cmp "one.$number.exr" "a.$number.exr" || return 1
    done
    test "$(ls -A | grep -c '^\.*a\.')" -eq $((2 * last + 2)) || { ls -A && return 1; }
}

expect 0 "one run" render $frames -o one.###.png --ids one.###.exr -q
for moment in $moments; do
    "$WHIT" render $frames -o a.###.png --ids a.###.exr --resume -q &
    pid=$!
    killed files "$moment"
done
check "not all is there" sh -c "! test -e a.$(printf %03d $last).png"
head -c 600 one.000.png >a.000.png       # cut short
cp one.002.exr a.001.exr                 # of another frame
head -c -10 one.002.exr >a.002.exr        # whole but for its end
"$WHIT" render "$SWARM" --frame 4 --size 96x72 --aa 4 --tile 1/2 -o a.004.png --ids a.004.exr -q # a part of it
"$WHIT" render "$SWARM" --frame 5 --size 96x72 --aa 4 -o a.005.exr -q # colours
: >a.003.png.lock                        # nobody has it
expect 0 "it goes on" render $frames -o a.###.png --ids a.###.exr --resume --stats json
check "what was finished is kept" jq -e ".frames.kept >= 1 and .frames.count >= 2 and .frames.kept + .frames.count == $((last + 1))" "$OUT/stdout"
check "all is as of one run" same
expect 0 "all is there" render $frames -o a.###.png --ids a.###.exr --resume --stats json
check "nothing is drawn" jq -e ".frames.count == 0 and .frames.kept == $((last + 1))" "$OUT/stdout"

if part 0 2; then
    # Each frame is drawn by only one of three processes.
    rm -f a.*
    for i in 1 2 3; do
        "$WHIT" render $frames -o a.###.png --ids a.###.exr --resume --stats json >"$i.json" 2>"$i.err" &
    done
    wait
    check "three processes draw every frame once" jq -es "map(.frames.count) | add == $((last + 1))" 1.json 2.json 3.json
    check "each ends with all frames there" jq -es "all(.[]; .frames.count + .frames.kept == $((last + 1)))" 1.json 2.json 3.json
    check "they are those of one run" same
fi

if part 1 2; then
    # `whit batch` draws the same frames, in one process and in two at once.
    {
        echo "# frames of one scene"
        for i in $(seq 0 $last); do
            echo "whit render '$SWARM' --frame $i --size 96x72 --aa 4 -o a.$(printf %03d "$i").png --ids a.$(printf %03d "$i").exr"
            [ "$i" -ne 3 ] || echo
        done
    } >lines
    rm -f a.*
    "$WHIT" batch lines --resume --stats json >1.json 2>1.err &
    "$WHIT" batch lines --resume --stats json >2.json 2>2.err
    wait
    check "two processes draw every line once" jq -es "map(.written) | add == $((last + 1))" 1.json 2.json
    check "with one renderer each" jq -es "map(.renderers) | max == 1" 1.json 2.json
    check "lines are the frames of one run" same
    sed 's/96x72/0x72/;6q' lines >wrong
    refuse 2 "standard input" "PARTS.txt -: lines are read from a file" batch - <wrong
    echo '# nothing' >nothing
    refuse 2 "no line" "nothing: there is no line in it" batch nothing
    refuse 2 "a wrong line" "wrong:2: --size \`0x72\`" batch wrong
    printf "'$SWARM' -o x.png\n\0\n'$SWARM' -o y.png\n" >wrong
    refuse 2 "a byte 0 between lines" "wrong: no lines: it has bytes that are 0" batch wrong
    echo "'$SWARM' -o x.png --time-limit 1" >wrong
    refuse 2 "a limit of a line" "wrong:1: --time-limit is of all lines" batch wrong
    echo "'$SWARM' -o x.png --counters" >wrong
    refuse 2 "costs of a line" "wrong:1: --counters is for .whit render" batch wrong
    echo "'$SWARM' -o x.png 'x" >wrong
    refuse 2 "a quote without end" "wrong:1: a quote has no end" batch wrong
    echo "'$SWARM' -o x.png" | tee wrong >>wrong2 && sed "s,-o ,-o $PWD/," wrong2 >>wrong
    refuse 2 "two lines of one picture" "wrong:2: its -o is the -o of line 1" batch wrong
    printf '%s --frames %s -o x.#.png\n' "'$SWARM'" 0-4 "'$SWARM'" 6-9 "'$SWARM'" 3-5 >wrong
    refuse 2 "frames in two lines" "wrong:3: its -o is the -o of line 1" batch wrong
    printf "'$SWARM' -o %s\n" 'x.png --ids a.exr' a.exr >wrong
    refuse 2 "identities in a picture" "wrong:2: its -o is the --ids of line 1" batch wrong
    printf "'$SWARM' -o %s\n" 'v2.#.png --frames 9-10' v2.10.png >wrong
    refuse 2 "a picture in frames" "wrong:2: its -o is the -o of line 1" batch wrong
    printf "'$SWARM' -o %s\n" 'v2.#.png --frames 9-10' 'v2.##.png --frames 10-99' >wrong
    refuse 2 "frames of another pattern" "wrong:2: its -o is the -o of line 1" batch wrong
    printf "'$SWARM' --size 2x2 -o %s\n" 'v2.#.png --frames 9-10' 'v2.##.png --frames 9-9' v2.11.png v3.10.png >right
    expect 0 "other names" batch right
    for option in "-o m1.pfm" "-o m1.png --thumbnail 8"; do
        printf "'$CUBE' $option\nnowhere.json -o m2.png\n" >wrong
        expect 2 "a line that cannot be drawn" batch wrong
        check "$option: no command that --resume would refuse" sh -c "! grep -q 'to go on' '$OUT/stderr'"
    done
    expect 5 "a time limit" batch lines --time-limit 0.001
    check "says how lines go on" grep -q "^whit: to go on: whit batch lines --time-limit 0.001 --resume$" "$OUT/stderr"
fi

if part 0 2; then
    # Lines share scenes, trees and kernels wherever they stand in the file.
    cat >mixed <<LINES
'$CUBE' --size 32x24 -o m1.png
'$SWARM' --size 32x24 -o m2.png
'$CUBE' --size 32x24 --shadows none -o m3.png
'$SWARM' --size 24x24 --time 1 -o m4.png
'$CUBE' --size 48x24 --leaf 2 -o m5.png
'$CUBE' --size 24x24 -o m6.png
'$CUBE' --size 32x24 --frames 0-1 -o m7.#.png
LINES
    expect 0 "lines in any order" batch mixed --stats json
    check "each scene, tree and kernel is made once" jq -e '[.lines, .written, .scenes, .trees, .renderers] == [7, 8, 2, 3, 4]' "$OUT/stdout"
    check "rays are those of all pictures" jq -e '.rays.primary == 32*24*5 + 24*24*2 + 48*24' "$OUT/stdout"
    for i in 1 2 3 4 5 6; do
        eval "\"\$WHIT\" render $(sed -n ${i}p mixed | sed "s/-o m$i/-o n$i/") -q"
        check "line $i is the picture that it is alone" cmp "n$i.png" "m$i.png"
    done
    rm m1.png m4.png m7.1.png
    expect 0 "some of them again" batch mixed --resume --stats json
    check "they alone are drawn" jq -e '.written == 3 and .kept == 5 and .rays.primary == 32*24*2 + 24*24' "$OUT/stdout"

fi
# Tiles in PFM files, whose recipes are in files beside them.
if part 1 2; then
    expect 0 "one picture" render "$CUBE" --size 64x130 --aa 4 -o one.pfm -q
    for i in $(seq $tiles); do
        "$WHIT" render "$CUBE" --size 64x130 --aa 4 -o "t$i.pfm" --tile $i/$tiles --resume -q &
        pid=$!
        killed test -e "t$i.pfm.lock"
        expect 0 "tile $i goes on" render "$CUBE" --size 64x130 --aa 4 -o "t$i.pfm" --tile $i/$tiles --resume -q
    done
    expect 0 "the tiles" merge t?.pfm -o merged.pfm
    check "are the picture" cmp one.pfm merged.pfm
    printf x >>t1.pfm
    expect 0 "a tile that was changed" render "$CUBE" --size 64x130 --aa 4 -o t1.pfm --tile 1/$tiles --resume
    check "is drawn again" sh -c "! grep -q kept '$OUT/stderr' && ! tail -c 1 t1.pfm | grep -q x"
fi

# Ctrl+C and --time-limit keep finished frames, and print the command that continues.
rm -f a.*
"$WHIT" render $frames --frames 0-5000 -o a.###.png --ids a.###.exr 2>"$OUT/stderr" &
interrupted $! files 2
check "it says how to go on" grep -q "^whit: to go on: whit render .* --resume$" "$OUT/stderr"
line=$(sed -n "s/^whit: to go on: whit \(.*\)/\1/p" "$OUT/stderr" | sed "s/--frames 0-5000/--frames 0-$last/")
eval "run $line"
check "and so it does" same
rm -f a.*
expect 5 "a time limit" render $frames --frames 0-5000 -o a.####.png --ids a.####.exr --resume --time-limit 1.5
check "it says how to go on" grep -q "^whit: to go on: whit render .* --resume --time-limit 1.5$" "$OUT/stderr"

refuse 2 "--resume of a PFM" "has no recipe" render "$CUBE" -o x.pfm --resume
refuse 2 "--resume and --refine" "--resume and --refine" render "$CUBE" -o x.png --resume --refine 0.1
refuse 2 "a folder that is not there" "cannot" render "$CUBE" -o none/x.png --resume
finish
