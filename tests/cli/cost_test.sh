#!/bin/sh
# `whit cost`: rows, errors, answers, files. Ctrl+C: fault_stop_cost. The third argument is whit over a library in
# which WHIT_TEST_WRONG is wrong.
. "$(dirname "$0")/common.sh"
RIGHT=$WHIT
WRONG=$3
XDG_CACHE_HOME=$OUT/cache
export XDG_CACHE_HOME
mkdir "$OUT/cache" "$OUT/files"
J=$OUT/files/cost.json
WHITTED=$SCENES/whitted.json
small="--size 48x36 --quick --rays 600 --quiet"

# value FILE KNOB SETTING COLUMN: of the CSV, whose cells hold no commas here but in the device's name.
value() {
    python3 - "$@" <<'PYTHON'
import csv, sys
path, knob, setting, column = sys.argv[1:]
for row in csv.DictReader(open(path)):
    if row["knob"] == knob and row["setting"] == setting:
        print(row[column])
PYTHON
}
# holds EXPRESSION: of numbers, by Python.
holds() {
    python3 -c "import sys; sys.exit(not ($1))"
}

C=$OUT/files/cost.csv
# shellcheck disable=SC2086
expect 0 "a scene" cost "$WHITTED" $small --spend 2 --samples 16 --knobs aa,depth,light-samples \
    --json "$J" --csv "$C" --html "$OUT/files/cost.html" --markdown "$OUT/files/cost.md" \
    --under 0.03 --within 1e6
check "the usual row" grep -q "^usual  " "$OUT/stdout"
check "what is not here is named" grep -q "^Not here: .*light-samples 1" "$OUT/stdout"
check "--within anything is kept" grep -q "^Best picture within 1e+06 ms: .*: kept" "$OUT/stdout"
check "--under is kept" grep -q "^Cheapest with rmse up to 0.03: .*: kept" "$OUT/stdout"
check "the page has plots and pictures" \
    test "$(grep -c '<svg\|data:image/png' "$OUT/files/cost.html")" -ge 4
