#!/bin/sh
# --view draws the costs of traversals: heat maps, raw numbers, and the same numbers in --stats.
. "$(dirname "$0")/common.sh"
needs jq
mkdir "$OUT/pictures"
P=$OUT/pictures
SCENE=$SCENES/balls.json
SIZE=96x64

# numbers FILE.pfm: prints all pixels, one in a line (a PFM of one channel has three lines of text, then floats).
numbers() {
    tail -c $((96 * 64 * 4)) "$1" | od -An -v -tf4 -w4
}
# figure FIELD: prints a field of the costs of camera rays from --stats.
figure() {
    jq ".costs.primary.$1" "$OUT/visits.json"
}

for view in depth visits boxes tris stack; do
    expect 0 "--view $view" render "$SCENE" -o "$P/$view.pfm" --size $SIZE --view $view --stats json
    cp "$OUT/stdout" "$OUT/$view.json"
    check "--view $view: one channel" grep -aq '^Pf$' "$P/$view.pfm"
    numbers "$P/$view.pfm" >"$OUT/$view.txt"
done
most() { sort -g "$OUT/$1.txt" | tail -1 | awk '{ print $1 + 0 }'; }
sum() { awk '{ s += $1 } END { printf "%.6g", s }' "$OUT/$1.txt"; }
check "the picture's deepest level is that of --stats" \
    test "$(most depth)" = "$(figure max.depth)"
check "its fullest stack too" test "$(most stack)" = "$(figure max.stack)"
check "its most box tests too" test "$(most boxes)" = "$(figure max.boxes)"
check "its most triangle tests too" test "$(most tris)" = "$(figure max.triangles)"
rays=$(figure rays)
check "one camera ray a pixel ($rays)" test "$rays" = 6144
for pair in boxes:boxes tris:triangles depth:depth stack:stack; do
    mean=$(figure "mean.${pair#*:}")
    same=$(awk -v sum="$(sum "${pair%:*}")" -v mean="$mean" 'BEGIN {
        d = sum / 6144 - mean; print (mean > 0 && d * d < 1e-8 * mean * mean) }')
    check "mean ${pair%:*} of the picture and of --stats ($mean)" test "$same" = 1
done
visits=$(for name in inner_nodes leaves instances; do figure mean.$name; done |
    awk -v sum="$(sum visits)" '{ v += $1 } END { d = sum / 6144 - v; print (d * d < 1e-8 * v * v) }')
check "visits are inner nodes, leaves and instances" test "$visits" = 1

# --view-rays chooses the kind of rays.
for kind in shadow reflected refracted all; do
    expect 0 "--view-rays $kind" render "$SCENE" -o "$P/$kind.pfm" --size $SIZE --view boxes \
        --view-rays $kind --quiet
    numbers "$P/$kind.pfm" >"$OUT/$kind.txt"
done
check "all kinds together are their sum" test "$(paste "$OUT/boxes.txt" "$OUT/shadow.txt" \
    "$OUT/reflected.txt" "$OUT/refracted.txt" "$OUT/all.txt" |
    awk '$1 + $2 + $3 + $4 != $5 { ++bad } END { print bad + 0 }')" = 0
check "some shadow rays were traced" test "$(sum shadow)" != 0
check "some refracted ones too" test "$(sum refracted)" != 0
expect 0 "without bounces" render "$SCENE" -o "$P/none.pfm" --size $SIZE --view boxes \
    --view-rays refracted --depth 0 --quiet
check "nothing is refracted" test "$(numbers "$P/none.pfm" | sort -u | wc -l)" = 1

# Heat maps.
expect 0 "a heat map" render "$SCENE" -o "$P/heat.png" --size $SIZE --view visits --quiet
check "says what it shows" grep -aq '"view":"visits","rays":"primary","scale":' "$P/heat.png"
check "and how to make it" grep -aq -- '--view visits -o whit.png' "$P/heat.png"
expect 0 "once more" render "$SCENE" -o "$P/again.png" --size $SIZE --view visits --quiet --tile-size 16
check "the same bytes" cmp "$P/heat.png" "$P/again.png"
expect 0 "another scale" render "$SCENE" -o "$P/scale.png" --size $SIZE --view visits \
    --view-scale 200 --quiet
check "is another picture" test "$(cmp -s "$P/heat.png" "$P/scale.png"; echo $?)" = 1
check "and says so" grep -aq '"scale":200' "$P/scale.png"
expect 0 "another order" render "$SCENE" -o "$P/order.pfm" --size $SIZE --view visits \
    --traversal basic --quiet
check "costs something else" test "$(cmp -s "$P/visits.pfm" "$P/order.pfm"; echo $?)" = 1
expect 0 "one pixel" render "$SCENE" -o "$P/one.png" --size 1x1 --view stack --quiet

# Counting does not change colours.
expect 0 "colours" render "$SCENE" -o "$P/color.pfm" --size $SIZE --quiet --view color
expect 0 "colours and counters" render "$SCENE" -o "$P/counted.pfm" --size $SIZE --counters
check "are the same" cmp "$P/color.pfm" "$P/counted.pfm"
check "costs as text" grep -q "^  refracted  *[1-9]" "$OUT/stdout"
expect 0 "no counters" render "$SCENE" -o "$P/color.pfm" --size $SIZE --stats json
check "no costs" test "$(grep -c '"costs"' "$OUT/stdout")" -eq 0

refuse 2 "an unknown view" "color, depth, visits" render "$SCENE" -o "$P/x.png" --view heat
refuse 2 "unknown rays" "primary, shadow" render "$SCENE" -o "$P/x.png" --view tris --view-rays eye
refuse 2 "a scale of 0" "a number from" render "$SCENE" -o "$P/x.png" --view tris --view-scale 0
refuse 2 "rays without a view" "nothing to count" render "$SCENE" -o "$P/x.png" --view-rays all
finish
