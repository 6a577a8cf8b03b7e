#!/bin/sh
# The viewer follows a file of functions that is saved while its picture is shown.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir -p "$OUT/here/live/part" && cd "$OUT/here" || exit 1
EXPECTED="^whit: \(error\|note\|warning\): " # they are looked at below

cat >live/a.glsl <<'END'
#include "part/tint.glsl"
//@ aov height
vec4 height(Surface s) { return vec4(s.p.y); }
//@ slider bands 1 8 3 "steps of light"
//@ toggle stepped on "in steps"
vec3 post(ivec2 at, vec3 color)
{
    return tint(stepped ? ceil(color * bands) / bands : color);
}
END
# hash_of FILE: prints the hash that whit gives the file, without making kernels.
hash_of() { WHIT_TEST_NO_DEVICE=1 "$WHIT" shader "$1" --json 2>/dev/null | jq -r .hash; }
# versions FILE NAME...: each NAME.new is a version of FILE, which becomes the first one; sets $NAME to its hash.
versions() {
    file=$1 first=$2
    shift
    for version in "$@"; do
        cp "$version.new" "$file"
        eval "$version=$(hash_of "$file")"
    done
    cp "$first.new" "$file"
}
# tint NAME COLOUR: writes NAME.new, a version of live/part/tint.glsl, and sets $NAME to the hash of live/a.glsl with
# it.
tint() {
    echo "vec3 tint(vec3 c) { return c * vec3($2); }" >"live/part/tint.glsl"
    cp live/part/tint.glsl "$1.new"
    eval "$1=$(hash_of live/a.glsl)"
}
tint green '0.2, 1.0, 0.2'
tint blue '0.2, 0.2, 1.0'
tint violet '1.0, 0.2, 1.0'
tint red '1.0, 0.2, 0.2'
tint white '1.0, 1.0, 1.0'
check "five versions" test "$(printf '%s\n' "$green" "$blue" "$violet" "$red" "$white" | sort -u | wc -l)" -eq 5
# Lines 2 to 5 have errors, and so has the included file; the window still shows the version before. Line 3 has two
# errors about `here`.
printf 'vec3 tint(vec3 c) {\n    c.x = wrong;\n    c.y = here * here;\n    c.z = other;\n    c = far;\n    return c;\n}\n#include "deep.glsl"\n' \
    >broken.new
printf '\nfloat deep = nowhere;\n\n' >live/part/deep.glsl
# post TEXT, bomb: print a file whose post() has this text, or a text of 2^40 words by macros that double.
post() { printf 'vec3 post(ivec2 at, vec3 color)\n{\n%s\n}\n' "$1"; }
bomb() {
    echo '#define B0 color + color'
    seq 39 | awk '{ print "#define B" $1 " B" $1 - 1 " + B" $1 - 1 }'
    post '    return B39;'
}
# put FILE AT: renames a copy over AT. Of two saves in a row the second must not truncate the file while the window
# reads the first: an empty file is an error that no state waits for.
put() { cp "$1" live/new && mv live/new "$2"; }
if part 0 2; then
    play "saves" "$CUBE" --size 200x150 --ui-scale 0.5 --shader live/a.glsl --aov heigth <<END