check "and asks for nothing from elsewhere" \
    test "$(grep -c 'src="[^d]\|href=\|<script\|url(' "$OUT/files/cost.html")" -eq 0
check "the Markdown is a table" grep -q "^| usual | " "$OUT/files/cost.md"
if command -v python3 >/dev/null; then
    check "the page is well-formed" \
        python3 -c "import sys, xml.dom.minidom as d; d.parse(sys.argv[1])" "$OUT/files/cost.html"
    one=$(value "$C" usual "" rmse) four=$(value "$C" aa 4 rmse) all=$(value "$C" aa 16 rmse)
    check "error falls with samples ($one $four $all)" holds "$one > 1.5 * $four > 3 * $all"
    before=1
    for depth in 0 1 2 4 16; do
        error=$(value "$C" depth $depth alone_rmse)
        check "error does not rise with depth $depth ($error)" holds "$error <= 1.01 * $before"
        before=$error
    done
    check "no bounces: far off ($(value "$C" depth 0 alone_rmse))" \
        holds "$(value "$C" depth 0 alone_rmse) > 50 * $before"
    check "the JSON names its device and is whole" python3 - "$J" <<'PYTHON'
import json, sys
report = json.load(open(sys.argv[1]))
assert report["device"] and report["driver"] and report["command"].startswith("whit cost ")
assert report["complete"] is True and report["reference"]["samples"] == 16
assert all(set(row) == set(report["rows"][0]) for row in report["rows"])
assert all(row["measured"] for row in report["rows"])
for row in report["rows"]:
    ratio = row["price"]["cpu" if row["price"]["cpu"] else "wall"]["ratio"]
    assert row["price"]["rounds"] >= 7 and ratio["low"] <= ratio["median"] <= ratio["high"]
PYTHON
    # shellcheck disable=SC2086
    expect 0 "what may change nothing" cost "$CUBE" $small --spend 1 --samples 4 \
        --knobs traversal,build,numerics,arithmetic --csv "$OUT/files/same.csv"
    double=$(value "$OUT/files/same.csv" arithmetic double alone_rmse)
    float=$(value "$OUT/files/same.csv" usual "" alone_rmse)
    check "double is exact where nothing is cut, float nearly ($double, $float)" \
        holds "$double < 1e-9 < $float < 1e-6"
    for row in "traversal sign" "traversal basic" "build median" "build sweep" "build spatial" \
        "build binned+opt"; do
        # shellcheck disable=SC2086
        set -- $row
        check "$row: no pixel is other" test "$(value "$OUT/files/same.csv" "$1" "$2" pixels_changed)" = 0
        check "$row: no identity is other" test "$(value "$OUT/files/same.csv" "$1" "$2" ids_changed)" = 0
    done
    check "600 rays are aimed" test "$(value "$OUT/files/same.csv" usual "" aimed_rays)" = 600
    check "exact: no aimed ray hits something else" test "$(value "$OUT/files/same.csv" \
        numerics exact aimed_other_ids)$(value "$OUT/files/same.csv" numerics exact aimed_misses)" = 00
fi
expect 0 "compared with itself" cost --compare "$J" "$J"
check "nothing is distinguishable" \
    test "$(grep -c 'dearer in\|cheaper in' "$OUT/stdout")" -eq 0
check "the reference is kept" test "$(find "$OUT/cache" -name 'reference-*' | wc -l)" -ge 2
# shellcheck disable=SC2086
expect 0 "one knob" cost "$WHITTED" $small --spend 1 --knobs fresnel --rays 0 --json "$J"
check "is that knob alone" test "$(grep -c '^fresnel  *schlick ' "$OUT/stdout")" -eq 1
check "and no other" test "$(grep -c '^aa  ' "$OUT/stdout")" -eq 0
# shellcheck disable=SC2086
expect 1 "an error that nothing has" cost "$CUBE" $small --spend 1 --knobs shadows --rays 0 --under 1e-9
check "says so" grep -q "no setting was found with an error" "$OUT/stderr"

# ---- Choices of `whit render` ----

tiny="$CUBE --size 48x36 -o $OUT/chosen.png"
# shellcheck disable=SC2086
expect 0 "a time that is enough" render $tiny --budget-ms 1e6
check "takes the most samples" grep -q "^whit: note: chosen: --aa 16;* .*predicted" "$OUT/stderr"
check "says what it took" grep -q "^whit: note: it took [0-9.]* of 1e+06 ms$" "$OUT/stderr"
# shellcheck disable=SC2086
expect 0 "an error that one sample has" render $tiny --max-error 0.9
check "is not measured again" test "$(grep -c "measuring" "$OUT/stderr")" -eq 0
check "takes less" test "$(grep -c "chosen: --aa" "$OUT/stderr")" -eq 0
# shellcheck disable=SC2086
refuse 1 "no time at all" "no setting takes" render $tiny --budget-ms 0.001 --quiet
# shellcheck disable=SC2086
refuse 2 "chosen and given" "chooses --aa" render $tiny --budget-ms 10 --aa 4
# shellcheck disable=SC2086
refuse 2 "two wishes" "one of them" render $tiny --budget-ms 10 --max-error 1

# ---- What is wrong is found, in its row ----

if command -v python3 >/dev/null; then
    D=$OUT/files/wrong.csv
    WHIT=$WRONG
    # shellcheck disable=SC2086
    run cost "$WHITTED" $small --spend 1 --knobs fresnel --rays 0 --csv "$C"
    export WHIT_TEST_WRONG=schlick
    # shellcheck disable=SC2086
    run cost "$WHITTED" $small --spend 1 --knobs fresnel --rays 0 --csv "$D"
    unset WHIT_TEST_WRONG
    right=$(value "$C" fresnel schlick alone_rmse) biased=$(value "$D" fresnel schlick alone_rmse)
    check "a biased Schlick: its error grows ($right to $biased)" holds "$biased > 1.5 * $right"
    check "and no other" test "$(value "$C" usual "" alone_rmse)" = "$(value "$D" usual "" alone_rmse)"

    export WHIT_TEST_WRONG=triangle
    # shellcheck disable=SC2086
    refuse 1 "a wrong triangle" "build median: it may change nothing" \
        cost "$CUBE" $small --spend 1 --knobs build,traversal --csv "$D"
    unset WHIT_TEST_WRONG
    check "its row says so" grep -q "^build  *median .*NOT THE SAME" "$OUT/stdout"
    check "no other does" test "$(grep -c "NOT THE SAME" "$OUT/stdout")" -eq 1
    check "rays find it too ($(value "$D" build median aimed_wrong))" \
        holds "$(value "$D" build median aimed_wrong) > $(value "$D" usual "" aimed_wrong)"

    # Nothing meets what a convex body reflects: 16 bounces are what 8 are.
    sed 's/"specular": 0.3/"reflection": 0.3/' "$CUBE" >"$OUT/mirror.json"
    deep="$OUT/mirror.json --size 160x120 --quick --rays 0 --quiet --knobs depth --samples 4 --spend 8"
    # What else goes on at that moment may be more than 10 %: then once or twice more.
    for try in 1 2 3; do
        # shellcheck disable=SC2086
        run cost $deep --csv "$C"
        export WHIT_TEST_WRONG=slow
        # shellcheck disable=SC2086
        run cost $deep --csv "$D"
        unset WHIT_TEST_WRONG
        right=$(value "$C" depth 16 ratio) slowed=$(value "$D" depth 16 ratio)
        if holds "0.9 < $right < 1.1" && holds "0.05 < $slowed - $right < 0.15" &&
            [ "$(value "$D" depth 16 verdict)" = 1 ] && [ "$(value "$D" depth 4 verdict)" != 1 ]; then
            break
        fi
        echo "        try $try: x $right and x $slowed"
    done
    check "16 bounces cost about what 8 do (x $right)" holds "0.9 < $right < 1.1"
    check "10 % more work is found (x $slowed)" test "$(value "$D" depth 16 verdict)" = 1
    check "about as much as it is" holds "0.05 < $slowed - $right < 0.15"
    check "and in no other row" test "$(value "$D" depth 4 verdict)" != 1
    WHIT=$RIGHT
fi

# ---- What is refused ----

rm -rf "$OUT/files"
mkdir "$OUT/files"
refuse 2 "no scene" "a scene is missing" cost
refuse 2 "no such scene" "missing.json" cost "$OUT/missing.json" --quiet
refuse 2 "no such knob" "did you mean .fresnel." cost "$CUBE" --knobs fresnal
refuse 2 "no error at all" "a number from" cost "$CUBE" --under 0
refuse 2 "no such metric" "rmse, flip" cost "$CUBE" --metric psnr
refuse 2 "too many scenes" "too many" cost "$CUBE" "$CUBE"
refuse 2 "one file to compare" "two files" cost --compare "$CUBE"
refuse 2 "no report" "no report of" cost --compare "$CUBE" "$CUBE"
refuse 2 "JSON to a pipe" "/dev/stdout" cost "$CUBE" --json -
refuse 2 "a page nowhere" "nowhere/x" cost "$CUBE" --html "$OUT/nowhere/x"
refuse 2 "one file for two" "the same file" cost "$CUBE" --html "$J" --json "$J"
check "no file was left" is_empty "$OUT/files"
expect 0 "help" cost --help
check "help names the reference" grep -q "reference" "$OUT/stdout"
finish
