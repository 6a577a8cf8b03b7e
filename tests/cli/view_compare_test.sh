#!/bin/sh
# The comparison of A and B side by side and in figures, effects with prices, settings by mouse and in files.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1
BALLS=$SCENES/balls.json

# columns FILE.pfm FROM TO: prints these columns of a picture of 96 x 64 pixels as text.
columns() {
    tail -c $((96 * 64 * 12)) "$1" | od -An -v -tx4 -w1152 | cut -d ' ' -f "$((3 * $2 + 2))-$((3 * $3 + 4))"
}

# ---- Split ----

if part 0 2; then
    play "A beside B" "$BALLS" --size 96x64 <<END
start: press F2 x2 | compare.mode = off
same: shot b.pfm, press I | compare.mode = split | compare.mixed is frame.pixels of same | compare.other_ids = 0 | compare.other_colors = 0 | compare.flip = 0
sign: press T | compare.other_colors = 0 | compare.count = 6144 | words = --size 96x64 --traversal sign
flat: press T x2, press Minus x8, still, wait 4200 | compare.other_ids = 0 | compare.other_colors > 100
    | compare.b.pixels is frame.pixels of start
ended: shot split.pfm, press I | compare.mode = off | frame.pixels as flat
shot a.pfm
END
    # The window has A on the left and B on the right; the divider is in between.
    columns a.pfm 0 43 >a.left
    columns b.pfm 52 95 >b.right
    columns split.pfm 0 43 >split.left
    columns split.pfm 52 95 >split.right
    columns b.pfm 0 43 >b.left
    check "44 columns of 64 pixels each" test "$(wc -w <a.left)" -eq $((44 * 64 * 3))
    check "A is on the left" cmp a.left split.left
    check "B is on the right" cmp b.right split.right
    check "B is not on the left" test "$(cmp -s b.left split.left; echo $?)" = 1

    # The figures are those of `whit compare` for the pictures that the two lines of `whit render` make.
    renders start -o rendered-b.pfm
    renders flat -o rendered-a.pfm
    expect 0 "whit compare" compare rendered-a.pfm rendered-b.pfm --json c.json
    for pair in largest:.largest flip:.flip.mean; do
        here=$(value flat "compare.${pair%:*}")
        there=$(jq "${pair#*:}" c.json)
        check "${pair%:*} is that of whit compare ($there, $here)" about "$there" "$here"
    done
    for side in a b; do
        tail -c $((96 * 64 * 12)) rendered-$side.pfm | od -An -v -tf4 -w4 >numbers.$side
    done
    mean=$(paste numbers.a numbers.b | awk '{ d = $1 - $2; s += d < 0 ? -d : d } END { print s / NR }')
    here=$(value flat compare.mean)
    check "the mean difference is that of the two pictures ($mean, $here)" about "$mean" "$here" 1e-4
    check "as many pixels differ" test "$(jq .differing_pixels c.json)" = "$(value flat compare.other_colors)"
fi

# ---- Difference, and the divider ----

if part 1 2; then
    play "A minus B" "$BALLS" --size 96x64 --depth 0 <<END
equal: still, press I, press T, press U | compare.other_colors = 0 | compare.scale = 1
press I
press Shift+T
one: still, press I, press Equal
difference: press U | compare.mode = difference | compare.scale > 0
scaled: press ] | compare.heat not as difference | words as one
own: press \\ | compare.heat as difference
order: press T | compare.heat as difference
dragged: press U, move 48 32, button left down, move 24 32, button left up | compare.divider = 0.25 | words as order
turned: move 80 20, button left down, move 90 25, button left up | words not as dragged | frame.pixels not as dragged
    | compare.other_ids = 0 | compare.b.ids is frame.ids of turned
END
    check "] doubles it" about "$(value scaled compare.scale)" "(2 * $(value difference compare.scale))"

    # Costs are numbers, not colours, so that there is no FLIP of their difference.
    play "costs of A and B" "$SCENES/8k.json" --size 96x64 --view visits <<END
costs: still, press I, press T x2 | compare.has_flip = false | compare.other_ids = 0 | compare.other_colors > 0
mixed: press V x3, still, press U | keys.view = stack | compare.known = true
END
fi

# ---- Effects ----

if part 0 2; then
    play "effects by click" "$CUBE" --size 320x240 --ui-scale 0.5 <<END
start: press F2 x2
off: press X, choose shadows | words = --size 320x240 --effects -shadows | change.what = effects auto -> -shadows
    | prices.shadows is change.other_colors of off | prices.highlights = (no prices.highlights)
on: choose shadows | words = --size 320x240 | frame.pixels as start
both: choose highlights, press T | change.what = effects auto -> -highlights, traversal distance -> sign
    | prices.highlights = (no prices.highlights)
END
    play "many effects" "$CUBE" --size 320x240 --ui-scale 0.5 \
        --effects +directional-lights,+environment-map,+smooth-normals,+vertex-colors,+metal-rough,+tinted-shadows <<END
both: press F2 x2, still, press X, choose highlights, press T | change.what has traversal distance -> sign
    | prices.highlights = (no prices.highlights)
END
fi

# ---- Settings by mouse, with the same effect as by keys ----

if part 0 2; then
    play "by mouse" "$CUBE" --size 320x400 --ui-scale 0.5 <<END
key: press F2 x2, press T
mouse: press Shift+T, still, press Tab, still, choose traversal, still, choose sign | words as key
    | keys.traversal as key | words = --size 320x400 --traversal sign | picked = false
