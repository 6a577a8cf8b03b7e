/* Lights: flat emitters compared with integrals, cones, ranges, and shadows of each kind. */
#include <float.h>

#include "picture_fixture.h"
#include "render/variants.h"
#include "unit.h"

static const double pi = 3.14159265358979323846;

enum { SIDE = 9 };
static const double eye_height = 8.0, view = 0.6; /* see dark_scene */

/* The point of the floor that pixel (x, y) of a picture of side * side pixels shows. */
static void floor_point(uint32_t x, uint32_t y, uint32_t side, double out[3])
{
    double reach = eye_height * tan(view / 2.0);
    out[0] = ((x + 0.5) / side * 2.0 - 1.0) * reach;
    out[1] = 0.0;
    out[2] = ((y + 0.5) / side * 2.0 - 1.0) * reach;
}

/* The form factor from an emitter to a horizontal floor, as a sum over midpoints in double. A
   triangle is half of the square that its edges span. */
static double form_factor(const struct scene_light *light, const double p[3])
{
    enum { GRID = 1200 };
    bool triangle = light->kind == WHIT_LIGHT_TRIANGLE;
    const double *u = light->edge_u, *v = light->edge_v;
    double n[3], sum = 0.0;
    for (int i = 0; i < 3; ++i)
        n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
    for (int row = 0; row < GRID; ++row) {
        for (int column = 0; column < GRID; ++column) {
            double s = (column + 0.5) / GRID, t = (row + 0.5) / GRID, way[3], cosine = 0.0;
            if (triangle && row + column > GRID - 1)
                continue;
            double share = triangle && row + column == GRID - 1 ? 0.5 : 1.0;
            for (int i = 0; i < 3; ++i) {
                way[i] = light->position[i] + s * u[i] + t * v[i] - p[i];
                cosine += way[i] * n[i];
            }
            double square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
            if (way[1] > 0.0)
                sum += share * way[1] * fabs(cosine) / (square * square);
        }
    }
    return sum / pi / GRID / GRID;
}

/* Without shadows the light of an emitter is an integral that whit states exactly. The kernel adds
   four edges, each off by some ten roundings (6e-7 of itself); in these scenes they cancel down to
   no less than an eighth of themselves. The reference is off by the square of its step over the
   distance, and by as much as a row of it where the horizon cuts the emitter. */
static void check_form_factor(struct scene_light light, uint32_t samples, double tolerance)
{
    whit_renderer_params params = {
        .width = SIDE, .height = SIDE, .shadows = WHIT_SHADOWS_NONE, .light_samples = samples};
    struct scene *scene = floor_scene(eye_height);
    const struct scene_light copy = light;
    scene_put_light(scene, light);
    own_image image = color_of(scene, NULL, &params);
    for (uint32_t y = 0; y < SIDE; y += 2) {
        for (uint32_t x = 0; x < SIDE; x += 2) {
            double p[3];
            floor_point(x, y, SIDE, p);
            double expected = 3.0 * form_factor(&copy, p);
            assert_near(image.pixels[4 * (y * SIDE + x)], expected, tolerance);
        }
    }
}

TEST_BY_TURNS(emitters_give_their_integral, 0, 4)
{
    /* Above the floor, tilted, and through the floor's horizon. */
    static const struct {
        double corner[3], u[3], v[3];
        uint32_t samples;
        double tolerance;
    } rows[] = {{{-0.7, 1.5, -0.4}, {2, 0, 0}, {0, 0, 1}, 16, 5e-6},
                {{-4.5, 0.5, -2.5}, {1, 0.3, 6}, {0.5, 2, -0.3}, 4, 5e-6},
                {{-4.5, -1.0, -2.0}, {1, 0.3, 6}, {0.5, 4, -0.3}, 64, 1e-3},
                {{-0.7, 1.5, -0.4}, {1e-2, 0, 0}, {0, 1e-3, 5e-3}, 16, 2e-5},
                {{-0.7, 1.5, -0.4}, {2e-6, 0, 0}, {0, 0, 1e-6}, 16, 5e-6}};
    for (int i = 0; i < 10; ++i) {
        whit_light_kind kind = i % 2 ? WHIT_LIGHT_TRIANGLE : WHIT_LIGHT_RECTANGLE;
        check_form_factor(emitter(kind, rows[i / 2].corner, rows[i / 2].u, rows[i / 2].v, 3.0f),
                          rows[i / 2].samples, rows[i / 2].tolerance);
    }
}

