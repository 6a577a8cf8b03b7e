#!/bin/sh
# `whit render --refine` draws until the estimated error or a time is reached; the picture is the same as with that
# number of samples at once.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
needs jq
cd "$OUT" || exit 1
BALLS="$SCENES/balls.json --size 32x24"

# refined ARGUMENT...: draws the refined picture r.exr; sets $samples and $estimate.
refined() {
    expect 0 "refined $*" render $BALLS -o r.exr --stats json "$@"
    samples=$(jq '.refine.samples' stdout)
    estimate=$(jq '.refine.rmse_estimate' stdout)
}

# same_as_samples: r.exr is the picture with $samples samples.
same_as_samples() {
    cp stdout refined.json
    expect 0 "--aa $samples" render $BALLS -o a.exr --aa "$samples" --stats json "$@"
    check "$samples samples at once are the same picture" \
        "$WHIT" compare r.exr a.exr --metric differing --tolerance 0 -q
}

refined --refine 0.05
coarse=$samples
check "the estimate is met" holds "$estimate > 0 && $estimate <= 0.05"
same_as_samples
check "stats have the samples" jq -es '.[0].picture.aa == .[1].picture.aa' refined.json stdout
check "and the same rays" jq -es '(.[0].rays | [.primary, .shadow, .reflected, .refracted,
    .cut_by_depth.rays, .cut_by_bailout.rays]) == (.[1].rays | [.primary, .shadow, .reflected,
    .refracted, .cut_by_depth.rays, .cut_by_bailout.rays])' refined.json stdout
check "and times of stages" jq -e 'all(.stages[]; .ms > 0)' refined.json
check "those of the estimate have a figure of their own" jq -e '.refine.estimate_rays > 32 * 24' refined.json
check "and the same weights" jq -es '.[0].rays.cut_by_depth.weight_of_a_pixel as $a |
    .[1].rays.cut_by_depth.weight_of_a_pixel as $b | $a > 0 and ($a - $b | fabs) < 1e-5 * $a' \
    refined.json stdout
check "the picture's recipe has them" grep -aq -- "--aa $samples" r.exr
check "and nothing of how they were found" sh -c '! grep -aq -- --refine r.exr'
refined --refine 1/20
check "a fraction is the same number ($coarse, $samples)" test "$samples" -eq "$coarse"
refined --refine 0.02
check "less error takes more samples ($coarse, $samples)" test "$samples" -gt "$coarse"
same_as_samples

# After two samples nothing is known of how quickly changes fall.
expect 0 "64 samples" render "$SCENES/spin.json" --size 32x24 --aa 64 -o truth.exr
expect 0 "two samples" render "$SCENES/spin.json" --size 32x24 --refine 1 -o r.exr --stats json
check "two" test "$(jq .refine.samples stdout)" -eq 2
check "are not told to be better than they are" "$WHIT" compare truth.exr r.exr --metric rmse -q \
    --tolerance "$(jq .refine.rmse_estimate stdout)"

if part 0 2; then
    # A limit of time decides only the number of samples; 0.001 ms is enough for the first sample alone.
    refined --refine 0.001ms
    check "the first sample is drawn in any case" test "$samples" -eq 1
    check "of one sample nothing is known" test "$estimate" = null
    refined --refine 1e5ms --depth 1 --size 4x3
    check "time for all samples" test "$samples" -eq 4096
    check "which tell of rays that were cut" jq -e '.refine.rmse_estimate_of_cuts > 0.01 and
        .refine.rmse_estimate >= .refine.rmse_estimate_of_cuts and .refine.cut_radiance > 0' stdout

    # Errors that more samples do not reduce.
    refuse 1 "rays that are cut" "rays that --depth and --bailout cut" render $BALLS -o cut.png -q \
        --depth 1 --refine 0.01
    check "the picture is there, of the few samples that told" grep -aq -- "--aa 4 " cut.png
    refuse 1 "too small an error" "no more than 4096 samples" render "$CUBE" -o small.png -q --size 2x2 \
        --refine 1e-9
    check "so is this one" test -s small.png
fi

if part 1 2; then
    # Identities and edges are those of the first sample.
    expect 0 "identities, refined" render $BALLS -o r.png --ids r.ids.exr --edges objects --refine 0.05
    check "it says what is left" grep -q "^whit: note: $coarse samples a pixel: an RMSE of 0.0" stderr
    expect 0 "identities, at once" render $BALLS -o a.png --ids a.ids.exr --edges objects --aa "$coarse"
    check "are the same" "$WHIT" compare r.ids.exr a.ids.exr --metric differing --tolerance 0 -q
    check "as is the picture" "$WHIT" compare r.png a.png --metric differing --tolerance 0 -q
    expect 0 "quiet" render $BALLS -o r.png --refine 0.05 --quiet
    check "says nothing" test ! -s stderr
    expect 0 "--stats text" render $BALLS -o r.png --refine 0.05 --stats text
    check "tells of it" grep -q "$coarse samples a pixel, an RMSE of" stdout
    check "and of its rays" grep -q "[0-9] rays more, for this estimate alone" stdout
fi

for value in x "" 0 -1 nan inf 1e7 200 1.5 5s ms 1msx 0ms 1e10ms; do
    refuse 2 "\`$value\`" "--refine" render $BALLS -o no.png --refine "$value"
done
for other in "--budget-ms 10" "--max-error 0.1"; do
    refuse 2 "and $other" "--refine and ${other% *}: one of them" render $BALLS -o no.png \
        --refine 0.1 $other
done
refuse 2 "milliseconds without their unit" "a time such as 500ms" render $BALLS -o no.png --refine 200
refuse 2 "and --aa" "--refine chooses --aa" render $BALLS -o no.png --refine 0.1 --aa 4
refuse 2 "and --view" "one picture of colours" render $BALLS -o no.png --refine 0.1 --view visits
refuse 2 "and --frames" "one picture of colours" render $BALLS -o no.#.png --refine 0.1 --frames 0-1
check "nothing was written" test ! -e no.png

# Ctrl+C ends it as it ends every picture.
"$WHIT" render "$SCENES/default.json" -o stopped.png --size 320x240 --refine 1e6ms 2>stderr &
pid=$!
sleep 0.5
kill -INT $pid
wait $pid
check "interrupted: exit code 130" test $? -eq 130
check "no picture is left" test ! -e stopped.png
finish