shown! until shader | shader.hash = $white
start: | toast has did you mean \`height\`? | shader.hash = $white | shader.files = 2 | shader.sliders = 2 | render has --shader live/a.glsl
do cp red.new live/part/tint.glsl # as an editor writes it
until shader.first = 1
step! | shader.hash = $red
red: | quality = full size, 1 sample | frame.ids as start | frame.pixels not as start | error =
do cp broken.new live/part/tint.glsl
until error
told: | toast as red | change.what = shader a.glsl, read again
broken: press R | error has live/part/tint.glsl:2:11: 'wrong' | error has live/part/tint.glsl:3: 'here' | errors_drawn = 5 | error has live/part/deep.glsl:2:14: 'nowhere'
    | error has live/part/tint.glsl:4:11: 'other' | error has live/part/tint.glsl:5:9: 'far' | frame.pixels as red | frame.ids as start | shader.hash = $red
turned: move 40 30, button left down, move 45 30, button left up | error as broken | frame.ids not as broken
do put green.new live/part/tint.glsl
until error =
until shader.changed
mended: | shader.changed has ms [ | shader.changed has ids equal  preview | shader.refused = 1 | shader.hash = $green | frame.pixels not as turned | frame.ids as turned
beside: press I | compare.mode = split | compare.other_ids = 0 | compare.other_colors > 100 | compare.b.pixels is frame.pixels of turned
alone: press I | compare.mode = off
do put blue.new live/part/tint.glsl && put violet.new live/part/tint.glsl
until shader.hash = $violet
twice: | frame.pixels not as mended | error =
prices: press P | toast has the reference, which has no --shader | frame.pixels as twice
effects: press X | toast as prices | frame.pixels as twice
panel: press X, press Tab
off: choose stepped | render has --set stepped=off | frame.pixels not as twice | shader.hash = $violet
on: choose stepped | render has --set stepped=on | frame.pixels as twice
height: press F3 | render has --aov height | frame.pixels not as twice | frame.ids as on
colour: press F3 | frame.pixels as on | frame.ids as on
do mv live/part live/away
until error
gone: | error has part/tint.glsl | frame.pixels as colour
do mv live/away live/part
until error =
back: | frame.pixels as colour | shader.hash = $violet
END
    check "each error is said once" test "$(grep -cE 'error: live/part/(tint.glsl:(2:11|3|4:11|5:9)|deep.glsl:2:14): ' "$OUT/stderr")" -eq 5
    check "and nothing else but the folder that was gone" test "$(grep -c error: "$OUT/stderr")" -eq 6
    check "each change is said" grep -q "note: a.glsl: .* pixels other .*ids equal  preview [0-9]" "$OUT/stderr"
    # On a busy machine the whole picture may be drawn before the first step is on the screen.
    case $(value step frame.divisor) in
    1) step="full size, 1 sample" ;;
    *) step="1/$(value step frame.divisor) of the size, 1 sample" ;;
    esac
    check "the window says which step it shows ($step)" expr "$(value step quality)" : "$step"
fi

# ---- A picture of it, a file of settings, and both again ----

cp "$CUBE" cube.json
if part 1 2; then
    said=$EXPECTED EXPECTED= # nothing is said here
    play "a slider that is moved" cube.json --size 200x150 --ui-scale 0.5 --shader live/a.glsl <<END
still
press X
press Tab
choose stepped
still
press F12
press Ctrl+S
press Ctrl+C
state first
END
    check "saved" test -e whit-0001.png -a -e whit-0001.view
    cp "$OUT/values" first
    value first render >line
    # again STATE: identities, pixels and functions of the state are those of the first one.
    again() {
        for field in frame.ids frame.pixels shader.hash; do
            is "$1" $field "$(awk -F '\t' -v field=$field '$2 == field { print $3 }' first)"
        done
    }
    for words in '--shader live/a.glsl' '--set stepped=off'; do
        check "the file of settings says $words" grep -qxF -e "$words" whit-0001.view
        check "and so does Ctrl+C" grep -qF -e "$words " line
    done
    play "an aov that is saved" cube.json --size 96x64 --shader live/a.glsl --aov height <<END
still
press F12
END
    mv whit-0002.png height.png
    expect 0 "and drawn by its recipe" render height.png --yes --quiet -o again.png
    expect 0 "is the same" compare height.png again.png --metric differing --tolerance 0
    # A save without the aov that is shown goes back to colours, and neither recipe nor line name it any more.
    { cat live/a.glsl && printf '//@ aov low\nvec4 low(Surface s) { return vec4(-s.p.y); }\n'; } >two.new
    cp live/a.glsl colours.new
    versions live/n.glsl two colours
    EXPECTED=$said
    play "an aov that is gone" cube.json --size 96x64 --shader live/n.glsl --aov low <<END
low: | render has --aov low
do put colours.new live/n.glsl
until shader.hash = $colours
gone: still, press F12 | frame.pixels not as low
END
    check "it is said" grep -qF 'warning: n.glsl has no `//@ aov low`' "$OUT/stderr"
    check "the line does not name it" test "$(value gone render | grep -c -e --aov)" -eq 0
    mv whit-0002.png gone.png
    expect 0 "what was saved is drawn again" render gone.png --yes --quiet -o again.png
    expect 0 "as it was" compare gone.png again.png --metric differing --tolerance 0
    EXPECTED=
    play "by the file, and A beside B" cube.json --state whit-0001.view --ui-scale 0.5 <<END
