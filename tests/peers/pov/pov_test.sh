#!/bin/sh
# whit beside POV-Ray 3.7, see scenes.sh for what is set equal:
#     sh pov_test.sh WHIT COMPARE flake|glass|hollow|wine|mesh...
# Flat colours of each object (masks) or all of it (colors). Of several scenes two have their turn with a commit, each in
# one of these ways (WHIT_TEST_OFFSET); with WHIT_TEST_TIMES all in both.
# Bounces: POV-Ray counts the eye's ray, and ends rays that add less than adc_bailout.
set -u
whit=$1 compare=$2
shift 2
width=240 height=180
here=$(cd "$(dirname "$0")" && pwd)
command -v povray >/dev/null || { echo "SKIPPED: no povray (Debian: apt-get install povray)"; exit 0; }
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
failed=0
offset=${WHIT_TEST_OFFSET:-0}

# NAME masks|colors
compare_one() {
    depth=10
    [ "$1" = wine ] && depth=2
    mkdir "$out/$1.$2" && cd "$out/$1.$2" || exit 1
    sh "$here/scenes.sh" "$1" "$2" $width $height $depth "$out/$1.$2" || exit 1
    "$whit" render "$1.json" -o whit.pfm --size ${width}x$height --aa 1 --depth $depth \
        --bailout 0.0005 --quiet || exit 1
    HOME=$out povray "+I$1.pov" +Opov.ppm +FP16 +W$width +H$height -A -D File_Gamma=1.0 -GA \
        +WT2 2>"$out/povray" || { cat "$out/povray"; exit 1; }
    printf '%s, %s: ' "$1" "$2"
    "$compare" "$2" whit.pfm pov.ppm || failed=1
}

scene=0
for name; do
    scene=$((scene + 1))
    for way in 0 1; do
        turn=$((scene + offset))
        [ -n "${WHIT_TEST_TIMES:-}" ] || { [ $((turn % 5)) -lt 2 ] && [ $(((turn / 5 + way) % 2)) -eq 0 ]; } || continue
        if [ $way -eq 0 ]; then compare_one "$name" masks; else compare_one "$name" colors; fi
    done
done
exit $failed
