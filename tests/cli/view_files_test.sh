#!/bin/sh
# The viewer and files: scenes that are opened, removed and repaired, pictures and lines that are saved, replays.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1
NONE=
SMALL="--size 96x64"

# ---- Scenes ----

if part 0 2; then
    # whit FILE without a command opens a window, too.
    printf 'still\nstate alone\n' >alone.replay
    run "$CUBE" $SMALL --replay alone.replay --quiet
    check "whit FILE is whit view FILE (exit code $status)" test "$status $(jq -r .scene "$OUT/stdout")" = "0 $CUBE"
    mkdir list
    cp "$CUBE" list/a.json
    cp "$SCENES/8k.json" list/b.json
    cp "$SCENES/spin.json" list/c.json
    echo no scene >list/notes.txt
    echo no scene >list/b0.json
    echo "--size 96x64" >start.view
    echo "--size 96x64 --effects -highlights" >plain.view
    echo "--size 96x64 --edges triangles" >edges.view
    EXPECTED="^whit: error: \($OUT/nowhere\|$SCENES/atrium.json: objects\|.*list/b0.json:\)"
    play "scenes by arrows" list/a.json $SMALL --memory-limit 12M <<END
a: | scene = list/a.json
b: press Right | scene = list/b.json | frame.ids not as a
b0! press Right, until error | scene = list/b.json
c: press Right | scene = list/c.json | error =
around: press Right | scene = list/a.json | frame.ids as a
back: press Left | scene = list/c.json | frame.ids as c
stepped: press Period
plays! press Space, drop $OUT/nowhere.json, until error | playing = true
stood: press Space | frame.pixels as stepped | render as stepped | frame.pixels not as back
picture: drop $OUT/nowhere.png | toast = nowhere.png is a picture; \`whit view nowhere.png\` shows what it was made from | error as stood
dropped: drop $SCENES/cube.json | scene = $SCENES/cube.json | frame.ids as a
beside: press Left | scene = $SCENES/balls.json | frame.ids not as a
again: press Right | scene = $SCENES/cube.json | frame.ids as a
large! drop $SCENES/atrium.json, until error | scene = $SCENES/cube.json | error has (--memory-limit)
nowhere: drop $OUT/nowhere.obj | frame.ids as dropped | render as dropped | error has nowhere.obj
edges: drop edges.view | frame.ids as nowhere | frame.pixels not as nowhere | render has --edges triangles
none: drop start.view | frame.ids as nowhere | frame.pixels as nowhere
turned: press I, move 40 30, button left down, move 49 33, button left up | scene = $SCENES/cube.json
    | frame.ids not as nowhere | error as nowhere | compare.count = 6144 | compare.other_colors = 0
picked: click 24 32 | picked = true | probe.rays > 0
closed! press Escape | error =
plain: drop plain.view | compare.other_ids = 0 | compare.other_colors > 0
copied! press Ctrl+C | toast has copied: whit render $SCENES/cube.json | toast has -highlights
mended: press F12, press I, drop start.view, drop list/b.json | error = | frame.ids as b
END
    check "each once on standard error" test "$(grep -v "memory-limit\|b0.json" "$OUT/stderr" | sort | tr '\n' ' ')" = \
        "whit: error: $OUT/nowhere.json: there is no such file whit: error: $OUT/nowhere.obj: there is no such file "
    check "and what takes too much" test "$(grep -c memory-limit "$OUT/stderr")" -eq 1
    check "F12 saves it" grep -aq "whit render .*/cube.json .*-highlights" whit-0001.png
    rm whit-0001.png
    EXPECTED=
fi

# A scene from standard input is read once and not watched, and has no other scenes beside it.
printf -- '--size 96x64\n' >./-
INPUT=$CUBE
play "standard input" - $SMALL --remember yes <<END
in: | scene = - | render has whit render - --size
again: press R, press Right, press Left | scene = - | frame.ids as in | render as in
turned: press 3 | frame.ids not as in
file: drop $CUBE | scene = $CUBE | frame.ids as in
END
grep -s -e '-"' "$XDG_STATE_HOME/whit/cameras.json"
check "no camera of it is remembered" test $? -ne 0
INPUT=/dev/null
rm ./-

if part 0 2; then
    # The window says why a picture, or a state, cannot be saved: nobody can write into this folder.
    cd /proc || exit 1
    EXPECTED="^whit: error: whit-0001.\(png\|view\): cannot write: "
    play "a folder that takes no files" "$CUBE" $SMALL <<END
whole: | error =
picture: press F12 | toast has whit-0001.png: cannot write: No such file
state: press Ctrl+S | toast has whit-0001.view: cannot write: No such file
END
    EXPECTED=
    cd "$OUT/work" || exit 1
fi

if part 1 2; then
    # If a scene names a file outside of its folder, the viewer asks once, and reads the file if the answer is yes.
    mkdir model maps
    printf 'mtllib ../maps/a.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl red\nf 1 2 3\n' >model/a.obj
    printf 'newmtl red\nKd 1 0 0\n' >maps/a.mtl
    maps=$(realpath maps)
    play "files elsewhere" model/a.obj --size 400x160 <<END
asked: until question | question = $maps
without: choose go on without | question =
again: press R | question = | frame.pixels as asked
other: drop $CUBE | question =
END
    ids=$(value without frame.ids) pixels=$(value without frame.pixels)
    # The pointer wanders about meanwhile, which disturbs no replay.
    python3 "$(dirname "$0")/pointer.py" &
    wanders=$!
    play "files elsewhere, allowed" model/a.obj --size 400x160 <<END
allowed: until question, choose allow | question = | frame.ids = $ids | render has --allow-path $maps
END
    kill $wanders || echo "SKIPPED part: no python3 or libX11 moved the pointer"
    wait $wanders 2>/dev/null
    check "the material is read" test "$(value allowed frame.pixels)" != "$pixels"
    # A scene may name files in two other folders: the first one stays allowed when the second is asked for.
    mkdir sheets two
    sheets=$(realpath sheets)
    cp model/a.obj maps/a.obj
    cp model/a.obj sheets/b.obj
    printf '{"objects": [{"model": "../maps/a.obj"}, {"model": "../sheets/b.obj"}]}' >two/two.json
    EXPECTED="two.json:1:[0-9]*: objects"
    play "files in two folders" "$CUBE" --size 400x160 <<END
asked! drop two/two.json, until question | question = $maps
refused: choose allow | scene = $CUBE | question =
more! drop two/two.json, until question | question = $sheets
both: choose allow | question = | scene = two/two.json | render has --allow-path $maps --allow-path $sheets
END
    EXPECTED=
fi

if part 1 2; then
    # A dropped picture becomes the sky, and replaces a background too; the panel switches back and forth; a broken
    # picture changes nothing.
    run render "$SCENES/whitted.json" --size 32x16 -o sky.exr --quiet
    echo rubbish >bad.hdr
    EXPECTED="bad.hdr: not a PNG, EXR, PFM or HDR picture$"
    play "pictures all around" "$CUBE" --size 320x240 --background "#ffffff" <<END
plain: | render has --background
sky: drop sky.exr | render has --environment sky.exr | frame.pixels not as plain | frame.ids as plain | toast = environment: sky.exr
own: press Tab, still, choose environment, still, choose the file's | frame.pixels not as sky | frame.ids as plain
again: choose environment, still, choose sky.exr | frame.pixels as sky | render as sky | error =
bad: drop bad.hdr, until error | frame.pixels as sky | render as sky | error has bad.hdr
mended: press Tab, drop $CUBE | error = | frame.pixels as sky | render as sky
END
    check "the background is gone" test "$(value sky render | grep -c background)" -eq 0
    EXPECTED=
    # Each of two skies with the same name can be chosen. `items` has the place of the second.
    mkdir other
    cp sky.exr other
    for second in "0 0" items; do
        [ "$second" != items ] || second=$(value open items.sky.exr)
        play "two skies of a name" "$CUBE" --size 320x240 <<END
first: drop other/sky.exr, press Tab | render has other/sky.exr
open: drop sky.exr, still, choose environment
chosen: choose sky.exr | render as first
again: choose environment, still, click $second
END
    done
    same render open again
fi

if part 0 2; then
    # A scene is read again when it was written: first with an error, which names file and line while the old picture
    # stays, then repaired.
    cp "$CUBE" own.json
    sed 's/"size": 1,/"size": 2,/' "$CUBE" >larger.json
    sed 's/"shape": "box"/"shape": "boxx"/' "$CUBE" >broken.json
    line=$(grep -n boxx broken.json | cut -d : -f 1)
    EXPECTED="^whit: error: \(own.json:$line\|late.json\):"
    play "read again" own.json --size 96x64 <<END
start:
turned: move 40 30, button left down, move 45 30, button left up
do mv broken.json own.json
until toast = own.json was written: reading it again
broken: until error, press R | error has own.json:$line: | frame.ids as turned | frame.pixels as turned
move 40 30
alive: button left down, move 45 34, button left up, still, click 48 32 | error as broken | frame.ids not as broken
    | probe.rays > 0
again: drop own.json | frame.pixels as alive | words as alive
do mv larger.json own.json
until error = $NONE
mended: | error = | scene = own.json | frame.ids not as alive | words as alive
missing! drop late.json, until error | scene = own.json
do mv own.json late.json
came: until scene = late.json | error = | scene = late.json
END
    check "each error once on standard error" test "$(cut -d : -f 3,4 "$OUT/stderr" | tr '\n' ' ')" = \
        " own.json:$line  own.json:$line  late.json: there is no such file "
    EXPECTED=
    # If it cannot be read again for another setting, this setting is given up, and the scene that is shown stays.
    EXPECTED="^whit: error: gone.json: there is no such file"
    cp "$CUBE" gone.json
    play "a file that is gone" gone.json --size 320x240 <<END
start: | error =
do mv gone.json kept.json && touch gone
gone: await gone, press Tab, still, choose light, still, choose none | error has gone.json | words as start
moved: press Tab, press 1, press T | frame.ids not as gone | words has --traversal sign
do mv kept.json gone.json
until error = $NONE
back: | frame.ids as moved
none: press Tab, still, choose light, still, choose none | words has --light none | frame.pixels not as back
END
    EXPECTED=
    # It is also read again if it was written while another scene was shown. Escape ends the opening of a file.
    cp "$CUBE" own.json
    sed 's/#d98a3d/#0000ff/' "$CUBE" >blue.json
    play "written unseen" own.json --size 96x64 <<END
start:
other: drop $SCENES/8k.json
do mv blue.json own.json && touch written
stopped: await written, drop own.json, press Escape | toast = stopped: as it was | scene = $SCENES/8k.json
    | frame.pixels as other | render as other
back: drop own.json, until toast = own.json was written: reading it again | frame.ids as start
    | frame.pixels not as start
same: drop $SCENES/8k.json, wait 9000, still, drop own.json | frame.made is frame.made of back | toast =
END
fi

if part 1 2; then
    # So it is when another file of it was written, or appears: models, pictures and the environment.
    mkdir parts
    printf 'v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n' >parts/m.obj
    printf '{ "materials": { "paint": { "texture": "parts/t.png" } },
      "objects": [{ "model": "parts/m.obj" }, { "shape": "box", "material": "paint", "translation": [1, 1, 1] }] }\n' >whole.json
    sed 's:parts/m.obj:parts/late.obj:' whole.json >lacks.json
    run render "$CUBE" --size 4x4 -o one.png --quiet
    run render "$SCENES/whitted.json" --size 4x4 -o two.png --quiet
    run render "$CUBE" --size 8x4 -o sky.new.exr --quiet
    cp one.png parts/t.png
    run render "$SCENES/whitted.json" --size 8x4 -o around.exr --quiet
    EXPECTED="^whit: error: .*parts/late.obj"
    play "each file of it" whole.json --size 96x64 --environment around.exr <<END
start: | error =
do sed 's/v 0 1 0/v 0 3 0/' parts/m.obj >m.new && mv m.new parts/m.obj
until toast
model: | frame.ids not as start | error =
model-told! wait 9000 | toast =
do mv two.png parts/t.png
until toast
texture: | frame.ids as model | frame.pixels not as model
texture-told! wait 9000 | toast =
do mv sky.new.exr around.exr
until toast
sky: | frame.ids as model | frame.pixels not as texture
do mv lacks.json whole.json
until error
lacks: | error has parts/late.obj | frame.pixels as sky
do sed 's/v 0 3 0/v 3 3 0/' parts/m.obj >m.new && mv m.new parts/late.obj
until error = $NONE
came: | frame.ids not as sky | scene = whole.json
END
    EXPECTED=
fi

# If the scene cannot be read at the start, the viewer ends with an error.
printf '{ "asset": { "version": "2.0" }, ' >broken.gltf
printf 'v 0 0 0\nf 1 2 3\n' >broken.obj
sed 's/"shape": "box"/"shape": "boxx"/' "$CUBE" >broken.json
line=$(grep -n boxx broken.json | cut -d : -f 1)
echo still >still.replay
refuse 2 "a missing scene" "$OUT/nowhere.json: there is no such file" view "$OUT/nowhere.json"
refuse 2 "a broken scene" "broken.json:$line:" view broken.json --frames 3
refuse 2 "a broken glTF" "broken.gltf:" view broken.gltf --replay still.replay
refuse 2 "a broken OBJ" "broken.obj:2: a face names vertex 2, and there are 1" view broken.obj --frames 3
DISPLAY='' refuse 3 "no display" "no display .*whit render" view "$CUBE" --frames 3

# A signal ends the viewer with 128 plus its number as the exit code.
printf 'state ready\nuntil playing\n' >for-ever.replay
for signal in HUP=129 INT=130 TERM=143; do
    "$WHIT" view "$CUBE" --size 96x64 --replay for-ever.replay >"$OUT/pipe" 2>"$OUT/stderr" &
    viewer=$!
    read -r state <"$OUT/pipe"
    kill "-${signal%=*}" $viewer
    wait $viewer
    check "SIG${signal%=*}: exit code ${signal#*=}" test $? -eq "${signal#*=}"
    check "SIG${signal%=*}: says so" test "$(cat "$OUT/stderr")" = \
        "whit: interrupted, each file is whole or as it was"
done

# ---- Saved pictures, and the lines that make them ----

if part 1 2; then
    play "pictures" "$SCENES/spin.json" $SMALL --fps 10 <<END
costs! press F2 x2, still, press V, still, press F12
press B
still
move 40 30
button left down
move 49 33
button left up
press T
press M
press Minus
shown! press Y, press K, press Period, still, press Ctrl+C, press F12, still, wait 4200, still, shot shown.png
END
    check "F12 saves" test -s whit-0001.png
    check "Ctrl+C copies the line" test "$(value shown frame.whole)" = true
    value shown render | sed -e 's/^whit //' -e 's/picture.png$/rendered.png/' >"$OUT/line"
    check "the line has all that was switched" sh -c "grep -q -e --camera '$OUT/line' &&
        grep -q -e '--traversal sign' '$OUT/line' && grep -q -e '--numerics exact' '$OUT/line' &&
        grep -q -e '--build sweep' '$OUT/line' && grep -q -e '--aa 4' '$OUT/line' &&
        grep -q -e '--depth 7' '$OUT/line' && grep -q -e '--time 0.1' '$OUT/line'"
    eval "run $(cat "$OUT/line") --quiet"
    check "the line renders (got $status)" test "$status" -eq 0
    check "byte for byte the window's picture" cmp whit-0001.png rendered.png
    expect 0 "what the window showed" compare shown.png rendered.png --tolerance 0 --metric largest
    check "its recipe is inside" grep -aq "whit render .*spin.json" whit-0001.png
    check "costs are not saved so" test ! -e whit-0002.png
    check "and it says how" test "$(value costs toast | grep -c 'whit render --view')" -eq 1
fi

if part 0 2; then
    # The state has the options of the command line, and `whit render` takes the same options.
    play "words" "$SCENES/whitted.json" $SMALL --traversal basic --build median --aa 4 --depth 3 \
        --bailout 0.01 --fresnel schlick --shadows opaque --instances off --numerics fast <<END
start:
    | words = --size 96x64 --aa 4 --depth 3 --bailout 0.01 --shadows opaque --fresnel schlick --build median --instances off --traversal basic --numerics fast
END
    renders start -o words.pfm --ids words.exr
    play "costs" "$SCENES/default.json" $SMALL --view visits --view-rays all --view-scale 64 <<END
start: press F2 x2 | words = --size 96x64 --view visits --view-rays all --view-scale 64 | frame.view = visits
END
fi

if part 0 2; then
    # The line of Ctrl+C has all folders, however long their names are.
    folders=
    for name in a b c d e; do
        long=$(printf "$name%.0s" $(seq 240))
        mkdir -p "$long/$long/$long/$long"
        folders="$folders --allow-path $PWD/$long/$long/$long/$long"
    done
    play "a long line" "$CUBE" $SMALL $folders <<END
long: | render has $folders -o picture.png
END
fi

if part 1 2; then
    # A file of settings begins with a line for a shell. Keys that come between two pictures are all counted.
    cp "$CUBE" "it's a cube.json"
    play "a name to quote" "it's a cube.json" $SMALL <<END
up: press Z | render has --exposure 0.5
down: press Shift+Z x2, press Ctrl+S | render has --exposure -0.5
END
    check "its line can be run" test "$(head -n 1 whit-0001.view)" = \
        "# whit view 'it'\\''s a cube.json' --state whit-0001.view"
    rm whit-0001.view
fi

# ---- Replays ----

bad() { # TEXT: a replay with this line is refused, with file and line
    printf 'still\n# a comment\n\n%s\n' "$1" >bad.replay
    refuse 2 "\`$1\`" "bad.replay:4: .*no event of a replay" view "$CUBE" --replay bad.replay
}
for text in "jump" "until" "await" "choose" "clock" "clock false" "key T" "key T sideways" "press Hyper+T" "press" "move 1" "click 1" "wheel" \
    "size 10" "size x y" "size 0 1" "size 2000000 1" "size 96 64 1" "wait 5s" "still T" "press T U" "key T up down" "click 1 2 3" \
    "char 65x" "button left up down" "wait -1" "wait soon" "button none down" "char x" "shot" "drop"; do
    bad "$text"
done
printf 'still\n\000jump\n' >zero.replay
refuse 2 "a byte 0" "zero.replay: it is no text" view "$CUBE" $SMALL --replay zero.replay
refuse 2 "no replay" "nowhere.replay" view "$CUBE" --replay nowhere.replay
refuse 2 "no place for a record" "nowhere/record: cannot write: No such file or directory" view "$CUBE" --record nowhere/record --frames 1
refuse 2 "no room for a record" "/dev/full: cannot be written" view "$CUBE" $SMALL --record /dev/full --frames 1
XDG_STATE_HOME=/proc/nowhere expect 0 "no place for cameras" view "$CUBE" $SMALL --frames 1
check "no place for cameras: is a warning" test "$(sed 's/cameras.json.*//' "$OUT/stderr")" = "whit: warning: /proc/nowhere/whit/"
finish
