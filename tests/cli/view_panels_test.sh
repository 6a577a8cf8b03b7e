#!/bin/sh
# sh view_panels_test.sh WHIT SCENES [large]: panels over the picture are in the window with all of their text, and none
# covers another one.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1

# uncut TAG NAME...: in the panels of these states no text is cut on the right.
uncut() {
    tag=$1
    shift
    for state in "$@"; do
        cut=$(grep "^$tag-$state	cut_panels\\." "$OUT/values" | cut -f 2)
        check "at $tag-$state: none is cut ($cut)" test -z "$cut"
    done
}

# opened WIDTH HEIGHT: prints a replay that opens all panels in a window of this size, and closes them.
opened() {
    cat <<END
size $1 $2
still
press F2
state $1x$2-full
$1x$2-split: press F2 x2, press T, press I, press M x2, press B
$1x$2-settings: press Tab
press X
priced
$1x$2-effects:
$1x$2-difference: press U, press X
$1x$2-boxes: press N
$1x$2-help: press H
press H
press U
press I
press B
still
$1x$2-pixel: click 60 50 | picked = true
$1x$2-over: press Tab
$1x$2-most: press F2 x2, press Tab, press X
press F2
press Escape
wait 5000
press N
press N
press M
press Shift+T
END
}
# panels SCALE WIDE SIZE...: checks the panels in windows of these sizes at this scale of text. From the width WIDE on
# there is room for all panels.
panels() {
    scale=$1
    wide=$2
    shift 2
    for size in "$@"; do
        opened "${size%x*}" "${size#*x}"
    done >"$OUT/sizes"
    play "panels at a scale of $scale" "$CUBE" --size 96x64 --ui-scale "$scale" <"$OUT/sizes"
    for size in "$@"; do
        for name in full split settings effects difference boxes help pixel over most; do
            apart "$size-$name" "${size%x*}" "${size#*x}" 1
        done
        uncut "$size" full split settings difference boxes help
        if [ "${size%x*}" -ge "$wide" ]; then
            uncut "$size" effects pixel
            apart "$size-settings" "${size%x*}" "${size#*x}" 6
        fi
    done
}

# At half the scale text fills a window of half the size in the same way. So scales of 0.5 and 2 show any size that does
# not follow the scale.
if [ "${3:-}" = large ]; then
    panels 1 640 320x240 640x480 1280x720
    panels 2 1280 640x480 1280x960
else
    panels 2 1280 640x480
    panels 0.5 320 160x120 320x240 640x360

    # No panel covers the pixel that was clicked, wherever it is.
    for at in "200 300" "300 200" "320 240" "620 30" "30 460"; do
        echo "pixel-${at% *}-${at#* }: click $at | probe.x = ${at% *} | probe.y = ${at#* }"
        echo "closed: press Escape | picked = false"
    done >"$OUT/pixels"
    play "a pixel of a window of 640 x 480" "$CUBE" --ui-scale 1 <"$OUT/pixels"
    over=$(awk -F '\t' 'sub(/^panels\./, "", $2) { split($1, at, "-"); split($3, r, " ")
        if (r[1] <= at[2] && at[2] < r[3] && r[2] <= at[3] && at[3] < r[4]) print $2 " over " $1 }' "$OUT/values")
    check "no panel covers the pixel ($over)" test -z "$over"
    check "its panel is seen each time" test "$(grep -c 'panels.Pixel' "$OUT/values")" = 5

    # Long names wrap.
    sed 's/"cube"/"a_name_that_is_as_long_as_a_modelling_program_makes_them_if_it_is_left_alone"/g' "$CUBE" >long.json
    play "long names in a window of 640 x 480" long.json --size 320x240 --ui-scale 0.5 <<END
long-effects: press X
long-pixel: press X, click 160 120
END
    uncut long effects pixel

    # Figures that gave way to a panel come back beside it when they are fewer.
    play "fewer figures" "$CUBE" --size 640x480 --ui-scale 1 <<END
full: press F2, press Tab
few: press F2 x2
again: press Tab x2 | panels.figures as few | panels.Settings as few
END

    # Each press changes a panel. The window is then drawn often enough that one in place of another can be clicked.
    presses=$(printf 'press 1, wait 1, press 3, wait 1, %.0s' 1 2 3 4 5)
    play "a panel after many changes" "$CUBE" --size 320x320 --ui-scale 0.5 <<END
before: press X
goal: ${presses}press X, press Tab, choose fps goal | fps_goal not as before | picked = false
END
fi
finish