/* The form factor from a floor to the rectangle between the point `h` above and the corner (x, h,
   z) (Howell, Menguc and Siegel 2010, configuration B-4). */
static double corner_factor(double x, double z, double h)
{
    double a = sqrt(h * h + x * x), b = sqrt(h * h + z * z);
    return (x / a * atan(z / a) + z / b * atan(x / b)) / (2.0 * pi);
}

/* The form factor of a sheet of the sides `wide` from p, whose normal is +y. The sheet begins at
   `at` and goes along `e` and `f`; or (a wall) along `f` and up, from below the horizon, so that of
   each direction in which it stands all is seen. Triangles lack no more than the share 10 / wide.
 */
static double wide_factor(bool wall, const double at[3], const double e[3], const double f[3],
                          const double p[3], double wide)
{
    const double way[3] = {at[0] - p[0], 0.0, at[2] - p[2]};
    double x = double3_dot(way, e), z = double3_dot(way, f), h = at[1];
    if (wall)
        return (pi / 2.0 - atan(z / x)) / (2.0 * pi);
    return corner_factor(wide, wide, h) - corner_factor(x, wide, h) - corner_factor(wide, z, h) +
           corner_factor(x, z, h);
}

/* Emitters of which one corner is near and the others very far away, some below the horizon. */
TEST(wide_emitters_keep_their_light)
{
    const double e[3] = {0.96, 0, 0.28}, f[3] = {-0.28, 0, 0.96}, widths[] = {1e7, 1e9, 1e12};
    const double corners[2][3] = {{-0.4, 1.5, -0.3}, {3.5, -0.7, 0.4}};
    for (int i = 0; i < 12; ++i) {
        double wide = widths[i / 4], u[3], v[3] = {0, wide, 0};
        bool wall = i & 2;
        for (int k = 0; k < 3; ++k) {
            u[k] = wide * f[k];
            v[k] = wall ? v[k] : wide * e[k];
        }
        whit_renderer_params params = {
            .width = SIDE, .height = SIDE, .shadows = WHIT_SHADOWS_NONE, .light_samples = 64};
        struct scene *scene = floor_scene(eye_height);
        scene_put_light(scene, emitter(i % 2 ? WHIT_LIGHT_TRIANGLE : WHIT_LIGHT_RECTANGLE,
                                       corners[wall], u, v, 3.0f));
        own_image image = color_of(scene, NULL, &params);
        for (uint32_t k = 0; k < SIDE * SIDE; ++k) {
            double p[3];
            floor_point(k % SIDE, k / SIDE, SIDE, p);
            double factor = wide_factor(wall, corners[wall], e, f, p, wide);
            assert_near(image.pixels[4 * k], 3.0 * factor, 5e-6);
        }
    }
}

/* Seen from the middle of the floor, a plate hides exactly half of the emitter. With n points on
   the emitter, each stands for 1 / n of its light. */
