#!/bin/sh
# Measures how long `whit check` takes for 60 pictures of 256x192, the first 60 cases of tests/check/whit.suite:
#     tools/time_check.sh WHIT...
# with empty caches, and then with filled ones; several programs take turns. The first program makes the golden.
set -eu
[ $# -gt 0 ] || { echo "usage: $0 WHIT..." >&2; exit 2; }
root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed -E '/ expect /d; s/--size [0-9]+x[0-9]+/--size 256x192/' "$root/tests/check/whit.suite" >"$work/all.suite"
"$1" check "$work/all.suite" --root "$root" --list | head -n 60 | sed 's/^/--only=/' >"$work/only"

# Prints the seconds to the first line of output, the seconds in all, and the line with the counts.
time_once() {
    export XDG_CACHE_HOME="$work/caches/$2"
    mkdir -p "$XDG_CACHE_HOME"
    start=$(date +%s.%N)
    # shellcheck disable=SC2046 # one option a line
    "$1" check "$work/all.suite" --root "$root" $(cat "$work/only") 2>"$work/said" | {
        read -r _
        first=$(date +%s.%N)
        counts=$(tail -n 1)
        end=$(date +%s.%N)
        echo "$start $first $end" | awk -v name="$3" -v counts="$counts" \
            '{ printf "%s: first verdict %.2f s, all %.2f s; %s\n", name, $2 - $1, $3 - $1, counts }'
    }
}

number=0
for whit; do
    number=$((number + 1))
    time_once "$whit" "$number" "$whit, empty caches"
    # shellcheck disable=SC2046
    [ "$number" -gt 1 ] || XDG_CACHE_HOME="$work/caches/1" "$whit" check "$work/all.suite" --root "$root" \
        $(cat "$work/only") --accept all -q >/dev/null
done
for _ in 1 2 3; do
    number=0
    for whit; do
        number=$((number + 1))
        time_once "$whit" "$number" "$whit, filled caches"
    done
done
