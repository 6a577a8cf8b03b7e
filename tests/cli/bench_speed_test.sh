#!/bin/sh
# sh bench_speed_test.sh WHIT SCENES [all | second DRIVER.json]: `whit bench rays` and `frame`, with `all` also `start`:
# rows, verdicts, JSON, the drawing, ray files and hits, peers that are not installed, refusals. No figure is judged,
# because figures depend on the machine. second: `rays` beside the ray tracing of another driver.
. "$(dirname "$0")/common.sh"
needs jq
needs xmllint
mkdir "$OUT/files" "$OUT/tmp" "$OUT/alone"
TMPDIR=$OUT/tmp
export TMPDIR

# holds FILTER: jq's filter is true for the JSON.
holds() {
    jq -e "$1" "$J" >/dev/null
}
# verdicts: each row ends in the verdict that follows from its figure and its `must`; no other line has a verdict.
verdicts() {
    jq -r '.tables[0].rows[] | select(.must != null) | if .more_is_better then .figure >= .must
        else .figure <= .must end | if . then "held" else "short" end' "$J" >"$OUT/expected"
    grep -ow "held\|short" "$OUT/stdout" >"$OUT/all"
    sed -n 's/^| .* \([a-z]*\)$/\1/p' "$OUT/stdout" | grep "^held$\|^short$" >"$OUT/ends"
    cmp -s "$OUT/expected" "$OUT/all" && cmp -s "$OUT/expected" "$OUT/ends"
}
# The fields that every row of both benches has.
row_schema='(.figure | type == "number" or . == null) and (.spread | type == "number") and
    (.unit | type == "string") and (.more_is_better | type == "boolean") and
    if .must == null then .aim == null and .verdict == null
    else .must > 0 and .aim > 0 and (.verdict == "held" or .verdict == "short") end'
schema='(.whit | type == "string") and (.device | has("name") and has("driver")) and
    (.settings | .quick and .runs == 1 and .width == 128 and .height == 72) and
    (.tables | length == 1) and (.tables[0] | .table == $bench and (.sentences | length > 2) and
        (.left_out | all(has("name") and has("why"))) and (.rows | all('$row_schema')))'
times='has("median") and has("spread") and .runs == 1'
# Rays by the driver's own ray tracing have times and the same hits, or it is left out by name.
pipeline=".tables[0] | if .left_out | any(.name | startswith(\"the driver\"))
    then .rows | all(.tiles.pipeline_ms == null and .pipeline_hits.compared == 0)
    else .rows | length > 2 and all((.tiles.pipeline_ms | $times) and (.shuffled.pipeline_ms | $times) and
        (.pipeline_hits | .compared > 1000 and .met_by_one_alone <= .compared / 1000 and .other_t == 0 and
            .other_ids <= .compared / 1000)) end"

# `second DRIVER.json`: on a driver that may have ray tracing of its own, under the validation layers, whose messages
# would spoil the answers of whit-ray-pipeline.
if [ "${3:-}" = second ]; then
    [ -f "${4:-}" ] || { echo "SKIPPED: no second driver (tools/second-driver)"; exit 77; }
    J=$OUT/files/second.json
    VK_DRIVER_FILES=$4 VK_ICD_FILENAMES=$4 VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
    export VK_DRIVER_FILES VK_ICD_FILENAMES VK_INSTANCE_LAYERS
    expect 0 "rays, on the second driver" bench rays "$SCENES/8k.json" --quick --runs 1 --json "$J"
    grep "^- Left out: the driver" "$OUT/stdout" && { echo "SKIPPED: it has no ray tracing"; exit 77; }
    check "beside the driver's own ray tracing" holds "$pipeline"
    finish
fi