TEST_BY_TURNS(half_a_cover_takes_half, 1, 4)
{
    static const uint32_t samples[] = {4, 16, 64};
    for (int i = 0; i < 6; ++i) {
        /* The triangle's line of symmetry is x = 0. */
        struct scene_light light =
            i % 2 ? emitter(WHIT_LIGHT_TRIANGLE, (double[]){0, 2, 0.2}, (double[]){-0.2, 0, -0.3},
                            (double[]){0.2, 0, -0.3}, 3.0f)
                  : emitter(WHIT_LIGHT_RECTANGLE, (double[]){-0.2, 2, -0.2}, (double[]){0.4, 0, 0},
                            (double[]){0, 0, 0.4}, 3.0f);
        const whit_renderer_params params = {.width = 1,
                                             .height = 1,
                                             .light_samples = samples[i / 2],
                                             .camera =
                                                 CAMERA_AT(-3, 0.5, 0, 0, 0, 0, 0, 1, 0, 0.01)};
        double whole = 3.0 * form_factor(&light, (double[]){0, 0, 0});
        struct scene *scene = floor_scene(eye_height);
        add_object(scene, mesh_plane(4), material_plain("plate"), 2.0, 1.0, 0);
        scene_put_light(scene, light);
        own_image image = color_of(scene, NULL, &params);
        double share = (double)image.pixels[0] / whole;
        print_message("  %s of %u points: share %.4f\n", i % 2 ? "triangle" : "rectangle",
                      samples[i / 2], share);
        assert_true(fabs(share - 0.5) <= 1.0 / samples[i / 2] + 1e-5);
    }
}

/* Each sample of a pixel takes other points of the light, so that the steps within a soft shadow
   become smaller. */
TEST_BY_TURNS(pixel_samples_smooth_shadows, 2, 4)
{
    double largest[2];
    for (int i = 0; i < 2; ++i) {
        struct scene *scene = floor_scene(eye_height);
        add_object(scene, mesh_plane(6), material_plain("plate"), 3.0, 1.5, 0);
        scene_put_light(scene, emitter(WHIT_LIGHT_RECTANGLE, (double[]){-1, 3, -1},
                                       (double[]){2, 0, 0}, (double[]){0, 0, 2}, 3.0f));
        whit_renderer_params params = {.width = 200,
                                       .height = 1,
                                       .sampling.count = i ? 16 : 1,
                                       .light_samples = 4,
                                       .camera =
                                           CAMERA_AT(-0.5, 1.4, 0, -0.5, 0, 0, 0, 0, -1, 0.2)};
        own_image image = color_of(scene, NULL, &params);
        largest[i] = 0.0;
        for (uint32_t x = 1; x < image.width; ++x)
            largest[i] =
                fmax(largest[i], fabs((double)(image.pixels[4 * x] - image.pixels[4 * (x - 1)])));
        assert_true(red_sum(&image) > 0.0);
    }
    print_message("  largest step %.4f, with 16 samples %.4f\n", largest[0], largest[1]);
    assert_true(largest[1] < 0.35 * largest[0]);
}

TEST_BY_TURNS(spots_fall_off_between_their_cones, 3, 4)
{
    const double height = 3.0, inner = 0.15, outer = 0.4;
    struct scene *scene = floor_scene(eye_height);
    struct scene_light light = {.kind = WHIT_LIGHT_SPOT,
                                .node = SCENE_NONE,
                                .position = {0, height, 0},
                                .direction = {0, -1, 0},
                                .falloff = true};
    scene_light_cones(&light, inner, outer);
    set_rgb(light.color, 5, 5, 5);
    scene_put_light(scene, light);
    whit_renderer_params params = {.width = 33, .height = 33};
    own_image image = color_of(scene, NULL, &params);
    uint32_t full = 0, soft = 0, dark = 0;
    for (uint32_t y = 0; y < 33; ++y) {
        for (uint32_t x = 0; x < 33; ++x) {
            double p[3];
            floor_point(x, y, 33, p);
            double square = p[0] * p[0] + p[2] * p[2] + height * height;
            double cosine = height / sqrt(square);
            double part = (cosine - cos(outer)) / (cos(inner) - cos(outer));
            double cone = fmin(fmax(part, 0.0), 1.0);
            double expected = 5.0 * cone * cone * cosine / square;
            float value = image.pixels[4 * (33 * y + x)];
            /* A cosine is off by some 6e-7 (the point by 2e-6, see below); those of the cones are
               0.068 apart. */
            if (cone > 0.01)
                assert_near(value, expected, 2.0 * 6e-7 / 0.068 / cone + 6e-6);
            else
                assert_true(value <= 1e-4f);
            ++*(part >= 1.0 ? &full : part > 0.0 ? &soft : &dark);
        }
    }
    assert_true(full > 20 && soft > 100 && dark > 100);
}

