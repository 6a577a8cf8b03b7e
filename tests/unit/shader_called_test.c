/* Only effects and rays that a user's shading function asks for are compiled and traced. */
#include "../cases.h"
#include "hooks_fixture.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

/* The picture with effects added; *compiled: bits of its effects. */
static whit_image *draw_with(const whit_shader *shader, uint64_t added, uint64_t *compiled)
{
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    params.effects_added = added;
    own_whit_renderer *renderer = renderer_of(&params);
    whit_image *color = drawn_by(renderer);
    *compiled = effects_compiled(renderer);
    return color;
}

static whit_image *draw(const whit_shader *shader)
{
    uint64_t compiled;
    return draw_with(shader, 0, &compiled);
}

static uint32_t count_shadow_kernels(const whit_shader *shader)
{
    const whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    whit_kernel list[WHIT_KERNELS_MAX];
    uint32_t count, found = 0;
    assert_int_equal(whit_kernels_list(device, accel, &params, true, list, &count), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i)
        found += strncmp(list[i].name, "shadow", 6) == 0;
    return found;
}

/* Each case is drawn as it is. In turns they are also drawn with every effect of lights added, and
   the pictures compared. */
TEST(what_is_not_asked_for_is_not_compiled)
{
    static const struct {
        const char *content;
        bool lights, shadows;
        uint32_t kernels; /* of shadow rays */
    } cases[] = {
        {"vec3 post(ivec2 at, vec3 color) { return color; }\n", true, true, 1},
        {"vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.ns + o.diffuse; }\n", false,
         false, 0},
        {"vec3 shade(Surface s, Optics o, vec3 to_eye) { return visible(s, s.ns, 1.0); }\n", false,
         true, 0},
        {"vec3 shade(Surface s, Optics o, vec3 to_eye) { return light(0u, 0u, s).arriving; }\n",
         true, false, 0},
        {"vec3 other(Surface s, Optics o, vec3 v) { return whit_shade(s, o, v); }\n"
         "#define CALL other\n"
         "vec3 shade(Surface s, Optics o, vec3 to_eye) { return CALL(s, o, to_eye); }\n",
         true, true, 0},
        {"void scatter(Surface s, Optics o, inout Rays rays) { whit_scatter(s, o, rays); }\n"
         "vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.ns; }\n",
         false, false, 0},
        {"//@ aov lit\nvec4 lit(Surface s) { return vec4(visible(s, s.ns, 1.0), 1.0); }\n"
         "vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.ns; }\n",
         false, true, 0},
    };
    uint64_t shadows = effect("shadows"), lights = effect("point-lights");
    uint64_t all = shadows | lights | effect("directional-lights") | effect("tinted-shadows");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        uint64_t compiled, forced;
        own_whit_shader *shader = hooks_load(cases[i].content);
        own_whit_image *usual = draw_with(shader, 0, &compiled);
        uint32_t kernels = count_shadow_kernels(shader);
        if ((compiled & lights) != (cases[i].lights ? lights : 0) ||
            (compiled & shadows) != (cases[i].shadows ? shadows : 0) || kernels != cases[i].kernels)
            fail_msg("lights %d, shadows %d, %u kernels: %s", (compiled & lights) != 0,
                     (compiled & shadows) != 0, kernels, cases[i].content);
        if (cases_turn(i, 3)) {
            own_whit_image *whole = draw_with(shader, all, &forced);
            assert_int_equal(forced & all, all);
            assert_same_image(usual, whole);
        }
    }
}

/* A shade() that sums up all inputs that it may have. */
#define TOLD                                                                                       \
    "vec3 shade(Surface s, Optics o, vec3 to_eye)\n{\n"                                            \
    "    vec3 sum = s.p + s.error * 1e6 + s.ng + s.ns + s.e1 + s.e2 + s.footprint + s.color;\n"    \
    "    sum += vec3(s.color_alpha, s.u, s.v) + vec3(s.shade_index, s.instance, s.material);\n"    \
    "    sum += vec3(s.on_sphere, o.thin, o.unlit) + o.diffuse + o.ambient + o.highlight;\n"       \
    "    sum += o.emission + o.reflected + o.refracted + vec3(o.straight, o.shininess, "           \
    "o.alpha);\n"                                                                                  \
    "    sum += vec3(o.eta, o.metal_rough, bounces()) + to_eye + ray_dir() + ray_origin();\n"      \
    "    sum += vec3(pixel(), ray_distance()) + visible(s, s.ns, 2.0);\n"

