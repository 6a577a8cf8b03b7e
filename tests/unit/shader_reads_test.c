/* Parts of a surface and its material that no function of the user reads are not compiled, and the
   picture is the same as with them. */
#include "../cases.h"
#include "hooks_fixture.h"

enum { WIDTH = 48, HEIGHT = 36, NAMES_BYTES = 256 };

/* Bits of the effects in `names`, which are separated by blanks. */
static uint64_t effects(const char *names)
{
    char text[NAMES_BYTES], *rest;
    uint64_t bits = 0;
    snprintf(text, sizeof text, "%s", names);
    for (char *name = strtok_r(text, " ", &rest); name; name = strtok_r(NULL, " ", &rest))
        bits |= effect(name);
    return bits;
}

static whit_image *draw(const whit_renderer_params *params, uint64_t *compiled)
{
    own_whit_renderer *renderer = renderer_of(params);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    *compiled = effects_compiled(renderer);
    return image_of(renderer, WHIT_AOV_COLOR);
}

static whit_renderer_params params_of(const whit_shader *shader, const char *removed)
{
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    params.effects_removed = effects(removed);
    return params;
}

#define SHADE  "vec3 shade(Surface s, Optics o, vec3 to_eye) { return "
#define RAYS   "reflection fresnel"
#define SHAPES "/gallery/shapes.json"
#define STUDS  "/gallery/normal-map.json"
#define LAMPS  "/gallery/emissive.json"
#define LOOKS  "textures vertex-colors highlights smooth-normals normal-maps metal-rough emission"

/* `read`: the effects of LOOKS that are compiled. */
static const struct {
    const char *scene, *removed, *content, *read;
} cases[] = {
    {SHAPES, RAYS, SHADE "s.ng; }\n", ""},
    {SHAPES, RAYS, SHADE "s.ns; }\n", "smooth-normals"},
    {SHAPES, RAYS, SHADE "s.color; }\n", "vertex-colors"},
    {SHAPES, RAYS, SHADE "o.diffuse; }\n", "textures vertex-colors"},
    {SHAPES, RAYS, SHADE "o.diffuse + s.ns; }\n", "textures vertex-colors smooth-normals"},
    {SHAPES, RAYS, SHADE "o.reflected; }\n", "textures vertex-colors smooth-normals"},
    {SHAPES, RAYS,
     "Optics[2] both(Optics a, Optics b) { Optics all[2]; all[0] = a; all[1] = b; return all; "
     "}\n" SHADE "vec3(both(o, o)[1].shininess); }\n",
     "textures highlights"},
    {SHAPES, RAYS,
     "vec3 look(int i, Optics o) { Optics all[2] = Optics[2](o, o); return all[i & 1].ambient; "
     "}\n" SHADE "look(3, o); }\n",
     "textures vertex-colors"},
    {SHAPES, RAYS, "//@ aov n\nvec4 n(Surface s) { return vec4(s.ns, 1.0); }\n" SHADE "s.ng; }\n",
     "smooth-normals"},
    {SHAPES, RAYS, "void surface(inout Surface s) { s.color = vec3(0.5); }\n" SHADE "s.ng; }\n",
     "vertex-colors"},
    {SHAPES, RAYS,
     SHADE "vec3(0.1); }\nvec3 post(ivec2 at, vec3 color) { Surface met; float t;\n"
           "return trace(eye(), vec3(0.0, 0.0, -1.0), met, t) ? met.ns : color; }\n",
     "smooth-normals"},
    {SHAPES, RAYS, SHADE "light(0u, 0u, s).arriving; }\n", "smooth-normals"},
    {SHAPES, RAYS, SHADE "whit_shade(s, o, to_eye); }\n",
     "textures vertex-colors highlights smooth-normals"},
    {SHAPES, "", SHADE "s.ng; }\n", "textures vertex-colors smooth-normals"},
    {SHAPES, RAYS, "vec3 miss(vec3 dir) { return dir; }\n",
     "textures vertex-colors highlights smooth-normals"},
    {STUDS, RAYS, SHADE "vec3(o.eta); }\n", ""},
    {STUDS, RAYS, SHADE "s.ns; }\n", "normal-maps"},
    {STUDS, RAYS, SHADE "s.e1; }\n", "normal-maps textures"},
    {STUDS, RAYS, SHADE "vec3(o.metal_rough); }\n", "metal-rough"},
    {STUDS, RAYS, SHADE "vec3(o.alpha); }\n", "metal-rough highlights textures"},
    {LAMPS, RAYS, SHADE "s.ng; }\n", ""},
    {LAMPS, RAYS, SHADE "o.emission; }\n", "emission"},
    {LAMPS, "", SHADE "s.p; }\n", "smooth-normals"},
};

