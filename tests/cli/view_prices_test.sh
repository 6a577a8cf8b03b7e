#!/bin/sh
# The price list of a view is measured beside the window, which goes on.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"

# has_item LABEL: the panel of prices has drawn the item, inside of its borders.
has_item() {
    awk -F '\t' -v label="$1" '
        $1 == "priced" && $2 == "panels.Prices" { split($3, panel, " ") }
        $1 == "priced" && sub(/^items\./, "", $2) && ($2 == label || (label ~ /,$/ && index($2, label) == 1)) {
            at = $3 }
        END { split(at, place, " "); exit !(at != "" && panel[1] < place[1] && place[1] < panel[3] &&
            panel[2] < place[2] && place[2] < panel[4]) }' "$OUT/values"
}

if part 0 2; then
    play "prices" "$CUBE" --size 160x200 --ui-scale 0.25 --spend 0.1 <<END
before: | price_list.open = false
priced: press P | price_list.open = true | price_list.finished = true | price_list.why = | price_list.broken = 0
    | frame.pixels as before
took: choose 4 | words has --aa 4 | frame.samples = 4 | price_list.open = true
moved: press 1 | frame.pixels not as priced
stopped: press P x3 | price_list.open = false
END
    apart priced 160 200 1
    check "there are prices ($(value priced price_list.rows))" \
        test "$(value priced price_list.rows)" -ge 8
    # The strip shows the time and FLIP of each crop, or that there is none.
    for title in "1/4 the time" "usual time" "4 x the time" "16 x the time"; do
        check "the strip has a crop of $title" has_item "$title,"
    done
    check "the usual one with time and FLIP" grep -q "^priced	items.usual time, [0-9.]* m\?s, FLIP [0-9]" "$OUT/values"
    check "two ends that look the same are one number" \
        sh -c '! grep -q "^priced	items[.].* \([0-9][0-9.e-]*\) to \1[^0-9.e]" "$1"' sh "$OUT/values"
    awk -F '\t' '$1 == "priced" && $2 ~ /^price_list.best[.]/ { print $3 } END { print "usual" }' "$OUT/values" |
        sort -u >"$OUT/names"
    check "the line joins some settings ($(tr '\n' ',' <"$OUT/names"))" test "$(wc -l <"$OUT/names")" -ge 2
    check "and none that the reference cannot judge" test "$(grep -c "aa 16" "$OUT/names")" -eq 0
    while read -r name; do
        check "the line names \`$name\`" has_item "$name"
    done <"$OUT/names"
fi

if part 1 2; then
    # The price of an effect is measured without switching it in the window: it is the change by its switch.
    play "effects" "$CUBE" --size 128x96 --ui-scale 0.25 <<END
before:
priced! press X, priced | frame.number as before | words as before
switched: press X, still, press X, choose highlights | words = --size 128x96 --effects -highlights
    | prices.highlights is effect_prices.highlights of priced
END
    check "none are priced before ($(value before effect_prices.shadows))" \
        test "$(value before effect_prices.shadows)" != "$(value priced effect_prices.shadows)"
    for effect in highlights point-lights; do
        check "$effect has a price, and changes $(value priced effect_prices.$effect) pixels" \
            awk -v n="$(value priced effect_prices.$effect)" 'BEGIN { exit !(n + 0 > 0) }'
    done
fi
finish
