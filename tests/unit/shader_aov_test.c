/* Aovs: values that functions of a shader give for hits of camera rays, kept beside the colour.
   They are means over samples, and change nothing else. */
#include "hooks_fixture.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT, AOVS = 3 };

static const char content[] = "//@ aov place\n"
                              "vec4 place(Surface s)\n"
                              "{\n"
                              "    return vec4(s.p, 1.0);\n"
                              "}\n"
                              "//@ aov ids\n"
                              "vec4 ids(Surface s)\n"
                              "{\n"
                              "    return vec4(float(s.instance), -1.0, 1000.0, 0.0);\n"
                              "}\n"
                              "//@ aov noise\n"
                              "vec4 noise(in Surface s) { return vec4(random(3u)); }\n";

static whit_shader *shader;

static int begin(void **state)
{
    hooks_begin_default(state);
    shader = hooks_load(content);
    return 0;
}

static int end(void **state)
{
    whit_shader_destroy(shader);
    return hooks_end(state);
}

static whit_renderer_params usual(uint32_t samples)
{
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, NULL);
    params.sampling.count = samples;
    params.shader = shader;
    return params;
}

struct drawn {
    whit_image *color, *ids, *aovs[AOVS];
};

static void drop(struct drawn *drawn)
{
    whit_image_destroy(drawn->color);
    whit_image_destroy(drawn->ids);
    for (int i = 0; i < AOVS; ++i)
        whit_image_destroy(drawn->aovs[i]);
}

/* Freed at the end of its block: own_drawn all = draw(...); */
#define own_drawn __attribute__((cleanup(drop), unused)) struct drawn

static struct drawn draw(const whit_renderer_params *params)
{
    struct drawn drawn = {0};
    own_whit_renderer *renderer = renderer_of(params);
    drawn.color = drawn_by(renderer);
    if (!params->sampling.first) /* ids are those of the first sample */
        drawn.ids = image_of(renderer, WHIT_AOV_IDS);
    for (uint32_t i = 0; params->shader && i < AOVS; ++i)
        assert_int_equal(
            whit_renderer_image(renderer, (whit_aov)(WHIT_AOV_SHADER + i), &drawn.aovs[i]),
            WHIT_OK);
    whit_image *none;
    assert_int_equal(whit_renderer_image(renderer,
                                         (whit_aov)(WHIT_AOV_SHADER + (params->shader ? AOVS : 0)),
                                         &none),
                     WHIT_ERROR_USAGE);
    return drawn;
}

static const float *floats(const whit_image *image)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    assert_int_equal(info.width * info.height, PIXELS);
    return whit_image_floats(image);
}

static bool is_miss(const struct drawn *drawn, uint32_t pixel)
{
    return whit_image_words(drawn->ids)[2 * pixel] == UINT32_MAX;
}

/* Compares steps with the whole picture: each value is that of one pixel of its square. */
struct steps {
    const float *whole;
    uint32_t seen, wrong;
};

static void look_at_step(void *user, const whit_step *step)
{
    struct steps *steps = user;
    uint32_t first = step->spacing == 8 ? 5 : step->spacing > 1;
    ++steps->seen;
    for (uint32_t y = 0; y < step->height; ++y) {
        for (uint32_t x = 0; x < step->width; ++x) {
            size_t pixel = (y * step->spacing + first) * WIDTH + x * step->spacing + first;
            steps->wrong += memcmp(&step->rgba[4 * (y * step->width + x)], &steps->whole[4 * pixel],
                                   4 * sizeof(float)) != 0;
        }
    }
}

TEST(steps_show_the_value_that_is_asked_for)
{
    whit_renderer_params params = usual(1);
    own_drawn drawn = draw(&params);
    for (uint32_t aov = 0; aov <= AOVS; ++aov) {
        struct steps steps = {.whole = floats(aov ? drawn.aovs[aov - 1] : drawn.color)};
        params.step_spacing = 8;
        params.step_aov = aov;
        params.step = look_at_step;
        params.progress_user = &steps;
        own_drawn again = draw(&params);
        assert_int_equal(steps.seen, 3);
        assert_int_equal(steps.wrong, 0);
    }
}