static void no_step(void *user, const whit_step *step)
{
    (void)user;
    (void)step;
}

static void is_as(whit_renderer *renderer, const whit_renderer_params *params,
                  const whit_shader *shader)
{
    whit_renderer_params usual = *params;
    whit_stats stats, stats_usual;
    usual.few_pixels = false;
    usual.shader = shader;
    own_whit_renderer *other = renderer_of(&usual);
    own_whit_image *b = drawn_by(other), *a = drawn_by(renderer);
    assert_same_image(a, b);
    whit_renderer_get_stats(renderer, &stats);
    whit_renderer_get_stats(other, &stats_usual);
    assert_int_equal(stats.rays_reflected, stats_usual.rays_reflected);
    /* A kernel in two parts has more instructions, for the second beginning and end. */
    assert_int_equal(stats.kernel_instructions == stats_usual.kernel_instructions,
                     !params->few_pixels);
}

/* A kernel in one part and one in two parts draw the same, also after other versions, and in tiles
   with more hits than there are rows. */
TEST(a_kernel_in_parts_draws_the_same)
{
    own_whit_shader *first = hooks_load(TOLD "    return sum;\n}\n");
    own_whit_shader *second = hooks_load(TOLD "    return sum * 0.5;\n}\n");
    own_whit_shader *flat =
        hooks_load("vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.ng + "
                   "visible(s, s.ns, 2.0); }\n");
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, first);
    params.step = no_step;
    params.keep_unread = params.few_pixels = true;
    params.tile_size = 256;
    own_whit_renderer *renderer = renderer_of(&params);
    is_as(renderer, &params, first);
    params.shader = second;
    assert_int_equal(whit_renderer_set_shader(renderer, &params), WHIT_OK);
    is_as(renderer, &params, second);
    params.few_pixels = false;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    is_as(renderer, &params, second);
    params.few_pixels = true;
    params.shader = first;
    params.width = params.height = 256; /* 65,536 pixels, 32,768 items */
    assert_int_equal(whit_renderer_set_shader(renderer, &params), WHIT_OK);
    is_as(renderer, &params, first);
    params.few_pixels = false; /* the shader reads no textures, so that it is one kernel anyway */
    params.shader = flat;
    assert_int_equal(whit_renderer_set_shader(renderer, &params), WHIT_OK);
    is_as(renderer, &params, flat);
}

/* miss() is called in a kernel of its own, for camera rays and for reflected rays. */
TEST(misses_know_their_ray)
{
    uint32_t seen = 0, mirrored = 0;
    own_whit_shader *shader =
        hooks_load("vec3 miss(vec3 dir)\n{\n    return vec3(bounces(), ray_distance() > "
                   "1e30, length(dir));\n}\n");
    own_whit_image *image = draw(shader);
    const float *color = whit_image_floats(image);
    for (uint32_t i = 0; i < PIXELS; ++i, color += 4) {
        bool straight = color[0] == 0.0f && color[1] == 1.0f;
        seen += straight && color[2] > 0.999f && color[2] < 1.001f;
        mirrored += color[0] > 0.5f && color[0] < 3.0f;
    }
    if (seen < PIXELS / 8 || mirrored < PIXELS / 50)
        fail_msg("%u pixels see the sky, %u in a mirror", seen, mirrored);
}

/* Another version of a shader has the same properties that buffers and kernels depend on. */
TEST(another_version_has_the_same_values_and_asks_for_the_same)
{
#define SHADE     "vec3 shade(Surface s, Optics o, vec3 to_eye) { return "
#define AOV(name) "//@ aov " name "\nvec4 " name "(Surface s) { return vec4(1.0); }\n"
    static const struct {
        const char *content;
        bool taken;
    } cases[] = {
        {AOV("one") SHADE "-s.ns; }\n", true},
        {AOV("one") SHADE "visible(s, s.ns, 1.0); }\n", false},
        {AOV("two") SHADE "s.ns; }\n", false},
        {AOV("one") AOV("two") SHADE "s.ns; }\n", false},
        {SHADE "s.ns; }\n", false},
    };
    own_whit_shader *shader = hooks_load(AOV("one") SHADE "s.ns; }\n");
    whit_renderer_params params = whit_renderer_defaults();
    params.shader = shader;
    own_whit_renderer *renderer = renderer_of(&params);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        own_whit_shader *other = hooks_load(cases[i].content);
        if (whit_renderer_takes_shader(renderer, other) != cases[i].taken)
            fail_msg("%s", cases[i].content);
    }
}

