# Tests of the viewer source this file after common.sh: it runs replays and checks their states.

needs jq

# Remembered cameras are stored in a folder of this test alone.
XDG_STATE_HOME=$OUT/state
export XDG_STATE_HOME
mkfifo "$OUT/pipe" # for states as they come

# run as in common.sh, but it ends a window that does not end by itself. $INPUT is the standard input of whit.
INPUT=/dev/null
run() {
    timeout $((${LIMIT_S:-100} * ${WHIT_TEST_PATIENCE:-1})) "$WHIT" "$@" <"$INPUT" >"$OUT/stdout" 2>"$OUT/stderr"
    status=$?
}

# read_states: $OUT/states has a line of JSON for each `state NAME`. Writes $OUT/values of it, with lines of NAME, field
# and value, separated by tabs. A field of an object is named as in `frame.ids`.
read_states() {
    jq -r '.at as $at | paths(type != "object") as $path |
        "\($at)\t\($path | join("."))\t\(getpath($path) | tostring | gsub("[\t\n]"; " "))"' \
        "$OUT/states" >"$OUT/values" || FAILED=1
}

# steps: prints the replay of a table, and writes its expectations to $OUT/wanted and its commands to $OUT/commands. A row is
#     NAME: EVENT, EVENT xN | FIELD = VALUE | FIELD > NUMBER | FIELD has PART | FIELD as OTHER | FIELD not as OTHER
#         | FIELD is FIELD of OTHER
# The events come first, each N times, then `still`, then `state NAME`. In that state the field is VALUE, or a larger
# number, or contains PART, or is (or is not) as in the state OTHER, or as another field of that. `NAME!` leaves out
# `still`. A line that begins with
# `|` continues the row before, and `do COMMAND` is what this script does as soon as the state has come; other lines are
# events.
steps() {
    awk -F ' *[|] *' -v wanted="$OUT/wanted" -v commands="$OUT/commands" '
        function expect(    i, at) {
            for (i = 2; i <= NF; ++i) {
                at = match($i, / (=|>|has|as|not as|is)( |$)/) # 0: as_wanted fails
                print name "\t" substr($i, at + 1, RLENGTH - 2 + ($i ~ / =$/)) "\t" substr($i, 1, at - 1) "\t" \
                    substr($i, at + RLENGTH) >wanted
            }
        }
        BEGIN { printf "" >wanted; printf "" >commands }
        /^ *[|]/ { expect(); next }
        sub(/^do /, "") { print name "\t" $0 >commands; next }
        !/^[A-Za-z0-9_-]+[:!]/ { print; next }
        {
            split($1, head, /[:!] */)
            name = head[1]
            count = split(substr($1, length(name) + 3), events, ", ")
            for (i = 1; i <= count; ++i) {
                times = match(events[i], / x[0-9]+$/) ? substr(events[i], RSTART + 2) + 0 : 1
                sub(/ x[0-9]+$/, "", events[i])
                for (n = 0; n < times; ++n) print events[i]
            }
            if (substr($1, length(name) + 1, 1) == ":") print "still"
            print "state " name
            expect()
        }'
}

