/* A user's shape is drawn as a mesh is, and invalid answers of intersect() are reported. */
#include "hooks_fixture.h"

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT };

/* A floor and a mirror behind it, with a ball or without. */
static const char room[] =
    "{\"camera\":{\"eye\":[0,1.2,4],\"target\":[0,0.8,0],\"fov\":45},\n"
    "\"lights\":[{\"kind\":\"point\",\"position\":[2,4,3],\"intensity\":20}],\n"
    "\"materials\":{\"floor\":{\"diffuse\":[0.5,0.4,0.3]},\"mirror\":{\"reflection\":0.9},\n"
    "\"gold\":{\"diffuse\":[0.6,0.5,0.1],\"reflection\":0.3,\"specular\":0.5,\"shininess\":50}},\n"
    "\"objects\":[{\"shape\":\"plane\",\"size\":[9,9],\"material\":\"floor\"},\n"
    "{\"shape\":\"ball\",\"radius\":0.2,\"translation\":[-0.9,0.2,1],\"material\":\"gold\"},\n"
    "%s{\"shape\":\"plane\",\"size\":[6,4],\"rotation\":[90,0,0],\"translation\":[0,1,-2],"
    "\"material\":\"mirror\"}]}\n";
static const char real_ball[] = "{\"shape\":\"ball\",\"radius\":0.7,"
                                "\"translation\":[0.2,0.75,0],\"material\":\"gold\"},\n";

/* The same ball by intersect(). */
#define BOX "//@ box -0.5 0.05 -0.7  0.9 1.45 0.7  0.000001 gold\n"
#define INTERSECT                                                                                  \
    "bool intersect(vec3 origin, vec3 dir, float far, out float t, out vec3 normal)\n{\n"
#define MEET                                                                                       \
    "    vec3 from = origin - vec3(0.2, 0.75, 0.0);\n"                                             \
    "    float b = dot(from, dir);\n"                                                              \
    "    vec3 aside = from - b * dir;\n"                                                           \
    "    float root = sqrt(max(0.49 - dot(aside, aside), 0.0));\n"                                 \
    "    t = -b - root;\n"                                                                         \
    "    normal = from + t * dir;\n"
#define GIVE       "    return dot(aside, aside) < 0.49 && t >= 0.0;\n}\n"
#define SHAPE_TEXT BOX INTERSECT MEET GIVE

/* The room with `part` in it. */
static void open_room(const char *part)
{
    char path[] = "/tmp/whit_room_XXXXXX.json";
    FILE *stream = fdopen(mkstemps(path, 5), "w");
    assert_non_null(stream);
    assert_true(fprintf(stream, room, part) >= 0 && fclose(stream) == 0);
    scene_open(path);
    remove(path);
}

struct picture {
    float color[PIXELS * 4];
    uint32_t ids[PIXELS * 2];
};

/* Draws the room with `part` in it. Gives the result of the renderer. */
static whit_result draw(const char *part, const whit_shader *shader, whit_numerics numerics,
                        struct picture *out)
{
    own_whit_renderer *renderer = NULL;
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    open_room(part);
    params.numerics = numerics;
    whit_result result = whit_renderer_create(device, accel, &params, &renderer);
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    own_whit_image *color = NULL, *ids = NULL;
    if (result == WHIT_OK && out) {
        color = image_of(renderer, WHIT_AOV_COLOR);
        ids = image_of(renderer, WHIT_AOV_IDS);
        memcpy(out->color, whit_image_floats(color), sizeof out->color);
        memcpy(out->ids, whit_image_words(ids), sizeof out->ids);
    }
    return result;
}

/* Colours, shadows, mirror images and hidden parts are those of a real ball, except pixels at the
   rim, where rays hit only one of the two by rounding. */
static void compare(const struct picture *shape, const struct picture *real)
{
    uint32_t on_shape = 0, apart = 0;
    for (uint32_t i = 0; i < PIXELS; ++i) {
        bool seen = shape->ids[2 * i] == WHIT_INSTANCE_SHAPE;
        on_shape += seen;
        bool same = seen == (real->ids[2 * i] == 2);
        for (uint32_t c = 0; c < 3; ++c)
            same = same && fabsf(shape->color[4 * i + c] - real->color[4 * i + c]) < 0.01f;
        apart += !same;
    }
    assert_true(on_shape > PIXELS / 12);
    if (apart > PIXELS / 500)
        fail_msg("%u of %d pixels are not as with the real ball", apart, PIXELS);
}

TEST(shape_is_seen_lit_mirrored_and_in_the_way_as_a_ball_is)
{
    static struct picture shape, real;
    own_whit_shader *shader = hooks_load(SHAPE_TEXT);
    static const whit_numerics levels[] = {WHIT_NUMERICS_WATERTIGHT, WHIT_NUMERICS_EXACT};
    for (size_t i = 0; i < sizeof levels / sizeof *levels; ++i) {
        assert_int_equal(draw("", shader, levels[i], &shape), WHIT_OK);
        assert_int_equal(draw(real_ball, NULL, levels[i], &real), WHIT_OK);
        compare(&shape, &real);
    }
}

/* In a probe the float mirror and exact arithmetic, which do not know the shape, agree that nothing
   is in front of it, and agree on all rays behind it. */
TEST_BY_TURNS(probe_of_the_shape_differs_nowhere, 0, 2)
{
    own_whit_shader *shader = hooks_load(SHAPE_TEXT);
    whit_probe_report *report;
    open_room("");
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_probe(renderer, WIDTH / 2, HEIGHT / 2, 0, &report), WHIT_OK);
    assert_int_equal(report->rays[0].device.instance, WHIT_INSTANCE_SHAPE);
    assert_true(report->ray_count > 2 && report->differing == 0);
    whit_probe_report_destroy(report);
}