static void count_call(void *user, double done)
{
    (void)done;
    ++*(uint32_t *)user;
}

/* Draws a picture with the same renderer in place of *out. Gives whether it traced rays. */
static bool draw_in_place(whit_renderer *renderer, const uint32_t *calls, whit_image **out)
{
    uint32_t before = *calls;
    whit_image_destroy(*out);
    *out = drawn_by(renderer);
    return *calls > before;
}

/* A version of a file. `traces`: behind the version before it its picture takes rays. */
struct version {
    const char *text;
    bool traces;
};

/* Each version in the same renderer draws the picture of a new renderer, with its own sliders. */
static void draw_versions(const struct version *versions, size_t count)
{
    uint32_t calls = 0;
    own_whit_shader *before = hooks_load(versions[0].text);
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, before);
    own_whit_image *in_place = NULL;
    params.reuse_rays = true;
    params.progress = count_call;
    params.progress_user = &calls;
    own_whit_renderer *renderer = renderer_of(&params);
    assert_true(draw_in_place(renderer, &calls, &in_place));
    for (size_t i = 1; i < count; ++i) {
        whit_shader *shader = hooks_load(versions[i].text);
        params.shader = shader;
        assert_int_equal(whit_renderer_set_shader(renderer, &params), WHIT_OK);
        whit_shader_destroy(before);
        before = shader;
        if (draw_in_place(renderer, &calls, &in_place) != versions[i].traces)
            fail_msg("%s", versions[i].text);
        own_whit_image *alone = draw(shader);
        assert_same_image(in_place, alone);
    }
}

#define POST(value)   "vec3 post(ivec2 at, vec3 c) { return " value "; }\n"
#define SLIDER(value) "//@ slider k 0 1 " value "\n"
TEST(a_version_in_place_draws_the_same)
{
    static const struct version versions[] = {
        {SLIDER("0.25") SHADE "s.ns * k; }\n" POST("c"), true},
        {SLIDER("0.5") SHADE "s.ns * k; }\n" POST("c"), true},
        {"//@ slider l 0 1 0.5\n" SLIDER("0.75") SHADE "s.ns * k + l; }\n" POST("c.bgr"), true},
        {"//@ slider l 0 1 0.5\n" SLIDER("0.75") SHADE "s.ns * k - l; }\n" POST("c.bgr"), true},
    };
    draw_versions(versions, sizeof versions / sizeof *versions);
}

/* After an error the renderer draws with the version that it had, and its sliders. */
TEST(a_refused_version_leaves_the_one_before)
{
    static const char *const text = SLIDER("0.25") SHADE "s.ns * k; }\n" POST("c");
    own_whit_shader *first = hooks_load(text);
    whit_shader *refused = hooks_load(SLIDER("0.5") SHADE "s.ng * k; }\n" POST("c.bgr"));
    const whit_renderer_params params = params_sized(WIDTH, HEIGHT, first);
    whit_renderer_params wrong = params;
    own_whit_renderer *renderer = renderer_of(&params);
    own_whit_image *drawn = drawn_by(renderer);
    wrong.shader = refused;
    wrong.exposure_ev = INFINITY;
    assert_int_equal(whit_renderer_set_shader(renderer, &wrong), WHIT_ERROR_USAGE);
    own_whit_image *again = image_of(renderer, WHIT_AOV_COLOR);
    assert_same_image(drawn, again);
    wrong.exposure_ev = params.exposure_ev;
    wrong.sliders = "k=1,l=1";
    assert_int_equal(whit_renderer_set_shader(renderer, &wrong), WHIT_ERROR_USAGE);
    assert_int_equal(whit_renderer_set_view(renderer, &wrong), WHIT_ERROR_USAGE);
    assert_int_equal(whit_renderer_set_time(renderer, 1.0), WHIT_OK);
    own_whit_image *later = drawn_by(renderer);
    assert_same_image(drawn, later);
    wrong.sliders = NULL;
    wrong.camera.name = "none of the scene";
    assert_int_equal(whit_renderer_set_shader(renderer, &wrong), WHIT_ERROR_USAGE);
    whit_shader_destroy(refused);
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    own_whit_image *last = drawn_by(renderer);
    assert_same_image(drawn, last);
}

