#!/bin/sh
# Checks `whit cost`: rows, errors, answers, files (for Ctrl+C see fault_stop_cost). The third argument is a whit with
# clocks of its own, so that nothing here depends on the speed of the machine, and with the fault that WHIT_TEST_WRONG
# names. With `all` as the fourth argument also choices by kept figures, and for a time that slow pictures exceed.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
needs jq
. "$(dirname "$0")/cost_common.sh"
RIGHT=$WHIT
J=$OUT/files/cost.json
# A ball of glass beside a mirror: the scene has rays of the same kinds as whitted.json, but fewer.
GLASS=$OUT/glass.json
cat >"$GLASS" <<'JSON'
{ "camera": { "eye": [0, 1, 4], "target": [0, 0.5, 0] },
  "materials": { "glass": { "transmission": 0.9, "ior": 1.5 }, "mirror": { "reflection": 0.8 } },
  "objects": [ { "shape": "plane", "size": 10 },
    { "shape": "ball", "radius": 0.5, "material": "glass", "translation": [-0.6, 0.5, 0] },
    { "shape": "box", "material": "mirror", "translation": [0.6, 0.5, 0], "rotation": [0, 30, 0] } ] }
JSON
small="--size 48x36 --quick --rays 600 --quiet --spend 0.1"

C=$OUT/files/cost.csv
D=$OUT/files/other.csv
if part 0 2; then
    expect 0 "a scene" cost "$CUBE" $small --reference-samples 4 --knobs aa,light-samples --within 1e6 --json "$J"
    check "--within anything is kept" grep -q "^Best picture within 1e+06 ms: .*: kept" "$OUT/stdout"
    check "the JSON names its device and is whole" jq -e '(.device | length > 0) and
        (.driver | length > 0) and (.command | startswith("whit cost ")) and .complete and
        .reference.samples == 4 and all(.rows[]; .measured) and
        ([.rows[] | keys] | unique | length == 1)' "$J"
    check "prices have intervals" jq -e 'all(.rows[].price; (.cpu // .wall).ratio as $ratio |
        .rounds >= 7 and $ratio.low <= $ratio.median and $ratio.median <= $ratio.high)' "$J"
fi

# ---- Known clocks ----

WHIT=$WRONG
shows "a scene by known clocks" "^usual  " cost "$GLASS" $small --reference-samples 16 \
    --knobs aa,depth,light-samples --csv "$C" --html "$OUT/files/cost.html" \
    --markdown "$OUT/files/cost.md" --json "$J" --metric rmse --under 0.03 --within 1e6
check "what is not here is named" grep -q "^Not here: .*light-samples 1" "$OUT/stdout"
cp "$OUT/stdout" "$OUT/known"
check "--under is kept" grep -q "^Cheapest with rmse up to 0.03: .*: kept" "$OUT/stdout"
check "rows of other samples are not held against one sample" jq -e '(.rows | map(select(.knob == "chosen")) | length > 1) and
    all(.rows[]; (.alone == null) == (.option | contains("--aa")))' "$J"
P=$OUT/files/page.json
sed -n 's|^<script id="report" type="application/json">\(.*\)</script>$|\1|p' "$OUT/files/cost.html" >"$P"
check "the page holds the JSON and pictures of its own" jq -e --slurpfile json "$J" '.page as $page |
    ($json[0] == del(.page)) and ($page.reference | startswith("data:image/png;base64,iVBOR")) and
    all($page.pictures[0][]; startswith("data:image/png;base64,iVBOR")) and ($page.method | length) > 1 and
    ($page.crop | .x + .width <= 48 and .y + .height <= 36)' "$P"
check "the terminal says which settings these are" test "$(grep -c "^Best picture within .*: --.*: kept" "$OUT/stdout")" -eq 3
check "it promises no error where the reference has too few samples to tell" \
    grep -q "^Best picture within 1e+06 ms: .* ms and an error that a reference of no more samples cannot tell (ms" "$OUT/known"
