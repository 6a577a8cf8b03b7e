#!/bin/sh
# `whit trace` reads rays and writes hits: the same on the device, by the float mirror on the CPU and without trees.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/files"
R=$OUT/files/rays

# Little-endian floats: 0, 1, -1, 4, 0.125 and infinity.
ZERO='\000\000\000\000' MINUS='\000\000\200\277' FOUR='\000\000\200\100'
EIGHTH='\000\000\000\076' INF='\000\000\200\177'
# The first ray goes down onto the cube's top at y = 0.5, the second one passes beside it, the third one ends above it.
printf "$EIGHTH$FOUR$ZERO$ZERO$ZERO$MINUS$ZERO$INF" >"$R"
printf "$FOUR$FOUR$ZERO$ZERO$ZERO$MINUS$ZERO$INF" >>"$R"
printf "$EIGHTH$FOUR$ZERO$ZERO$ZERO$MINUS$ZERO\000\000\000\100" >>"$R"

for on in device cpu brute; do
    expect 0 "trace --on $on" trace "$CUBE" --input "$R" -o "$OUT/files/$on" --on $on --quiet
    check "three hits of 32 bytes" test "$(wc -c <"$OUT/files/$on")" -eq 96
    t=$(od -An -v -tf4 -w32 "$OUT/files/$on" | awk '{ printf "%s ", $1 }')
    check "t is 3.5, nothing, nothing ($t)" test "$t" = "3.5 inf inf "
    ids=$(od -An -v -tu4 -w32 "$OUT/files/$on" | awk '{ printf "%s:%s ", ($4 > 11), $5 }')
    check "a triangle of instance 0, and two misses" \
        test "${ids%% *}" = "0:0" -a "$(echo "$ids" | grep -o '1:' | wc -l)" -eq 2
    up=$(od -An -v -tf4 -w32 -N32 "$OUT/files/$on" | awk '{ print ($6 == 0 && $7 > 0 && $8 == 0) }')
    check "the normal points up" test "$up" = 1
done
check "the device equals its twin" cmp "$OUT/files/device" "$OUT/files/cpu"
check "the twin equals brute force" cmp "$OUT/files/cpu" "$OUT/files/brute"
expect 0 "trace --build none" trace "$CUBE" --input "$R" -o "$OUT/files/no-bvh" --build none --quiet
check "so does the device without trees" cmp "$OUT/files/no-bvh" "$OUT/files/brute"

# A device refuses to test this many triangles one by one without trees; `--on brute` on the CPU has no such limit.
MANY=$SCENES/54k.json
expect 0 "54,450 triangles without trees" \
    trace "$MANY" --input "$R" -o "$OUT/files/many" --on brute --quiet
for command in "trace --input $R -o $OUT/files/none" "render -o $OUT/files/none.png" "probe --pixel 0,0"; do
    refuse 2 "${command%% *} --build none" "54k.json: without trees .* 54450 over all instances are too many" \
        ${command%% *} "$MANY" ${command#* } --build none
done
expect 0 "any hit" trace "$CUBE" --input "$R" -o "$OUT/files/any" --any --quiet
any=$(od -An -v -tu4 -w32 "$OUT/files/any" | awk '{ printf "%s ", ($4 == 4294967295) }')
check "finds the same rays blocked ($any)" test "$any" = "0 1 1 "


# From 10^9 away floats cannot tell which of the meshes a ray meets. Integers need more iterations than some drivers allow.
printf "\\050\\153\\156\\116$EIGHTH$EIGHTH$ZERO$MINUS$ZERO$ZERO$INF" >"$OUT/far"
far="trace $SCENES/many.json -i $OUT/far --numerics exact"
expect 0 "a ray from far away, on the CPU" $far -o "$OUT/files/near" --on cpu
if "$WHIT" $far -o "$OUT/files/far" 2>"$OUT/stderr"; then
    check "the device has time for it" cmp "$OUT/files/near" "$OUT/files/far"
else
    check "the device says who has" grep -q "a traversal was cut short .*--on cpu ends none" "$OUT/stderr"
fi
expect 0 "no rays at all" trace "$CUBE" --input /dev/null -o "$OUT/files/none" --on cpu --quiet
check "gives no hits" test ! -s "$OUT/files/none"
cat "$R" | "$WHIT" trace "$CUBE" --input /dev/stdin -o "$OUT/files/piped" --on cpu --quiet
check "rays from a pipe: exit code 0" test $? -eq 0
check "rays from a pipe give the same hits" cmp "$OUT/files/cpu" "$OUT/files/piped"

find "$OUT/files" -type f ! -name rays -exec rm {} +
printf 'xxx' >"$OUT/short"
cat "$R" "$OUT/short" >"$OUT/cut"
refuse 2 "a ray cut short" "cut: 99 bytes .*at byte 96" \
    trace "$CUBE" --input "$OUT/cut" -o "$OUT/files/hits"
refuse 2 "a device for the CPU" "--on cpu takes no device" trace "$CUBE" --input "$R" -o "$OUT/files/hits" --on cpu \
    --device 0
refuse 2 "missing rays" "missing: cannot read" \
    trace "$CUBE" --input "$OUT/missing" -o "$OUT/files/hits"
ln -s "$R" "$OUT/link"
refuse 2 "hits in place of the rays" "link: --input and -o name the same file" trace "$CUBE" -i "$R" -o "$OUT/link"
cp "$CUBE" "$OUT/scene.json"
refuse 2 "hits in place of the scene" "SCENE and -o name the same file" \
    trace "$OUT/scene.json" -i "$R" -o "$OUT/scene.json"
check "both stay" cmp "$CUBE" "$OUT/scene.json"
refuse 2 "a folder of rays" "cannot read" trace "$CUBE" --input "$OUT" -o "$OUT/files/hits"
check "no file was left" test "$(ls -A "$OUT/files")" = rays
TINY='\001\000\000\000' # 2^-149
{ cat "$R" && printf "$EIGHTH$FOUR$ZERO$ZERO$TINY$MINUS$ZERO$INF"; } >"$OUT/tiny"
expect 0 "a direction with a denormal" \
    trace "$CUBE" --input "$OUT/tiny" -o "$OUT/hits" --on cpu --numerics exact --quiet

printf 'mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$OUT/bare.obj"
head -c 32 /dev/zero >"$OUT/one.rays"
run trace "$OUT/bare.obj" --input "$OUT/one.rays" -o "$OUT/one.hits" --on cpu
check "a warning about the scene" grep -q "^whit: warning: .*none.mtl" "$OUT/stderr"
check "nothing about lights and cameras" test "$(grep -c "^whit: note:" "$OUT/stderr")" -eq 0
finish