TEST(a_sample_says_what_the_camera_meets)
{
    const whit_renderer_params params = usual(1);
    own_drawn drawn = draw(&params);
    const uint32_t *ids = whit_image_words(drawn.ids);
    const float *place = floats(drawn.aovs[0]), *id = floats(drawn.aovs[1]);
    uint32_t misses = 0;
    for (uint32_t i = 0; i < PIXELS; ++i) {
        bool miss = is_miss(&drawn, i);
        misses += miss;
        assert_true(place[4 * i + 3] == (miss ? 0.0f : 1.0f));
        assert_true(id[4 * i] == (miss ? 0.0f : (float)ids[2 * i]));
        assert_true(id[4 * i + 1] == (miss ? 0.0f : -1.0f) &&
                    id[4 * i + 2] == (miss ? 0.0f : 1000.0f));
    }
    assert_true(misses > 100 && misses < PIXELS - 100);
}

/* Such functions change neither colours nor identities, with any number of samples. */
TEST(nothing_else_changes)
{
    for (uint32_t samples = 1; samples <= 4; samples *= 4) {
        whit_renderer_params params = usual(samples);
        own_drawn with = draw(&params);
        params.shader = NULL;
        own_drawn without = draw(&params);
        assert_same_image(with.color, without.color);
        assert_memory_equal(whit_image_words(with.ids), whit_image_words(without.ids),
                            PIXELS * 2 * sizeof(uint32_t));
    }
}

/* A picture of samples 0 to 3 has the mean of the values of samples 0, 1 and of samples 2, 3. */
TEST_BY_TURNS(samples_are_averaged, 0, 2)
{
    whit_renderer_params params = usual(4);
    own_drawn all = draw(&params);
    params.sampling.count = 2;
    own_drawn first = draw(&params);
    params.sampling.first = 2;
    own_drawn second = draw(&params);
    uint32_t others = 0;
    for (int aov = 0; aov < AOVS; ++aov) {
        const float *mean = floats(all.aovs[aov]), *a = floats(first.aovs[aov]),
                    *b = floats(second.aovs[aov]);
        for (uint32_t i = 0; i < PIXELS * 4; ++i) {
            double expected = 0.5 * ((double)a[i] + (double)b[i]);
            assert_true(fabs((double)mean[i] - expected) <= 1e-6 * (1.0 + fabs(expected)));
            others += a[i] != b[i];
        }
    }
    assert_true(others > PIXELS);
}

TEST_BY_TURNS(tiles_leave_them_as_they_are, 1, 2)
{
    whit_renderer_params params = usual(4);
    own_drawn whole = draw(&params);
    params.tile_size = 16;
    own_drawn tiled = draw(&params);
    for (int aov = 0; aov < AOVS; ++aov)
        assert_same_image(whole.aovs[aov], tiled.aovs[aov]);
}

/* A pixel of an adaptive picture has the values of a picture with the same number of samples. */
TEST_BY_TURNS(adaptive_samples_have_those_of_their_number, 0, 2)
{
    whit_renderer_params params = usual(4);
    own_drawn four = draw(&params);
    params.sampling = (whit_sampling){.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.1};
    own_drawn adaptive = draw(&params);
    uint32_t same = 0, flat = 0, hits = 0, anew = 0;
    for (uint32_t i = 0; i < PIXELS; ++i) {
        bool colors = memcmp(floats(four.color) + 4 * i, floats(adaptive.color) + 4 * i, 12) == 0;
        bool values =
            memcmp(floats(four.aovs[0]) + 4 * i, floats(adaptive.aovs[0]) + 4 * i, 16) == 0;
        bool hit = !colors && !is_miss(&four, i);
        hits += hit;
        anew +=
            hit && memcmp(floats(four.aovs[2]) + 4 * i, floats(adaptive.aovs[2]) + 4 * i, 16) != 0;
        flat += colors;
        same += colors && values;
    }
    assert_true(flat > PIXELS / 4 && flat < PIXELS);
    assert_true(hits > 0 && anew == hits); /* more samples have other random numbers */
    assert_true(same * 100 > flat * 99);   /* some colours are equal by chance */
}

TEST_BY_TURNS(refined_pictures_have_those_of_all_samples, 1, 2)
{
    whit_renderer_params params = usual(4);
    own_drawn four = draw(&params);
    whit_refine *refine;
    whit_refine_info info;
    whit_image *aov;
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_refine_create(renderer, &params, &refine), WHIT_OK);
    do {
        assert_int_equal(whit_refine_step(refine), WHIT_OK);
        whit_refine_get_info(refine, &info);
    } while (info.samples < 4);
    for (uint32_t k = 0; k < AOVS; ++k) {
        assert_int_equal(whit_refine_aov(refine, k, &aov), WHIT_OK);
        for (uint32_t i = 0; i < PIXELS * 4; ++i) {
            double expected = (double)floats(four.aovs[k])[i];
            assert_true(fabs((double)floats(aov)[i] - expected) <= 1e-6 * (1.0 + fabs(expected)));
        }
        whit_image_destroy(aov);
    }
    assert_int_equal(whit_refine_aov(refine, AOVS, &aov), WHIT_ERROR_USAGE);
    whit_refine_destroy(refine);
}

