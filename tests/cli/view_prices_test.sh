#!/bin/sh
# The price list of a view: measured beside the window, which goes on.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"

play "prices" "$CUBE" --size 96x72 --spend 0.1 <<END
still
state before
press P
still
state priced
press 1
still
state moved
press P
press P
press P
still
state stopped
END
is before price_list.open false
is priced price_list.open true
is priced price_list.finished true
is priced price_list.why ""
check "there are prices ($(value priced price_list.rows))" \
    test "$(value priced price_list.rows)" -ge 8
is priced price_list.broken 0
same frame.pixels before priced
differs frame.pixels priced moved
is stopped price_list.open false

# Effects are priced without being switched, by what their switch changes.
play "effects" "$CUBE" --size 128x96 --ui-scale 0.25 <<END
still
state before
press X
priced
state priced
shot $OUT/effects.png
press X
still
press X
choose highlights
still
state switched
END
check "none are priced before ($(value before effect_prices.shadows))" \
    test "$(value before effect_prices.shadows)" != "$(value priced effect_prices.shadows)"
same frame.number before priced
same words before priced
for effect in highlights point-lights; do
    check "$effect has a price, and changes $(value priced effect_prices.$effect) pixels" \
        awk -v n="$(value priced effect_prices.$effect)" 'BEGIN { exit !(n + 0 > 0) }'
done
is switched prices.highlights "$(value priced effect_prices.highlights)"
is switched words "--size 128x96 --effects -highlights"
finish
