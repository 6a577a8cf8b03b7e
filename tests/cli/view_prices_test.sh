#!/bin/sh
# The price list of a view: measured beside the window, which goes on.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"

play "prices" "$CUBE" --size 96x72 <<END
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
finish
