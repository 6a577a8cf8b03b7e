#!/bin/sh
# Panels over the picture: all of what they say is in the window, and none covers another one.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1

# apart NAME: no two panels of the state overlap.
apart() {
    sed -n "/\"at\":\"$1\",/s/.*\"panels\":{\([^}]*\)}.*/\1/p" "$OUT/states" | tr ',' '\n' |
        sed 's/"//g; s/:/ : /' >"$OUT/panels"
    overlaps=$(awk -F ' : ' '
        { split($2, r, " "); for (i = 0; i < NR - 1; ++i) if (r[1] < x1[i] && x0[i] < r[3] &&
              r[2] < y1[i] && y0[i] < r[4]) print $1 " and " name[i]
          name[NR - 1] = $1; x0[NR - 1] = r[1]; y0[NR - 1] = r[2]; x1[NR - 1] = r[3]
          y1[NR - 1] = r[4] }' "$OUT/panels")
    outside=$(awk -F ' : ' -v w="$2" -v h="$3" '{ split($2, r, " ")
        if (r[1] < 0 || r[2] < 0 || r[3] > w || r[4] > h) print $1 }' "$OUT/panels")
    check "at $1: $(grep -c . "$OUT/panels") panels, none over another ($overlaps)" test -z "$overlaps"
    check "at $1: none outside ($outside)" test -z "$outside"
    check "at $1: at least $4" test "$(grep -c . "$OUT/panels")" -ge "$4"
}
# uncut NAME...: nobody has to scroll sideways in the panels of these states.
uncut() {
    for state in "$@"; do
        cut=$(sed -n "/\"at\":\"$state\",/s/.*\"cut_panels\":{\([^}]*\)}.*/\1/p" "$OUT/states")
        check "at $state: none is cut ($cut)" test -z "$cut"
    done
}

# Small and large; at 2 as large as 320x240 is at 1.
for case in "320 240 1" "640 480 1" "640 480 2" "1280 720 1" "1280 960 2"; do
    # shellcheck disable=SC2086
    set -- $case
    tag=$1x$2-$3
    play "panels, $1 x $2 at a scale of $3" "$CUBE" --size "$1x$2" --ui-scale "$3" <<END
still
press F2
state full
press F2
press F2
press T
press C
press M
press B
still
shot split-$tag.png
state split
press Tab
still
shot settings-$tag.png
state settings
press X
still
shot effects-$tag.png
state effects
press D
press X
still
state difference
press N
still
state boxes
press H
still
shot help-$tag.png
state help
press H
press D
press C
click 60 50
still
state pixel
END
    for name in full split settings effects difference boxes help pixel; do
        apart $name "$1" "$2" 1
    done
    uncut full split settings difference boxes help
    if [ $(($1 / $3)) -ge 640 ]; then
        uncut effects pixel
        apart settings "$1" "$2" 6
    fi
done
finish
