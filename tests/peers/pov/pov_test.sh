#!/bin/sh
# whit beside POV-Ray 3.7 on one scene, see scenes.sh for what is set equal:
#     sh pov_test.sh WHIT COMPARE flake|glass|hollow|wine|mesh
# Flat colours of each object (masks) or all of it (colors) with each commit by turns (WHIT_TEST_OFFSET), with
# WHIT_TEST_TIMES both.
# Bounces: POV-Ray counts the eye's ray, and ends rays that add less than adc_bailout.
set -u
whit=$1 compare=$2 name=$3
width=240 height=180 depth=10
[ "$name" = wine ] && depth=2
here=$(cd "$(dirname "$0")" && pwd)
command -v povray >/dev/null || { echo "SKIPPED: no povray (Debian: apt-get install povray)"; exit 0; }
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
failed=0
turn=${WHIT_TEST_OFFSET:-0}
for mode in masks colors; do
    turn=$((turn + 1))
    [ -n "${WHIT_TEST_TIMES:-}" ] || [ $((turn % 2)) -eq 0 ] || continue
    mkdir "$out/$mode" && cd "$out/$mode" || exit 1
    sh "$here/scenes.sh" "$name" $mode $width $height $depth "$out/$mode" || exit 1
    "$whit" render "$name.json" -o whit.pfm --size ${width}x$height --aa 1 --depth $depth \
        --bailout 0.0005 --quiet || exit 1
    HOME=$out povray "+I$name.pov" +Opov.ppm +FP16 +W$width +H$height -A -D File_Gamma=1.0 -GA \
        +WT2 2>"$out/povray" || { cat "$out/povray"; exit 1; }
    printf '%s, %s: ' "$name" $mode
    "$compare" $mode whit.pfm pov.ppm || failed=1
done
exit $failed
