#!/bin/sh
# Promises of `whit cost` and `whit render`, on second runs: 9 of 10 pictures take at most the time T, in two scenes
# with three T each; the error is below E. This test is long.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/cost_common.sh"

# draw SCENE T: draws one picture, and notes it in $OUT/kept if it took at most T ms.
draw() {
    run render "$SCENES/$1.json" -o "$OUT/chosen.png" --size 160x120 --budget-ms "$2"
    took=$(sed -n 's/^whit: note: it took \([0-9.]*\) of.*/\1/p' "$OUT/stderr")
    awk -v took="${took:-x}" -v most="$2" 'BEGIN { exit !(took > 0 && took + 0 <= most) }' &&
        echo "$1 $2" >>"$OUT/kept"
    echo "$1 $2 ${took:-no picture}, load $(cut -d' ' -f1 /proc/loadavg)"
}

scenes="default room" times="250 1000 4000"
: >"$OUT/kept"
for scene in $scenes; do
    expect 0 "$scene: measured once" render "$SCENES/$scene.json" -o "$OUT/first.png" --size 160x120 \
        --budget-ms 1e7
done
for i in 1 2 3 4 5 6 7 8 9 10; do
    for time in $times; do
        for scene in $scenes; do
            draw "$scene" "$time"
        done
    done
done
for scene in $scenes; do
    for time in $times; do
        count=$(grep -c "^$scene $time$" "$OUT/kept")
        check "$scene within $time ms: $count of 10" test "$count" -ge 9
    done
done

# The true picture has many more samples and bounces than the pictures that the figures were measured on.
for scene in whitted cube; do
    expect 0 "$scene: the truth" render "$SCENES/$scene.json" -o "$OUT/true.pfm" \
        --size 96x72 --aa 64 --depth 32 --bailout 1.52587890625e-5
    for error in 0.05 0.02; do
        expect 0 "$scene: error up to $error" render "$SCENES/$scene.json" -o "$OUT/chosen.pfm" \
            --size 96x72 --max-error "$error"
        run compare "$OUT/true.pfm" "$OUT/chosen.pfm" --metric rmse --tolerance "$error"
        check "$scene: it is below ($(head -n 1 "$OUT/stdout"))" test "$status" -eq 0
        for i in 1 2; do
            expect 0 "$scene: --under $error, run $i" cost "$SCENES/$scene.json" --size 96x72 --quick \
                --rays 0 --spend 5 --reference-samples 64 --knobs aa,depth,bailout --metric rmse \
                --under "$error" --quiet
            check "kept" grep -q "^Cheapest with rmse up to $error: .*: kept" "$OUT/stdout"
        done
    done
done
finish
