#!/bin/sh
# The tests that a change can reach, unit tests first, for up to a minute; tools/test --quick calls it.
#     tools/test_quick.sh ROOT FOLDER [COMMIT]
# FOLDER is where Ninja built ROOT: Ninja knows the inputs of each program, included headers among them.
# COMMIT is by default HEAD where there are uncommitted changes, else HEAD~1. The last line says how many of
# the tests that the change can reach were run. Exit code 1 where one failed.
set -eu
root=$1
folder=$2
commit=${3:-}
if [ -z "$commit" ]; then
    commit=HEAD
    [ -n "$(git -C "$root" status --porcelain)" ] || commit=HEAD~1
fi
git -C "$root" rev-parse --verify --quiet "$commit^{commit}" >/dev/null || {
    echo "tools/test: there is no commit $commit" >&2
    exit 2
}
limit_s=60
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# write_stale: writes $work/stale: the paths that differ from COMMIT, new files included, the objects that
# were compiled from them or include them, and the scripts that source them.
write_stale() {
    {
        git -C "$root" diff --name-only "$commit"
        git -C "$root" ls-files --others --exclude-standard
    } | sed "s|^|$root/|" >"$work/changed"
    {
        cat "$work/changed"
        ninja -C "$folder" -t deps | awk -v list="$work/changed" '
            BEGIN { while ((getline path < list) > 0) changed[path] = 1 }
            /^[^ ]/ { object = $0; sub(/: #deps.*/, "", object) }
            /^ / && ($1 in changed) { print object }'
        grep '\.sh$' "$work/changed" | while read -r path; do
            grep -lF "/$(basename "$path")\"" "$(dirname "$path")"/*.sh || :
        done
    } | sort -u >"$work/stale"
}

# is_stale WORD: whether WORD, a word of a test's command, is a program made from a stale file, a stale file
# itself, or a folder with a stale file in it.
is_stale() {
    case $1 in
    "$folder"/*) ninja -C "$folder" -t inputs "${1#"$folder"/}" 2>/dev/null | grep -qxFf "$work/stale" ;;
    "$root" | "$root"/*) grep -qxF "$1" "$work/stale" || grep -qF "$1/" "$work/stale" ;;
    *) false ;;
    esac
}

# write_reached: writes $work/reached: the names of the tests with a stale word in their command, those
# without a device first. Where a file of CMake changed, these are all tests.
write_reached() {
    ctest --test-dir "$folder" --show-only=json-v1 -LE long >"$work/tests.json"
    jq -r '.tests[].command[]? | split("=")[-1]' "$work/tests.json" | sort -u | while read -r word; do
        if [ -e "$word" ] && is_stale "$word"; then
            echo "$word"
        fi
    done >"$work/words"
    every=false
    ! grep -qE '(CMakeLists\.txt|\.cmake|CMakePresets\.json)$' "$work/changed" || every=true
    jq -r --rawfile words "$work/words" --argjson every $every '
        ($words | split("\n") | map({(.): true}) | add) as $stale
        | [.tests[] | select($every or any(.command[]?; $stale[split("=")[-1]]))
           | {name, labels: [.properties[] | select(.name == "LABELS") | .value[]]}]
        | sort_by(.labels | if index("source") then 0 elif index("unit") then 1 else 2 end)
        | .[].name' "$work/tests.json" >"$work/reached"
}

# run_one NAME END_S: runs a test until END_S, a time of `date +%s`, at which it is stopped; later it is not
# begun. Leaves $work/passed-NAME, failed-NAME or skipped-NAME, or none of them where it was stopped.
cat >"$work/run_one" <<'END'
left_s=$(($2 - $(date +%s)))
[ "$left_s" -gt 0 ] || exit 0
code=0
timeout "$left_s" ctest --test-dir "$FOLDER" --output-on-failure -R "^$1\$" >"$WORK/log-$1" 2>&1 || code=$?
[ $code -ne 124 ] || exit 0
result=passed
if [ $code -ne 0 ]; then
    cat "$WORK/log-$1"
    result=failed
elif grep -q '\*\*\*Skipped' "$WORK/log-$1"; then
    result=skipped
fi
: >"$WORK/$result-$1"
echo "$result  $1"
END

count() {
    find "$work" -name "$1-*" | wc -l
}

write_stale
write_reached
FOLDER=$folder WORK=$work xargs -a "$work/reached" -P 2 -I '{}' \
    sh "$work/run_one" '{}' $(($(date +%s) + limit_s))
passed=$(count passed)
failed=$(count failed)
skipped=$(count skipped)
echo "$passed passed, $failed failed, $skipped skipped"
echo "$((passed + failed + skipped)) of the $(wc -l <"$work/reached") tests ran that the change since" \
    "$(git -C "$root" rev-parse --short "$commit") can reach, in at most $limit_s s. ./tools/test runs all" \
    "$(jq '.tests | length' "$work/tests.json")."
[ "$failed" -eq 0 ]
