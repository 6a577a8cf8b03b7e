#!/bin/sh
# Functions of a user in the place of whit's own: files, errors, sliders, pictures, recipes. Wrong texts are in
# shader_compile and shader_program, attacks in shader_harm. With a third argument there are more scenes, exact hits,
# and all examples; a short run has one example, another one with the next commit.
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
needs jq
EXAMPLES=$(cd "$SCENES/../shaders/examples" && pwd)
OWN=$SCENES/../tests/check/whit.golden
MORE=${3:+whitted glass-of-water}
mkdir "$OUT/here" && cd "$OUT/here" || exit 1
SMALL="--size 48x32 --quiet"
draw_usual() { expect 0 "as usual" render "$SCENES/default.json" --size 48x32 --quiet --light-samples 1 --depth 3 -o usual.png; }
draw() { # WHAT OUTPUT SCENE OPTION...
    what=$1 output=$2 scene=$3
    shift 3
    expect 0 "$what" render "$SCENES/$scene.json" $SMALL "$@" -o "$output"
}
said() { check "$1" grep -qF -- "$2" "$OUT/stderr"; }

# ---- dbg() of a pixel ----

if part 0 2; then
    mkdir looks
    cat >looks/at.glsl <<'END'
//@ whit 1
//@ slider scale 0 4 1

#include "post.glsl"
vec3 shade(Surface s, Optics o, vec3 to_eye) { return dbg(vec3(0.25, 1.5, 0.1) * scale); }
END
    printf 'vec3 post(ivec2 at,\n vec3 color) { return dbg(\n  at.x == 24)\n  ? color : dbg(-color); }\n' >looks/post.glsl
    expect 0 "a pixel" probe "$CUBE" --size 48x32 --quiet --pixel 24,16 --shader looks/at.glsl --set scale=2 --json looks.json
    grep '^looks/' "$OUT/stdout" >told
    cat >want <<'END'
looks/at.glsl:5: vec3(0.25, 1.5, 0.1) * scale = (0.5, 3, 0.200000003)
looks/post.glsl:2: at.x == 24 = true
looks/post.glsl:4: -color was not reached
END
    check "says what each value is: $(tr '\n' ';' <told)" cmp told want
    check "says what rows have not" grep -q '^missing    .*post()' "$OUT/stdout"
    check "and where rays end is as the CPU says" \
        test "$(grep -c '^\(twin\|exact\)  *differs in 0 of 1$' "$OUT/stdout")" = 2
    check "JSON has them" test "$(jq -c '[.dbg[] | [.line, .count, .values[0].value]]' looks.json)" = \
        '[[5,1,[0.5,3,0.2]],[2,1,[true]],[4,0,null]]'
    printf 'struct A { float b; };\nvec3 miss(vec3 dir)\n{\n A a;\n dbg(a);\n return dir; }\n' >looks/struct.glsl
    expect 2 "a value of another kind, in pictures too" render "$CUBE" $SMALL --shader looks/struct.glsl -o no.png
    said "names the line, and what there is" "looks/struct.glsl:5: dbg(x) takes a float, int, uint, bool or a vector"
fi

# ---- Files ----

for hook in camera surface shade scatter miss post aov intersect; do # the others are own.glsl, below
    expect 0 "new $hook" shader new $hook
    cp "$OUT/stdout" $hook.glsl