TEST_BY_TURNS(ranges_end_lights, 0, 4)
{
    struct scene *scene = floor_scene(eye_height);
    scene_put_lamp(scene, 0, 1, 0, 2.0f);
    scene->lights[0].range = 1.5f;
    whit_renderer_params params = {.width = 33, .height = 33};
    own_image image = color_of(scene, NULL, &params);
    for (uint32_t i = 0; i < 33 * 33; ++i) {
        double p[3];
        floor_point(i % 33, i / 33, 33, p);
        double square = p[0] * p[0] + p[2] * p[2] + 1.0;
        /* The eye is 8 away: four roundings put the point off by 2e-6, which counts up to three
           times, and four times more in what is left of 1 - (distance / range)^4; with those of
           the light 6e-6 and 9e-6. */
        double fade = 1.0 - square * square / pow(1.5, 4.0);
        if (square < 2.24)
            assert_near(image.pixels[4 * i], 2.0 / square / sqrt(square) * fade,
                        6e-6 + 9e-6 / fade);
        if (square > 2.26)
            assert_true(image.pixels[4 * i] == 0.0f);
    }
}

/* Without lights, with lights in the surface itself, without power or with far too much power, all
   values of the picture are finite. */
TEST_BY_TURNS(odd_lights_give_finite_pictures, 1, 4)
{
    for (int i = 0; i < 6; ++i) {
        struct scene *scene = floor_scene(eye_height);
        float strength = i == 2 ? 0.0f : i == 3 ? 3e38f : 1.0f;
        if (i == 5)
            scene_put_light(scene, emitter(WHIT_LIGHT_RECTANGLE, (double[]){-1, 0, -1},
                                           (double[]){2, 0, 0}, (double[]){0, 0, 2}, 3e38f));
        else if (i == 4)
            scene_put_light(scene, emitter(WHIT_LIGHT_TRIANGLE, (double[]){-1, 1, -1},
                                           (double[]){2, 0, 0}, (double[]){1, 0, 0}, 1.0f));
        else if (i > 0)
            scene_put_lamp(scene, 0, i == 1 ? 0.0 : 1e-6, 0, strength);
        whit_renderer_params params = {.width = 33, .height = 33};
        own_image image = color_of(scene, NULL, &params);
        assert_range(&image, 0, FLT_MAX);
        assert_true(i != 2 || red_sum(&image) == 0.0);
    }
}

/* S4 of the catalogue of hard cases: a lamp just above the floor lights it by the formula, one in
   it or just behind it not at all. */
TEST_BY_TURNS(lamps_next_to_a_surface_are_on_one_side, 2, 4)
{
    enum { ACROSS = 33 };
    const double heights[] = {1e-6, 1e-3, 0.0, -1e-6};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; ++i) {
        const whit_renderer_params params = {.width = ACROSS, .height = ACROSS};
        struct scene *scene = floor_scene(eye_height);
        double worst = 0.0;
        scene_put_lamp(scene, 0, heights[i], 0, 1.0f);
        own_image image = color_of(scene, NULL, &params);
        for (uint32_t k = 0; k < ACROSS * ACROSS; ++k) {
            double p[3], value = (double)image.pixels[4 * k];
            floor_point(k % ACROSS, k / ACROSS, ACROSS, p);
            double square = p[0] * p[0] + p[2] * p[2] + heights[i] * heights[i];
            double expected = fmax(heights[i], 0.0) / (square * sqrt(square));
            if (k == ACROSS * ACROSS / 2) /* below it: where exactly is a matter of roundings */
                assert_true(isfinite(value) && (heights[i] > 0.0 || value == 0.0));
            else if (heights[i] <= 0.0)
                assert_true(value == 0.0);
            else
                worst = fmax(worst, fabs(value / expected - 1.0));
        }
        print_message("  at %g: off by %.2g at most\n", heights[i], worst);
        assert_true(worst <= 2e-4);
    }
}