/* If only the body of post() has changed, no ray is traced. */
TEST_BY_TURNS(another_post_needs_no_rays, 0, 2)
{
    static const struct version versions[] = {
        {SLIDER("0.25") POST("c"), true},
        {SLIDER("0.25") POST("c.bgr * k"), false},
        {SLIDER("0.25") POST("c.brg"), false},
        {SLIDER("0.5") POST("c.bgr * k"), true},
    };
    draw_versions(versions, sizeof versions / sizeof *versions);
}

/* The same with other functions in the file, whose ids in SPIR-V change with post(). */
TEST_BY_TURNS(another_post_beside_other_functions_needs_no_rays, 1, 2)
{
#define SCATTER "void scatter(Surface s, Optics o, inout Rays r) { whit_scatter(s, o, r); }\n"
    static const struct version versions[] = {
        {POST("c") SCATTER SHADE "s.ns * sin(s.p.x * 3.0) + 0.125; }\n", true},
        {POST("c.bgr * 0.75 + length(c) * vec3(0.5, 0.0, 0.25)") SCATTER SHADE
         "s.ns * sin(s.p.x * 3.0) + 0.125; }\n",
         false},
        {POST("c.brg") SCATTER SHADE "s.ns * sin(s.p.x * 5.0) + 0.125; }\n", true},
    };
    draw_versions(versions, sizeof versions / sizeof *versions);
}

/* The rays of the last picture are reused only for the same view, and only with reuse_rays. */
TEST_BY_TURNS(rays_are_taken_again_for_the_same_view, 0, 2)
{
    uint32_t calls = 0;
    own_whit_shader *shader = hooks_load(POST("c.bgr"));
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    own_whit_image *first = NULL, *again = NULL;
    params.progress = count_call;
    params.progress_user = &calls;
    own_whit_renderer *renderer = renderer_of(&params);
    assert_true(draw_in_place(renderer, &calls, &first));
    assert_true(draw_in_place(renderer, &calls, &again));
    assert_same_image(first, again);
    params.reuse_rays = true;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    assert_false(draw_in_place(renderer, &calls, &again));
    assert_same_image(first, again);
    params.sampling.first = 1;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    assert_true(draw_in_place(renderer, &calls, &again));
    params.sampling.first = 0;
    params.depth = 0;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    assert_true(draw_in_place(renderer, &calls, &again));
    assert_memory_not_equal(whit_image_floats(first), whit_image_floats(again),
                            PIXELS * 4 * sizeof(float));
}

enum { CALLS_BEFORE_STOP = 3 };

static struct {
    uint32_t calls;
    bool stop;
} stopping;

static void count_until_stop(void *user, double done)
{
    bool stops = *(bool *)user;
    stopping.stop = ++stopping.calls >= CALLS_BEFORE_STOP && stops && done < 1.0;
}

/* Whether another post() must trace rays after a picture of `samples` samples was cancelled. */
static bool traces_behind_cancelled(uint32_t samples, whit_shader *const shaders[2],
                                    whit_image **out)
{
    bool stops = false;
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, NULL);
    params.tile_size = 16;
    params.sampling.count = samples;
    params.shader = shaders[0];
    params.reuse_rays = true;
    params.progress = count_until_stop;
    params.progress_user = &stops;
    params.cancel = &stopping.stop;
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    params.reuse_rays = false;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    stopping.calls = 0;
    stops = true;
    assert_int_equal(whit_renderer_render(renderer), WHIT_ERROR_CANCELLED);
    stops = stopping.stop = false;
    params.reuse_rays = true;
    params.shader = shaders[1];
    assert_int_equal(whit_renderer_set_shader(renderer, &params), WHIT_OK);
    return draw_in_place(renderer, &stopping.calls, out);
}

