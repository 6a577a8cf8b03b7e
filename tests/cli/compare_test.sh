#!/bin/sh
# whit compare: metrics computed by hand for pictures of two pixels, tolerances, formats, pictures of differences.
. "$(dirname "$0")/common.sh"
needs jq
VK_DRIVER_FILES=/nonexistent
VK_ICD_FILENAMES=/nonexistent
export VK_DRIVER_FILES VK_ICD_FILENAMES
A=$OUT/a.pfm
B=$OUT/b.pfm
N=$OUT/nan.pfm

# Floats, little-endian: 0, 0.25, 0.5, 1, NaN.
ZERO='\0\0\0\0' QUARTER='\0\0\200\076' HALF='\0\0\0\077' ONE='\0\0\200\077' NAN='\0\0\300\177'
printf "PF\n2 1\n-1\n$ZERO$ZERO$ZERO$HALF$HALF$HALF" >"$A"
printf "PF\n2 1\n-1\n$ZERO$ZERO$ZERO$ONE$HALF$QUARTER" >"$B"
printf "PF\n2 1\n-1\n$ZERO$ZERO$ZERO$HALF$NAN$HALF" >"$N"
printf "PF\n1 2\n-1\n$ZERO$ZERO$ZERO$HALF$HALF$HALF" >"$OUT/tall.pfm"
printf "Pf\n2 1\n-1\n$ZERO$HALF" >"$OUT/grey.pfm"
# Two pixels, sRGB codes 0 and 188, which are linear 0 and 0.5028865.
echo iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mNgYGDYs2cPAARvAjV7odqHAAAAAElFTkSuQmCC |
    base64 -d >"$OUT/a.png"

# value METRIC: prints the number in the metric's line of the last output.
value() {
    awk -v name="$1" '$1 == name { print $2 }' "$OUT/stdout"
}

expect 0 "the same" compare "$A" "$A"
for metric in rmse relmse largest mean over differing flip; do
    check "the same: $metric is 0" test "$(value $metric)" = 0
done
check "pixels are counted" grep -q "^  differing  0  (0 of 2 pixels" "$OUT/stdout"
expect 0 "grey is three equal channels" compare "$A" "$OUT/grey.pfm"
check "grey: nothing differs" test "$(value differing)" = 0

expect 0 "two pictures" compare "$A" "$B" --json "$OUT/j.json"
check "largest" test "$(value largest)" = 0.5
check "mean: (0.5 - 0.25) / 6" test "$(value mean)" = 0.0416667
check "rmse: root of (0.25 + 0.0625) / 6" test "$(value rmse)" = 0.228218
check "relmse: 0.3125 / 0.26 / 6" test "$(value relmse)" = 0.200321
check "half of the pixels" test "$(value over)" = 0.5
check "flip is between 0 and 1" holds "$(value flip) > 0.1 && $(value flip) < 1"

expect 0 "JSON on standard output" compare "$A" "$B" --json /dev/stdout
check "is nothing else" jq -e .rmse "$OUT/stdout"
expect 0 "one metric" compare "$A" "$B" --metric largest
check "one metric: one line" test "$(wc -l <"$OUT/stdout")" -eq 1
expect 0 "within" compare "$A" "$B" --metric largest --tolerance 0.5
refuse 1 "over" "largest is 0.5, over 0.49" compare "$A" "$B" --metric largest --tolerance 0.49 --json "$OUT/j.json"
check "over: JSON says so" jq -e '.within == false' "$OUT/j.json"
refuse 1 "the mean's sign does not matter" "mean is -0.0416667" compare "$B" "$A" --metric mean --tolerance 0.04
refuse 1 "flip is the metric by itself" "flip is .* over 0" compare "$A" "$B" --tolerance 0
expect 0 "quiet" compare "$A" "$B" -q
check "quiet prints nothing" test ! -s "$OUT/stdout"

shows "a picture with NaN" "nonfinite  0 in A, 1 in B, of 2 pixels" compare "$A" "$N"
check "NaN is left out of rmse" test "$(value rmse)" = 0
refuse 1 "NaN passes no tolerance" "rmse is within 1, but" compare "$A" "$N" --metric rmse --tolerance 1
expect 0 "the same NaN passes" compare "$N" "$N" --metric rmse --tolerance 0

expect 0 "PNG beside PFM" compare "$OUT/a.png" "$A" --metric largest
check "PNG is taken to linear" about 0.0028865 "$(value largest)" 3e-5
expect 0 "difference as EXR" compare "$OUT/grey.pfm" "$B" --diff "$OUT/d.exr" --flip "$OUT/f.exr" -q
expect 0 "difference as PFM" compare "$OUT/grey.pfm" "$B" --diff "$OUT/d.pfm" -q
expect 0 "both are the same" compare "$OUT/d.exr" "$OUT/d.pfm" --metric differing --tolerance 0
expect 0 "difference and FLIP as PNG" compare "$A" "$B" --diff "$OUT/d.png" --flip "$OUT/f.png" -q
check "they are PNGs" test "$(head -c 4 "$OUT/d.png" | tail -c 3)$(head -c 4 "$OUT/f.png" | tail -c 3)" = PNGPNG

{ printf 'Pf\n512 512\n-1\n' && head -c 1048576 /dev/zero; } >"$OUT/large.pfm"
refuse 2 "too little memory for FLIP" "large.pfm: comparing pictures of 512 x 512 pixels would take 15 MiB of memory; the \
limit is 14 MiB (--memory-limit)" compare "$OUT/large.pfm" "$OUT/none.pfm" --memory-limit 14M
expect 0 "enough for another metric" compare "$OUT/large.pfm" "$OUT/large.pfm" --memory-limit 14M --metric rmse

refuse 2 "other sizes" "a.pfm is 2 x 1, .*tall.pfm is 1 x 2" compare "$A" "$OUT/tall.pfm"
refuse 2 "no pictures" "A and B are missing" compare
refuse 2 "one picture" "B is missing" compare "$A"
refuse 2 "three pictures" "too many" compare "$A" "$B" "$N"
refuse 2 "no such picture" "none.png" compare "$A" "$OUT/none.png"
refuse 2 "not a picture" "not a PNG, EXR, PFM or HDR" compare "$A" "$OUT/j.json"
refuse 2 "unknown metric" "one of rmse, relmse" compare "$A" "$B" --metric psnr
refuse 2 "tolerance below 0" "a number from 0" compare "$A" "$B" --tolerance -1
refuse 2 "tolerance nan" "a number from 0" compare "$A" "$B" --tolerance nan
refuse 2 "an import limit of nothing" "import-limit" compare "$A" "$B" --import-limit 0
run compare "$A" "$A" --require-sandbox --import-limit 30
check "a required sandbox is there, or an error" \
    test "$status" -eq "$(if grep -q sandbox "$OUT/stderr"; then echo 2; else echo 0; fi)"
refuse 2 "difference as text" ".png, .exr or .pfm" compare "$A" "$B" --diff "$OUT/d.txt"
refuse 2 "no such folder" "none/d.png" compare "$A" "$B" --diff "$OUT/none/d.png"
check "nothing was left" test ! -e "$OUT/d.txt"
finish
