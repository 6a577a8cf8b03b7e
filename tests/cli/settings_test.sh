#!/bin/sh
# Every row of the table of settings takes effect in all of its commands, files and keys, with a value that is not its
# default: settings_test.sh WHIT SCENES ROWS. The program ROWS prints name, value, commands, change, key, title, key in
# JSON, and whether files of settings may not have it.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
ROWS=$3
mkdir "$OUT/work" && cd "$OUT/work" || exit 1
"$ROWS" rows >rows
printf '%s\n' '//@ slider bright 0 2 1' '//@ toggle tint' '//@ aov gray' \
    'vec4 gray(Surface s) { return vec4(bright); }' \
    'vec3 post(ivec2 at, vec3 color) { return color * (tint ? bright : 1.0); }' >bright.glsl
cp -r "$SCENES/../shaders" stages
expect 0 "a sky" render "$CUBE" -o sky.pfm --size 16x8 --quiet
TAB=$(printf '\t')
IN_RUN=0 IN_COST=1 # of enum setting_change
has() { test $((commands >> $1 & 1)) -eq 1; } # of enum settings_command
RENDER=0 VIEW=1 PROBE=2 PRICES=3

# has_json FILE: the JSON has the key $json with the value $value, as a number or a word.
has_json() {
    jq -e --arg key "$(echo "$json" | tr - _)" --arg value "$value" \
        'if $key == "size" then "\(.width)x\(.height)" == $value
            else has($key) and (.[$key] | tostring) == $value end' "$1" >/dev/null
}
# option: prints the option, with its value if it is not a flag.
option() { test "$value" = - && echo "--$name" || echo "--$name=$value"; }
# quoted VALUE: prints the value as a shell needs it.
quoted() { case $1 in '#'*) echo "'$1'" ;; *) echo "$1" ;; esac; }
command_of() { grep -a -o 'whit render [^"]* -o whit\.png' "$1"; }

# One picture has all rows together, except those of heat maps, which are in a second picture.
count=0
: >all.view
for pass in colours costs; do
    render= probe= prices=
    while IFS=$TAB read -r name value commands change _ _ _ held; do
        # Settings of a run that are not about its pictures are never written; the device is that of the test.
        if [ "$change" -eq $IN_RUN ] || [ "$name" = device ]; then continue; fi
        of=$(expr "$name" : view >/dev/null && echo costs || echo colours)
        [ $of = $pass ] || [ "$name" = size ] || continue
        count=$((count + 1))
        if has $VIEW && [ "$held" -eq 0 ] && [ $of = $pass ]; then echo "--$name $(quoted "$value")"; fi >>all.view
        has $RENDER && render="$render $(option)"
        has $PROBE && probe="$probe $(option)"
        has $PRICES && prices="$prices $(option)"
    done <rows
    # shellcheck disable=SC2086
    {
        expect 0 "render$render" render "$CUBE" -o $pass.png $render --quiet
        [ $pass = costs ] || expect 0 "probe$probe" probe "$CUBE" --pixel 1,1 $probe --json probe.json --quiet
        [ $pass = costs ] || expect 0 "cost$prices" cost "$CUBE" $prices --spend 0.1 --rays 0 \
            --knobs traversal --json cost.json --quiet
    }
done
check "there are rows ($count)" test $count -ge 20
jq .picture probe.json >probe.options
jq .picture cost.json >cost.options
while IFS=$TAB read -r name value commands change _ _ json _; do
    if [ "$change" -eq $IN_RUN ] || [ "$name" = device ]; then continue; fi
    words="--$name $(quoted "$value")"
    test "$value" = - && words=--$name value=true
    pass=$(expr "$name" : view >/dev/null && echo costs || echo colours)
    command_of $pass.png >command
    grep -a -o '{"width":[^}]*}' $pass.png >options
    if has $RENDER && [ "$change" -eq $IN_COST ]; then
        check "no recipe says --$name, which changes no pixel" sh -c '! grep -q -- "--$1" command' - "$name"
    elif has $RENDER; then
        check "the recipe says $words" sh -c 'grep -qF -- "$1 " command' - "$words"
    fi
    if [ "$change" -eq $IN_COST ] || [ "$name" = allow-path ]; then
        continue
    elif [ $pass = costs ]; then
        check "JSON of costs has $words" grep -aqE "\"${name#view-}\":\"?$value" costs.png
    else
        has $RENDER && check "JSON of the recipe has $words" has_json options
        has $PROBE && check "JSON of the probe has $words" has_json probe.options
        has $PRICES && check "JSON of whit cost has $words" has_json cost.options
    fi
done <rows

