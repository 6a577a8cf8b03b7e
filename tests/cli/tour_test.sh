#!/bin/sh
# The README is right: its C program makes a picture, and the commands of "Functions of your own" work as they stand
# there; with `tour` each command of its tour ends within 20 s. tour_test.sh WHIT SCENES EXAMPLE [tour]
. "$(dirname "$0")/common.sh"
EXAMPLE=$3
README=$SCENES/../README.md
mkdir "$OUT/here" && cd "$OUT/here" && ln -s "$SCENES" scenes || exit 1
# The program frees nothing before it ends, so the leak check is off.
check "the C program of the README ends well" \
    env "ASAN_OPTIONS=${ASAN_OPTIONS:-}:detect_leaks=0" "$EXAMPLE"
expect 0 "the picture by the program" render scenes/cube.json -o own.png --quiet
expect 0 "is the same" compare cube.png own.png --metric differing --tolerance 0
PATH=$(dirname "$WHIT"):$PATH
export PATH

# ---- Functions of your own ----

if part 0 4; then
    ln -s "$SCENES/../shaders" shaders
    sed -n '/^## Functions of your own/,/^## [^F]/p' "$README" >section
    check "the section has 20 lines at most" test "$(grep -c . section)" -le 21 # and the next head
    commands_of "$README" "Functions of your own" >commands
    check "it has three commands" test "$(cut -d ' ' -f 2 commands | tr '\n' ' ')" = "shader view render "
    # Each command runs in a shell as it stands there; the window runs a replay.
    while read -r line; do
        case $line in
        "whit view "*)
            command -v Xvfb >/dev/null && "$WHIT" view --help >help || { echo "SKIPPED: no Xvfb, or no viewer: $line" && continue; }
            echo 'vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.ns; }' >edited
            mkfifo pipe
            printf '%s\n' still 'state before' "until shader.first = 1" still 'state after' >replay
            sh "$(dirname "$0")/display.sh" timeout 60 $line --size 160x100 --quiet --replay replay >pipe 2>"$OUT/stderr" &
            while read -r state; do
                echo "$state" >>states
                case $state in *'"at":"before"'*) cp edited my.glsl ;; esac # edit and save it
            done <pipe
            wait $!
            check "$line" test $? -eq 0
            check "the window follows" test "$(grep -o '"pixels": *"[0-9a-f]*"' states | sort -u | wc -l)" -eq 2
            check "without an error" test "$(grep -c '"error": *""' states)" -eq 2
            ;;
        *) check "$line" sh -c "$line" ;;
        esac
    done <commands
    check "its picture is there" test -s toon.png
fi
[ "${4:-}" = tour ] || finish

# ---- The tour ----

commands_of "$README" "A tour" >commands
check "the tour has ten commands or more" test "$(grep -c . commands)" -ge 10
check "and 25 lines at most" test "$(sed -n '/^## A tour/,/^## /s/^    //p' "$README" | grep -c .)" -le 25
grep -v "^whit view" commands >ended
while read -r line; do
    # shellcheck disable=SC2086
    check "$line" timeout 20 $line >said 2>&1 </dev/null
    cat said >>"$OUT/stderr"
    grep -E "^(ok|FAILED)" said
    grep -q "^FAILED" said && FAILED=1
done <ended
finish
