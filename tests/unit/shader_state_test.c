/* What functions of users can read of the call they are in: rays, pixels, random numbers, and
   surfaces that trace() has met. */
#include "hooks_fixture.h"

enum { WIDTH = 48, HEIGHT = 36, PIXELS = WIDTH * HEIGHT };

/* Draws with functions; `pixels` gets RGBA. */
static void draw(const char *content, float pixels[PIXELS][4])
{
    own_whit_shader *shader = hooks_load(content);
    const whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    own_whit_renderer *renderer = renderer_of(&params);
    if (whit_renderer_render(renderer) != WHIT_OK)
        fail_msg("%s\n%s", content, messages.last_error);
    own_whit_image *image = image_of(renderer, WHIT_AOV_COLOR);
    memcpy(pixels, whit_image_floats(image), PIXELS * sizeof *pixels);
}

static float pixels[PIXELS][4], others[PIXELS][4];

/* From a point of the floor straight up; what is met there cannot see below the floor. */
TEST_IN(surfaces_that_trace_meets_are_shadowed, hooks_begin_default, hooks_end)
{
    draw("vec3 shade(Surface s, Optics o, vec3 to_eye) {\n"
         " Surface met, back; float d, e; vec3 up = vec3(0.0, 1.0, 0.0);\n"
         " if (s.ng.y < 0.99 || !trace(off_surface(s, up), up, met, d)) return vec3(0.25);\n"
         " bool hits = trace(off_surface(met, -up), -up, back, e);\n"
         " return vec3(visible(met, -up, 1e6).g, visible(back, up, e * 0.5).g, hits ? 1.0 : 0.0);\n"
         "}\nvoid scatter(Surface s, Optics o, inout Rays rays) {}\n",
         pixels);
    uint32_t below = 0;
    for (uint32_t i = 0; i < PIXELS; ++i) {
        if (pixels[i][2] != 1.0f)
            continue;
        ++below;
        assert_true(pixels[i][0] == 0.0f); /* the floor blocks */
        assert_true(pixels[i][1] == 1.0f); /* and does not block itself */
    }
    assert_true(below > PIXELS / 50);
}

/* Rays along a rounded surface would see shading normals that point away from them. */
TEST_IN(normals_that_trace_meets_face_the_ray, hooks_begin_default, hooks_end)
{
    draw("vec3 shade(Surface s, Optics o, vec3 to_eye) {\n"
         " float away = 0.0, met = 0.0;\n"
         " for (uint i = 0u; i < 32u; i++) { Surface m; float d;\n"
         "  vec3 dir = normalize(vec3(random(3u * i), random(3u * i + 1u), random(3u * i + 2u)) - "
         "0.5);\n"
         "  if (!trace(off_surface(s, dir), dir, m, d)) continue;\n"
         "  met = 1.0; away += dot(m.ns, dir) > 0.0 || dot(m.ng, dir) > 0.0 ? 1.0 : 0.0; }\n"
         " return vec3(met, away, 0.0); }\n"
         "vec3 miss(vec3 dir) { return vec3(0.0); }\n"
         "void scatter(Surface s, Optics o, inout Rays rays) {}\n",
         pixels);
    uint32_t some = 0;
    for (uint32_t i = 0; i < PIXELS; ++i) {
        some += pixels[i][0] == 1.0f;
        assert_true(pixels[i][1] == 0.0f);
    }
    assert_true(some > PIXELS / 4);
}

TEST_IN(random_numbers_of_post_differ_and_repeat, hooks_begin_default, hooks_end)
{
    static const char content[] = "vec3 post(ivec2 at, vec3 color) { return vec3(random(0u), "
                                  "random(1u), ray_distance()); }\n";
    double sum = 0.0;
    uint32_t same = 0;
    draw(content, pixels);
    draw(content, others);
    assert_memory_equal(pixels, others, sizeof pixels);
    for (uint32_t i = 0; i < PIXELS; ++i) {
        sum += (double)pixels[i][0] / PIXELS;
        same += pixels[i][0] == pixels[i][1] || (i && pixels[i][0] == pixels[i - 1][0]);
        assert_true(pixels[i][2] == 0.0f); /* post() has no ray */
    }
    assert_true(fabs(sum - 0.5) < 0.05 && same < 4);
}

