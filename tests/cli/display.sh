#!/bin/sh
# sh display.sh COMMAND...: runs a command on an invisible display of its own, and exits with the command's exit code.
# WHIT_TEST_SCREEN is the size of the screen. Without Xvfb it prints `SKIPPED`, which CTest reports.
if ! command -v Xvfb >/dev/null; then
    echo "SKIPPED: no Xvfb"
    exit 77
fi
folder=$(mktemp -d) || exit 1
mkfifo "$folder/number"
export WHIT_TEST_SCREEN="${WHIT_TEST_SCREEN:-1280x1024}"
# The server chooses a free number, and writes it as soon as it listens.
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
