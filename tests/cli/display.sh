#!/bin/sh
# sh display.sh COMMAND...: runs a command on a display of its own, which nobody sees, and exits as
# it does. WHIT_TEST_SCREEN: the size of its screen. Without Xvfb it says `SKIPPED`, which CTest
# reports as such.
if ! command -v Xvfb >/dev/null; then
    echo "SKIPPED: no Xvfb"
    exit 77
fi
folder=$(mktemp -d) || exit 1
mkfifo "$folder/number"
export WHIT_TEST_SCREEN="${WHIT_TEST_SCREEN:-1280x1024}"
# The server finds a number that is free, and says it once it listens.
Xvfb -displayfd 3 -screen 0 "${WHIT_TEST_SCREEN}x24" -nolisten tcp -noreset 3>"$folder/number" \
    2>"$folder/messages" </dev/null >/dev/null &
server=$!
finish() {
    kill "$server" 2>/dev/null
    wait "$server" 2>/dev/null
    rm -rf "$folder"
}
trap finish EXIT
trap 'exit 143' TERM INT
if ! read -r number <"$folder/number"; then
    echo "Xvfb does not start:"
    cat "$folder/messages"
    exit 1
fi
DISPLAY=:$number
export DISPLAY
unset WAYLAND_DISPLAY XAUTHORITY
"$@"