done
expect 0 "what traces" shader shade.glsl
check "says so" grep -qx 'shade.glsl: 1 file, functions shade; they trace rays' "$OUT/stdout"
cat aov.glsl intersect.glsl >more.glsl
expect 0 "the new aov and the new intersect compile" shader more.glsl
expect 2 "new nothing" shader new nothing
said "names what there is" "camera, surface, shade, scatter, miss, post"
expect 2 "new alone" shader new
mkdir part
cat >all.glsl <<'END'
//@ whit 1
#include "part/tint.glsl"
//@ slider bands 1 8 3 "steps of light"
//@ color rim #ffcc88
//@ toggle on on "whether"
//@ choice mode plain,warm
//@ fuel 20000
//@ aov facing
vec4 facing(Surface s) { return vec4(-dot(s.ns, ray_dir())); }
vec3 post(ivec2 at, vec3 color)
{
    return tint(on ? ceil(color * bands) / bands : color) + (mode == mode_warm ? rim : vec3(0.0));
}
END
echo 'vec3 tint(vec3 c) { return c; }' >part/tint.glsl
expect 0 "a file" shader all.glsl --json
cp "$OUT/stdout" all.json
check "its files" test "$(jq -r '[.files[].name] | join(" ")' all.json)" = "all.glsl part/tint.glsl"
check "its functions" test "$(jq -r '[.functions[].name] | join(" ")' all.json)" = "post aov"
check "its aovs" test "$(jq -r '[.aovs[].name] | join(" ")' all.json)" = facing
check "its sliders" test "$(jq -r '[.sliders[] | "\(.name)=\(.value)"] | join(",")' all.json)" = \
    "bands=3,rim=#ffcc88,on=on,mode=plain"
check "the words of a choice" test "$(jq -c '[.sliders[].words]' all.json)" = \
    '[null,null,null,[{"name":"plain"},{"name":"warm"}]]'
check "its kernels" test "$(jq -r '[.kernels[].name] | join(" ")' all.json)" = "aov post"
expect 2 "no such aov" render "$CUBE" --size 16x12 --quiet --shader all.glsl --aov face -o aov.exr
said "names those that there are" "there is facing"
expect 0 "an aov" render "$CUBE" --size 16x12 --quiet --shader all.glsl --aov facing -o aov.exr
expect 0 "beside the colour" render "$CUBE" --size 16x12 --quiet --shader all.glsl -o both.exr
check "it is in both files" test "$(grep -ac facing.R both.exr) $(grep -ac facing.R aov.exr)" = "1 0"
seq 64 | sed 's|.*|//@ aov a&\nvec4 a&(Surface s) { return vec4(&.0); }|' >many.glsl
expect 0 "as many aovs as may be" render "$CUBE" --size 16x12 --quiet --shader many.glsl -o many.exr
check "are all in the file" test "$(grep -aoE 'a[0-9]+[.]R' many.exr | sort -u | wc -l)" -eq 64
expect 0 "in large tiles" render "$CUBE" --size 16x12 --quiet --shader many.glsl --tile-size 1024 -o large.exr
check "as in small ones" cmp many.exr large.exr
expect 0 "the last one" render "$CUBE" --size 16x12 --quiet --shader many.glsl --aov a64 -o last.exr
expect 2 "--aov without --shader" render "$CUBE" --aov facing -o aov.exr
check "its fuel" test "$(jq .fuel all.json)" = 20000
check "it traces no rays" test "$(jq .traces all.json)" = false
expect 0 "dump" shader all.glsl --dump spirv
sed -n '/^  --[as]/p' "$OUT/stdout" >told
cat >want <<'END'
  --aov facing
  --set bands=3 (1 to 8)  steps of light
  --set rim=#ffcc88
  --set on=on  whether
  --set mode=plain (plain, warm)
END
check "sliders as text: $(tr '\n' ';' <told)" cmp told want
check "the SPIR-V instructions of a stage beside those of whit's own" \
    holds "$(awk '$1 == "resolve" && $2 + 0 > 0 { print $2 " > " $3 " && " $3 " > 0" }' "$OUT/stdout")"