/* The floor of a hall, seen from below its ceiling. */
static struct scene *hall(struct scene_light light)
{
    struct scene *scene = dark_scene((double[]){0, 2, 0.1}, (double[]){0, 0, 0});
    add_object(scene, mesh_plane(40), matte(1, 1, 1), 0, 0, 0);
    add_object(scene, mesh_plane(12), matte(1, 1, 1), 0, 3, 0);
    scene_put_light(scene, light);
    return scene;
}

static uint32_t count_lit(const struct image *image)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < image->width * image->height; ++i)
        count += image->pixels[4 * (size_t)i] > 0.0f;
    return count;
}

/* S4 of the catalogue of hard cases: a lamp in a ceiling lights the room, and that ceiling casts no
   shadow; one that is hidden right above it does. */
TEST(ceilings_hide_what_is_above_them)
{
    static const whit_numerics levels[] = {WHIT_NUMERICS_WATERTIGHT, WHIT_NUMERICS_EXACT};
    for (int i = 0; i < 12; ++i) {
        double y = i % 2 ? 3.0005 : 3.0;
        struct scene_light light = emitter(WHIT_LIGHT_RECTANGLE, (double[]){0.2, y, -0.3},
                                           (double[]){0.3, 0, 0}, (double[]){0, 0, 0.3}, 9.0f);
        if (i / 2 % 3) {
            light.kind = i / 2 % 3 == 1 ? WHIT_LIGHT_POINT : WHIT_LIGHT_AREA_SAMPLE;
            light.direction[1] = -1.0;
            light.falloff = true;
        }
        const whit_renderer_params params = {.width = 40, .height = 30, .numerics = levels[i / 6]};
        own_image image = color_of(hall(light), NULL, &params);
        assert_int_equal(count_lit(&image), i % 2 ? 0 : 40 * 30);
    }
}

/* The vertices of a wide ceiling that is tilted are off its plane by roundings of their own. */
TEST(wide_ceilings_hide_nothing_of_lamps_in_them)
{
    const double a = 0.5, across[3] = {cos(a), sin(a), 0};
    const struct affine tilt = {
        .m = {across[0], -across[1], 0, 0, across[1], across[0], 0, 3, 0, 0, 1, 0}};
    for (int i = 0; i < 4; ++i) {
        double sums[2];
        for (int k = 0; k < 2; ++k) {
            const whit_renderer_params params = {
                .width = 40, .height = 30, .shadows = k ? WHIT_SHADOWS_NONE : WHIT_SHADOWS_TINTED};
            struct scene *scene = dark_scene((double[]){0, 2, 0.1}, (double[]){0, 0, 0});
            add_object(scene, mesh_plane(40), matte(1, 1, 1), 0, 0, 0);
            scene_put(scene, mesh_plane(i % 2 ? 4000 : 40), &(struct put){.matrix = &tilt});
            struct scene_light light = emitter(
                WHIT_LIGHT_RECTANGLE, (double[]){0.1 * across[0], 3 + 0.1 * across[1], -0.3},
                (double[]){0.3 * across[0], 0.3 * across[1], 0}, (double[]){0, 0, 0.3}, 9.0f);
            if (i / 2) {
                light.kind = WHIT_LIGHT_AREA_SAMPLE;
                light.direction[0] = across[1];
                light.direction[1] = -across[0];
                light.falloff = true;
            }
            scene_put_light(scene, light);
            own_image image = color_of(scene, NULL, &params);
            sums[k] = red_sum(&image);
        }
        assert_near((float)sums[0], sums[1], 1e-6);
    }
}

