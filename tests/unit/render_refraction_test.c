/* Compares the directions and the weights of refracted rays with formulas in double. */
#include "media_fixture.h"
#include "unit.h"

static const double FOV = 0.7;

static struct scene *lens_scene(const double eye[3])
{
    struct scene *scene = dark_scene(eye, (double[]){eye[0], eye[1], eye[2] - 1});
    scene->cameras[0].fov_y = (float)FOV;
    return scene;
}

/* ---- A slab ---- */

static const double SLAB_HALF = 0.3, SLAB_IOR = 1.5;

/* A sky that tells a ray's |y|: it is red divided by blue, and blue is the share of the ray's
   weight that arrives. */
static void set_height_sky(struct scene *scene)
{
    set_rgb(scene->environment.zenith, 1, 0, 1);
    set_rgb(scene->environment.horizon, 0, 0, 1);
    set_rgb(scene->environment.ground, 1, 0, 1);
}

/* All rays leave a slab as steeply as they came, also those that were reflected inside it. */
TEST(slab_keeps_directions)
{
    struct scene *scene = lens_scene((double[]){0, 0, 5});
    set_height_sky(scene);
    add_object(scene, mesh_box(20, 20, 2 * SLAB_HALF), clear_glass((float)SLAB_IOR, 0), 0, 0, 0);
    const whit_renderer_params params = {.width = 24, .height = 24, .depth = 8};
    own_image image = color_of(scene, NULL, &params);
    double worst = 0.0;
    for (uint32_t i = 0; i < 24 * 24; ++i) {
        const float *color = &image.pixels[4 * (size_t)i];
        double slope[2];
        pixel_slope(&image, i % 24, i / 24, FOV, slope);
        double y = fabs(slope[1]) / sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
        worst = fmax(worst, fabs((double)color[0] / (double)color[2] - y));
    }
    print_message("  directions are off by %.2g\n", worst);
    assert_true(worst <= 2e-6); /* NUMERICS O4: some ten roundings of a unit vector */
}

/* ---- A ball lens ---- */

/* Follows a ray through a ball of radius 1 at the origin to the plane z = -wall. False if the ray
   misses, or passes beyond 0.7 of the radius, where light that the ball reflects reaches the wall
   too. */
static bool pass_ball(const double slope[2], double n, double wall, double at[2])
{
    double d[3] = {slope[0], slope[1], -1}, o[3] = {0, 0, 5}, p[3];
    double size = sqrt(d[0] * d[0] + d[1] * d[1] + 1);
    for (int k = 0; k < 3; ++k)
        d[k] /= size;
    double b = -o[2] * d[2], off2 = 25.0 - b * b;
    if (off2 > 0.49)
        return false;
    double t = b - sqrt(1 - off2), eta = 1 / n;
    for (int face = 0; face < 2; ++face) {
        double cosine = 0;
        for (int k = 0; k < 3; ++k) {
            p[k] = o[k] + t * d[k];
            cosine -= d[k] * p[k];
        }
        double side = face == 0 ? 1 : -1;
        cosine *= side;
        double turn = eta * cosine - sqrt(1 - eta * eta * (1 - cosine * cosine));
        for (int k = 0; k < 3; ++k) {
            d[k] = eta * d[k] + turn * side * p[k];
            o[k] = p[k];
        }
        t = -2 * (d[0] * p[0] + d[1] * p[1] + d[2] * p[2]);
        eta = n;
    }
    for (int k = 0; k < 2; ++k)
        at[k] = p[k] + d[k] * (-wall - p[2]) / d[2];
    return true;
}