check "and of a kernel that whit has not" grep -qE '^  post +[0-9]+ +- +[0-9.]+ ms$' "$OUT/stdout"
check "SPIR-V" spirv-val --target-env vulkan1.2 spirv/post.spv
check "GLSL with all that it includes" sh -c 'grep -q "^vec3 tint" spirv/post.comp && ! grep -q "^#include [^<]" spirv/post.comp'
check "the text of the SPIR-V" sh -c 'spirv-as --target-env vulkan1.2 spirv/post.spvasm -o again.spv && spirv-val again.spv'
check "variants beside whit's own" test "$(jq '[.variants[] | select(.name == "resolve" and
    .base_instructions > 0 and .instructions > .base_instructions)] | length' all.json)" = 1

# ---- Tests and expectations of a file ----

if part 1 2; then
    cat >tests.glsl <<'END'
#include "part/tint.glsl"
//@ slider bands 1 8 3
//@ test
void fine(uint seed)
{
    float x = random(seed);
    check(x >= 0.0 && x < 1.0); check(tint(vec3(x)) == vec3(x));
    check(bands <= 3.0);
}
//@ test
void rays(uint seed)
{
    Surface met;
    float t;
    vec2 at = vec2(random(1u), random(2u)) * 2.0 - 1.0;
    check(trace(vec3(at.x, 3.0, at.y), vec3(0.0, -1.0, 0.0), met, t));
}
END
    expect 0 "tests" shader tests.glsl
    check "the file's functions trace no rays, but for tests" sh -c '! grep -q "trace rays" "$1"' - "$OUT/stdout"
    check "passes are told" grep -q "test fine: passed, 3 checks of 4096 seeds" "$OUT/stdout"
    # Arguments of calls do not count as variables of a test, but arrays of all tests do.
    many() { # DECLARATION: a hundred tests of ten checks, each with it
        echo 'float both(vec3 a, vec3 b) { return dot(a, b); }'
        seq 100 | sed "s/.*/\/\/@ test\nvoid t&(uint seed)\n{\n    vec3 v = vec3(random(seed), 0.5, 1.0); $1/" |
            sed 's/^    vec3 v.*/&\n    check(both(v, v) >= 1.25); check(both(v, -v) < 0.0); check(both(v, v) < 2.25);\n    check(both(v.zyx, v) > 0.0); check(both(v, v.yzx) > 0.0); check(both(v, v.xyz) > 1.0); check(both(v, v.xzy) > 0.5);\n    check(both(v, vec3(1.0)) > 1.0); check(both(v, vec3(0.0)) == 0.0); check(both(-v, -v) > 1.0); }/'
    }
    many "" >many.glsl
    expect 0 "a hundred tests of ten checks" shader many.glsl
    check "pass" test "$(grep -c "passed, 10 checks of 4096 seeds" "$OUT/stdout")" -eq 100
    many "float a[100]; a[seed % 100u] = 1.0; v.y = a[seed % 100u];" >many.glsl
    expect 2 "a hundred arrays" shader many.glsl
    said "that they are too much" "variables of more than 16 KiB together"
    # Linking a file into whit's kernels keeps numbers that are not ids, initial values of global variables, and the
    # file's own functions and records with the same names as whit's.
    cat >linked.glsl <<'END'
