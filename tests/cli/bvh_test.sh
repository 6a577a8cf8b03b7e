# Checks `whit bvh`: builders side by side, trees in files, and refusals.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
cd "$OUT" || exit 1
SMALL="--runs 1 --rays 2000"
BALL=$OUT/ball.json
printf '{ "objects": [ { "shape": "sphere", "segments": 40, "rings": 20 } ] }\n' >"$BALL"

# has PATTERN: the standard output of the last run matches.
has() {
    grep -q -- "$1" "$OUT/stdout"
}

# ---- Comparisons ----

expect 0 "the default builders" bvh "$BALL" $SMALL --threads 1,2 --validate
check "nothing but the report" test ! -s stderr
check "the scene" has "^scene      $BALL: [0-9]* triangles in 1 instance of 1 mesh$"
check "the device" has "^device     .*"
check "a column a number of threads" has "^builder .* 1t  *2t "
for builder in median binned sweep spatial binned+opt; do
    check "a row for $builder" test "$(grep -c "^$builder  .*[0-9] %" stdout)" -eq 1
    check "details of $builder" test "$(grep -cx "$builder" stdout)" -eq 1
done
check "no hit differs" has "^hits: 0 of [1-9][0-9]* differ$"
check "every tree is valid" test "$(grep -c '^  valid    yes$' stdout)" -eq 5
check "visits are predicted and measured" \
    test "$(grep -c 'inner nodes and .* by areas, .* by 32768 lines' stdout)" -eq 5
for kind in primary shadow diffuse; do
    check "rates of $kind rays" test "$(grep -c "^  $kind  *[0-9.]* Mray/s (" stdout)" -eq 5
done

# Few rows, because a device takes half a second to compile for each.
for option in "--traversal sign --instance-build median" "--load-path texel --instances off"; do
    expect 0 "$option" bvh "$SCENES/many.json" $SMALL --build median,binned:4+opt --threads 2 $option
    check "$option: no hit differs" has "^hits: 0 of [1-9][0-9]* differ$"
done

expect 0 "a list with commas inside" bvh "$BALL" --no-trace --runs 2 \
    --build spatial:1e-6,0.25+opt,spatial:0.5,binned:7
for builder in spatial:1e-06,0.25+opt spatial:0.5 binned:7; do
    check "a row for $builder" has "^$builder  "
done
check "without rays there are no rates" sh -c '! grep -q Mray stdout'

MIXED=$OUT/mixed.json
printf '{ "objects": [ { "shape": "box" }, { "shape": "ball" } ] }\n' >"$MIXED"
for instances in "" "--instances off"; do
    expect 0 "spheres $instances" bvh "$MIXED" --no-trace --runs 1 --build sweep $instances
    check "spheres are no triangles $instances" has "^scene .*: 12 triangles and 1 sphere in 2 instances"
    check "nor in trees $instances" has ", 12 triangles and 1 sphere in 13 references (1.000 each)"
done

expect 0 "leaves of one triangle" bvh "$CUBE" --no-trace --build sweep --leaf 1
check "twelve of them" has "^  of size  1: 12$"

# ---- JSON ----

expect 0 "--json" bvh "$BALL" $SMALL --json --build sweep --threads 1,3
check "three threads" jq -e '.builders[0].build_ms[1].threads == 3' stdout
check "nothing to compare" jq -e '.hits.compared == 0' stdout
expect 0 "--json without rays" bvh "$BALL" --json --no-trace --build median --runs 1
check "no device" jq -e 'has("device") and .device == null' stdout
check "no hits" jq -e 'has("hits") and .hits == null' stdout
check "no rates" jq -e '.builders[0].mrays_per_s | has("diffuse") and .diffuse == null' stdout

# ---- Refusals ----

for list in best "" binned, ,binned binned,,sweep binned:7,300; do
    refuse 2 "--build '$list'" "need" bvh "$CUBE" --build "$list"
done
for list in "" 1, x 1,65 -1; do
    refuse 2 "--threads '$list'" "whole number from 0 to 64" bvh "$CUBE" --threads "$list"
done
refuse 2 "no runs" "from 1 to" bvh "$CUBE" --runs 0
refuse 2 "no rays" "from 1 to" bvh "$CUBE" --rays 0
refuse 2 "no scene" "a scene is missing" bvh
for option in save load; do
    refuse 2 "--$option, which is gone" "option .--$option. is gone: trees are built" bvh "$CUBE" --$option x.bvh
done
refuse 2 "--tree, which is gone" "option .--tree. is gone: trees are built" render "$CUBE" -o b.png --tree=x.bvh
check "no picture" test ! -e b.png

export VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent
expect 0 "no device" bvh "$CUBE" $SMALL --build sweep
check "one note says so" test "$(grep -c "^whit: note: .*no rays are traced" stderr)" -eq 1
check "and nothing else" test "$(grep -c . stderr)" -eq 1
check "the trees are shown" has "^sweep  "
refuse 3 "a device that is not there" "" bvh "$CUBE" --build sweep --device nothing
finish