menu: choose traversal, still, press Escape | panels.Settings has 129
panel: press Escape | panels.Settings = (no panels.Settings)
END

    # A difference that is too small for any display is not scaled up until it is visible.
    play "last bits" "$BALLS" --size 320x400 --ui-scale 0.5 --depth 1 <<END
last: still, press I, press Tab, still, choose portable, still, choose on, still, press Tab, press U
    | words has --portable on | compare.other_ids = 0 | compare.other_colors > 0
END
    check "the scale ends at what a display shows" about "$(value last compare.scale)" "(1 / 255)"

    # ---- The panel of a pixel stands beside it ----

    play "a pixel" "$CUBE" --size 640x400 --ui-scale 0.5 <<END
left: press F2 x2, click 40 200 | picked = true
right: click 600 200 | picked = true
END
    check "on its right" test "$(value left panels.Pixel | cut -d ' ' -f 1)" -gt 320
    check "and on its left" test "$(value right panels.Pixel | cut -d ' ' -f 3)" -lt 320
fi

# ---- Files of settings ----

if part 1 2; then
    play "a file that comes" "$CUBE" --size 320x400 --ui-scale 0.5 <<END
none: press Tab
do echo "--size 320x400" >whit-0001.view
one: await whit-0001.view, press Tab x2, still, choose files, still, choose whit-0001.view | toast = whit-0001.view: these settings
END
    rm whit-0001.view
    play "saved" "$SCENES/8k.json" --size 96x64 <<END
still
move 40 30
saved! button left down, move 49 33, button left up, press T, press M, press K, press Y, press Minus, press O, press V, still, press Ctrl+S
press Ctrl+S
END
    check "Ctrl+S saves" test -s whit-0001.view
    check "and once more beside" test -s whit-0002.view
    check "one option a line" test "$(grep -c '^--' whit-0001.view)" -eq "$(grep -vc '^#' whit-0001.view)"
    check "as many as there are words" test "$(grep -c '^--' whit-0001.view)" -eq \
        "$(value saved words | grep -o -e ' --' -e '^--' | wc -l)"
    cp "$OUT/values" saved.values
    echo "--numerics exactly" >bad.view
    play "loaded" "$SCENES/8k.json" --state whit-0001.view <<END
loaded:
dropped: press Ctrl+S, press T, press Y, press V, still, drop whit-0001.view
bad! drop bad.view
END
    cat saved.values >>"$OUT/values"
    same words saved loaded
    same words saved dropped
    same words saved bad
    same frame.ids saved loaded
    same frame.pixels saved loaded
    same frame.pixels saved dropped
    check "the message has file and line ($(value bad toast))" \
        test "$(value bad toast | grep -c '^bad.view:1: --numerics `exactly`: one of')" -eq 1
    rm whit-0002.view
    play "a gap in the numbers" "$SCENES/8k.json" --size 320x400 --ui-scale 0.5 <<END
list: press Tab, still, choose files, still, choose whit-0003.view | toast = whit-0003.view: these settings
END
    check "what was loaded is saved as it was" sh -c \
        "grep -v '^#' whit-0001.view >1 && grep -v '^#' whit-0003.view | cmp - 1"
    play "the command line has the last word" "$CUBE" --state whit-0001.view --traversal basic <<END
last:
END
    check "of all words one is another ($(value last words))" test "$(value last words | grep -c -e "--traversal basic .*--numerics")" -eq 1
    # A file that is there stays, also where no number is left.
    seq -f 'whit-%04g.view' 9999 | xargs touch
    rm whit-0007.view
    play "the last number" "$CUBE" --size 96x64 <<END
free: press Ctrl+S | toast = saved as whit-0007.view
none: press Ctrl+S | toast = whit-9999.view could not be saved
END
    check "the last file is as it was" test ! -s whit-9999.view
fi

if part 0 2; then
    # The words have no options that `whit render` refuses together: heat maps of costs with adaptive samples.
    play "adaptive costs" "$CUBE" --size 96x64 --aa adaptive:0.1 <<END
costs: still, press V | error = | frame.view = depth | words = --size 96x64 --view depth
colors: press V x5 | words = --size 96x64 --aa adaptive:0.1
END
fi

# refused WHAT PATTERN LINE...: a file of settings with these lines is refused with PATTERN.
refused() {
    title=$1
    pattern=$2
    shift 2
    printf '%s\n' "$@" >refused.view
    expect 2 "$title" view "$CUBE" --state refused.view --frames 1
    check "$title: says \`$pattern\` ($(cat "$OUT/stderr"))" grep -q "^whit: error: $pattern" "$OUT/stderr"
}
refused "nonsense" 'refused.view:3: there is no option `--numerix`; did you mean `--numerics`?' \
    "# a comment" "" "--numerix exact"
refused "a value" 'refused.view:2: --depth `-1`: a whole number' "--traversal sign" "--depth -1"
refused "a word" 'refused.view:1: `cube.json` is no option' "cube.json"
refused "a quote" 'refused.view:1: a quote has no end' "--camera 'here"
refused "another file" 'refused.view:1: --state is nothing to be saved' "--state refused.view"
refused "two that exclude each other" 'refused.view:.*--time and --frame' "--time 1" "--frame 2"
mkfifo pipe.view
expect 2 "a pipe" view "$CUBE" --state pipe.view --frames 1
check "a pipe: says so" grep -q "pipe.view: cannot be read: it is a folder, a device or a pipe" "$OUT/stderr"
expect 2 "no such file" view "$CUBE" --state nowhere.view --frames 1
check "no such file: says so" grep -q "nowhere.view: cannot be read: No such file" "$OUT/stderr"

finish
