#!/bin/sh
# Checks `whit bench`: the list, the tables of the report and of builders on small pictures, refusals, Ctrl+C.
. "$(dirname "$0")/common.sh"
needs jq
mkdir "$OUT/files" "$OUT/tmp"
TMPDIR=$OUT/tmp
export TMPDIR

shows "no bench named" "^report " bench
refuse 2 "a bench that is not there" "did you mean .report" bench reprot
refuse 2 "a folder without scenes" "nowhere/cube.json" bench report --quick --scenes "$OUT/nowhere"
refuse 2 "JSON to a pipe" "tables are printed" bench report --json -
refuse 2 "no runs" "from 1 to 99" bench report --runs 0
refuse 2 "no such model" "nowhere.obj: cannot read" bench look "$OUT/nowhere.obj"
check "before anything is measured" test ! -s "$OUT/stdout"
expect 0 "scenes that are no checkout" bench frame glass --quick --scenes "$OUT/tmp"
check "POV-Ray is left out, which is no error" test ! -s "$OUT/stderr"

J=$OUT/files/figures.json
expect 0 "the report, quick" bench report --quick --scenes "$SCENES" --json "$J"
check "says nothing on a pipe" test ! -s "$OUT/stderr"
check "three tables" test "$(grep -c '^### ' "$OUT/stdout")" -eq 3
check "is said to be quick" grep -q "Quick run" "$OUT/stdout"
for row in "cube, no tree" "34k, no tree .*estimated" "sweep .*249.8" \
    "distance .*33 " "sign .*28 " "binned:7 .*0.328"; do
    check "a row of $row" grep -q "^| $row" "$OUT/stdout"
done
check "the estimate of 34k is explained" grep -q "34k without a tree is estimated" "$OUT/stdout"
check "the quadratic search is quoted" grep -q "took the report 762 times as long" "$OUT/stdout"
check "claims are judged" \
    test "$(grep -cE '^- .*(holds here|does NOT hold here|cannot be told here)' "$OUT/stdout")" -ge 5
check "the figures as JSON" jq -e '.bench == "report" and .tables[0].table == "trees"' "$J"
for key in fps frame_ms build_ms visits_per_ray sah_cost references depth_mean report_fps; do
    check "with $key" jq -e "any(.. | objects; has(\"$key\"))" "$J"
done
# On every machine the orders `distance` and `sign` open fewer nodes than `basic`.
saved=$(awk -F'|' '/^\| basic/ { b = $6 } /^\| distance/ { d = $6 } /^\| sign/ { s = $6 }
    END { print (b > 0 && d + 0 < b + 0 && s + 0 < b + 0) }' "$OUT/stdout")
check "basic opens the most nodes" test "$saved" = 1

# Spatial splits: more references than triangles, and fewer visits where these are long and thin.
B=$OUT/files/builders.json
expect 0 "builders, quick" bench build "$SCENES/strands.json" --quick --runs 1 --json "$B"
check "says nothing on a pipe" test ! -s "$OUT/stderr"
check "strands: more references, fewer visits" jq -e '.bench == "build" and (.tables[0] | .table == "build" and
    .model == "strands.json" and (.rows | map({(.case): .}) | add | .sweep.references == 20002 and
    .spatial.references > 20002 and .spatial.visits_per_ray < .sweep.visits_per_ray))' "$B"
check "time and memory of each" jq -e '.tables[0].rows | length > 2 and all(.one_thread_ms.median > 0 and
    .build_ms.runs == 1 and .bytes_per_triangle > 40)' "$B"
check "Embree, or why not" grep -q "^- Beside Embree\|^- Left out: Embree" "$OUT/stdout"
refuse 2 "no triangles" "balls.json: has no triangles" bench build "$SCENES/balls.json" --quick
check "no scratch files stay" is_empty "$OUT/tmp"

V=$OUT/files/views.json
NAMED=$OUT/$(printf 'c\033\377.json')
cp "$CUBE" "$NAMED"
expect 0 "views, quick, of a file" bench views "$NAMED" --quick --runs 1 --json "$V"
check "its name is shown" grep -qF '| c\u001b\xff.json ' "$OUT/stdout"
check "tiles of a picture and views around, beside it" jq -e '.tables[0].rows | [.[].cameras] == ["tiles", "around"] and
    all(.views_ms.median > 0 and .one_ms.median > 0) and .[0].views == 36 and .[1].views == 9 and .[1].apart_ms.median > 0' "$V"
check "the rays of tiles are those of the picture" jq -e '.tables[0].rows[0].rays_a_pixel | .[0] / .[1] | . > 0.98 and . < 1.02' "$V"

"$WHIT" bench report --runs 99 --scenes "$SCENES" --json "$OUT/files/never" \
    >"$OUT/longer" 2>"$OUT/stderr" &
interrupted $! test -s "$OUT/longer"
check "and no file" test ! -e "$OUT/files/never"
check "no scratch files stay" is_empty "$OUT/tmp"

mkdir "$OUT/rays"
"$WHIT" bench rays "$CUBE" "$SCENES/54k.json" --quick --runs 99 --keep "$OUT/rays" --json "$OUT/part.json" \
    >"$OUT/stdout" 2>"$OUT/stderr" &
interrupted $! test -s "$OUT/rays/54k-camera.rays"
check "rows that are whole are kept" jq -e '[.tables[0].rows[].model] | index("cube") != null' "$OUT/part.json"
check "that others are missing is said" grep -q "^- Interrupted: rows are missing.$" "$OUT/stdout"

# The work is done by whit-bench, a program beside whit or in the installed ../libexec/whit.
mkdir -p "$OUT/alone/bin" "$OUT/alone/libexec/whit"
cp "$WHIT" "$OUT/alone/bin/whit"
PEERED=$WHIT WHIT=$OUT/alone/bin/whit
refuse 2 "no whit-bench" "neither beside this program nor in ../libexec/whit" bench report
expect 0 "which is no error of the list" bench
cp "$(dirname "$PEERED")/whit-bench" "$OUT/alone/libexec/whit/"
refuse 2 "installed it is found" "nowhere/cube.json" bench report --quick --scenes "$OUT/nowhere"
finish