/* Each number of the surface that surface() returns comes from another kernel. */
static const char changes[] =
    "void surface(inout Surface s)\n{\n"
    "    s.ns = vec3(0.6, 0.0, 0.8);\n    s.u = 0.25;\n    s.v = 0.5;\n"
    "    s.color = vec3(0.125, 2.0, 3.0);\n    s.color_alpha = 0.75;\n}\n"
    "//@ aov colors\nvec4 colors(Surface s) { return vec4(s.color, s.color_alpha); }\n"
    "//@ aov coordinates\nvec4 coordinates(Surface s) { return vec4(s.u, s.v, 0.0, 0.0); }\n"
    "//@ aov normals\nvec4 normals(Surface s)\n{\n    vec3 n = vec3(0.6, 0.0, 0.8);\n"
    "    bool averted = dot(n, ray_dir()) > -1e-4;\n" /* replaced by the triangle's normal */
    "    return vec4(averted || length(s.ns - n) < 1e-5, averted, 0.0, 1.0);\n}\n";

TEST(values_are_of_the_surface_as_it_is_changed)
{
    static const float expected[AOVS - 1][4] = {{0.125f, 2.0f, 3.0f, 0.75f},
                                                {0.25f, 0.5f, 0.0f, 0.0f}};
    whit_renderer_params params = usual(1);
    own_whit_shader *changing = hooks_load(changes);
    uint32_t hits = 0, wrong = 0, turned = 0;
    params.shader = changing;
    own_drawn drawn = draw(&params);
    for (uint32_t pixel = 0; pixel < PIXELS; ++pixel) {
        const float *normal = &floats(drawn.aovs[2])[4 * pixel];
        if (is_miss(&drawn, pixel))
            continue;
        ++hits;
        turned += normal[1] == 0.0f;
        wrong += normal[0] != 1.0f;
        for (uint32_t i = 0; i < AOVS - 1; ++i)
            wrong += memcmp(&floats(drawn.aovs[i])[4 * pixel], expected[i], sizeof *expected) != 0;
    }
    assert_true(hits > PIXELS / 4 && turned > PIXELS / 8);
    assert_int_equal(wrong, 0);
}

static double render_ms(const whit_renderer *renderer)
{
    whit_stats stats;
    whit_renderer_get_stats(renderer, &stats);
    assert_true(stats.render_ms > 0.0 && stats.rays_primary >= PIXELS);
    return stats.render_ms;
}

/* Draws a picture, and reads its colours, its ids and its first aov. */
static void draw_again(whit_renderer *renderer, struct drawn *drawn)
{
    drawn->color = drawn_by(renderer);
    drawn->ids = image_of(renderer, WHIT_AOV_IDS);
    drawn->aovs[0] = image_of(renderer, WHIT_AOV_SHADER);
}

/* Draws with another version of the shader in the same renderer. Gives whether colours were drawn
   anew: a picture that reuses them has the times of the last one. */
static bool draw_in_place(whit_renderer *renderer, const whit_renderer_params *params,
                          struct drawn *drawn)
{
    double before_ms = render_ms(renderer);
    assert_int_equal(whit_renderer_set_shader(renderer, params), WHIT_OK);
    draw_again(renderer, drawn);
    return render_ms(renderer) != before_ms;
}

static void assert_same_picture(const struct drawn *in_place, const struct drawn *alone)
{
    assert_same_image(in_place->color, alone->color);
    assert_same_image(in_place->aovs[0], alone->aovs[0]);
    assert_memory_equal(whit_image_words(in_place->ids), whit_image_words(alone->ids),
                        PIXELS * 2 * sizeof(uint32_t));
}