/* A cancelled picture of one sample has overwritten pixels with the same values, so that the kept
   picture is still valid; sums of several samples are incomplete then. */
TEST_BY_TURNS(another_post_behind_a_cancelled_picture_needs_no_rays, 1, 2)
{
    own_whit_shader *before = hooks_load(POST("c")), *behind = hooks_load(POST("c.bgr"));
    whit_shader *const shaders[2] = {before, behind};
    own_whit_image *in_place = NULL;
    assert_false(traces_behind_cancelled(1, shaders, &in_place));
    own_whit_image *alone = draw(behind);
    assert_same_image(in_place, alone);
    assert_true(traces_behind_cancelled(4, shaders, &in_place));
}

/* The picture without the shader, with which expectations compare, has shadow rays although the
   shader asks for none, and no steps of an aov. */
TEST_BY_TURNS(expectations_are_held_against_all_effects, 1, 2)
{
    own_whit_shader *shader =
        hooks_load("//@ expect rays.shadow == base\n" AOV("one") SHADE "s.ns; }\n");
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    params.step_aov = 1;
    bool held;
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    assert_int_equal(whit_renderer_check_expectations(renderer, &held), WHIT_OK);
    assert_false(held);
}

/* The number of rays that functions traced for a picture; *hits: number of pixels with a hit. */
static uint64_t traced_by_functions(const char *content, whit_numerics numerics, uint64_t *hits)
{
    enum { ODD_WIDTH = 51, ODD_HEIGHT = 37 }; /* no multiples of a tile's sides */
    own_whit_shader *shader = hooks_load(content);
    whit_renderer_params params = params_sized(ODD_WIDTH, ODD_HEIGHT, shader);
    whit_stats stats;
    params.depth = 0;
    params.numerics = numerics;
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    own_whit_image *ids = image_of(renderer, WHIT_AOV_IDS);
    whit_renderer_get_stats(renderer, &stats);
    *hits = 0;
    for (uint32_t i = 0; i < ODD_WIDTH * ODD_HEIGHT; ++i)
        *hits += whit_image_words(ids)[2 * i] != WHIT_NONE;
    assert_int_equal(stats.rays_primary, ODD_WIDTH * ODD_HEIGHT);
    assert_int_equal(whit_stats_rays(&stats),
                     stats.rays_primary + stats.rays_shadow + stats.rays_by_functions);
    return stats.rays_by_functions;
}

/* At `exact` in turns. */
#define TRACE "Surface met; float t; bool some = trace("
TEST(rays_of_functions_are_counted)
{
    static const struct {
        const char *content;
        uint64_t of_hits, of_misses;
    } cases[] = {
        {"vec3 post(ivec2 at, vec3 color) { return color.bgr; }\n", 0, 0},
        {"vec3 shade(Surface s, Optics o, vec3 to_eye)\n{ " TRACE
         "off_surface(s, s.ng), s.ng, met, t);\n"
         "return some ? visible(s, s.ng, t) : visible(s, to_eye, 1.0); }\n",
         2, 0},
        {"vec3 miss(vec3 dir) { " TRACE "ray_origin(), -dir, met, t); return vec3(some ? t : 0.0); "
         "}\n",
         0, 1},
        /* Camera rays are not kept: camera() is called again by the stage that shades, and at
           `exact` by the kernel that decides deferred rays. */
        {"void camera(vec2 at, inout vec3 origin, inout vec3 dir) { " TRACE
         "origin, dir, met, t); if (some) origin += 0.001 * t * dir; }\n",
         2, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        bool settled = !cases[i].of_hits != !cases[i].of_misses;
        for (int exact = 0; exact < 1 + (settled && cases_turn(i, 2)); ++exact) {
            uint64_t hits, counted = traced_by_functions(
                               cases[i].content,
                               exact ? WHIT_NUMERICS_EXACT : WHIT_NUMERICS_WATERTIGHT, &hits);
            assert_in_range(hits, 1, 51 * 37 - 1);
            assert_int_equal(counted,
                             hits * cases[i].of_hits + (51 * 37 - hits) * cases[i].of_misses);
        }
    }
}

TESTS_IN(hooks_begin_default, hooks_end)