float k = 3.0, twice = 2.0 * k;
const float table[4] = float[4](1.0, 2.0, 3.0, 4.0);
struct Hit { vec3 a; int b[3]; };
Hit traverse(int n) { Hit h; h.a = vec3(n, n + 1, n + 2); h.b = int[3](n, 5, 6); return h; }
int picked(uint n) { switch (n) { case 0u: return 7; case 1u: break; case 5u: return 9; default: return 1; } return 2; }
void out_of(in float x, out vec3 y, inout float z) { y = vec3(x).zyx; z *= x; }
//@ test
void linked(uint seed) {
    check(k == 3.0 && twice == 6.0 && table[seed & 3u] == float(seed & 3u) + 1.0);
    check(picked(0u) == 7 && picked(1u) == 2 && picked(5u) == 9 && picked(seed + 6u) == 1);
    Hit h = traverse(4);
    check(h.a.zx == vec2(6.0, 4.0) && h.b[seed % 3u] == int[3](4, 5, 6)[seed % 3u]);
    vec3 y; float z = 2.0;
    out_of(1.5, y, z);
    check(y == vec3(1.5) && z == 3.0);
    vec4 v = vec4(1.0, 2.0, 3.0, 4.0);
    v.yw = v.xz;
    check(v.wzyx == vec4(3.0, 3.0, 1.0, 1.0));
    vec2 whole = v.xy;
    float one, part = modf(-2.75, one);
    check(modf(vec2(2.5, -1.25), whole) == vec2(0.5, -0.25) && whole == vec2(2.0, -1.0) && part == -0.75 && one == -2.0);
    check(unpackHalf2x16(0x40003c00u) == vec2(1.0, 2.0) && unpackHalf2x16(0xc0003c00u + seed) != vec2(1.0, 2.0));
}
END
    expect 0 "what is linked" shader linked.glsl
    check "it has nothing but tests" grep -qx 'linked.glsl: 1 file, tests alone' "$OUT/stdout"
    check "all of it" grep -q "test linked: passed, 7 checks of 4096 seeds" "$OUT/stdout"
    cat >zeros.glsl <<'END'
struct Pair { float a; vec2 b; };
float sum(int n)
{
    float a[1000]; mat4 b[37]; Pair c[50]; vec3 d[3]; float sum = 0.0;
    for (int i = 0; i < 1000; i++)
        sum += abs(a[i]) + abs(b[i % 37][i % 4].y) + abs(c[i % 50].b.x) + abs(d[i % 3].z);
    a[n % 1000] = 1.0; b[n % 37][3] = vec4(2.0); c[n % 50] = Pair(3.0, vec2(4.0)); d[n % 3] = vec3(5.0);
    return sum + a[n % 1000] + b[n % 37][3].x + c[n % 50].b.y + d[n % 3].x - 12.0;
}
//@ test
void zeros(uint seed)
{
    for (int k = 0; k < 2; k++) check(sum(int(seed) + k) == 0.0);
}
END
    post_of_calls='vec3 post(ivec2 at, vec3 color) { for (int i = 0; i < 2000; i++) color += f(i); return color; }'
    echo "float f(int n) { float a[1024]; a[n % 1024] = 1.0; return a[n * 7 % 1024]; } $post_of_calls" >calls.glsl
    expect 0 "an array is set in few of the iterations that a driver allows" render "$CUBE" --size 8x8 --quiet --shader calls.glsl -o calls.png
    expect 0 "variables in each call" shader zeros.glsl
    check "begin as 0, large arrays too" grep -q "test zeros: passed, 1 check of 4096 seeds" "$OUT/stdout"
    expect 1 "a slider in tests" shader tests.glsl --set bands=4
    said "the failed check" "tests.glsl:8: check(bands <= 3.0) fails for 4096 of 4096 seeds of fine, the smallest is 0"
    cat >wrong.glsl <<'END'
//@ test
void wrong(uint seed)
{
    float x = sqrt(-1.0 - float(seed));
    check(seed != 7u && seed < 4000u); check(x == x);
    if (seed > 4096u)
        check(true);
}
END
    expect 1 "failed tests" shader wrong.glsl --json
    said "seeds" "wrong.glsl:5: check(seed != 7u && seed < 4000u) fails for 97 of 4096 seeds of wrong, the smallest is 7"
    said "what is no number" "wrong.glsl:5: check(x == x) fails for 4096 of 4096"
    said "what is not reached" "wrong.glsl:7: check(true) is not reached"
    check "in JSON" test "$(jq -c '[.tests[0].checks[] | [.line, .reached, .failed, .first_seed]]' "$OUT/stdout")" = \
        "[[5,true,97,7],[5,true,4096,0],[7,false,0,0]]"
    cat >long.glsl <<'END'