if part 1 2; then
    # With less exposure a PNG is darker, but floats stay.
    expect 0 "light" render "$CUBE" -o light.pfm --size 24x16 --quiet
    expect 0 "light, displayed darker" render "$CUBE" -o dark.pfm --size 24x16 --exposure -1 --quiet
    check "has the same floats" cmp light.pfm dark.pfm
    render_png() { expect 0 "$1" render "$CUBE" -o "$1.png" --size 24x16 --exposure "$2" --quiet; }
    render_png usual 0
    render_png dark -1
    expect 0 "the PNG of it" compare usual.png dark.png --metric mean --json dark.json
    check "is darker ($(jq -c .mean dark.json))" jq -e '.mean | type == "array" and all(. < -0.01)' dark.json
    # The automatic exposure of a model depends on its visible surfaces; floats stay.
    printf 'newmtl glow\nKd 0 0 0\nKe 50 25 5\n' >glow.mtl
    printf 'mtllib glow.mtl\nusemtl glow\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n' >glow.obj
    expect 0 "a model that burns out" render glow.obj -o glow.png --size 24x16
    check "says its exposure" grep -q 'note: 100 % of what is seen would be burnt out: `--exposure auto` is -6 EV' \
        "$OUT/stderr"
    check "and the recipe has it" grep -aq '"exposure_ev":-6\(\.0\)\{0,1\}[,}]' glow.png
    for exposure in -6 0; do
        expect 0 "at $exposure" render glow.obj -o glow$exposure.png --exposure $exposure --size 24x16 --quiet
        expect 0 "its floats at $exposure" render glow.obj -o glow$exposure.pfm --exposure $exposure --size 24x16 --quiet
    done
    expect 0 "its floats" render glow.obj -o glow.pfm --size 24x16 --quiet
    check "are those of any exposure" cmp glow.pfm glow0.pfm
    expect 0 "highlights are softer than at the number" compare glow-6.png glow.png --metric mean --json soft.json
    check "darker where they are bright ($(jq -c .mean soft.json))" jq -e '.mean[0] < -0.01 and .mean[2] == 0' soft.json
    # `--camera auto` is whit's own view, even if a camera of the file has that name.
    sed 's/"camera": {/"camera": {"name": "auto", /' "$CUBE" >named.json
    check "a file names its camera auto" grep -q '"name": "auto"' named.json
    own() { expect 0 "$1" render "$2" -o "$1.pfm" --size 24x16 --quiet ${3:+--camera "$3"}; }
    own first "$CUBE"
    own number named.json 0
    own auto named.json auto
    expect 0 "its recipe" render named.json -o auto.png --size 24x16 --quiet --camera auto
    own again named.json "$(grep -a -o '"camera":"[^"]*"' auto.png | cut -d '"' -f 4)"
    check "auto is none of the file's" sh -c '! cmp -s first.pfm auto.pfm'
    check "a number is the file's" cmp first.pfm number.pfm
    check "the recipe has auto's numbers" cmp auto.pfm again.pfm
    own viewless glow.obj
    own viewless-auto glow.obj auto
    check "a model without a camera has whit's" cmp viewless.pfm viewless-auto.pfm
    flip_of() {
        expect 0 "cost --exposure $1" cost "$CUBE" --size 24x16 --exposure "$1" --spend 0.1 --rays 0 \
            --knobs traversal --json "cost$1.json" --quiet
        flip=$(jq '.rows[0].error.flip' "cost$1.json")
    }
    flip_of 0
    usual=$flip
    flip_of -12
    check "FLIP is of what is displayed ($usual, $flip)" \
        holds "$usual > 0 && $flip < $usual / 4"
fi

# ---- The viewer ----

if ! "$WHIT" view --help >/dev/null 2>&1; then
    echo "SKIPPED part: no viewer"
    finish
fi
play "all of them out of a file" "$CUBE" --state all.view <<END
still
press Ctrl+C
press Ctrl+S
state all
END
sort all.view >wanted
grep -v '^#' whit-0001.view | sort >saved
check "Ctrl+S writes the same" cmp wanted saved
value all render >line
while read -r words; do
    case $words in
    --fps-goal* | --at-rest* | --boxes*) ;; # of the window alone
    *) check "Ctrl+C: $words" grep -qF -- "$words " line ;;
    esac
done <all.view

if part 0 2; then
    {
        echo still
        echo state start
        while IFS=$TAB read -r name value commands _ key _; do
            [ "$key" != - ] || continue
            press=$(echo "$key" | sed 's/=/Equal/; s/\//Slash/')
            back=$(test "$key" = = && echo Minus || echo "Shift+$press")
            printf 'press %s\nstate %s\npress %s\nstate %s-back\n' "$press" "$name" "$back" "$name"
        done <rows
    } >keys
    play "keys" "$CUBE" --size 24x16 <keys
    while IFS=$TAB read -r name _ _ _ key title _; do
        [ "$key" != - ] || continue
        differs "keys.$title" start "$name"
        same "keys.$title" start "$name-back"
    done <rows
fi
finish
