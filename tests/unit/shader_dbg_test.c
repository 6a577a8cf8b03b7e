/* dbg(x): the values that it records for a probed pixel, in each function of a file; and pictures
   are the same as without it. */
#include "hooks_fixture.h"

enum { WIDTH = 64, HEIGHT = 48, X = 20, Y = 30, FLOOR_X = 5, FLOOR_Y = 40 };

/* The text begins with line 1. */
static const char content[] =
    "void camera(vec2 at, inout vec3 origin, inout vec3 dir) {\n"
    "    whit_camera(at, origin, dir); dbg(pixel()); }\n"
    "//@ aov kept\n"
    "vec4 kept(Surface s) { return vec4(dbg(vec2(0.1, -0.0)), 0.0, 0.0); }\n"
    "void scatter(Surface s, Optics o, inout Rays rays) {\n"
    "    whit_scatter(s, o, rays); dbg(bounces()); }\n"
    "vec3 shade(Surface s, Optics o, vec3 to_eye) {\n"
    "    for (int i = 0; i < 12; i++) dbg(ivec3(i, -i, -2147483647));\n"
    "    if (sample_number() > 99u) dbg(1.0);\n"
    "    return vec3(0.25) * dbg(1.0 + float(dbg(bvec4(true, false, false, true)).w)); }\n"
    "vec3 miss(vec3 dir) { return dbg(vec3(4.0)); }\n"
    "vec3 post(ivec2 at, vec3 color) { return dbg(color); }\n";

static whit_shader *shader, *plain;

/* `blank`: replaces each name dbg by blanks. */
static whit_shader *load(bool blank)
{
    char text[sizeof content];
    strcpy(text, content);
    for (char *at = text; blank && (at = strstr(at, "dbg("));)
        memcpy(at, "   ", 3);
    return hooks_load(text);
}

static int begin(void **state)
{
    hooks_begin(state);
    scene_open(WHIT_SCENES_DIR "/whitted.json");
    shader = load(false);
    plain = load(true);
    return 0;
}

static int end(void **state)
{
    whit_shader_destroy(shader);
    whit_shader_destroy(plain);
    return hooks_end(state);
}

static whit_renderer *make(const whit_shader *with, uint32_t samples)
{
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, NULL);
    params.sampling.count = samples;
    params.shader = with;
    whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    return renderer;
}

static void drop_report(whit_probe_report **at)
{
    whit_probe_report_destroy(*at);
}

/* Freed at the end of its block: own_report *report = probe_of(...); */
#define own_report __attribute__((cleanup(drop_report), unused)) whit_probe_report

/* The report of a pixel, with `records` rays at most (0: as many as there are). */
static whit_probe_report *probe_of(whit_renderer *renderer, uint32_t x, uint32_t y,
                                   uint32_t records)
{
    whit_probe_report *report = NULL;
    assert_int_equal(whit_probe(renderer, x, y, records, &report), WHIT_OK);
    return report;
}

/* Value `at` of call `index`, as text. */
static const char *text_of(const whit_probe_report *report, uint32_t index, uint32_t at)
{
    static char text[128];
    assert_true(index < report->call_count && at < report->calls[index].value_count);
    whit_probe_value_text(&report->calls[index].values[at], 9, text, sizeof text);
    return text;
}

static void assert_call(const whit_probe_report *report, uint32_t index, uint32_t line,
                        const char *text, uint32_t count, const char *value)
{
    const whit_probe_call *call = &report->calls[index];
    assert_int_equal(call->line, line);
    assert_string_equal(call->text, text);
    assert_int_equal(call->count, count);
    assert_int_equal(call->value_count, count < WHIT_PROBE_VALUES ? count : WHIT_PROBE_VALUES);
    if (count)
        assert_string_equal(text_of(report, index, 0), value);
}

static uint32_t count_of(const whit_probe_report *report, whit_probe_end end_a,
                         whit_probe_end end_b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < report->ray_count; ++i)
        count += report->rays[i].end == end_a || report->rays[i].end == end_b;
    return count;
}

TEST(values_are_those_of_the_first_sample_in_the_order_of_rays)
{
    own_whit_renderer *renderer = make(shader, 4);
    own_report *report = probe_of(renderer, X, Y, 0);
    uint32_t met = count_of(report, WHIT_PROBE_OPAQUE, WHIT_PROBE_DIVIDED);
    uint32_t missed = count_of(report, WHIT_PROBE_MISSED, WHIT_PROBE_MISSED);
    assert_true(met > 2 && missed > 0);
    assert_int_equal(report->call_count, 9);
    assert_call(report, 0, 2, "pixel()", 1, "(20, 30)");
    assert_call(report, 1, 4, "vec2(0.1, -0.0)", 1, "(0.100000001, -0)");
    assert_call(report, 2, 6, "bounces()", met, "0");
    assert_call(report, 3, 8, "ivec3(i, -i, -2147483647)", 12 * met, "(0, 0, -2147483647)");
    assert_string_equal(text_of(report, 3, 7), "(7, -7, -2147483647)");
    assert_call(report, 4, 9, "1.0", 0, "");
    assert_call(report, 5, 10, "1.0 + float(dbg(bvec4(true, false, false, true)).w)", met, "2");
    assert_call(report, 6, 10, "bvec4(true, false, false, true)", met,
                "(true, false, false, true)");
    assert_call(report, 7, 11, "vec3(4.0)", missed, "(4, 4, 4)");
    char color[128];
    snprintf(color, sizeof color, "(%.9g, %.9g, %.9g)", (double)report->color[0],
             (double)report->color[1], (double)report->color[2]);
    assert_call(report, 8, 12, "color", 1, color);
    const whit_probe_call *bounces = &report->calls[2];
    for (uint32_t i = 0; i < bounces->value_count; ++i) {
        const whit_probe_value *value = &bounces->values[i];
        assert_true(value->v[0] == (double)report->rays[value->ray].generation);
        assert_int_equal(value->generation, report->rays[value->ray].generation);
        assert_true(i == 0 || value->ray > bounces->values[i - 1].ray);
    }
}