//@ test
void long_loop(uint seed)
{
    float x = 0.0;
    while (x >= 0.0) x += 1.0;
    check(x < 0.0);
}
END
    expect 1 "a test without end" shader long.glsl
    said "its loop" "long.glsl:5: \`//@ fuel N\`"
    cat >turned.glsl <<'END'
//@ expect rays.camera == base
//@ expect ids == base
//@ expect pixels == base
void camera(vec2 at, inout vec3 origin, inout vec3 dir) { if (at.x > 0.9) dir.x += 0.1; }
END
    expect 1 "what is expected and not so" shader turned.glsl
    said "ids" "turned.glsl:2: \`ids == base\` does not hold: "
    check "pixels and the first" grep -qE "turned.glsl:3: .*of 19200 pixels have another colour, the first at 15[0-9],[0-9]+: " "$OUT/stderr"
    check "and no more" test "$(grep -c error: "$OUT/stderr")" -eq 2
    expect 1 "in a picture" render "$SCENES/default.json" $SMALL --shader turned.glsl -o broken.png
    said "says so" "turned.glsl:2: "
    check "no picture" test ! -e broken.png
    expect 2 "ids of a refined picture" render "$SCENES/default.json" $SMALL --shader turned.glsl --refine 0.1 -o broken.png
    said "the expectation" "turned.glsl:2: \`ids == base\` cannot be checked"
    sed 's/0\.1;/0.0;/' turned.glsl >still.glsl
    expect 0 "what is so" shader still.glsl --scene "$CUBE"
    draw "a picture that is as expected" still.png cube --shader still.glsl
fi

printf 'vec3 miss(vec3 dir) {\n    float x = 1.0 return vec3(x);\n}\n' >broken.glsl
expect 2 "no semicolon" shader broken.glsl
said "names the line" "broken.glsl:2:19: syntax error, unexpected 'return'"
check "once" test "$(grep -c error: "$OUT/stderr")" -eq 1
echo 'float f() { return 1.0; }' >none.glsl
expect 2 "no hook" shader none.glsl
said "says which there are" "none of the functions camera, surface"
expect 2 "no file" shader missing.glsl
said "names it" "missing.glsl"

# ---- Pictures ----

cat camera.glsl surface.glsl shade.glsl scatter.glsl miss.glsl post.glsl | grep -v '^//@' >own.glsl
if part 0 2; then
    for scene in default $MORE; do
        draw "$scene" a.exr $scene --shadows tinted
        draw "$scene by the defaults in a file" b.exr $scene --shader own.glsl
        expect 0 "$scene: the same picture" compare a.exr b.exr --metric rmse --tolerance 1e-4
        expect 0 "$scene: the same as displayed" compare a.exr b.exr --metric over --tolerance 0
        test $scene != default || mv b.exr few.exr
    done
    cat >called.glsl <<'END'
void camera(vec2 at, inout vec3 origin, inout vec3 dir) { whit_camera(at, origin, dir); }
void surface(inout Surface s) { whit_surface(s); }
vec3 shade(Surface s, Optics o, vec3 to_eye) { return whit_shade(s, o, to_eye); }
void scatter(Surface s, Optics o, inout Rays rays) { whit_scatter(s, o, rays); }
vec3 miss(vec3 dir) { return whit_miss(dir); }
vec3 post(ivec2 at, vec3 color) { return whit_post(at, color); }
END
    draw "the defaults, called by their names" c.exr default --shader called.glsl
    expect 0 "the same as in a file" compare few.exr c.exr --metric over --tolerance 0
    draw "in other tiles" c.exr default --shader own.glsl --tile-size 16 --segments 1
    expect 0 "the same bits" compare few.exr c.exr --metric largest --tolerance 0
    if [ -n "$MORE" ]; then
        draw "exact" a.exr cube --numerics exact
        draw "exact, by a file" b.exr cube --numerics exact --shader own.glsl
        expect 0 "exact: the same as displayed" compare a.exr b.exr --metric over --tolerance 0
    fi