static uint64_t called_by_scene(void)
{
    uint64_t called = 0;
    for (uint32_t i = 0; whit_effect_name(i); ++i) {
        whit_effect_info info;
        whit_scene_get_effect(scene, i, &info);
        called |= (uint64_t)info.called << i;
    }
    return called;
}

static void check(const char *content, const char *removed, const char *read)
{
    uint64_t called = called_by_scene() & effects(LOOKS), expected = effects(read) & called;
    uint64_t compiled, whole;
    own_whit_shader *shader = hooks_load(content);
    whit_renderer_params params = params_of(shader, removed);
    own_whit_image *usual = draw(&params, &compiled);
    compiled &= called;
    if (compiled != expected)
        fail_msg("%#llx is compiled, %#llx was expected: %s", (unsigned long long)compiled,
                 (unsigned long long)expected, content);
    params.effects_added = called & ~compiled;
    own_whit_image *other = draw(&params, &whole);
    assert_int_equal(whole & called, called);
    if (memcmp(whit_image_floats(usual), whit_image_floats(other),
               WIDTH * HEIGHT * 4 * sizeof(float)) != 0)
        fail_msg("another picture: %s", content);
}

TEST(what_is_not_read_is_not_compiled)
{
    const char *opened = "";
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char path[512];
        snprintf(path, sizeof path, "%s%s", WHIT_SCENES_DIR, cases[i].scene);
        if (strcmp(opened, cases[i].scene) != 0) {
            scene_open(path);
            opened = cases[i].scene;
        }
        check(cases[i].content, cases[i].removed, cases[i].read);
    }
}

/* Instructions of the kernel of surface() and shade(). */
static uint32_t instructions_of(const whit_renderer_params *params)
{
    whit_kernel list[WHIT_KERNELS_MAX];
    uint32_t count, instructions = 0;
    assert_int_equal(whit_kernels_list(device, accel, params, true, list, &count), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i)
        instructions += strcmp(list[i].name, "hit") == 0 ? list[i].instructions : 0;
    return instructions;
}

/* Textures and other parts that only reflected and refracted rays need are in other kernels. */
TEST(the_kernel_of_functions_has_what_they_read)
{
    static const char *const contents[] = {
        SHADE "s.ng; }\n",
        SHADE "o.emission; }\n",
        SHADE "o.diffuse + o.reflected; }\n",
        "void surface(inout Surface s) { s.ns = normalize(s.ns + 0.1 * s.p); s.color *= 0.5; }\n",
    };
    uint32_t least = 0;
    scene_open(WHIT_SCENES_DIR "/default.json");
    for (size_t i = 0; i < sizeof contents / sizeof *contents; ++i) {
        uint64_t compiled;
        own_whit_shader *shader = hooks_load(contents[i]);
        whit_renderer_params params = params_of(shader, "");
        uint32_t instructions = instructions_of(&params);
        assert_true(i == 0 || i == 3 || instructions > least);
        least = i == 0 ? instructions : least;
        params.all_effects = true;
        assert_true(instructions_of(&params) > instructions);
        if (cases_turn(i, 4)) {
            params.all_effects = false;
            own_whit_image *usual = draw(&params, &compiled);
            params.all_effects = true;
            own_whit_image *whole = draw(&params, &compiled);
            assert_same_image(usual, whole);
        }
    }
}

/* A renderer with keep_unread takes a version that reads more; another one must be made anew. */
TEST(another_version_may_read_more)
{
    scene_open(WHIT_SCENES_DIR SHAPES);
    own_whit_shader *flat = hooks_load(SHADE "s.ng; }\n");
    own_whit_shader *smooth = hooks_load(SHADE "s.ns; }\n");
    for (int keeps_all = 0; keeps_all < 2; ++keeps_all) {
        whit_renderer_params params = params_of(flat, RAYS);
        params.keep_unread = keeps_all;
        own_whit_renderer *renderer = renderer_of(&params);
        assert_int_equal(whit_renderer_takes_shader(renderer, smooth), keeps_all);
        assert_true(whit_renderer_takes_shader(renderer, flat));
    }
}

TESTS_IN(hooks_begin, hooks_end)
