#!/bin/sh
# The price list of a view: measured beside the window, which goes on.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"

if part 0 2; then
    play "prices" "$CUBE" --size 96x72 --spend 0.1 <<END
before: | price_list.open = false
priced: press P | price_list.open = true | price_list.finished = true | price_list.why = | price_list.broken = 0
    | frame.pixels as before
moved: press 1 | frame.pixels not as priced
stopped: press P x3 | price_list.open = false
END
    check "there are prices ($(value priced price_list.rows))" \
        test "$(value priced price_list.rows)" -ge 8
fi

if part 1 2; then
    # Effects are priced without being switched, by what their switch changes.
    play "effects" "$CUBE" --size 128x96 --ui-scale 0.25 <<END
before:
priced! press X, priced | frame.number as before | words as before
switched: press X, still, press X, choose highlights | words = --size 128x96 --effects -highlights
END
    check "none are priced before ($(value before effect_prices.shadows))" \
        test "$(value before effect_prices.shadows)" != "$(value priced effect_prices.shadows)"
    for effect in highlights point-lights; do
        check "$effect has a price, and changes $(value priced effect_prices.$effect) pixels" \
            awk -v n="$(value priced effect_prices.$effect)" 'BEGIN { exit !(n + 0 > 0) }'
    done
    is switched prices.highlights "$(value priced effect_prices.highlights)"
fi
finish