fi

if part 1 2; then
    draw "usual sliders" a.pfm cube --shader all.glsl
    draw "others" b.pfm cube --shader all.glsl --set bands=2 --set on=off,mode=warm
    draw "the last of a name" c.pfm cube --shader all.glsl --set bands=5,on=off --set mode=warm,bands=2
    check "sliders count" sh -c '! cmp -s a.pfm b.pfm'
    check "the last one of a name counts" cmp b.pfm c.pfm
    draw "by the file's own values" c.pfm cube --shader all.glsl --set bands=3,rim=#ffcc88,on=on,mode=plain
    check "those of the file are the usual ones" cmp a.pfm c.pfm
    for pair in band=2 bands=9; do
        expect 2 "--set $pair" render "$CUBE" $SMALL --shader all.glsl --set $pair -o no.png
        check "no picture of --set $pair" test ! -e no.png
    done
    draw "with a recipe" a.png cube --shader all.glsl --set bands=2
    check "the recipe names file and sliders" grep -aq -- '--shader all.glsl --set bands=2' a.png
fi

if part 0 2; then
    draw "a camera of its own" a.pfm cube --shader camera.glsl
    draw "and without" b.pfm cube
    check "the empty camera changes nothing" cmp a.pfm b.pfm
    echo 'void camera(vec2 at, inout vec3 origin, inout vec3 dir) { dir.x += 0.2 * random(1u); }' >shaky.glsl
    draw "random" a.pfm cube --shader shaky.glsl
    draw "random again" b.pfm cube --shader shaky.glsl --tile-size 16 --packets on
    check "the same numbers in every run" cmp a.pfm b.pfm
    # scatter() sends kinds of rays that no material of the scene sends; in a scene with mirrors an effect is left out.
    echo 'void scatter(Surface s, Optics o, inout Rays rays) { }' >sent.glsl
    draw "no rays" none.pfm cube --shader sent.glsl
    for kind in reflected refracted straight; do
        echo "void scatter(Surface s, Optics o, inout Rays rays) { rays.$kind = vec3(0.7); }" >sent.glsl
        draw "rays that are $kind" a.pfm cube --shader sent.glsl
        check "$kind: they are seen" sh -c '! cmp -s a.pfm none.pfm'
        draw "beside all effects" b.pfm cube --shader sent.glsl --effects all
        check "$kind: the same bytes" cmp a.pfm b.pfm
    done
    expect 0 "what they cost" scene "$CUBE" --effects --shader sent.glsl --size 32x24 --quiet
    check "rays that a scatter() sends are something" grep -q '^  reflection  *yes .* [1-9][0-9]* pixels, by up to ' "$OUT/stdout"
    draw "mirrors" a.pfm default --shader scatter.glsl
    draw "without them" b.pfm default --shader scatter.glsl --effects -reflection
    check "they are left out" sh -c '! cmp -s a.pfm b.pfm'
fi