# By these clocks only samples take time.
check "it shows what 4 and 16 times the time bring" jq -e '. as $all |
    [.answers[] | select(.of_usual)] | map(.of_usual) == [0.25, 4, 16] and
    (.[0].found | not) and all(.[1:][]; .found and $all.rows[.row].measured) and
    .[1].predicted_error > .[2].predicted_error' "$P"
check "and asks for nothing from elsewhere" \
    test "$(grep -c 'src="[^d]\|href=\|<script src\|url(' "$OUT/files/cost.html")" -eq 0
# A number in a sentence is the rounded figure beside it, or names a setting.
numbers='. as $all | [.findings[] | . as $finding | .text | scan("[0-9]+(?:\\.[0-9]+)?") | . as $text |
    (if contains(".") then -(split(".")[1] | length) else 0 end) as $decimals |
    select(([$finding.values[], ($all.rows[].setting | tonumber? // empty)] |
        any((. - ($text | tonumber) | fabs) <= 0.501 * pow(10; $decimals))) | not)] '
check "sentences have the figures of the report" jq -e ".sentence as \$sentence | (.findings | length) > 1 and
    all(.findings[:3][]; .text[1:] as \$text | \$sentence | contains(\$text)) and ($numbers == [])" "$J"
check "and another number is seen" jq -e "(.findings[0].values) = [] | $numbers != []" "$J"
check "the terminal begins with it" grep -qF "$(jq -r .sentence "$J")" "$OUT/stdout"
check "the Markdown is a table" grep -q "^| usual | " "$OUT/files/cost.md"
check "4 samples take 4 times as long" test "$(value "$C" aa 4 ratio)" = 4
check "that is more" test "$(value "$C" aa 4 verdict)" = 1
check "bounces that take as long are not told apart" \
    test "$(value "$C" depth 16 ratio)$(value "$C" depth 16 verdict)" = 10
expect 0 "time for 5 samples" cost "$GLASS" $small --reference-samples 16 --rays 0 --knobs aa --metric rmse --within 700 \
    --json "$OUT/files/five.json"
check "4 samples are taken, whose measured error is smaller" jq -e '. as $all | .answers[0] | .kept and
    $all.rows[.row].setting == "4" and $all.rows[-1].option == "--aa 5" and
    $all.rows[-1].error.rmse > .predicted_error' "$OUT/files/five.json"
one=$(value "$C" usual "" rmse) four=$(value "$C" aa 4 rmse) all=$(value "$C" aa 16 rmse)
check "error falls with samples ($one $four $all)" \
    holds "$one > 1.5 * $four && 1.5 * $four > 3 * $all"
before=1
for depth in 0 1 2 4 16; do
    error=$(value "$C" depth $depth alone_rmse)
    check "error falls with depth $depth ($error)" holds "$error < $before"
    before=$error
done
check "no bounces: far off ($(value "$C" depth 0 alone_rmse))" \
    holds "$(value "$C" depth 0 alone_rmse) > 50 * $before"
expect 0 "compared with itself" cost --compare "$J" "$J"
check "nothing is distinguishable" \
    test "$(grep -c 'dearer in\|cheaper in' "$OUT/stdout")" -eq 0
jq '(.rows[] | select(.knob == "aa" and .setting == "4").price) |= (.width = 7 | .height = 5 |
    (.cpu, .wall | objects).ratio |= {median: 9, low: 8, high: 10, coverage: 0.95})' "$J" >"$OUT/files/smaller.json"
shows "compared with smaller pictures" "^aa  *4 .* timed at other sizes " cost --compare "$J" "$OUT/files/smaller.json"
check "the CSV has the sizes" test "$(value "$C" aa 4 width) $(value "$C" aa 4 height)" = \
    "$(jq -r '.rows[] | select(.knob == "aa" and .setting == "4").price | "\(.width) \(.height)"' "$J")"
check "samples that the reference has not are not here" grep -q \
    "^Not here: aa 64, aa adaptive:0.05 (more samples than the reference, which cannot judge it)" "$OUT/known"

if part 1 2; then
    expect 0 "what may change nothing" cost "$CUBE" $small --reference-samples 4 \
        --knobs numerics,arithmetic --csv "$C"
    double=$(value "$C" arithmetic double alone_rmse)
    float=$(value "$C" usual "" alone_rmse)
    check "double is exact where nothing is cut, float nearly ($double, $float)" \
        holds "$double < 1e-9 && 1e-9 < $float && $float < 1e-6"
    check "600 rays are aimed" test "$(value "$C" usual "" aimed_rays)" = 600
    check "exact: no aimed ray hits something else" test "$(value "$C" \
        numerics exact aimed_other_ids)$(value "$C" numerics exact aimed_misses)" = 00
fi
if part 0 2; then
    # Far from the origin the triangles of a turned box are rounded differently with instances and in one tree (the
    # default for this scene). Each way is compared with its own reference.
    cat >"$OUT/far.json" <<'JSON'
{ "camera": { "eye": [90, 1, 4], "target": [90, 0.5, 0] },
  "objects": [
    { "shape": "box", "translation": [90.3, 0.7, 0.1], "rotation": [10, 30, 20] },
    { "shape": "sphere", "translation": [91.6, 0.7, 0.1] } ] }
JSON
    expect 0 "with instances and in one tree" cost "$OUT/far.json" $small --reference-samples 4 \
        --knobs instances --csv "$C"
    for row in usual: instances:on; do
        most=$(value "$C" "${row%:*}" "${row#*:}" aimed_ulp_max)
        check "$row: rays are held against its triangles ($most ulp)" holds "$most < 100"
    done
    check "what the scene takes by itself is no row" grep -q "^Not here: .*instances off" "$OUT/stdout"
    cat >"$OUT/many.json" <<'JSON'
{ "camera": { "eye": [12, 10, 16], "target": [0, 0, 0] },
  "objects": [ { "shape": "torus", "radius": 0.3, "repeat": { "count": [7, 6, 6], "step": [1, 1, 1] } } ] }
JSON
    expect 0 "many instances" cost "$OUT/many.json" $small --reference-samples 4 --knobs instances --rays 0
    check "are not copied into one tree" grep -q \
        "^Not here: instances on (.*), instances off (it would copy over a million triangles)" "$OUT/stdout"
fi
check "the reference is kept" test "$(find "$OUT/cache" -name 'reference-*' | wc -l)" -ge 2
expect 0 "JSON on standard output" cost "$GLASS" $small --reference-samples 4 --knobs fresnel --rays 0 --json /dev/stdout
check "is nothing else" jq -e .complete "$OUT/stdout"
expect 0 "one knob" cost "$GLASS" $small --reference-samples 4 --knobs fresnel --rays 0 --csv "$C"
check "is that knob alone" test "$(grep -c '^fresnel  *schlick ' "$OUT/stdout")" -eq 1
check "and no other" test "$(grep -c '^aa  ' "$OUT/stdout")" -eq 0
refuse 2 "a file that cannot be written" "No space left" cost "$CUBE" $small --reference-samples 4 --knobs numerics \
    --rays 0 --json /dev/full --html "$OUT/files/kept.html" --csv "$OUT/files/kept.csv"
check "the others are" test -s "$OUT/files/kept.html" -a -s "$OUT/files/kept.csv"
if part 0 2; then
    expect 1 "an error that nothing has" cost "$CUBE" $small --reference-samples 4 --knobs shadows --rays 0 \
        --under 1e-9
    check "says so" grep -q "no setting was found with an error" "$OUT/stderr"
    refuse 5 "a time limit" "passed with [123] of 4 settings measured" cost "$CUBE" $small --reference-samples 4 \
        --knobs aa,traversal --rays 0 --time-limit 3 --json "$OUT/files/part.json"
    check "keeps what was measured" jq -e '.complete == false and .rows[0].measured' "$OUT/files/part.json"
fi

# ---- Choices of `whit render` ----

if part 1 2; then
    tiny="$CUBE --size 48x36 -o $OUT/chosen.png"
    enough="$tiny --budget-ms 1e6"
    chosen() { sed -n 's/^whit: note: chosen: \(.*\); predicted.*/\1/p' "$OUT/stderr"; }
    expect 0 "a time that is enough" render $enough
    check "takes the most samples" grep -q "^whit: note: chosen: --aa 64.*; predicted" "$OUT/stderr"
    most=$(chosen)
    check "says what it took" grep -q "^whit: note: it took [0-9.]* of 1e+06 ms$" "$OUT/stderr"
    wrong compile expect 0 "kernels that take that time" render $enough
    check "are no part of it" test "$(grep -c "it will take" "$OUT/stderr")" -eq 0
    for run in first second; do
        expect 0 "a time that is a fraction, the $run run" render $tiny --budget-ms 10000000/3
    done
    check "the second has the choice of the first" \
        test "$(cat "$OUT"/cache/whit/cost-* | grep -ao '"budget_ms": *3333333' | wc -l)" -eq 1
    # A run that another one overtakes keeps the other's choice.
    "$WHIT" render $tiny --budget-ms 2000001 >"$OUT/slow.stdout" 2>"$OUT/slow.stderr" &
    slow=$!
    until grep -q "by figures of" "$OUT/slow.stderr" || ! kill -0 $slow 2>/dev/null; do sleep 0.01; done
    kill -STOP $slow
    expect 0 "a run beside one that is slower" render $tiny --budget-ms 2000002
    kill -CONT $slow
    wait $slow
    check "both choices are kept" \
        test "$(cat "$OUT"/cache/whit/cost-* | grep -ao '"budget_ms": *200000[12]' | wc -l)" -eq 2
    # A choice whose tries took too long is tried again.
    wrong noisy expect 0 "a time that slow tries exceed" render $tiny --budget-ms 160
    check "says so" grep -q "it is likely to take more than 160 ms" "$OUT/stderr"
    expect 0 "the next run" render $tiny --budget-ms 160
    check "tries again" grep -q "; predicted: 135.0 ms" "$OUT/stderr"
    expect 0 "an error that one sample has" render $tiny --max-error 0.9
    check "is not measured again" test "$(grep -c "measuring" "$OUT/stderr")" -eq 0
    check "takes less" test "$(grep -c "chosen: --aa" "$OUT/stderr")" -eq 0
    expect 0 "--fresh" render $enough --fresh
    check "measures anew" grep -q "measuring what settings cost" "$OUT/stderr"
    expect 0 "other trees" render $enough --build median
    check "have figures of their own" grep -q "measuring what settings cost" "$OUT/stderr"
    # If a record is cut short, empty or of something else, whit measures again without a message about it.
    record=$(ls -t "$OUT"/cache/whit/cost-* | sed -n 2p)
    for damage in "truncate -s 2000" "truncate -s 0" "cp $(ls -t "$OUT"/cache/whit/cost-* | sed -n 1p)"; do
        $damage "$record"
        expect 0 "a record damaged by ${damage%% /*}" render $enough
        check "is measured again" grep -q "measuring what settings cost" "$OUT/stderr"
        check "with the same choice, and no error" test "$(chosen)$(grep -c "error\|warning" "$OUT/stderr")" = "${most}0"
    done
    refuse 1 "no time at all" "no setting takes" render $tiny --budget-ms 0.001 --quiet
    refuse 2 "chosen and given" "chooses --aa" render $tiny --budget-ms 10 --aa 4
    refuse 2 "figures of no wish" "--fresh goes with --budget-ms" render $tiny --fresh
    refuse 2 "two wishes" "one of them" render $tiny --budget-ms 10 --max-error 1
fi

if [ "${4:-}" = all ]; then
    # A sample takes 135 ms and bounces take nothing. So whit chooses the most bounces, and 4 samples: 16 would take
    # longer than nine tenths of 1000 ms. What is left goes to edges.
    most=" --depth 16 --bailout 0"
    tiny="$GLASS --size 48x36 -o $OUT/chosen.png --budget-ms 1000"
    predicted() { sed -n 's/^whit: note: chosen: .*; predicted: \([0-9.]*\) ms.*/\1/p' "$OUT/stderr"; }
    kept="kept with the scene; --fresh measures anew"
    expect 0 "what is left of the time goes to samples" render $tiny
    first=$(chosen)
    check "four, and sixteen at edges ($first)" expr "$first" : "--aa adaptive:[0-9.]*,4,16$most\$"
    check "most of it ($(predicted))" holds "$(predicted) >= 700 && $(predicted) <= 900"
    check "it was measured" grep -q "measuring what settings cost" "$OUT/stderr"
    check "nobody knows before the end how long edges take" test "$(grep -c "it will take" "$OUT/stderr")" -eq 0
    expect 0 "without notes" render $tiny --quiet
    check "nothing is said" test ! -s "$OUT/stderr"
    expect 0 "tiles of another size" render $tiny --tile-size 16
    check "have figures of their own" grep -q "measuring what settings cost" "$OUT/stderr"
    # The second run makes the same choice, even if it is slower.
    wrong noisy expect 0 "the second run" render $tiny
    check "makes the same choice ($(chosen))" test "$(chosen)" = "$first"
    check "and says by which figures" grep -q "^whit: note: by figures of 20.* UTC, $kept" "$OUT/stderr"
    check "it is not measured again" test "$(grep -c "measuring" "$OUT/stderr")" -eq 0
    expect 0 "another time, by the same figures" render $tiny --budget-ms 1400
    check "gets its own choice ($(chosen))" expr "$(chosen)" : "--aa adaptive:[0-9.]*,4,16$most\$"
    check "of more edges" test "$(chosen)" != "$first"
    expect 0 "and the first one again" render $tiny
    check "its own" test "$(chosen)" = "$first"
    # One sample takes 135 of 250 ms, and two take too long: edges get four.
    expect 0 "a time between one sample and two" render $tiny --budget-ms 250
    edges=$(chosen)
    check "goes to edges ($edges)" expr "$edges" : "--aa adaptive:[0-9.]*,1,4$most\$"
    check "most of it ($(predicted))" holds "$(predicted) >= 175 && $(predicted) <= 225"
    expect 0 "the same time again" render $tiny --budget-ms 250
    check "gets the same edges" test "$(chosen)" = "$edges"

    # By the slowest of ten pictures no choice is predicted to take at most 150 ms, but the usual settings do.
    wrong noisy expect 0 "--within what only a row of the table keeps" cost "$CUBE" $small --reference-samples 4 \
        --knobs aa,numerics --within 150 --json "$J"
    check "gets that row" grep -q "^Best picture within 150 ms: the usual settings. .*: kept" "$OUT/stdout"
    check "the sentence does not say that exact hits are free" jq -e \
        '.sentence | contains("exact hits cost at most 200 %, as closely as")' "$J"
    check "as the JSON says" jq -e '.answers[0] | .kept and .row == 0 and .predicted_ms < 150' "$J"
fi

# ---- A fault shows in its row ----

wrong schlick run cost "$GLASS" $small --reference-samples 4 --knobs fresnel --rays 0 --csv "$D"
right=$(value "$C" fresnel schlick alone_rmse) biased=$(value "$D" fresnel schlick alone_rmse)
check "a biased Schlick: its error grows ($right to $biased)" holds "$biased > 1.5 * $right"
check "and no other" test "$(value "$C" usual "" alone_rmse)" = "$(value "$D" usual "" alone_rmse)"

if part 0 2; then
    wrong triangle refuse 1 "a wrong triangle" "build median: it may change nothing" \
        cost "$CUBE" $small --reference-samples 4 --knobs build,traversal --csv "$D"
    check "its row says so" grep -q "^build  *median .*NOT THE SAME" "$OUT/stdout"
    check "no other does" test "$(grep -c "NOT THE SAME" "$OUT/stdout")" -eq 1
    # (render_test.sh has a right tree by medians.)
    for row in "traversal sign" "traversal basic" "build sweep" "build spatial" "build binned+opt"; do
        set -- $row
        check "$row: no pixel is other" test "$(value "$D" "$1" "$2" pixels_changed)" = 0
        check "$row: no identity is other" test "$(value "$D" "$1" "$2" ids_changed)" = 0
    done
    check "from when on its trees are dearer" grep -q \
        "^build median: 1.0 ms to build beside 9.0; dearer from 1 picture on" "$OUT/stdout"
    check "rays find it too ($(value "$D" build median aimed_wrong))" \
        holds "$(value "$D" build median aimed_wrong) > $(value "$D" usual "" aimed_wrong)"
fi

wrong waits run cost "$CUBE" $small --reference-samples 4 --knobs build,numerics --rays 0
check "builds and pictures are compared by one clock" grep -q \
    "^build median: 1.0 ms to build beside 9.0; dearer from 1 picture on, by the wall clock" "$OUT/stdout"
check "without rays no hits are called as right" test "$(grep -c \
    "^numerics .* best\|\(as right\|more right)\): .*numerics" "$OUT/stdout")" -eq 0