# `all`: every row of `whit bench frame`, with all peers, and the figure that each must reach.
if [ "${3:-}" = all ]; then
    needs povray
    needs "$(dirname "$WHIT")/whit-embree"
    unset WHIT_VALIDATION # the layers would slow down a hundred processes
    J=$OUT/files/all.json
    expect 0 "frame, quick, all" bench frame --quick --runs 1 --scenes "$SCENES" --against "$WHIT" \
        --json "$J"
    check "the JSON is as documented" jq -e --arg bench frame "$schema" "$J"
    check "verdicts at the ends of rows alone" verdicts
    check "nobody is left out" holds '.tables[0].left_out == []'
    jq -r '.tables[0].rows[] | [.picture, .beside, .level, .must, .aim] | map(. // "-") | join(" ")' \
        "$J" >"$OUT/rows"
    {
        printf '%s POV-Ray watertight %s\n' glass '0.5 0.25' wine '0.5 0.25' flake '0.5 0.25' \
            hollow '0.58 0.3' mesh '0.19 0.08'
        printf '%s whit watertight %s\n' whitted '0.32 0.15' default '0.48 0.25' 34k '0.6 0.35' \
            room '0.7 0.4'
        echo "34k Embree, its rays watertight 1.9 1"
        for scene in whitted default 34k room; do
            printf '%s\n' "$scene watertight exact 1.1 1.05" "$scene fast watertight 1.1 1.05" \
                "$scene, device memory - - 110 60"
        done
    } | sort >"$OUT/musts"
    check "every row, with its goal" sh -c "sort '$OUT/rows' | diff '$OUT/musts' -"
    J=$OUT/files/start.json
    expect 0 "start, quick" bench start --quick --runs 1 --scenes "$SCENES" --against "$WHIT" --json "$J"
    check "verdicts at the ends of rows alone" verdicts
    check "first pictures of three scenes, by the clock and of the processor" \
        holds '[.tables[0].rows[] | select(.start | endswith(", 320x240"))] |
            length == 6 and all(.beside_ms.median > 0 and .figure > 0 and .must > 0)'
    check "caches that are filled" holds '.tables[0].rows | any(.start == "cube, 1280x720, filled")'
    rm "$OUT/files"/*
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$OUT/one.obj"
    # shellcheck disable=SC2046 # 22 names
    expect 0 "rays of many models" bench rays $(yes "$OUT/one.obj" | head -n 22) --quick --runs 1
    check "each has its rows" test "$(grep -c "^| one" "$OUT/stdout")" -eq 66
fi

# --- Refusals ---

refuse 2 "no such model" "nowhere.obj: cannot read" bench rays "$CUBE" "$OUT/nowhere.obj"
check "before anything is measured" test ! -s "$OUT/stdout"
refuse 2 "no such scene" "nowhere.json: is not there" bench frame glass "$OUT/nowhere.json"
refuse 2 "a scene that is none" "34l.json: cannot read" bench frame 34l --scenes "$SCENES"
refuse 2 "no triangles" "balls.json: has no triangles" bench rays "$SCENES/balls.json" --quick
refuse 2 "--against what is no whit" "true: is no whit" \
    bench frame cube --against /bin/true --quick --scenes "$SCENES"
refuse 2 "the viewer" "a bench of its own: .whit bench view" bench frame cube viewer
refuse 2 "--against of rays" "option of .whit bench frame" bench rays --against "$WHIT"
refuse 2 "--keep of frame" "option of .whit bench rays" bench frame --keep "$OUT/kept"
refuse 2 "--plot of the report" "draws none" bench report --plot "$OUT/files/never.svg"
refuse 2 "a scene for the report" "one argument too many" bench report cube
refuse 2 "a drawing to a pipe" "goes to a file" bench rays --plot -
check "no files" is_empty "$OUT/files"

# --- Rays ---

if part 1 2; then
    # The numbers of triangles lie on both sides of 200,000, above which the second goal applies.
    for steps in 316 317; do
        echo "{\"objects\": [{\"shape\": \"terrain\", \"size\": 9, \"steps\": $steps, \"seed\": 5}]}" \
            >"$OUT/t$steps.json"
    done
    J=$OUT/files/rays.json K=$OUT/kept
    expect 0 "rays, quick" bench rays "$OUT/t316.json" "$OUT/t317.json" --quick --runs 1 --json "$J" \
        --plot "$OUT/files/rays.svg" --keep "$K"
    check "says nothing on a pipe" test ! -s "$OUT/stderr"
    check "the JSON is as documented" jq -e --arg bench rays "$schema" "$J"
    check "rows of each model" test "$(jq -r '.tables[0].rows[] | .model + " " + .rays' "$J" | tr '\n' ,)" \
        = "t316 camera,t316 shadow,t316 bounce,t317 camera,t317 shadow,t317 bounce,"
    check "the driver's own ray tracing" holds "$pipeline"
    check "whit's times in both orders" \
        holds ".tables[0].rows | all((.tiles.whit_ms | $times) and (.shuffled.whit_ms | $times))"
    check "verdicts at the ends of rows alone" verdicts
    check "the drawing is SVG" xmllint --noout "$OUT/files/rays.svg"
    check "device and driver" grep -qF "$(jq -r '.device.name + ", " + .device.driver' "$J")" "$OUT/stdout"

    # Both sides read the same file of rays: records of `whit trace`.
    floats() {
        od -An -v -t f4 -w32 "$1"
    }
    check "camera rays, one a pixel" test "$(floats "$K/t316-camera.rays" | wc -l)" -eq $((128 * 72))
    # Rays 0 to 3 are neighbours in x, ray 4 is below ray 0, and ray 64 is 8 to its right. Directions of length 1 are
    # scaled to the picture's plane: the sum of all of them is perpendicular to it.
    check "in tiles of 8x8" sh -c "od -An -v -t f4 -w32 '$K/t316-camera.rays' | awk '
        { for (i = 0; i < 3; i++) { d[NR - 1, i] = \$(5 + i); ahead[i] += \$(5 + i) } }
        function place(n, i,    along, k) {
            for (k = 0; k < 3; k++) along += d[n, k] * ahead[k]
            return d[n, i] * NR / along
        }
        function near(n, a, times,    i, worst, gap) {
            worst = 0
            for (i = 0; i < 3; i++) {
                gap = place(n, i) - place(0, i) - times * (place(a, i) - place(0, i))
                worst = gap * gap > worst ? gap * gap : worst
            }
            return worst < 1e-10
        }
        END { exit !(near(3, 1, 3) && near(8, 1, 4) && near(16, 4, 2) && near(64, 1, 8) && !near(4, 1, 4)) }'"
    for kind in camera shadow; do
        floats "$K/t316-$kind.rays" >"$OUT/in_order"
        floats "$K/t316-$kind-shuffled.rays" >"$OUT/shuffled"
        check "$kind: the same rays in another order" sh -c "! cmp -s '$OUT/in_order' '$OUT/shuffled' &&
            sort '$OUT/in_order' >'$OUT/a' && sort '$OUT/shuffled' | cmp -s - '$OUT/a'"
    done
    for kind in camera shadow; do
        check "$kind: one origin" \
            test "$(floats "$K/t316-$kind.rays" | awk '{ print $1, $2, $3 }' | sort -u | wc -l)" -eq 1
    done
    "$WHIT" trace "$OUT/t316.json" --input "$K/t316-bounce.rays" -o "$OUT/twin" --on cpu --quiet
    check "whit's hits are the twin's" cmp "$OUT/twin" "$K/t316-bounce.whit.hits"
    if [ -x "$(dirname "$WHIT")/whit-embree" ]; then
        check "every row has a verdict" holds '.tables[0].rows | all(.verdict != null)'
        check "Embree's times" holds ".tables[0].rows |
            all(.tiles | (.single_ms | $times) and (.packets_ms | $times) and (.stream_ms | $times))"
        check "Embree has the same hits" holds '.tables[0].rows | all(.hits.compared > 1000 and
            .hits.met_by_one_alone <= .hits.compared / 10000 and .hits.other_t == 0 and
            .hits.other_ids <= .hits.compared / 1000)'
        check "up to 200,000 triangles the first goal" \
            holds '[.tables[0].rows[:3][] | [.must, .aim]] == [[2, 3.5], [1.5, 2.5], [0.6, 0.75]]'
        check "above it the second" \
            holds '[.tables[0].rows[3:][] | [.must, .aim]] == [[0.8, 1.2], [0.6, 1], [0.45, 0.6]]'
        ids() { # t to 5 digits, primitive and instance of every hit
            od -An -v -t f4 -w32 "$1" | awk '{ printf "%.3f\n", $1 }'
        }
        ids "$K/t316-camera.whit.hits" >"$OUT/a"
        ids "$K/t316-camera.embree.hits" >"$OUT/b"
        check "and t in the files" sh -c "test \$(diff '$OUT/a' '$OUT/b' | grep -c '^<') -le 9"
        echo bogus | "$(dirname "$WHIT")/whit-embree" "$K/t316.triangles" >"$OUT/answer" 2>"$OUT/stderr"
        check "whit-embree refuses other lines" \
            test "$? $(cat "$OUT/stderr")" = "2 whit-embree: no such line: bogus"
    else
        echo "SKIPPED: no whit-embree: rays without a peer"
        check "Embree is left out by name" grep -q "^- Left out: Embree" "$OUT/stdout"
    fi
fi

# --- Whole pictures ---

if part 0 2; then
    J=$OUT/files/frame.json
    expect 0 "frame, quick" bench frame glass "$CUBE" --quick --runs 1 --scenes "$SCENES" \
        --against "$WHIT" --json "$J" --plot "$OUT/files/frame.svg"
    check "says nothing on a pipe" test ! -s "$OUT/stderr"
    check "the JSON is as documented" jq -e --arg bench frame "$schema" "$J"
    check "rows of cube" test "$(jq -r '.tables[0].rows[] | select(.picture | test("^cube")) |
        .picture + " " + (.level // "-") + " : " + (.beside // "-")' "$J" | tr '\n' ,)" \
        = "cube watertight : whit,cube exact : watertight,cube watertight : fast,cube, device memory - : -,"
    check "times of both sides and the reference" holds ".tables[0].rows | map(select(.ms)) |
        length > 2 and all((.ms | $times) and (.beside_ms | $times) and (.reference_ms | $times))"
    check "the figure is their ratio" holds '.tables[0].rows | map(select(.ms)) |
        all(.figure * .beside_ms.median / .ms.median - 1 | fabs < 0.01)'
    check "verdicts at the ends of rows alone" verdicts
    check "the drawing is SVG" xmllint --noout "$OUT/files/frame.svg"
    if command -v povray >/dev/null; then
        check "beside POV-Ray" holds '.tables[0].rows[0] |
            .picture == "glass" and .beside == "POV-Ray" and .must == 0.5'
    else
        echo "SKIPPED: no povray"
    fi
    check "no scratch files stay" is_empty "$OUT/tmp"
    # A small picture whose time is subtracted has the kernels of the large one, also of another whit.
    printf '#!/bin/sh\necho "$*" >>"%s/asked"\nexec "%s" "$@"\n' "$OUT" "$WHIT" >"$OUT/asking"
    chmod +x "$OUT/asking"
    expect 0 "frame, beside whit" bench frame "$CUBE" --runs 1 --against "$OUT/asking"
    check "two large pictures without, two small ones with the kernels" test \
        "$(sed -n 's/.*--size \([^ ]*\) .* --quiet */\1 /p' "$OUT/asked" | sed 's/ *$//' | tr '\n' ,)" = \
        "1280x720,32x18 --packets off --classes many,1280x720,32x18 --packets off --classes many,"
    printf '#!/bin/sh\ncase "$*" in *--packets*) exit 2 ;; esac\nexec "%s" "$@"\n' "$WHIT" >"$OUT/old"
    chmod +x "$OUT/old"
    expect 0 "frame, beside a whit without these options" bench frame "$CUBE" --runs 1 --against "$OUT/old"
