#!/bin/sh
# Runs each example of user functions by its command in docs/shaders.md, with only the size changed: it draws a picture
# that differs from that of the same command without the example.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/here" && cd "$OUT/here" && ln -s "$SCENES" scenes && ln -s "$SCENES/../shaders" shaders || exit 1
commands_of "$SCENES/../docs/shaders.md" Examples >commands
check "each example has a command" test "$(ls shaders/examples)" = \
    "$(sed 's|.* --shader shaders/examples/\([^ ]*\).*|\1|' commands | sort)"
printf '%s\n' still 'press F12' >replay

# drawn COMMAND FILE: the command makes one picture, which is moved to FILE; a window saves its picture by a replay.
drawn() {
    replay=
    case $1 in "whit view "*) replay="--replay replay" ;; esac
    rm -f ./*.png
    # shellcheck disable=SC2086
    run ${1#whit } --size 24x18 --quiet $replay
    check "$1: exit code 0 (got $status)" test "$status" -eq 0
    check "it draws" mv ./*.png "$2"
}
turn=0
while read -r line; do
    turn=$((turn + 1))
    part $turn 5 || continue
    drawn "$line" with
    drawn "$(echo "$line" | sed 's/ --\(shader\|aov\) [^ ]*//g')" without
    run compare with without --metric flip --tolerance 0.001
    check "another picture (got $status)" test "$status" -eq 1
done <commands
finish
