#!/bin/sh
# Checks `whit hard`: the table, its promises, JSON, options. sh hard_test.sh WHIT SCENES LEAKY UNIT_TEST
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
needs jq
LEAKY=$3
HASH=$(sed -n 's/^#define HASH UINT64_C(0x\(.*\))$/\1/p' "$4")
mkdir "$OUT/files"
J=$OUT/files/hard.json

expect 0 "the built-in cases" hard --rays 1000 --quiet --json "$J" # all rays: cli_hard_whole
check "a table with all levels" \
    test "$(grep -c '^all  *\(fast\|watertight\|exact\) ' "$OUT/stdout")" -eq 3
check "no promise is broken, is said first" test "$(head -1 "$OUT/stdout")" = "promises   0 of 105 rows broke one"
check "the hash is the one that is stored" \
    grep -q "^hash       $HASH .*, met by the device$" "$OUT/stdout"
check "and in the JSON, met" jq -e ".hash == \"$HASH\" and .hash_met == \"$HASH\"" "$J"
# sum LEVEL KEY: prints the sum over all rows of a level.
sum() {
    jq "[.rows[] | select(.numerics == \"$1\") | .$2] | add" "$J"
}
for level in fast watertight exact; do
    check "$level: 35 rows of 1000 rays" test "$(sum $level rays)" -eq 35000
    check "$level: device and twin have the same bits" test "$(sum $level differing)" -eq 0
done
check "fast leaks ($(sum fast leaks))" test "$(sum fast leaks)" -gt 100
check "watertight: nothing is wrong" test "$(sum watertight wrong)" -eq 0
check "exact: nothing is missed" test "$(sum exact misses)" -eq 0
check "exact: no other primitive" test "$(sum exact other_ids)" -eq 0

expect 0 "one level" hard --quick --quiet --numerics watertight
check "is that level alone" test "$(grep -c ' \(fast\|exact\)  ' "$OUT/stdout")" -eq 0
expect 0 "a scene" hard "$CUBE" --quick --quiet --numerics watertight --json "$J"
check "its surface" grep -q "^surface    12 triangles, 18 edges: 0 open" "$OUT/stdout"
check "its variants" grep -q "instance + 1e7" "$OUT/stdout"
check "no hash" test "$(grep -c '^hash' "$OUT/stdout")" -eq 0
expect 0 "some cases" hard --case grid --quick --quiet --numerics fast
check "are those alone" test "$(grep -c ' fast  ' "$OUT/stdout")" -eq 4
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 2 3\n' >"$OUT/open.obj"
expect 0 "an open mesh with a duplicate" hard "$OUT/open.obj" --quick --quiet --numerics watertight
check "is described" grep -q "^surface    3 triangles, .* 1 duplicate" "$OUT/stdout"

"$LEAKY" hard --quick --quiet --numerics watertight --json "$J" >"$OUT/stdout" 2>"$OUT/stderr"
check "a twin that loses rays: exit code 1" test $? -eq 1
check "says so" grep -q "^whit: error: .* rows break a promise" "$OUT/stderr"
check "and where" grep -q " NO$" "$OUT/stdout"
check "the table is in the JSON all the same" jq -e 'any(.rows[]; .kept == false)' "$J"

# The camera is in the middle of the sphere and looks along an axis, so that rays lie in the planes of edges.
V="--view leaks --size 201x151 --camera 0,0,0,1,0,0,0,1,0,90"
expect 0 "a picture at fast" hard $V --numerics fast -o "$OUT/fast.png" --quiet
red=$(sed -n 's/.*: fast: \([0-9]*\) pixels wrong.*/\1/p' "$OUT/stdout")
check "has leaks in it ($red)" test "$red" -gt 0
shows "a picture at watertight" ": watertight: 0 pixels wrong" hard $V -o "$OUT/watertight.png" --quiet
expect 0 "a picture of a scene" hard "$CUBE" --view leaks --size 64x48 -o "$(printf "$OUT/\033.pfm")" --quiet
check "its name steers no terminal" grep -q '/\\u001b.pfm: watertight' "$OUT/stdout"
check "is of that size" test "$(head -c 8 "$(printf "$OUT/\033.pfm")" | tr '\n' ' ')" = "PF 64 48"

rm "$J"
refuse 2 "too few rays" "from 512 to" hard --rays 10
refuse 2 "no such level" "fast, watertight, exact" hard --numerics best
expect 0 "JSON on standard output" hard "$CUBE" --quick --rays 512 --quiet --json /dev/stdout
check "is nothing else" jq -e .rows "$OUT/stdout"
refuse 2 "JSON to a pipe" "/dev/stdout" hard --json -
refuse 2 "JSON nowhere" "nowhere/x" hard --json "$OUT/nowhere/x"
refuse 2 "no such case" "in its name" hard --case goblin --quiet
refuse 2 "a case of a scene" "not of a scene" hard "$CUBE" --case grid
refuse 2 "a view without a file" "go together" hard --view leaks
refuse 2 "a file without a view" "go together" hard -o "$OUT/files/x.png"
refuse 2 "a view and a table" "no table" hard --view leaks -o "$OUT/files/x.png" --quick
refuse 2 "another view" "leaks is needed" hard --view depth -o "$OUT/files/x.png"
refuse 2 "a picture of no kind" "pictures are" hard --view leaks -o "$OUT/files/x.gif"
for option in "--size 9x9" "--camera 0" "--time 1" "--frame 1"; do
    refuse 2 "$option of nothing" "are of --view" hard $option
done
refuse 5 "a time limit" "time limit" hard --rays 200000 --quiet --time-limit 0.5 --json "$J"
check "no file was left" is_empty "$OUT/files"
finish
