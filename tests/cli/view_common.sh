# Sourced, behind common.sh, by the tests of the viewer: replays, and what they leave.

# Cameras that were remembered are this test's own.
XDG_STATE_HOME=$OUT/state
export XDG_STATE_HOME

# As in common.sh, but a window that does not end is ended.
run() {
    timeout $((100 * ${WHIT_TEST_PATIENCE:-1})) "$WHIT" "$@" >"$OUT/stdout" 2>"$OUT/stderr"
    status=$?
}

# play WHAT OPTION...: `whit view` with the replay on standard input. Leaves $OUT/states, one line
# of JSON for each `state NAME`. Neither whit nor the validation layers may complain.
play() {
    what=$1
    shift
    cat >"$OUT/replay"
    rm -rf "$XDG_STATE_HOME"
    run view "$@" --replay "$OUT/replay" --quiet
    cp "$OUT/stdout" "$OUT/states"
    check "$what: exit code 0 (got $status)" test "$status" -eq 0
    check "$what: nothing to complain of" test ! -s "$OUT/stderr"
    check "$what: all states are there" test "$(grep -c '^state' "$OUT/replay")" -eq \
        "$(grep -c '^{.*}$' "$OUT/states")"
}

# value NAME FIELD: of the state NAME. A FIELD of an object is `frame.ids`.
value() {
    awk -v name="\"at\":\"$1\"," -v path="$2" '
        function object_of(text,    depth, i, c) {
            for (i = 1; i <= length(text); ++i) {
                c = substr(text, i, 1)
                depth += (c == "{") - (c == "}")
                if (depth == 0)
                    return substr(text, 1, i)
            }
            return text
        }
        index($0, name) {
            count = split(path, part, ".")
            text = $0
            for (i = 1; i <= count; ++i) {
                at = index(text, "\"" part[i] "\":")
                if (!at) { print "(no " path ")"; exit }
                text = substr(text, at + length(part[i]) + 3)
                if (substr(text, 1, 1) == "{")
                    text = object_of(text)
            }
            if (substr(text, 1, 1) == "\"") {
                text = substr(text, 2)
                match(text, /^([^"\\]|\\.)*/)
            } else {
                match(text, /^[^,}]*/)
            }
            print substr(text, 1, RLENGTH)
            exit
        }' "$OUT/states"
}

# is NAME FIELD VALUE: the state NAME has it.
is() {
    check "at $1: $2 is \`$3\` (\`$(value "$1" "$2")\`)" test "$(value "$1" "$2")" = "$3"
}

# same FIELD NAME NAME, differs FIELD NAME NAME: of two states.
same() {
    check "$1 is the same at $2 and $3 ($(value "$2" "$1"))" \
        test "$(value "$2" "$1")" = "$(value "$3" "$1")"
}
differs() {
    check "$1 differs from $2 to $3" test "$(value "$2" "$1")" != "$(value "$3" "$1")"
}

# renders NAME: the `whit render` line of the state makes, byte for byte, the picture of the window.
renders() {
    value "$1" render | sed -e 's/^whit //' -e 's/ -o picture.png$//' >"$OUT/line"
    eval "run $(cat "$OUT/line") -o '$OUT/rendered.pfm' --ids '$OUT/rendered.exr' --quiet"
    check "at $1: the line renders (got $status)" test "$status" -eq 0
}