wrong slow run cost "$GLASS" $small --reference-samples 4 --knobs depth --rays 0 --csv "$D"
check "10 % more work is found" test "$(value "$D" depth 16 ratio)$(value "$D" depth 16 verdict)" = 1.11
check "and in no other row" test "$(value "$D" depth 4 ratio)$(value "$D" depth 4 verdict)" = 10
WHIT=$RIGHT

# ---- Refusals ----

rm -rf "$OUT/files"
mkdir "$OUT/files"
refuse 2 "no scene" "a scene is missing" cost
refuse 2 "no such scene" "missing.json" cost "$OUT/missing.json" --quiet
refuse 2 "no such knob" "did you mean .fresnel." cost "$CUBE" --knobs fresnal
refuse 2 "a knob of another name now" "is .shadows. now" cost "$CUBE" --knobs aa,tinted-shadows
refuse 2 "no error at all" "a number from" cost "$CUBE" --under 0
refuse 2 "no such metric" "flip, rmse" cost "$CUBE" --metric psnr
refuse 2 "too many scenes" "too many" cost "$CUBE" "$CUBE"
refuse 2 "one file to compare" "two files" cost --compare "$CUBE"
for option in "--json $OUT/other.json" "--knobs aa" "--size 640x480"; do
    refuse 2 "$option of no measurement" "takes no ${option%% *}" cost --compare "$J" "$J" $option
done
refuse 2 "no report" "no report of" cost --compare "$CUBE" "$CUBE"
cp "$CUBE" "$OUT/scene.json"
refuse 2 "a report in place of the scene" "SCENE and --json name the same file" \
    cost "$OUT/scene.json" $small --json "$OUT/scene.json"
mkfifo "$OUT/pipe"
refuse 2 "a pipe to compare" "pipe: cannot read: it is a folder, a device or a pipe" cost --compare "$OUT/pipe" "$J"
refuse 2 "no file to compare" "$OUT/none: cannot read: No such file" cost --compare "$OUT/none" "$J"
refuse 2 "JSON to a pipe" "/dev/stdout" cost "$CUBE" --json -
refuse 2 "a page nowhere" "nowhere/x" cost "$CUBE" --html "$OUT/nowhere/x"
refuse 2 "one file for two" "the same file" cost "$CUBE" --html "$J" --json "$J"
check "no file was left" is_empty "$OUT/files"
shows "help" "reference" cost --help
finish