state: | error =
panel: press X, press Tab
same: press I | compare.mode = split | compare.other_colors = 0 | compare.other_ids = 0
other: choose stepped | compare.other_colors > 0 | compare.other_ids = 0 | render has --set stepped=on
END
    again state
    # The viewer goes on with the picture's file as it was when the user was asked, even if it is replaced.
    echo 'vec3 post(ivec2 at, vec3 color) { return color.bgr; }' >other.glsl
    expect 0 "another picture" render cube.json --size 8x8 --quiet --shader other.glsl -o other.png
    cp whit-0001.png asked.png
    mv live away
    play "by the picture" asked.png --yes <<END
picture:
do cp other.png asked.png
later: wait 600, press F12 | shader.hash as picture | frame.pixels as picture
END
    mv away live
    again picture
    expect 0 "what is saved of it" compare whit-0001.png whit-0002.png --metric differing --tolerance 0
    play "without functions at the start" cube.json --size 96x64 <<END
start: | error =
dropped: drop whit-0001.view | toast has whit-0001.view has --shader | frame.pixels as start
END
    expect 2 "by a picture, without an answer" view whit-0001.png
    check "says what to do" grep -q 'no terminal to ask at; --yes' "$OUT/stderr"
    # At a terminal whit lists the files that it would load, asks once, and opens these or nothing.
    printf '%s\n' still 'state picture' >"$OUT/replay"
    for answer in n y; do
        command -v script >/dev/null || { echo "SKIPPED what is asked at a terminal: there is no script(1)"; break; }
        echo $answer | timeout $((100 * ${WHIT_TEST_PATIENCE:-1})) script -qec \
            "'$WHIT' view whit-0001.png --replay '$OUT/replay' >'$OUT/states'" /dev/null >"$OUT/asked"
        eval "$answer=$?"
        check "$answer: names the scene" grep -q '^  scene      cube.json' "$OUT/asked"
        check "$answer: and all functions" test "$(grep -c '^  functions  a.glsl, 9 lines\|^             part/tint.glsl, 1 line' "$OUT/asked")" -eq 2
        check "$answer: asks once" test "$(grep -c 'Load and compile it? \[y/N\]' "$OUT/asked")" -eq 1
        test $answer = y || check "no opens nothing" test ! -s "$OUT/states"
    done
    if command -v script >/dev/null; then
        check "exit codes ($n, $y)" test "$n $y" = "2 0"
        read_states
        again picture
    fi
    printf -- '--shader live/a.glsl\n--trust\n' >bad.view
    refuse 2 "a file that trusts" "bad.view:2: --trust is nothing to be saved" view cube.json --state bad.view
    for option in --allow-path=/ --memory-limit=900G --import-limit=99 --require-sandbox; do
        echo $option >bad.view
        refuse 2 "a file with $option" "bad.view:1: ${option%=*} is nothing to be saved" view cube.json --state bad.view
    done
    EXPECTED=$said
fi

# ---- Stages of a checkout that are saved while their picture is shown ----

if part 0 2; then
    cp -r "$SCENES/../shaders" st
    sed 's/environment(dir)/environment(dir) * bright/' st/hook/miss.glsl >broken.new
    sed 's/environment(dir)/environment(dir) * 0.5/' st/hook/miss.glsl >dim.new
    line=$(grep -n bright broken.new | cut -d : -f 1)
    play "stages" cube.json --size 96x64 --stages st <<END