/* Hits of a glowing surface lie in the plane of the light that stands for it, but for rounding; the
   light must not light them. */
TEST_BY_TURNS(emitters_do_not_light_themselves, 3, 4)
{
    const double heights[] = {1.99, 1001.3};
    const whit_renderer_params params = {
        .width = SIDE, .height = SIDE, .shadows = WHIT_SHADOWS_NONE};
    for (size_t i = 0; i < 2 * sizeof heights / sizeof *heights; ++i) {
        const whit_accel_params trees = {.instances =
                                             i % 2 ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON};
        own_image image = color_of(glowing_panel(heights[i / 2]), &trees, &params);
        assert_true(red_sum(&image) == 0.0);
    }
}

/* A box on a floor under LAMPS lights, of which only number `lit` shines; -1: all. `flat`: every
   second one has an area. */
enum { LAMPS = 2 * LIGHT_LISTS + 3 };

static struct picture lamps_picture(int lit, bool flat)
{
    const whit_renderer_params params = {.width = 24, .height = 24, .light_samples = 4};
    struct scene *scene = floor_scene(eye_height);
    add_object(scene, mesh_box(1, 1, 1), matte(0.5, 1, 1), 0.5, 0.5, 0);
    for (int i = 0; i < LAMPS; ++i) {
        const double at[3] = {sin(i), 1.2 + 0.3 * i, cos(i)};
        struct scene_light light = emitter(flat && i % 2 ? WHIT_LIGHT_RECTANGLE : WHIT_LIGHT_POINT,
                                           at, (double[]){0.3, 0, 0}, (double[]){0, 0, 0.3},
                                           lit < 0 || lit == i ? 0.1f + 0.01f * (float)i : 0);
        scene_put_light(scene, light);
    }
    return picture_of(scene, NULL, &params);
}

/* Where there are more lights than lists, a dispatch adds several: each once, one after the other.
   Lights with an area, which take many rays, have a dispatch each. */
TEST(many_lights_are_added_in_their_order)
{
    uint64_t dispatches[2];
    for (int flat = 0; flat < 2; ++flat) {
        own_picture all = lamps_picture(-1, flat), sum = lamps_picture(0, flat);
        for (int lit = 1; lit < LAMPS; ++lit) {
            own_picture one = lamps_picture(lit, flat);
            assert_true(red_sum(&one.color) > 0.0);
            for (uint32_t i = 0; i < 4 * sum.color.width * sum.color.height; ++i)
                sum.color.pixels[i] = i % 4 == 3 ? 1.0f : sum.color.pixels[i] + one.color.pixels[i];
        }
        assert_same_image("the sum of pictures of one light", &all.color, &sum.color);
        dispatches[flat] = all.stats.dispatches;
    }
    assert_int_equal(dispatches[1] - dispatches[0],
                     LAMPS - (LAMPS + LIGHTS_EACH - 1) / LIGHTS_EACH);
}

/* A ring under three lights. `black`: and a spot that sends none, for which each light has its own
   list of hits. */
static struct scene *few_lamps_scene(bool black)
{
    struct scene *scene = floor_scene(eye_height);
    struct scene_material mirror = matte(0.5, 1, 1);
    set_rgb(mirror.reflection, 0.3f, 0.3f, 0.3f);
    add_object(scene, mesh_torus(1, 0.4, 40, 30), mirror, 0, 0.5, 0);
    scene_put_lamp(scene, 1, 3, 0, 8.0f); /* in the plane of edges of the ring: some rays wait */
    scene_put_sun(scene, -0.3, -1, 0.4, 0.4f);
    scene_put_lamp(scene, -2, 0.3, 1, 3.0f);
    if (black)
        scene_put_light(scene, (struct scene_light){.kind = WHIT_LIGHT_SPOT,
                                                    .node = SCENE_NONE,
                                                    .position = {0, 5, 0},
                                                    .direction = {0, -1, 0},
                                                    .versine_outer = 0.1f});
    return scene;
}

