# The tests of the command line source this file: sh TEST WHIT SCENES. A failing check fails the script.
set -u
WHIT=$1
SCENES=$2
FAILED=0
OUT=$(mktemp -d) || exit 1
trap 'rm -rf "$OUT"' EXIT
case $WHIT in */*) WHIT=$(cd "$(dirname "$WHIT")" && pwd)/$(basename "$WHIT") ;; esac
SCENES=$(cd "$SCENES" && pwd)
CUBE=$SCENES/cube.json

OFFSET=${WHIT_TEST_OFFSET:-0}

# With validation layers commands take half as long again. So a quarter of the tests of scripts has them at each commit,
# another quarter at the next, as with tests that are programs (layers_turn.c).
if [ "${WHIT_VALIDATION:-}" = sync ] && [ $(((${WHIT_TEST_TURN:-0} + OFFSET + OFFSET / 8) % 4)) -ne 0 ]; then
    unset WHIT_VALIDATION
fi

# part I N: whether part I of a test runs. A short run has one of the N parts, another one with the next commit; the
# test cli_NAME_long has all.
part() {
    [ -n "${WHIT_TEST_TIMES:-}${WHIT_TEST_ONLY:-}" ] || [ $((($1 + OFFSET) % $2)) -eq 0 ]
}

# needs PROGRAM: skips the test and names the program where it is not installed.
needs() {
    command -v "$1" >/dev/null && return
    echo "SKIPPED: no $1"
    exit 77
}

# check WHAT COMMAND...: the command succeeds.
check() {
    checked=$1
    shift
    if "$@"; then
        echo "ok      $checked"
    else
        echo "FAILED  $checked"
        FAILED=1
    fi
}

# run ARGUMENT...: runs whit; leaves $status, $OUT/stdout and $OUT/stderr.
run() {
    "$WHIT" "$@" >"$OUT/stdout" 2>"$OUT/stderr"
    status=$?
}

# expect CODE WHAT ARGUMENT...: whit exits with CODE.
expect() {
    code=$1
    what=$2
    shift 2
    run "$@"
    check "$what: exit code $code (got $status)" test "$status" -eq "$code"
}

# refuse CODE WHAT PATTERN ARGUMENT...: exits with CODE and says why in one line.
refuse() {
    code=$1
    what=$2
    pattern=$3
    shift 3
    expect "$code" "$what" "$@"
    check "$what: one line" test "$(grep -c . "$OUT/stderr")" -eq 1
    check "$what: says \`$pattern\`" grep -q "^whit: error: .*$pattern" "$OUT/stderr"
}

# holds EXPRESSION: awk's expression of numbers is true.
holds() {
    awk "BEGIN { exit !($1) }"
}

# about A B [SHARE]: two numbers differ by at most SHARE of the first; without SHARE by a millionth.
about() {
    holds "($1 - $2) ^ 2 <= (${3:-1e-6} * $1) ^ 2"
}

# wait_for PID COMMAND...: waits until the command succeeds; fails if the process ends before.
wait_for() {
    awaited=$1
    shift
    until "$@"; do
        kill -0 "$awaited" 2>/dev/null || return 1
        sleep 0.02
    done
}

# gives CODE WHAT PATTERN ARGUMENT...: whit exits with CODE, and standard output has a line with PATTERN.
gives() {
    code=$1
    what=$2
    pattern=$3
    shift 3
    expect "$code" "$what" "$@"
    check "$what: shows \`$pattern\`" grep -q -e "$pattern" "$OUT/stdout"
}

# shows WHAT PATTERN ARGUMENT...: it does so with exit code 0.
shows() {
    gives 0 "$@"
}

# interrupted PID COMMAND...: sends Ctrl+C once the command succeeds; the process then ends with exit code 130.
interrupted() {
    pid=$1
    check "it goes on until $2" wait_for "$@"
    kill -INT "$pid"
    wait "$pid"
    status=$?
    check "Ctrl+C: exit code 130 (got $status)" test $status -eq 130
}

# commands_of PAGE HEAD: prints the commands of whit in that section of a page, in indented lines and in tables, without
# the remarks beside them.
commands_of() {
    sed -n "/^## $2/,/^## /{s/^    \(whit [^#]*\).*/\1/p;s/^|.*| \`\(whit [^\`]*\)\` |\$/\1/p;}" "$1"
}

# is_empty FOLDER: the folder has no file, not even a hidden one.
is_empty() {
    test -z "$(ls -A "$1")"
}

finish() {
    [ "$FAILED" -eq 0 ] || { echo "last messages:"; cat "$OUT/stderr"; }
    exit "$FAILED"
}
