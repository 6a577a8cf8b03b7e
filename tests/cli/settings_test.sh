#!/bin/sh
# Every row of the table of settings, with a value that is not its default, wherever it is to work:
# settings_test.sh WHIT SCENES ROWS. ROWS prints name, value, commands, change, key, title, key in JSON,
# and whether files of settings may not say it.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
ROWS=$3
mkdir "$OUT/work" && cd "$OUT/work" || exit 1
"$ROWS" rows >rows
TAB=$(printf '\t')
IN_RUN=0 IN_COST=1 # of enum setting_change
has() { test $((commands >> $1 & 1)) -eq 1; } # of enum settings_command
RENDER=0 VIEW=1 PROBE=2 PRICES=3

# has_json FILE: the key with the value, a number or a word.
has_json() {
    jq -e --arg key "$(echo "$json" | tr - _)" --arg value "$value" \
        'if $key == "size" then "\(.width)x\(.height)" == $value
            else has($key) and (.[$key] | tostring) == $value end' "$1" >/dev/null
}
command_of() { grep -a -o 'whit render [^"]* -o whit\.png' "$1"; }

count=0
while IFS=$TAB read -r name value commands change _ _ json held; do
    # What is of a run, not of its pictures, is never written; the device is that of the test.
    if [ "$change" -eq $IN_RUN ] || [ "$name" = device ]; then continue; fi
    count=$((count + 1))
    words="--$name $value"
    small=$(test "$name" = size || echo --size=24x16)
    costs=$(expr "$name" : view- >/dev/null && echo --view=visits)
    if has $VIEW && [ "$held" -eq 0 ]; then echo "$words"; fi >>all.view
    if has $RENDER; then
        # shellcheck disable=SC2086
        expect 0 "render $words" render "$CUBE" -o p.png $small $costs "--$name=$value" --quiet
        case $change in
        "$IN_COST") check "and no word of it" sh -c '! echo "$1" | grep -q -- "--$2"' - "$(command_of p.png)" "$name" ;;
        *) check "and its recipe says so" sh -c 'echo "$1 " | grep -qF -- "$2 "' - "$(command_of p.png)" "$words" ;;
        esac
        case $change$name in
        "$IN_COST"* | *allow-path) ;;
        *view*) check "and its JSON" grep -aq "\"whit:view\|\"$value\|:$value" p.png ;;
        *)
            grep -a -o '{"width":[^}]*}' p.png >options
            check "and its JSON" has_json options ;;
        esac
    fi
    if has $PROBE; then
        # shellcheck disable=SC2086
        expect 0 "probe $words" probe "$CUBE" --pixel 1,1 $small "--$name=$value" --json probe.json --quiet
        jq .picture probe.json >options
        [ "$change" -eq $IN_COST ] || [ "$name" = allow-path ] || check "and its JSON" has_json options
    fi
    if has $PRICES; then
        # shellcheck disable=SC2086
        expect 0 "cost $words" cost "$CUBE" $small "--$name=$value" --spend 0.3 --rays 0 --knobs traversal --quiet
    fi
done <rows
check "there are rows ($count)" test $count -ge 20

# What is displayed is darker, what is found is not.
expect 0 "light" render "$CUBE" -o light.pfm --size 24x16 --quiet
expect 0 "light, displayed darker" render "$CUBE" -o dark.pfm --size 24x16 --exposure -1 --quiet
check "has the same floats" cmp light.pfm dark.pfm
render_png() { expect 0 "$1" render "$CUBE" -o "$1.png" --size 24x16 --exposure "$2" --quiet; }
render_png usual 0
render_png dark -1
expect 0 "the PNG of it" compare usual.png dark.png --metric mean --json dark.json
check "is darker ($(jq -c .mean dark.json))" jq -e '.mean | type == "array" and all(. < -0.01)' dark.json
flip_of() {
    expect 0 "cost --exposure $1" cost "$CUBE" --size 24x16 --exposure "$1" --spend 0.3 --rays 0 \
        --knobs traversal --json "cost$1.json" --quiet
    flip=$(jq '.rows[0].error.flip' "cost$1.json")
}
flip_of 0
usual=$flip
flip_of -12
check "FLIP is of what is displayed ($usual, $flip)" \
    awk -v a="$usual" -v b="$flip" 'BEGIN { exit !(a > 0 && b < a / 4) }'

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
    --fps-goal*) ;;
    *) check "Ctrl+C: $words" grep -qF -- "$words " line ;;
    esac
done <all.view

{
    echo still
    echo state start
    while IFS=$TAB read -r name value commands _ key _; do
        [ "$key" != - ] || continue
        press=$(test "$key" = = && echo Equal || echo "$key")
        back=$(test "$key" = = && echo Minus || echo "Shift+$key")
        printf 'press %s\nstate %s\npress %s\nstate %s-back\n' "$press" "$name" "$back" "$name"
    done <rows
} >keys
play "keys" "$CUBE" --size 24x16 <keys
while IFS=$TAB read -r name _ _ _ key title _; do
    [ "$key" != - ] || continue
    differs "keys.$title" start "$name"
    same "keys.$title" start "$name-back"
done <rows
finish
