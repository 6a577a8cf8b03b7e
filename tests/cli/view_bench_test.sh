#!/bin/sh
# sh view_bench_test.sh WHIT SCENES [figures]: `whit bench view`, the table and its JSON, on small pictures; no display.
# `figures`: each figure is a number, which is not so on a machine that is busy.
. "$(dirname "$0")/common.sh"
needs jq
FIGURES=${3:-}
mkdir "$OUT/files" "$OUT/tmp"
TMPDIR=$OUT/tmp
export TMPDIR

J=$OUT/files/figures.json
expect 0 "the viewer, quick" bench view --quick --scenes "$SCENES" --json "$J"
check "says nothing on a pipe" test ! -s "$OUT/stderr"
rows=$(jq -r '.tables[0].rows[] | "\(.scene), \(.case)"' "$J")
for row in "cube, full" "34k, with shadows" "34k, full" "54k, full" "default, full"; do
    check "a row of $row" grep -q "^| $row" "$OUT/stdout"
    check "and one as JSON" test "$(echo "$rows" | grep -cxF "$row")" -eq 1
done
check "how busy the machine is" grep -q "Load average" "$OUT/stdout"
# holds FILTER: jq's filter is true for the JSON.
holds() {
    jq -e "$1" "$J" >/dev/null
}
# every WHAT FILTER: jq's filter is true for each row.
every() {
    check "$1" holds ".tables[0].rows | all($2)"
}
check "the figures as JSON" holds '.bench == "view" and .tables[0].table == "view"'
for key in first_ms idle_share; do
    every "with $key" "has(\"$key\")"
done
for key in whole_ms quick_ms gap_ms latency_ms present_ms; do
    every "with $key" ".moving.$key | has(\"count\") and has(\"median\") and has(\"p95\") and has(\"max\")"
done
every "with gaps_over_100_ms" '.moving | has("gaps_over_100_ms")'
every "a first picture, whole ones" \
    '.first_ms > 0 and .whole.whole_ms.count > 0 and .whole.whole_ms.median > 0'
check "what it must reach" holds '.tables[1].table == "view_goals" and [.tables[1].rows[] | [.viewer, .must, .aim]] ==
    [["34k, whole pictures", 8, 17], ["default moving, size 1/N", 6, 4], ["default moving", 30, 30]]'
check "with verdicts" holds '.tables[1].rows | all((.figure | type == "number") and
    .verdict == if (.more_is_better and .figure >= .must) or (.more_is_better | not) and .figure <= .must
        then "held" else "short" end)'
if [ "$FIGURES" = figures ]; then
    every "pictures while it moves, and who waited for them" \
        '.moving.quick_ms.median > 0 and .moving.latency_ms.median > 0'
    every "the idle window leaves the machine alone" '.idle_share < 0.5'
fi
MODEL=$OUT/corner.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\n' >"$MODEL"
refuse 2 "looks at nothing" "takes the files of models" bench look --quick --scenes "$SCENES"
expect 0 "looks, quick" bench look "$MODEL" "$CUBE" --quick --scenes "$SCENES" --json "$OUT/looks.json"
check "at the first picture, the whole one, and that of a scene at rest" jq -e '.tables[0].rows | [.[] | .picture, .must] ==
    ["first", 0.4, "whole", 1.2, "first", 0.4, "whole", 1.6, "16 samples", 22] and all(.ms.median > 0 and .ms.runs == 2 and .narrowest > 0 and .unit == "s") and
    .[1].ms.median >= .[0].ms.median' "$OUT/looks.json"
if [ "$FIGURES" = figures ]; then
    J=$OUT/files/shaders.json
    expect 0 "saves of a shader, quick" bench shaders cube 34k --quick --runs 2 --scenes "$SCENES" --json "$J"
    check "each function" holds '[.tables[0].rows[].function] == (["shade", "surface", "miss", "aov", "post", "shade, lit", "shade, visible", "intersect"] | . + .)'
    every "from a save on" '.first_ms.p50 > 0 and .whole_ms.p95 >= .first_ms.p50 and .whole_ms.runs == 2'
    for key in gap_over_ms gap_drags_ms gap_pictures_ms; do
        every "with $key" ".scene == \"34k\" or .$key.saved > 0 and .$key.alone > 0"
    done
    check "fuel beside none" grep -q "^- cube, two loops .* with --trust; the median ratio is [0-9]" "$OUT/stdout"
    check "time to an error" grep -q "^- cube, from a save to its error in the window: p50 [0-9].* of 2\.$" "$OUT/stdout"
    check "what saves must reach" holds '.tables[1].table == "shaders_goals" and
        [.tables[1].rows[] | [.save, .must]] == ([("shade", "surface", "miss", "aov", "post", "shade, lit") | ["34k, \(.): first", 0.15], ["34k, \(.): whole", 0.6]] +
        [["34k, shade, visible: first", 0.35], ["34k, shade, visible: whole", 0.6], ["34k, intersect: first", 0.35], ["34k, intersect: whole", 1.2], ["34k: error", 0.05], ["34k: fuel, median", 1.02], ["34k: 1000 checks", 2]])'
    check "a thousand checks" grep -q "^- cube, 1000 checks of 4096 seeds, .* of 2\.$" "$OUT/stdout"
    check "with verdicts of 95 of 100" holds '[.tables[1].rows[:-3][].figure * 1000 | round] == [.tables[0].rows[] | select(.scene == "34k") | (.first_ms, .whole_ms).p95 | round] and
        (.tables[1].rows | all(.verdict == if .figure <= .must then "held" else "short" end))'
    rm "$J"
fi
check "no scratch files stay" is_empty "$OUT/tmp"
unset DISPLAY
expect 3 "no display" bench view --quick --scenes "$SCENES" --json "$OUT/files/never"
for bench in view shaders; do
    refuse 3 "no display for $bench" "this bench needs a window.*xvfb-run" bench $bench --quick --scenes "$SCENES"
done
refuse 3 "no display for look" "this bench needs a window.*xvfb-run" bench look "$MODEL" --quick --scenes "$SCENES"
check "and why" grep -q "DISPLAY environment variable is missing" "$OUT/stderr"
check "in one error" test "$(grep -c . "$OUT/stderr")" -eq 1
check "and no file" test "$(ls -A "$OUT/files")" = figures.json
check "no scratch files stay" is_empty "$OUT/tmp"
finish