fi

# --- Peers that are not here ---

if part 1 2; then
    cp "$WHIT" "$(dirname "$WHIT")/whit-bench" "$OUT/alone/"
    PEERED=$WHIT WHIT=$OUT/alone/whit
    echo '{"objects": [{"shape": "ball"}, {"shape": "box", "translation": [2, 0, 0]}]}' >"$OUT/ball.json"
    J=$OUT/files/alone.json
    expect 0 "rays without Embree" bench rays "$OUT/t316.json" --quick --runs 1 --json "$J" \
        --keep "$OUT/again"
    check "the same rays once more" cmp "$K/t316-bounce-shuffled.rays" "$OUT/again/t316-bounce-shuffled.rays"
    check "the same hits" cmp "$K/t316-bounce-shuffled.whit.hits" "$OUT/again/t316-bounce-shuffled.whit.hits"
    check "left out by name" grep -q "^- Left out: Embree: .whit-embree. is not beside" "$OUT/stdout"
    check "and no verdict" verdicts
    check "nor in the JSON" holds '.tables[0].left_out[0].name == "Embree" and
        (.tables[0].rows | length == 3 and all(.verdict == null and (.tiles | has("single_ms") | not)))'
    path=$PATH
    PATH=$OUT/alone
    export PATH
    run bench frame glass --quick --runs 1 --scenes "$SCENES"
    PATH=$path
    check "frame without peers: exit code 0 (got $status)" test "$status" -eq 0
    check "which is no error" test ! -s "$OUT/stderr"
    for name in "another whit" Embree "glass, wine, flake, hollow, mesh: povray"; do
        check "$name is left out by name" grep -q "^- Left out: $name" "$OUT/stdout"
    done
    printf '#!/bin/sh\necho ready 0\nexit 7\n' >"$OUT/alone/whit-embree"
    chmod +x "$OUT/alone/whit-embree"
    refuse 1 "an Embree that dies" "whit-embree. ended with exit code 7" bench rays "$CUBE" --quick
    WHIT=$PEERED
    expect 0 "spheres and triangles" bench rays "$OUT/ball.json" --quick --runs 1
    [ -x "$(dirname "$WHIT")/whit-embree" ] &&
        check "Embree is left out for spheres" grep -q "^- Left out: Embree: .*spheres" "$OUT/stdout"
fi

# Ctrl+C while a child process is at work that would take long.
cat >"$OUT/sleeper" <<'END'
#!/bin/sh
[ "$1" = --version ] && echo "whit 0" && exit
touch begun
exec sleep 600
END
chmod +x "$OUT/sleeper"
"$WHIT" bench frame cube --quick --scenes "$SCENES" --against "$OUT/sleeper" --json "$OUT/files/never" \
    >"$OUT/stdout" 2>"$OUT/stderr" &
child=$!
begun() {
    test -n "$(find "$OUT/tmp" -name begun)"
}
interrupted $child begun
check "and no file" test ! -e "$OUT/files/never"
check "and no scratch files" is_empty "$OUT/tmp"
finish