/* Lights without range and cone share hits and dispatches, where not some of a hit's lights are
   added while it is shaded (at NUMERICS_EXACT without packets). Each is counted alone, and in timed
   tiles each has its dispatch. */
TEST(lights_that_reach_all_share_hits)
{
    for (int i = 0; i < 8; ++i) {
        const whit_renderer_params params = {.width = 49,
                                             .height = 49,
                                             .depth = 3,
                                             .tile_size = 16,
                                             .numerics = i & 1 ? WHIT_NUMERICS_EXACT
                                                               : WHIT_NUMERICS_WATERTIGHT,
                                             .packets = i & 2 ? WHIT_PACKETS_ON : WHIT_PACKETS_OFF,
                                             .time_stages = i & 4};
        own_fixture alone = fixture_open(few_lamps_scene(true), NULL, &params);
        own_fixture together = fixture_open(few_lamps_scene(false), NULL, &params);
        own_picture a = render_picture(&alone), b = render_picture(&together);
        assert_same_picture("each light alone", &a, &b);
        assert_false(alone.renderer->picture.stages.set.shares_hits);
        assert_int_equal(together.renderer->picture.stages.set.shares_hits, (i & 3) != 1);
        for (int light = 0; light < 3; ++light) {
            const whit_stage *one = &a.stats.stages[RENDER_STAGE_SHADOW + light],
                             *other = &b.stats.stages[RENDER_STAGE_SHADOW + light];
            assert_true(one->rays > 500 && one->rays == other->rays);
            assert_true((other->ms > 0.0) == ((i & 4) != 0));
        }
        assert_true((b.stats.stages[RENDER_STAGE_DEFERRED].rays > 0) == (i & 1));
    }
}

/* Slivers in the way of rays, which go through the boxes of all and hit none, under several lamps.
   `black`: and a light with an area that sends none. */
static struct picture slivers_picture(bool black)
{
    enum { SLIVERS = 12000 };
    const float corners[9] = {-2, 0.5f, -2, 2, 0.5f, 2, 2, 0.5f, 1.99f};
    const whit_renderer_params params = {.width = 8, .height = 8};
    struct scene *scene = floor_scene(eye_height);
    scene_put(scene, mesh_stack(SLIVERS, corners, 1, 1e-5f), NULL);
    for (int i = 0; i < LAMPS; ++i)
        scene_put_lamp(scene, 0.1 * i, eye_height, 0.5, 0.1f);
    if (black)
        scene_put_light(scene, emitter(WHIT_LIGHT_RECTANGLE, (double[]){0, 9, 0},
                                       (double[]){1, 0, 0}, (double[]){0, 0, 1}, 0));
    return picture_of(scene, NULL, &params);
}

/* Drivers limit the loops of a dispatch. Where lights have one each because one has an area, the
   loops suffice. */
TEST(lights_that_fill_loops_together_are_added_alone)
{
    own_picture together = slivers_picture(false), alone = slivers_picture(true);
    assert_true(red_sum(&together.color) > 0.0);
    assert_same_image("each light alone", &together.color, &alone.color);
}

/* Rings, two of them of glass, and a table over terrain, all moved by `moved` along each axis, the
   light too. With `slope` the ground is one triangle, so large that hits on it are rounded more
   coarsely than those on the rest. */
