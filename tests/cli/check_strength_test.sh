#!/bin/sh
# whit check --mutate and --power: faults of every class are caught, with their cause, or are reported as missed.
. "$(dirname "$0")/common.sh"
cd "$OUT" || exit 1
cat >a.json <<'END'
{ "camera": { "eye": [0, 1, 4], "target": [0, 0.5, 0], "fov": 40 },
  "lights": [ { "name": "lamp", "kind": "point", "position": [2, 4, 3], "color": [1, 1, 1], "intensity": 20 } ],
  "materials": {
    "glass": { "transmission": 1, "ior": 1.5 },
    "wood": { "diffuse": [0.5, 0.3, 0.1] },
    "floor": { "texture": { "checker": { "colors": ["#ffffff", "#202020"], "size": 8 } } } },
  "objects": [
    { "name": "floor", "shape": "plane", "size": 6, "material": "floor" },
    { "name": "ball", "shape": "icosphere", "radius": 0.6, "translation": [0, 0.6, 0], "material": "glass" },
    { "name": "unseen", "shape": "box", "size": 1, "translation": [0, 0, 90], "material": "wood" },
    { "name": "box", "shape": "box", "size": 0.6, "translation": [-1, 0.3, 0], "material": "wood" } ] }
END
echo 'a a.json --size 40x30' >looks.whit

expect 0 "faults" check looks.whit --mutate 20 --seed 3
# row NAME DRAWN: all DRAWN faults of the class were caught, and the cause of all was found.
row() { check "$1: $2 of $2" grep -Eqx "$1 +$2 +$2 +$2" "$OUT/stdout"; }
sum=0
for class in vertex ior light "texel row" materials order "two parts"; do
    drawn=$(sed -n "s/^$class  *\([0-9]*\) .*/\1/p" "$OUT/stdout")
    check "$class: some are drawn" test "$drawn" -gt 0
    row "$class" "$drawn"
    sum=$((sum + drawn))
done
row all 20
check "each is one of a class" test "$sum" -eq 20
expect 0 "power" check looks.whit --power
check "power: each kind" grep -Eqx "a: vertex [0-9.]*e-0[5-9], ior [0-9.]*e-0[5-9], light [0-9.]*e-0[5-9], texel row 3.9e-03" "$OUT/stdout"

# In a picture that shows nothing, no place is found for a fault.
sed -i 's/"lights": \[.*\],$/"lights": [], "ambient": 0,/; s/"eye": \[0, 1, 4\]/"eye": [0, 1, -90]/; s/"target": \[0, 0.5, 0\]/"target": [0, 0.5, -99]/' a.json
echo 'a a.json --size 40x30 --light none' >looks.whit
expect 1 "nothing is seen" check looks.whit --mutate 2
check "none is drawn" grep -Eqx "all +0 +0 +0" "$OUT/stdout"
check "that is said" grep -qx "2 more found no place that is seen" "$OUT/stdout"

refuse 2 "no comparison" "compares nothing with a golden" check looks.whit --mutate 2 --accept all
refuse 2 "one of two" "one of them" check looks.whit --mutate 2 --power
printf 'a a.json\nb broken.json\n' >looks.whit && echo '{' >broken.json
refuse 2 "a scene that cannot be loaded" "looks.whit:2: b: broken.json" check looks.whit --only b --power
finish