draw_usual
turn=${WHIT_TEST_OFFSET:-0}
for example in "$EXAMPLES"/*.glsl; do
    name=$(basename "$example" .glsl)
    check "$name has less than 100 lines" test "$(wc -l <"$example")" -lt 100
    grep -q " --shader shaders/examples/$name.glsl$" "$OWN" && continue # its picture is held by whit's own suite
    turn=$((turn + 1))
    test -n "$MORE" || test $((turn % 4)) -eq 0 || continue
    draw "example $name" "$name.png" default --shader "$example" --light-samples 1 --depth 3
    run compare usual.png "$name.png" --metric flip --tolerance 0.001
    check "$name is no usual picture" test "$status" -eq 1
done

# The example path tracer brings the light of a lamp once: a floor on which nothing else shines is as bright as usual, and
# so is one that also mirrors the lamp.
if part 0 2; then
    for floor in '"diffuse": 0.7' '"diffuse": 0.4, "reflection": 0.9'; do
        cat >lamp.json <<END
{ "camera": { "eye": [0, 2, 4], "target": [0, 0.6, 0], "fov": 45 }, "ambient": 0, "environment": [0, 0, 0],
  "materials": { "floor": { $floor }, "lamp": { "diffuse": 0, "emission": 8 } },
  "objects": [ { "shape": "plane", "size": [4, 4], "material": "floor" },
    { "shape": "plane", "size": [1.2, 1.2], "rotation": [180, 0, 0], "translation": [0, 1.2, 0], "material": "lamp" } ] }
END
        expect 0 "a lamp" render lamp.json $SMALL --light-samples 4 --aa 16 -o a.pfm
        expect 0 "by paths" render lamp.json $SMALL --light-samples 4 --aa 256 --shader "$EXAMPLES/paths.glsl" -o b.pfm
        expect 0 "as bright ($floor)" compare a.pfm b.pfm --metric mean --tolerance 0.01
    done
fi

# ---- Animation, adaptive samples, refinement, levels of numerics ----

if part 0 2; then
    echo 'vec3 shade(Surface s, Optics o, vec3 to_eye) { return 0.5 + 0.5 * s.ns; }' >normals.glsl
    draw "frames" f.#.pfm spin --shader normals.glsl --frames 0-1 --fps 2
    draw "a frame alone" one.pfm spin --shader normals.glsl --time 0.5
    check "is the same" cmp f.1.pfm one.pfm
    check "and another one than the first" sh -c '! cmp -s f.0.pfm f.1.pfm'
    for level in watertight exact fast; do
        draw "$level" $level.pfm spin --shader normals.glsl --numerics $level
        expect 0 "as displayed" compare $level.pfm watertight.pfm --metric over --tolerance 0.01
    done
    draw "adaptive samples" a.pfm spin --shader normals.glsl --aa adaptive:0.05
    draw "in other tiles" b.pfm spin --shader normals.glsl --aa adaptive:0.05 --tile-size 16
    check "the same bytes of adaptive samples" cmp a.pfm b.pfm
    expect 0 "refined" render "$SCENES/spin.json" --size 48x32 --shader normals.glsl --refine 0.02 -o a.pfm
    samples=$(sed -n 's/.*note: \([0-9]*\) samples a pixel.*/\1/p' "$OUT/stderr")
    draw "its $samples samples at once" b.pfm spin --shader normals.glsl --aa "$samples"
    check "are the same picture" cmp a.pfm b.pfm
fi

# ---- Refusals at run time ----

if part 1 2; then
    cat >trusted.glsl <<'END'
vec3 miss(vec3 dir) { for (int i = 0; i < 12000; ++i) dir.x += 1e-9; return dir * dir; }
END
    expect 1 "12,000 iterations" render "$CUBE" $SMALL --shader trusted.glsl -o no.png
    check "say where" grep -qE "trusted\.glsl:1: .*fuel" "$OUT/stderr"
    check "and have no picture" test ! -e no.png
    draw "trusted" trusted.pfm cube --shader trusted.glsl --trust
    sed 's/^/\/\/@ fuel 12001\n/' trusted.glsl >fuel.glsl
    draw "with fuel" fuel.pfm cube --shader fuel.glsl
    check "the same as trusted" cmp trusted.pfm fuel.pfm
fi
expect 2 "--max-error" render "$CUBE" $SMALL --shader own.glsl --max-error 0.1 -o no.png
said "says why" "the reference, which has no --shader"
expect 2 "--refine of what has post" render "$CUBE" $SMALL --shader own.glsl --refine 100ms -o no.png
said "says why" "is not refined"
expect 2 "--set alone" render "$CUBE" $SMALL --set x=1 -o no.png
expect 2 "--trust alone" render "$CUBE" $SMALL --trust -o no.png
finish