static struct scene *rings_under(struct scene_light light, double moved, float slope)
{
    struct scene *scene =
        dark_scene((double[]){moved, moved + 4, moved + 8}, (double[]){moved, moved + 0.5, moved});
    const float corners[9] = {-slope, -0.3f * slope, slope,     2 * slope, 1.05f * slope, slope,
                              0,      -0.3f * slope, -2 * slope};
    struct scene_material glass = material_plain("glass");
    set_rgb(glass.transmission, 0.5f, 0.9f, 0.4f);
    for (int k = 0; k < 3; ++k)
        light.position[k] += moved;
    struct scene_mesh ground =
        slope > 0 ? mesh_triangles(corners, 1) : mesh_terrain(10.0, 1.0, 24, 3);
    add_object(scene, ground, material_grey("ground"), moved, moved, moved);
    add_object(scene, mesh_box(3, 0.5, 1.5), material_grey("table"), moved, moved + 1.25,
               moved - 1);
    for (int i = 0; i < 3; ++i)
        add_object(scene, mesh_torus(1.0, 0.3, 24, 12), i ? glass : material_grey("ring"),
                   moved + 1.5 * (i - 1), moved + 1.0, moved + 0.4 * i);
    scene_put_light(scene, light);
    return scene;
}

/* S4 and S5 of the catalogue of hard cases, for lights: 10^-6 above a surface, 10^4 sizes of the
   scene and farther away, in a plane or a corner of an object, at large coordinates. Packets, which
   test boxes from the light, hit the same as single rays. */
TEST(packets_to_a_light_shade_as_rays_do)
{
    static const struct {
        double at[3], moved;
        float slope;
        bool clipped, exact, flat;
    } cases[] = {
        {{3, 6, 2}, 0, 0, false, false, false},
        {{3, 6, 2}, 0, 0, false, true, false},
        {{3, 6, 2}, 0, 0, false, false, true},
        {{3, 6, 2}, 0, 4e5f, false, false, false},
        {{0, 1e5, 0}, 0, 0, false, false, false},
        {{3e4, 8e4, 5e4}, 0, 0, true, false, false},
        {{1e30, 1e30, 1}, 0, 0, false, false, false},
        {{0, 1.500001, -1}, 0, 0, false, false, false},
        {{0, 1.500001, -1}, 0, 0, false, true, false},
        {{0, 1.500001, -1}, 0, 0, false, false, true},
        {{1.5, 1.5, -0.25}, 0, 0, true, false, false},
        {{0, 1.0, 0.4}, 0, 0, false, false, false},
        {{-4, 6, 3}, 1e4, 0, false, false, false},
        {{1, 1.6, 1}, -1e5, 0, true, false, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        struct scene_light light =
            emitter(cases[i].flat ? WHIT_LIGHT_RECTANGLE : WHIT_LIGHT_POINT, cases[i].at,
                    (double[]){0.3, 0, 0}, (double[]){0, 0, 0.3}, 1);
        const whit_accel_params accel = {.build = cases[i].clipped ? WHIT_BUILD_SPATIAL
                                                                   : WHIT_BUILD_BINNED,
                                         .instances = WHIT_INSTANCES_OFF};
        whit_renderer_params params = {
            .width = 128,
            .height = 96,
            .depth = 1,
            .light_samples = 4,
            .packets = WHIT_PACKETS_OFF,
            /* Else its kernels take 6 s more to compile. */
            .effects_removed = cases[i].exact ? UINT64_C(1) << SCENE_EFFECT_REFRACTION : 0,
            .numerics = cases[i].exact ? NUMERICS_EXACT : NUMERICS_WATERTIGHT};
        own_fixture f =
            fixture_open(rings_under(light, cases[i].moved, cases[i].slope), &accel, &params);
        own_image alone = render(&f);
        params.packets = WHIT_PACKETS_ON;
        fixture_renew(&f, &params);
        own_image together = render(&f);
        print_message("  light %zu: sum %g\n", i, red_sum(&alone));
        assert_true(red_sum(&alone) > 0.0);
        assert_same_image("packets", &alone, &together);
    }
}