# play WHAT OPTION...: runs `whit view` with the replay of the table on standard input; its states are as expected.
# Neither whit nor the validation layers print messages, except those that match $EXPECTED.
EXPECTED=
play() {
    what=$1
    shift
    steps >"$OUT/replay"
    rm -rf "$XDG_STATE_HOME"
    : >"$OUT/states"
    timeout $((${LIMIT_S:-100} * ${WHIT_TEST_PATIENCE:-1})) "$WHIT" view "$@" --replay "$OUT/replay" --quiet \
        <"$INPUT" >"$OUT/pipe" 2>"$OUT/stderr" &
    viewer=$!
    while read -r state; do
        printf '%s\n' "$state" >>"$OUT/states"
        at=${state#*\"at\":\"}
        eval "$(awk -F '\t' -v at="${at%%\"*}" '$1 == at { print $2 }' "$OUT/commands")"
    done <"$OUT/pipe"
    wait $viewer
    status=$?
    read_states
    check "$what: exit code 0 (got $status)" test "$status" -eq 0
    test "$status" -eq 0 || sed 's/^/        said: /' "$OUT/stderr"
    check "$what: nothing to complain of" \
        test "$(grep -cv "${EXPECTED:-^$}" "$OUT/stderr")" -eq 0
    check "$what: all states are there" test "$(grep -c '^state' "$OUT/replay")" -eq \
        "$(grep -c '^{.*}$' "$OUT/states")"
    as_wanted
}

# as_wanted: the states in $OUT/values are as the table of the last `steps` expects.
as_wanted() {
    while IFS=$(printf '\t') read -r at how field wanted; do
        has=$(value "$at" "$field")
        case $how in
        =) is "$at" "$field" "$wanted" ;;
        '>') check "at $at: $field is more than $wanted ($has)" holds "$has > $wanted" ;;
        has) check "at $at: $field has \`$wanted\` ($has)" test "${has#*"$wanted"}" != "$has" ;;
        as) same "$field" "$wanted" "$at" ;;
        is) is "$at" "$field" "$(value "${wanted#* of }" "${wanted% of *}")" ;;
        "not as") differs "$field" "$wanted" "$at" ;;
        *) check "at $at: what is \`$field$wanted\`?" false ;;
        esac
    done <"$OUT/wanted"
}

# value NAME FIELD: prints the field of the first state of this name.
value() {
    NAME=$1 FIELD=$2 awk -F '\t' '
        $1 == ENVIRON["NAME"] && $2 == ENVIRON["FIELD"] { print $3; found = 1; exit }
        END { if (!found) print "(no " ENVIRON["FIELD"] ")" }' "$OUT/values"
}

# is NAME FIELD VALUE: the field has this value in the state NAME.
is() {
    has=$(value "$1" "$2")
    check "at $1: $2 is \`$3\` (\`$has\`)" test "$has" = "$3"
}

# same FIELD NAME NAME, differs FIELD NAME NAME: the field is the same, or differs, in two states that both have it.
same() {
    has=$(value "$2" "$1")
    check "$1 is the same at $2 and $3 ($has)" test "$has" = "$(value "$3" "$1")" -a "$has" != "(no $1)"
}
differs() {
    has=$(value "$2" "$1") other=$(value "$3" "$1")
    check "$1 differs from $2 to $3 ($has, $other)" \
        test "$has" != "$other" -a "$has" != "(no $1)" -a "$other" != "(no $1)"
}

# renders NAME OPTION...: runs the `whit render` line of the state, with these options (`-o` among them) behind it.
renders() {
    at=$1
    shift
    eval "run $(value "$at" render | sed -e 's/^whit //' -e 's/ -o picture.png$//') \"\$@\" --quiet"
    check "at $at: the line renders (got $status)" test "$status" -eq 0
}

# apart NAME WIDTH HEIGHT COUNT: the state has at least COUNT panels; all are in the window, and no two overlap.
apart() {
    awk -F '\t' -v name="$1" '$1 == name && sub(/^panels\./, "", $2) { print $2 " : " $3 }' \
        "$OUT/values" >"$OUT/panels"
    overlaps=$(awk -F ' : ' '
        { split($2, r, " "); for (i = 0; i < NR - 1; ++i) if (r[1] < x1[i] && x0[i] < r[3] &&
              r[2] < y1[i] && y0[i] < r[4]) print $1 " and " name[i]
          name[NR - 1] = $1; x0[NR - 1] = r[1]; y0[NR - 1] = r[2]; x1[NR - 1] = r[3]
          y1[NR - 1] = r[4] }' "$OUT/panels")
    outside=$(awk -F ' : ' -v w="$2" -v h="$3" '{ split($2, r, " ")
        if (r[1] < 0 || r[2] < 0 || r[3] > w || r[4] > h) print $1 }' "$OUT/panels")
    check "at $1: $(grep -c . "$OUT/panels") panels, none over another ($overlaps)" test -z "$overlaps"
    check "at $1: none outside ($outside)" test -z "$outside"
    check "at $1: at least $4" test "$(grep -c . "$OUT/panels")" -ge "$4"
}