/* The functions of each version of the shader. `anew`: its colours must be drawn anew. */
static const struct version {
    const char *value, *shade, *post;
    bool anew;
} versions[] = {
    {"vec4(s.p, 1.0)", "s.ns", "c", true},
    {"vec4(s.ns, 1.0).zxyw * 2.0 + random(1u)", "s.ns", "c", false},
    {"vec4(length(s.p), s.u, s.v, 1.0)", "s.ns", "c.bgr * 0.5", false},
    {"vec4(length(s.p), s.u, s.v, 1.0)", "s.ns", "c.brg", false},
    {"vec4(length(s.p), s.u, s.v, 1.0)", "s.ng", "c.brg", true},
    /* The picture counts rays of functions, so that it is drawn anew. */
    {"trace(s.p + s.ng, s.ng, met, t) ? vec4(t) : vec4(1.0)", "s.ng", "c.brg", true},
    {"vec4(s.ng, 0.5)", "s.ng", "c.brg", true},
    {"vec4(s.ng, 0.25)", "s.ng", "c.brg", false},
};
enum { VERSIONS = sizeof versions / sizeof *versions };

/* `posts`: the file also has post() and a shape. */
static whit_shader *load_version(size_t i, bool posts)
{
    static const char shape[] =
        "//@ box -1 -1 -1 1 1 1 0.01\n"
        "bool intersect(vec3 o, vec3 d, float far, out float t, out vec3 n) {\n"
        "    float b = dot(o, d), r = b * b - dot(o, o) + 0.5;\n"
        "    t = -b - sqrt(max(r, 0.0)); n = normalize(o + t * d);\n"
        "    return r > 0.0 && t > 0.0 && t < far; }\n";
    char text[1024];
    snprintf(text, sizeof text,
             "Surface met;\nfloat t;\n//@ aov kept\nvec4 kept(Surface s) { return %s; }\n"
             "vec3 shade(Surface s, Optics o, vec3 e) { return %s * sin(s.p.x * 3.0); }\n"
             "vec3 %s(ivec2 at, vec3 c) { return %s; }\n%s",
             versions[i].value, versions[i].shade, posts ? "post" : "other", versions[i].post,
             posts ? shape : "");
    return hooks_load(text);
}

/* If only post() and aovs have changed, colours are not drawn anew. */
static void draw_versions(whit_renderer_params params, bool posts)
{
    own_whit_shader *before = load_version(0, posts);
    params.shader = before;
    params.reuse_rays = true;
    params.time_stages = true;
    own_whit_renderer *renderer = renderer_of(&params);
    whit_stats first, stats;
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    whit_renderer_get_stats(renderer, &first);
    assert_true(first.share_count > 0 || !posts);
    for (size_t i = 1; i < VERSIONS; ++i) {
        own_drawn in_place = {0}, alone = {0};
        whit_shader *version = load_version(i, posts);
        params.shader = version;
        if (draw_in_place(renderer, &params, &in_place) != versions[i].anew)
            fail_msg("drawn anew or not: %s", versions[i].value);
        whit_renderer_get_stats(renderer, &stats);
        assert_true(!posts || stats.share_count == first.share_count);
        own_whit_renderer *other = renderer_of(&params);
        draw_again(other, &alone);
        assert_same_picture(&in_place, &alone);
        whit_shader_destroy(before);
        before = version;
    }
}

TEST(other_values_leave_the_colours)
{
    draw_versions(usual(1), false);
}

TEST(other_values_of_many_samples_in_tiles_leave_the_colours)
{
    whit_renderer_params params = usual(4);
    params.tile_size = 16;
    draw_versions(params, true);
}

/* Steps show the new values of an aov; colours, which are kept, come all at once. */
TEST(steps_show_other_values)
{
    own_whit_shader *first = load_version(0, true), *second = load_version(1, true);
    for (uint32_t aov = 0; aov < 2; ++aov) {
        own_drawn alone = {0}, in_place = {0};
        whit_renderer_params params = usual(1);
        params.shader = second;
        own_whit_renderer *other = renderer_of(&params);
        draw_again(other, &alone);
        struct steps steps = {.whole = floats(aov ? alone.aovs[0] : alone.color)};
        params.shader = first;
        params.step = look_at_step;
        params.progress_user = &steps;
        params.reuse_rays = true;
        own_whit_renderer *renderer = renderer_of(&params);
        assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
        params.shader = second;
        params.step_spacing = 8;
        params.step_aov = aov;
        assert_false(draw_in_place(renderer, &params, &in_place));
        assert_same_picture(&in_place, &alone);
        assert_int_equal(steps.seen, aov ? 3 : 1);
        assert_int_equal(steps.wrong, 0);
    }
}

TESTS_IN(begin, end)
