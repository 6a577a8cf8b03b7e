#!/bin/sh
# whit check --on reference: pictures in double where there is no Vulkan at all, with goldens of their own.
. "$(dirname "$0")/common.sh"
needs jq
cd "$OUT" || exit 1
export VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent
cp "$SCENES/cube.json" "$SCENES/balls.json" .
printf 'void shade(inout vec4 color) {}\n' >f.glsl
cat >looks.whit <<'END'
cube cube.json --size 64x48
balls balls.json --size 48x36
cube expect nonfinite == 0, hits > 100, rays.primary == 3072, pixel(32,24).instance == "cube"
cube expect pixel(32,24).t > 1, pixel(32,24).material == "cube", pixel(0,0).instance == none, mean > 0
END
refuse 3 "by a device" "no Vulkan driver" check looks.whit
expect 4 "without a golden" check looks.whit --on reference
expect 0 "accepted" check looks.whit --on reference --accept all
check "in a golden of its own" test -e looks.reference.golden -a ! -e looks.golden
check "its first line says so" grep -qx "whit check reference golden 2, whit .*" looks.reference.golden
mkdir ci
shows "all as it was" "^2 cases, 2 ok$" check looks.whit --on reference --json ci/r.json --junit junit.xml --report page.html
check "JSON: what drew it, and the command" jq -e '.on == "reference" and .driver == null and .cases[0].command ==
    "whit check looks.whit --on reference --only cube"' ci/r.json >jq.out
check "JUnit" grep -q 'tests="2" failures="0" errors="0"' junit.xml
check "a page" grep -q "the reference in double" page.html
cp looks.reference.golden was

# Goldens and reports of the other kind (device or reference) are refused.
sed 's/ reference golden/ golden/' was >looks.reference.golden
refuse 2 "a golden of a device" "looks.reference.golden:1: a golden of pictures by the device" \
    check looks.whit --on reference
cp was looks.golden
refuse 2 "a golden of the reference" "looks.golden:1: a golden of pictures by the reference" check looks.whit
rm looks.golden
cp was looks.reference.golden
refuse 2 "a report of the reference" "ci/r.json: its pictures are by the reference" check looks.whit --accept-from ci
rm looks.reference.golden
expect 0 "its lines" check looks.whit --on reference --accept-from ci
check "are the golden" cmp was looks.reference.golden

# Verdicts.
sed -i 's/48x36/48x36 --depth 1/' looks.whit
gives 1 "fewer bounces" "^balls: differs: colours other, of the same hits; rays: .* reflected, were" check looks.whit --on reference
expect 0 "one alone" check looks.whit --on reference --only cube
sed -i 's/rays.primary == 3072/rays.primary == 3/' looks.whit
gives 1 "an expectation" "^cube: line 3 expects rays.primary == 3, it is 3072$" check looks.whit --on reference --only cube
printf 'away cube.json --size 32x24 --camera 0,0,9,0,0,99,0,1,0,40\n' >away.whit
gives 1 "nothing to see" "refused as a golden" check away.whit --on reference --accept all
printf 'large cube.json --size 640x480 --aa 64\n' >large.whit
expect 5 "a time limit" check large.whit --on reference --time-limit 0.001

# Cases that the reference cannot draw.
cat >beyond.whit <<'END'
shader cube.json --shader f.glsl
view cube.json --view depth
adaptive cube.json --aa adaptive:0.1
edges cube.json --edges triangles
grid cube.json --grid on
less cube.json --effects -textures
stack cube.json --size 16x12
leaks cube.json --size 16x12
stack expect max_stack < 9
leaks expect leaks == 0
END
expect 2 "beyond it" check beyond.whit --on reference
check "is refused by name" test "$(grep -c ': cannot be drawn: .*the reference' stdout)" -eq 8
check "by the option" grep -qx "view: cannot be drawn: --view: the reference does not draw it, a device does" stdout
check "by the expectation" grep -qx "stack: cannot be drawn: line 9 expects max_stack < 9, of which the reference .*" stdout
refuse 2 "a device" "on reference uses no device: --device" check looks.whit --on reference --device 0

# --base names the cause of a difference.
if command -v git >/dev/null; then
    export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null
    printf 'cube cube.json --size 64x48\n' >looks.whit
    git init -q . && git config user.name t && git config user.email t@t
    git add cube.json looks.whit && git commit -qm one
    sed -i 's/#d98a3d/#d9803d/' cube.json
    gives 1 "another colour" "^cube: differs: .*cause: material" check looks.whit --on reference --base HEAD
fi
finish