/* Red at the first surface, green behind it. */
TEST_IN(random_numbers_of_rays_that_go_straight_on_differ, hooks_begin_default, hooks_end)
{
    draw("vec3 shade(Surface s, Optics o, vec3 to_eye) { float x = random(0u);\n"
         " return vec3(bounces() == 0u ? x : 0.0, bounces() == 1u ? x : 0.0, 0.0); }\n"
         "vec3 miss(vec3 dir) { return vec3(0.0); }\n"
         "void scatter(Surface s, Optics o, inout Rays rays) { rays.straight = vec3(1.0); }\n",
         pixels);
    uint32_t pairs = 0;
    for (uint32_t i = 0; i < PIXELS; ++i) {
        bool both = pixels[i][0] > 0.0f && pixels[i][1] > 0.0f;
        pairs += both;
        assert_true(!both || pixels[i][0] != pixels[i][1]);
    }
    assert_true(pairs > 100);
}

TEST_IN(variables_are_set_before_there_is_a_pixel, hooks_begin_default, hooks_end)
{
    draw("uvec2 at = pixel();\nfloat k = random(1u), t = ray_distance(); vec3 d = ray_dir();\n"
         "vec3 post(ivec2 p, vec3 color) { return vec3(at.x + at.y, k, t + length(d)); }\n",
         pixels);
    for (uint32_t i = 0; i < PIXELS; ++i)
        assert_true(pixels[i][0] == 0.0f && pixels[i][1] == pixels[0][1] && pixels[i][2] == 0.0f);
}

/* A shape that is there for some pixels only. */
TEST_IN(intersect_knows_the_pixel, hooks_begin_default, hooks_end)
{
    draw("//@ box -50 -50 -50  50 50 50  0.01\n"
         "bool intersect(vec3 origin, vec3 dir, float far, out float t, out vec3 normal) {\n"
         " t = 0.5; normal = -dir;\n"
         " return bounces() == 0u && pixel().x < 24u && random(0u) >= 0.0 && t < far; }\n"
         "vec3 shade(Surface s, Optics o, vec3 to_eye) { return vec3(ray_distance()); }\n"
         "void scatter(Surface s, Optics o, inout Rays rays) {}\n"
         "vec3 miss(vec3 dir) { return vec3(0.0); }\n",
         pixels);
    for (uint32_t i = 0; i < PIXELS; ++i)
        assert_true((fabsf(pixels[i][0] - 0.5f) < 1e-4f) == (i % WIDTH < 24));
}

TEST_IN(surface_that_changes_nothing_changes_no_bit, hooks_begin_default, hooks_end)
{
    const whit_renderer_params params = params_sized(WIDTH, HEIGHT, NULL);
    own_whit_renderer *renderer = renderer_of(&params);
    own_whit_image *image = drawn_by(renderer);
    draw("void surface(inout Surface s) {}\n", pixels);
    assert_memory_equal(whit_image_floats(image), pixels, sizeof pixels);
}

TEST_IN(camera_directions_may_have_any_length, hooks_begin_default, hooks_end)
{
    static const char *const factors[] = {"1e-38", "1e-30", "1e25", "3e37"};
    draw("void camera(vec2 at, inout vec3 origin, inout vec3 dir) {}\n", pixels);
    for (size_t i = 0; i < sizeof factors / sizeof *factors; ++i) {
        char content[128];
        uint32_t apart = 0;
        snprintf(content, sizeof content,
                 "void camera(vec2 at, inout vec3 origin, inout vec3 dir) { dir *= %s; }\n",
                 factors[i]);
        draw(content, others);
        for (uint32_t p = 0; p < PIXELS; ++p)
            apart += !(fabsf(others[p][1] - pixels[p][1]) < 1e-2f);
        if (apart > PIXELS / 100)
            fail_msg("%s: %u pixels are other", factors[i], apart);
    }
}