start: | shader.files > 10 | error =
do cp broken.new st/hook/miss.glsl
until error
broken: | error has st/hook/miss.glsl:$line: | frame.pixels as start
do cp dim.new st/hook/new && mv st/hook/new st/hook/miss.glsl
until error =
mended: | frame.pixels not as start | frame.ids as start
END
fi

# ---- Values of dbg(x) in the pixel that was clicked ----

if part 1 2; then
    cat >looks.new <<'END'
//@ toggle twice off
vec3 miss(vec3 dir)
{
    return environment(dbg(dir)) * dbg(twice ? 2.0 : 1.0);
}
END
    sed 's/dbg//g' looks.new >plain.new
    versions live/d.glsl plain looks
    VALUE="d.glsl:4: twice ? 2.0 : 1.0 ="
    play "what values are" cube.json --size 320x240 --ui-scale 0.5 --shader live/d.glsl <<END
plain: click 4 4 | picked = true | probe.dbg = | probe.number = 1
slid: press X, press Tab, move 10 10, still, choose twice | probe.number = 1 | frame.pixels not as plain
do cp looks.new live/d.glsl
until shader.hash = $looks
saved: | probe.dbg has $VALUE 2 | probe.dbg has d.glsl:4: dir = ( | frame.pixels as slid
twice: choose twice | probe.dbg has $VALUE 1 | frame.pixels as plain
moved: press Tab, move 190 6, still, button left down, move 196 20, button left up | probe.dbg has $VALUE 1 | probe.dbg not as twice
do cp plain.new live/d.glsl
until shader.hash = $plain
without: | probe.dbg = | frame.pixels as moved
END
fi

# ---- Widgets of sliders change the next picture without compiling ----

if part 0 4; then
    cat >own.new <<'END'
//@ slider bands 1 8 3
//@ color rim #204060
//@ choice mode plain,warm
vec3 miss(vec3 dir) { return rim; }
vec3 post(ivec2 at, vec3 color)
{
    color = ceil(color * bands) / bands;
    return mode == mode_warm ? color * vec3(1.0, 0.5, 0.2) : color;
}
END
    sed 's/ceil/floor/' own.new >other.new
    versions live/w.glsl own other
    play "sliders" cube.json --size 320x240 --ui-scale 0.5 --shader live/w.glsl <<END
start: press F2 x2, press X, press Tab, move 20 20 | error = | hud = off
number: choose bands | render has bands= | frame.pixels not as start | picked = false
opened: choose mode, wait 50, move 46 43, wait 50, move 46 42
choice: choose warm | render has mode=warm | frame.pixels not as number | picked = false
color: choose rim x2, char 70, char 48, char 56, char 48, char 49, char 48 | render has rim=#f08010 | frame.pixels not as choice
same: choose bands | render as color | frame.pixels as color | picked = false
do cp other.new live/w.glsl
until shader.hash = $other
saved: | error = | frame.pixels not as color
subtracted: press U | compare.mode = difference | compare.other_ids = 0 | compare.other_colors > 100 | compare.b.pixels is frame.pixels of color
END
    check "a float is as short as it can be" \
        test "$(value number render | grep -cE 'bands=[1-8][.][0-9]{1,6}[ ,]')" -eq 1
    for at in number choice color; do
        same frame.made start $at
        same frame.kernels start $at
    done
    differs frame.made color saved # so that it can be told
fi

# ---- A new include that is broken, then mended; a slider that a version no longer has; a link ----

if part 2 4; then
    mkdir real
    printf '//@ slider k 0 1 0.5\nvec3 post(ivec2 at, vec3 color) { return color * k; }\n' >real/l.glsl
    ln -s ../real/l.glsl live/l.glsl
    printf '#include "new.glsl"\nvec3 post(ivec2 at, vec3 color) { return twice(color); }\n' >with.new
    play "a new include" cube.json --size 320x240 --ui-scale 0.5 --shader live/l.glsl <<END
start: press F2 x2, press Tab | error =
moved: choose k | render has --set k=
do cp with.new real/l.glsl
until error
lacks: | error has new.glsl | render has --set k=
do echo 'vec3 twice(vec3 c) { return 2.0 * c; }' >live/new.glsl
until error =
mended: | frame.pixels not as start
END
    check "a slider that is gone is not named" test "$(value mended render | grep -c -e --set)" -eq 0
fi

# ---- After harmful saves the window goes on with the last good picture ----

if part 1 4; then
    post '    return color.bgr;' >good.new
    post '    while (color.r >= 0.0) color.r += 1.0; return color;' >endless.new
    post '    return vec3(sqrt(-1.0 - color.r));' >nan.new
    post "    return color * $(head -c 100000 /dev/zero | tr '\0' '(' | fold -w 1000)1.0;" >deep.new
    bomb >bomb.new
    for version in gbr grb rrr; do post "    return color.$version;" >$version.new; done
    versions live/h.glsl good gbr grb rrr
    play "saves that mean harm" cube.json --size 96x64 --shader live/h.glsl <<END
start: | error =
do cp endless.new live/h.glsl
until shader.refused = 1
endless: | error has live/h.glsl:3: | error has fuel | frame.pixels as start
do cp nan.new live/h.glsl
until shader.refused = 2
nan: | error has not finite: in | error has h.glsl has functions of this picture | frame.pixels as start
do cp deep.new live/h.glsl
until shader.refused = 3
deep: | error has live/h.glsl: | error has too deep | frame.pixels as start
do cp bomb.new live/h.glsl
until shader.refused = 4
bomb: | error has live/h.glsl: | frame.pixels as start
do put gbr.new live/h.glsl
until shader.hash = $gbr
renamed: | error = | frame.pixels not as start | frame.ids as start
do put grb.new live/h.glsl && put rrr.new live/h.glsl
until shader.hash = $rrr
twice: | error = | frame.pixels not as renamed | frame.ids as start
END
    check "the compiler's two errors are told once each" test "$(grep -c 'error: live/h.glsl' "$OUT/stderr")" -eq 2
    # Each of these is told, and the next good save mends it.
    post '    for (;;) color.r += 1e-9; return color;' >endfor.new
    post '    do color.r += 1e-9; while (color.r > -1.0); return color;' >enddo.new
    post '    for (int i = 0; i < 1000; ++i) for (int k = 0; k < 1000; ++k) color.r += 1e-9; return color;' >nested.new
    { echo 'float f(float x) { return f(x); }' && post '    return color * f(1.0);'; } >recursion.new
    { printf 'float g(float x);\nfloat f(float x) { return g(x); }\nfloat g(float x) { return f(x); }\n' &&
        post '    return color * f(1.0);'; } >mutual.new
    post '    float a[2684354560]; a[at.x] = 1.0; return color * a[at.y];' >array.new
    post '    float a[2000000000]; a[at.x] = 1.0; return color * a[at.y];' >large.new
    post '    float a[4]; return color * a[-1];' >before.new
    post '    float a[4]; return color * a[2147483648u];' >behind.new
    post '    return color * 1e30 * 1e30 + 1e38 * 1e30;' >inf.new
    post '    return (color + 1.0) / (color.r - color.r);' >division.new
    post '    discard; return color;' >discard.new
    post '    if (at.x > 3) barrier(); return color;' >barrier.new
    post '    if (at.x > 3) return color;' >return.new
    { echo 'return 1;' && post '    return color;'; } >outside.new
    post "    return color; // $(head -c 1000000 /dev/zero | tr '\0' x)" >line.new
    for name in h.glsl part /dev/zero; do
        { echo "#include \"$name\"" && post '    return color;'; } >"include$(echo $name | tr -d ./).new"
    done
    { echo '#version 100' && post '    return color;'; } >version.new
    : >empty.new
    printf '\177ELF\001\000' >binary.new
    cp good.new live/h.glsl
    told=0
    echo 'start: | error =' >table
    for name in endfor enddo nested recursion mutual array large before behind inf division discard barrier return outside line \
        includehglsl includepart includedevzero version empty binary; do
        told=$((told + 1))
        echo "do put $name.new live/h.glsl"
        echo "until shader.refused = $told"
        echo "$name: | error has h.glsl | frame.pixels as start"
        echo "do echo // $name >>good.new && put good.new live/h.glsl"
        echo "until error ="
        echo "after-$name: | error = | frame.pixels as start"
    done >>table
    play "each of many harmful saves, and a good one" cube.json --size 96x64 --shader live/h.glsl <table
    check "each is told once" test "$(grep -c error: "$OUT/stderr")" -eq $told
    # A save that ends the measurement of the one before leaves its line.
    versions live/h.glsl good gbr grb
    play "saves in a row" cube.json --size 96x64 --shader live/h.glsl <<END
start: | error =
do put gbr.new live/h.glsl
until shader.whole = 1
first! | shader.hash = $gbr
do put grb.new live/h.glsl
until shader.hash = $grb
until shader.changed
second: | shader.whole = 2
END
    check "a line for each" test "$(grep -c 'note: h.glsl: ' "$OUT/stderr")" -eq 2
    # A file that was saved while another was used is read again.
    cp grb.new live/i.glsl
    for name in h i; do echo "--shader live/$name.glsl" >$name.view; done
    versions live/h.glsl good gbr
    play "saved unseen" cube.json --size 96x64 --shader live/h.glsl <<END
start:
other: drop i.view | frame.pixels not as start
do cp gbr.new live/h.glsl && touch saved
back: await saved, drop h.view, until shader.hash = $gbr | frame.pixels not as start | frame.pixels not as other
END
fi

# ---- If the compiler's process ends while it compiles, that is an error like others, and the next save works ----

if part 3 4; then
    child_of() { cat /proc/[0-9]*/stat 2>/dev/null | awk -v parent="$1" '$4 == parent { print $1; exit }'; }
    kept() { child_of "$(child_of "$viewer")"; } # by the window, which `timeout` runs; each file is compiled in a child of it
    # end_compiler SIGNAL: sends the signal to that child while it compiles.
    end_compiler() {
        keeper=$(kept) child=
        until [ "$child" ]; do
            kill -0 "$viewer" || return
            child=$(child_of "$keeper")
        done
        kill -s "$1" "$child"
    }
    bomb >long.new # to compile
    for version in rgb gbr brg; do post "    return color.$version;" >$version.new; done
    versions live/k.glsl rgb gbr brg
    play "a compiler that ends" cube.json --size 96x64 --shader live/k.glsl <<END
start: | error = | shader.hash = $rgb
do cp long.new live/k.glsl && end_compiler KILL
until error
killed: | error has live/k.glsl: the compiler was killed (signal 9) | frame.pixels as start | shader.hash = $rgb
do cp gbr.new live/k.glsl
until shader.hash = $gbr
mended: | error = | frame.pixels not as start
do cp long.new live/k.glsl && end_compiler SEGV
until error
crashed: | error has live/k.glsl: the compiler crashed on it (signal 11) | frame.pixels as mended | shader.hash = $gbr
do check "the process that is kept can be ended" kill -s KILL "\$(kept)"
do cp brg.new live/k.glsl
until shader.hash = $brg
again: | error = | frame.pixels not as mended | frame.ids as start
END
    check "the terminal says both" test "$(grep -c 'error: live/k.glsl: ' "$OUT/stderr")" -eq 2
    check "and no more" test "$(grep -c error: "$OUT/stderr")" -eq 2
fi

# If the file does not compile at the start, the viewer ends with an error.
printf 'vec3 post(ivec2 at, vec3 color) { return color }\n' >live/bad.glsl
expect 2 "broken at the start" view "$CUBE" --size 96x64 --shader live/bad.glsl --quiet
check "says where" grep -q 'live/bad.glsl:1:48: ' "$OUT/stderr"
finish