/* An analytic ball, and walls before, at and behind the image of the camera. */
TEST(ball_bends_rays_to_its_focus)
{
    const double walls[] = {1.2, 2.14, 6.0}; /* 1 / 1.5 = 1 / 5 + 1 / 2.14 */
    double spread[3] = {0};
    for (int w = 0; w < 3; ++w) {
        struct scene *scene = lens_scene((double[]){0, 0, 5});
        add_object(scene, mesh_balls((double[]){0, 0, 0, 1}, 1), clear_glass(1.5f, 0), 0, 0, 0);
        add_coordinate_wall(scene, -walls[w], 4);
        const whit_renderer_params params = {.width = 32, .height = 32, .depth = 2};
        own_image image = color_of(scene, NULL, &params);
        double worst = 0;
        uint32_t through = 0;
        for (uint32_t i = 0; i < 32 * 32; ++i) {
            double slope[2], at[2];
            pixel_slope(&image, i % 32, i / 32, FOV, slope);
            if (!pass_ball(slope, 1.5, walls[w], at))
                continue;
            const float *color = &image.pixels[4 * (size_t)i];
            for (int k = 0; k < 2; ++k)
                worst = fmax(worst, fabs(wall_coordinate(color, k, 4) - at[k]));
            if (hypot(slope[0], slope[1]) < 0.05)
                spread[w] = fmax(spread[w],
                                 hypot(wall_coordinate(color, 0, 4), wall_coordinate(color, 1, 4)));
            ++through;
        }
        print_message("  wall at %g: %u rays, off by %.2g at most; near the axis %.3g wide\n",
                      walls[w], through, worst, spread[w]);
        assert_true(through > 100);
        /* Hits of the ball: some 8 roundings of the 5 between; normals likewise. Each face turns an
           error of the normal into up to twice that of the direction this far from the rim, and the
           wall is up to 6 away. */
        assert_true(worst < 8 * 5 * 0x1p-24 * 2 * 2 * (1 + walls[w]));
    }
    assert_true(spread[1] < 0.1 * spread[0] && spread[1] < 0.1 * spread[2]);
}

/* ---- Many bounces ---- */

/* A ray bounces upwards between two mirrors and leaves them. They are turned so that the ray leaves
   the last one nearly straight up, where the sky shows the length of its direction, and then by
   `turn` about that. */
static void leave_mirrors(double turn)
{
    /* Before the turns the normals are along x; 65 times the ray's x changes its sign. */
    const double before[3] = {1, 0.05, 0.001}, after[3] = {-1, 0.05, 0.001};
    const double tilt = atan2(after[1], after[0]) - 0.98 * acos(0), way = sqrt(1.002501);
    const double half[2] = {-0.5 * tilt, 0.5 * turn};
    /* About z by -tilt, then about y by turn. */
    const double q[4] = {sin(half[0]) * sin(half[1]), cos(half[0]) * sin(half[1]),
                         sin(half[0]) * cos(half[1]), cos(half[0]) * cos(half[1])};
    const struct affine turned = affine_from_trs((double[]){0, 0, 0}, q, (double[]){1, 1, 1});
    double target[3], out[3];
    affine_point(&turned, before, target);
    affine_point(&turned, after, out);
    struct scene *scene = dark_scene((double[]){0, 0, 0}, target);
    set_height_sky(scene);
    for (int i = 0; i < 2; ++i) {
        double at[3];
        affine_point(&turned, (double[]){i ? 1.5 : -1.5, 0, 0}, at);
        add_object(scene, mesh_box(1, 13, 13), mirror(1, 1, 1), at[0], at[1], at[2]);
        memcpy(scene->nodes[scene->node_count - 1].rotation, q, sizeof q);
    }
    const whit_renderer_params params = {.width = 1, .height = 1, .depth = 255};
    own_picture picture = picture_of(scene, NULL, &params);
    const float *color = picture.color.pixels;
    double off = (double)color[0] / (double)color[2] - out[1] / way;
    print_message("  %u reflections, mirrors turned by %g: up is off by %.2g, the weight by %.2g\n",
                  (unsigned)picture.stats.rays_reflected, turn, off, (double)color[2] - 1);
    assert_int_equal(picture.stats.rays_reflected, 65);
    assert_int_equal(picture.stats.rays_cut_depth, 0);
    assert_true(fabs(off) <= 1e-6); /* NUMERICS O6 */
    assert_true(color[2] == 1.0f);
}

TEST(directions_stay_unit)
{
    for (int i = 0; i < 6; ++i)
        leave_mirrors(0.5 * i);
}

/* ---- Absorption ---- */

/* Straight through glass of index 1 and thickness 1: Beer's law says how much of each colour is
   left. */