TEST(rays_that_are_dropped_have_no_values)
{
    own_whit_renderer *renderer = make(shader, 1);
    own_report *all = probe_of(renderer, X, Y, 0), *some = probe_of(renderer, X, Y, 2);
    assert_true(some->dropped > 0);
    assert_int_equal(some->calls[2].count, all->calls[2].count);
    assert_int_equal(some->calls[2].value_count, 2);
    assert_int_equal(some->calls[8].value_count, 1);
}

TEST(a_pixel_tells_of_itself_and_twice_the_same)
{
    own_whit_renderer *renderer = make(shader, 1);
    own_report *first = probe_of(renderer, X, Y, 0);
    own_report *other = probe_of(renderer, FLOOR_X, FLOOR_Y, 0);
    own_report *second = probe_of(renderer, X, Y, 0);
    assert_call(other, 0, 2, "pixel()", 1, "(5, 40)");
    for (uint32_t i = 0; i < first->call_count; ++i) {
        assert_int_equal(second->calls[i].count, first->calls[i].count);
        assert_memory_equal(second->calls[i].values, first->calls[i].values,
                            sizeof first->calls[i].values);
    }
}

static void assert_calls(whit_renderer *renderer, uint32_t count)
{
    own_report *report = probe_of(renderer, X, Y, 0);
    assert_int_equal(report->call_count, count);
    if (count)
        assert_call(report, 1, 4, "vec2(0.1, -0.0)", 1, "(0.100000001, -0)");
}

TEST(another_view_and_another_version_are_followed)
{
    own_whit_renderer *renderer = make(plain, 1);
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    assert_calls(renderer, 0);
    assert_int_equal(whit_renderer_set_shader(renderer, &params), WHIT_OK);
    assert_calls(renderer, 9);
    params.shader = NULL;
    params.depth = 2;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    assert_calls(renderer, 9);
    params.shader = plain;
    params.camera.name = "none of the scene";
    assert_int_equal(whit_renderer_set_shader(renderer, &params), WHIT_ERROR_USAGE);
    params.camera.name = NULL;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    assert_calls(renderer, 9);
    assert_int_equal(whit_renderer_set_shader(renderer, &params), WHIT_OK);
    assert_calls(renderer, 0);
}

TEST(a_picture_has_nothing_of_it)
{
    whit_shader_info with, without;
    const uint32_t *words, *plain_words;
    size_t bytes, plain_bytes;
    whit_shader_get_info(shader, &with);
    whit_shader_get_info(plain, &without);
    assert_int_equal(with.kernel_count, 7);
    assert_int_equal(with.instructions, without.instructions);
    for (uint32_t i = 0; i < with.kernel_count; ++i) {
        assert_non_null(whit_shader_kernel(shader, i, &words, &bytes));
        assert_non_null(whit_shader_kernel(plain, i, &plain_words, &plain_bytes));
        assert_int_equal(bytes, plain_bytes);
        assert_memory_equal(words, plain_words, bytes);
    }
    whit_renderer_params params = whit_renderer_defaults();
    whit_kernel kernels[2][WHIT_KERNELS_MAX];
    uint32_t counts[2];
    for (int i = 0; i < 2; ++i) {
        params.shader = i ? plain : shader;
        assert_int_equal(whit_kernels_list(device, accel, &params, false, kernels[i], &counts[i]),
                         WHIT_OK);
    }
    assert_int_equal(counts[0], counts[1]);
    for (uint32_t i = 0; i < counts[0]; ++i)
        assert_int_equal(kernels[0][i].instructions, kernels[1][i].instructions);
}

/* A probe draws the pixel with kernels that record, and has the same values. */
TEST(a_value_that_is_recorded_is_the_value)
{
    own_whit_renderer *renderer = make(plain, 4), *looked_at = make(shader, 4);
    own_whit_image *image = image_of(renderer, WHIT_AOV_COLOR);
    const float *pixel = whit_image_floats(image) + 4 * (Y * WIDTH + X);
    own_report *report = probe_of(looked_at, X, Y, 0), *without = probe_of(renderer, X, Y, 0);
    assert_memory_equal(report->color, pixel, 3 * sizeof *pixel);
    assert_int_equal(without->call_count, 0);
    assert_memory_equal(without->color, pixel, 3 * sizeof *pixel);
}

TESTS_IN(begin, end)