/* Rays that the user's other functions trace hit the shape, and its loops have their own fuel. */
TEST_BY_TURNS(functions_that_trace_meet_the_shape, 1, 2)
{
    static const char shade[] =
        "%s" SHAPE_TEXT "vec3 shade(Surface s, Optics o, vec3 to_eye)\n{\n"
        "    Surface met;\n    float distance;\n    vec3 sum = vec3(0.0);\n"
        "    bool some = trace(off_surface(s, s.ng), s.ng, met, distance);\n"
        "    return vec3(visible(s, s.ng, 5.0).x, some ? distance : 0.0, some ? met.ns.y : 0.0);\n"
        "}\n";
    static struct picture shape, real;
    char text[4096];
    snprintf(text, sizeof text, shade, "");
    own_whit_shader *with_shape = hooks_load(text);
    own_whit_shader *without = hooks_load(strstr(text, "vec3 shade"));
    assert_int_equal(draw("", with_shape, WHIT_NUMERICS_WATERTIGHT, &shape), WHIT_OK);
    assert_int_equal(draw(real_ball, without, WHIT_NUMERICS_WATERTIGHT, &real), WHIT_OK);
    compare(&shape, &real);
}

TEST_BY_TURNS(material_that_nothing_wears_has_a_nearest_one, 0, 2)
{
    own_whit_shader *shader =
        hooks_load("//@ box -1 0 -1  1 1 1  0.01 gald\n"
                   "bool intersect(vec3 origin, vec3 dir, float far, out float t, "
                   "out vec3 normal)\n{ t = 0.0; normal = -dir; return false; }\n");
    assert_int_equal(draw("", shader, WHIT_NUMERICS_WATERTIGHT, NULL), WHIT_OK);
    assert_non_null(strstr(messages.text, "wears a material `gald`; did you mean `gold`?"));
}

/* Asserts that drawing gives `wanted`, with `part` in the message. */
static void expect_error(const char *content, whit_result wanted, const char *part)
{
    own_whit_shader *shader = NULL;
    messages = (struct messages){0};
    whit_result result = hooks_try(content, &shader);
    if (result == WHIT_OK)
        result = draw("", shader, WHIT_NUMERICS_WATERTIGHT, NULL);
    if (result != wanted || !strstr(messages.last_error, part))
        fail_msg("%d, `%s` in place of %d, `%s`", (int)result, messages.last_error, (int)wanted,
                 part);
}

TEST_BY_TURNS(answers_that_are_no_shape_s_are_told, 1, 2)
{
    static const struct {
        const char *content, *part;
    } cases[] = {
        /* Both this and a loop without an end are reported. */
        {"//@ box -0.5 0.05 -0.7  0.9 0.8 0.7  0.000001 gold\n" INTERSECT MEET GIVE
         "vec3 shade(Surface s, Optics o, vec3 to_eye) { float t = 1.0; while (t > 0.0) t += 1.0; "
         "return vec3(t); }\n",
         ":2: intersect() meets its shape outside of the box of `//@ box`, in pixel "},
        {"//@ box -0.5 0.05 -0.7  0.9 0.8 0.7  0.000001 gold\n" INTERSECT MEET GIVE,
         ":2: intersect() meets its shape outside of the box of `//@ box`, in pixel "},
        {BOX INTERSECT MEET "    t = min(t, far * 0.5);\n" GIVE,
         ":2: intersect() meets something else with a larger `far`, in pixel "},
        {BOX "float count = 0.0;\n" INTERSECT MEET
             "    count += 1.0;\n    t += count * 0.01;\n" GIVE,
         ":3: intersect() meets something else with a larger `far`, in pixel "},
        {BOX INTERSECT MEET "    t = sqrt(-1.0 - t * t);\n    return true;\n}\n",
         ":2: intersect() gives what is no number, in pixel "},
        {BOX INTERSECT MEET "    t = (1.0 + t * t) * 1e30 * 1e30;\n    return true;\n}\n",
         ":2: intersect() gives what is no number, in pixel "},
        {BOX INTERSECT
         "    t = 0.5;\n    while (t > 0.0)\n        t += 1.0;\n    return false;\n}\n",
         ":5: `//@ fuel N` gives it more than 10000"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        expect_error(cases[i].content, WHIT_ERROR_STATUS, cases[i].part);
        bool names_pixel = strstr(cases[i].part, ", in pixel ");
        assert_int_equal(strstr(messages.last_error, " of 96 x 64") != NULL, names_pixel);
    }
}

TEST(files_with_half_a_shape_are_refused)
{
    static const struct {
        const char *content, *part;
    } cases[] = {
        {INTERSECT MEET GIVE, ":1: intersect() needs `//@ box`"},
        {BOX "vec3 miss(vec3 dir) { return dir; }\n", ":1: the box has no shape"},
        {BOX BOX INTERSECT MEET GIVE, ":2: there is a box already, in line 1"},
        {"//@ box 1 0 0 0 1 1 0.1\n" INTERSECT MEET GIVE,
         ":1: a side of the box is a number from 1 to"},
        {"//@ box 0 0 0 1 1 1 0\n" INTERSECT MEET GIVE, ":1: how far answers may be"},
        {"//@ box 0 0 0 1 1 1 0.1 gold x\n" INTERSECT MEET GIVE, ":1: behind the box"},
        {BOX INTERSECT "    Surface met;\n    return trace(origin, dir, met, t);\n}\n",
         "recursion"},
        {BOX INTERSECT "    Surface s;\n    normal = visible(s, dir, far);\n    return false;\n}\n",
         "recursion"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        expect_error(cases[i].content, WHIT_ERROR_INPUT, cases[i].part);
}

TESTS_IN(hooks_begin, hooks_end)