TEST(beer_from_nothing_to_infinity)
{
    const float absorptions[] = {0.0f, 1e-9f, 1.0f, 100.0f, 3e38f, INFINITY};
    for (size_t i = 0; i < sizeof absorptions / sizeof *absorptions; ++i) {
        struct scene *scene = lens_scene((double[]){0, 0, 5});
        set_sky(scene, 1, 1, 1);
        struct scene_material m = clear_glass(1.0f, 0);
        set_rgb(m.absorption, 0, absorptions[i], 1.0f);
        add_object(scene, mesh_box(20, 20, 1), m, 0, 0, 0);
        const whit_renderer_params params = {.width = 1, .height = 1, .depth = 4};
        own_image image = color_of(scene, NULL, &params);
        const float *color = image.pixels;
        assert_true(color[0] == 1.0f);
        /* scene_freeze replaces values that are not finite by 0. */
        double expected = isfinite(absorptions[i]) ? exp(-(double)absorptions[i]) : 1.0;
        print_message("  %g: %.9g\n", (double)absorptions[i], (double)color[1]);
        /* exp: 3 + 2 |x| ulp (Vulkan, precision of SPIR-V instructions); below FLT_MIN: 0 */
        assert_true(color[1] >= 0.0f && color[1] <= 1.0f);
        assert_true(fabs((double)color[1] - expected) <=
                    expected * (8 + 2 * fmin((double)absorptions[i], 100)) * 0x1p-23 + 1.2e-38);
        assert_near(color[2], exp(-1), 10 * 0x1p-23);
    }
}

/* A camera in a medium that never ends sees nothing of the colours that it absorbs. */
TEST(endless_media_are_dark)
{
    struct scene *scene = lens_scene((double[]){0, 0, 0});
    set_sky(scene, 1, 1, 1);
    struct scene_material m = clear_glass(1.0f, 0);
    set_rgb(m.absorption, 0, 1e-3f, 1e-9f);
    struct scene_mesh cube = mesh_box(20, 20, 20);
    /* Without the side that the camera looks at, -z. */
    uint32_t kept = 0;
    for (uint32_t t = 0; t < cube.triangle_count; ++t) {
        bool back = true;
        for (size_t k = 0; k < 3; ++k)
            back = back && cube.positions[3 * cube.indices[3 * t + k] + 2] < 0;
        if (!back)
            memcpy(&cube.indices[3 * (size_t)kept++], &cube.indices[3 * (size_t)t],
                   3 * sizeof *cube.indices);
    }
    cube.triangle_count = kept;
    add_object(scene, cube, m, 0, 0, 0);
    const whit_renderer_params params = {.width = 1, .height = 1, .depth = 4};
    own_fixture f = fixture_open(scene, NULL, &params);
    own_image image = render(&f);
    assert_true(f.renderer->frame.eye_media0 != 0);
    assert_true(image.pixels[0] == 1.0f && image.pixels[1] < 1e-37f && image.pixels[2] < 1e-37f);
}

/* ---- Both ways ---- */

/* The same share of light arrives from air into glass and back along the same path, because whit
   divides radiance by the square of the index. */
TEST(paths_are_reversible)
{
    const double slopes[] = {0.1, 0.7, 2.0, 5.0};
    for (int i = 0; i < 4; ++i) {
        double sine = slopes[i] / sqrt(1 + slopes[i] * slopes[i]), inside = sine / 1.5;
        double tangent = inside / sqrt(1 - inside * inside), share[2];
        for (int way = 0; way < 2; ++way) {
            /* The surface is y = 0, met at the origin; glass is below. */
            double eye[3] = {way ? tangent : -slopes[i], way ? -1 : 1, 0};
            struct scene *scene = dark_scene(eye, (double[]){0, 0, 0});
            scene->cameras[0].fov_y = 0.01f;
            add_object(scene, mesh_box(80, 40, 80), clear_glass(1.5f, 0), 0, -20, 0);
            add_object(scene, mesh_box(1, 1, 1), unlit(1, 1, 1), way ? -slopes[i] * 3 : tangent * 3,
                       way ? 3 : -3, 0);
            const whit_renderer_params params = {.width = 1, .height = 1, .depth = 1};
            own_image image = color_of(scene, NULL, &params);
            share[way] = (double)image.pixels[0];
        }
        double expected = 1 - fresnel(sqrt(1 - sine * sine), 1, 1.5);
        print_message("  %.7f there, %.7f back, by formula %.7f\n", share[0], share[1], expected);
        assert_true(fabs(share[0] - expected) < 1e-5 && fabs(share[1] - expected) < 1e-5);
    }
}
