#!/bin/sh
# whit check refuses goldens that could not fail: ten pictures that show nothing, each refused with its reason.
. "$(dirname "$0")/common.sh"
cd "$OUT" || exit 1
cp "$SCENES/cube.json" .

# scene NAME CAMERA OBJECTS [MORE]: writes a scene with a box at the origin, further objects, and further keys of JSON.
scene() {
    echo "{ \"camera\": $2, \"environment\": \"#102030\", ${4:-}
        \"objects\": [ { \"shape\": \"box\" }$3 ] }" >"$1.json"
}
away='{ "eye": [0, 0, 3], "target": [0, 0, 9] }'
floor=', { "shape": "box", "scale": [400, 0.01, 400], "translation": [0, -2, 0] }'
scene away "$away" ''
scene floor '{ "eye": [0, 0, 3], "target": [0, -0.7, 9] }' "$floor"
scene inside '{ "eye": [0, 0, 0], "target": [0, 0, 9] }' '' '"ambient": 0, "lights": [],'
scene mirror "$away" ', { "shape": "plane", "size": 8, "rotation": [-90, 0, 0], "translation": [0, 0, 8],
    "material": { "diffuse": 0.05, "reflection": 0.9 } }'
scene aside '{ "eye": [0, 0, 3], "target": [9, 0, 0.5] }' ''
scene dark '{ "eye": [0, 0, 0.6], "target": [0, 0, -1] }' '' '"ambient": 0,'
echo 'void camera(vec2 at, inout vec3 origin, inout vec3 dir) { dir.z = -dir.z; }' >back.glsl

cat >looks.whit <<'END'
# behind the camera
away       away.json
away-own   cube.json --camera 0,0,3,0,0,9,0,1,0,45
floor      floor.json
behind     cube.json --camera 3,2,5,9,2,5.5,0,1,0,45
# no hits
aside      aside.json
above      cube.json --camera 0,0,3,0,9,0.5,0,0,1,45
far        cube.json --camera 0,0,1e6,0,0,0,0,1,0,45
# one colour
inside     inside.json
dark       dark.json --light none
near       cube.json --camera 0,0,0.501,0,0,0,0,1,0,5 --light none
# fine
cube       cube.json
mirror     mirror.json
functions  away.json --shader back.glsl
END
sed -i 's/json/json --size 64x48/' looks.whit
gives 1 "vacuous pictures" "^13 cases, 3 accepted, 10 refused$" check looks.whit --accept all
for name in away away-own floor behind; do
    check "$name" grep -q "^$name: .*refused as a golden: the model is behind the camera" stdout
done
for name in aside above far; do
    check "$name" grep -q "^$name: .*refused as a golden: no pixel hits anything" stdout
done
for name in inside dark near; do
    check "$name" grep -q "^$name: .*refused as a golden: every pixel has the same colour" stdout
done
check "the golden has the others alone" test "$(grep -c '^case' looks.golden)" -eq 3

# A case that was accepted with a good picture is refused as soon as its picture shows nothing.
printf 'cube cube.json --size 64x48\n' >looks.whit
sed -i 's/"target": \[0, 0, 0\]/"target": [9, 9, 9]/' cube.json
gives 1 "a golden of nothing" "^cube: differs: .*; refused as a golden: the model is behind" check looks.whit
finish
