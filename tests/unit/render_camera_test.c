/* Cameras: where their rays go, what a lens blurs, what a panorama sees, odd sizes and odd views.
 */
#include <float.h>

#include "picture_fixture.h"
#include "render/renderer.h"
#include "twin/traverse.h"
#include "unit.h"

/* Adds a ball that is drawn with the value 1 everywhere. */
static void add_marker(struct scene *scene, double radius, double x, double y, double z)
{
    add_object(scene, mesh_sphere(radius, 16, 8), unlit(1, 1, 1), x, y, z);
}

static double red(const struct image *image, uint32_t x, uint32_t y)
{
    return (double)image->pixels[4 * ((size_t)y * image->width + x)];
}

static void assert_finite(const struct image *image)
{
    assert_range(image, 0, FLT_MAX);
}

/* ---- Sine and cosine ---- */

TEST(sines_are_those_of_libm)
{
    enum { STEPS = 1 << 20 };
    double worst = 0.0;
    for (int i = -STEPS; i <= STEPS; ++i) {
        float a = (float)i / STEPS, s, c;
        if (i % 3 == 0)
            a = nextafterf(a, 0.0f);
        sine_cosine_pi(a, &s, &c);
        worst = fmax(worst, fabs((double)s - sin(PI * (double)a)));
        worst = fmax(worst, fabs((double)c - cos(PI * (double)a)));
    }
    print_message("  off by %.3g\n", worst);
    assert_true(worst <= 1.2e-7);
    float s, c;
    sine_cosine_pi(1.0f, &s, &c);
    assert_true(s == 0.0f && c == -1.0f);
    sine_cosine_pi(-0.5f, &s, &c);
    assert_true(s == -1.0f && c == 0.0f);
}

/* ---- The lens ---- */

/* A bright ball `z` in front of a camera whose lens is focused at 5, seen as a patch. */
static struct image lens_picture(double z, float lens_radius, uint32_t samples, double size)
{
    struct scene *scene = dark_scene((double[]){0, 0, 0}, (double[]){0, 0, -1});
    scene->cameras[0].lens_radius = lens_radius;
    scene->cameras[0].focus_distance = 5.0f;
    add_marker(scene, size * z, 0, 0, -z);
    const whit_renderer_params params = {.width = 75, .height = 75, .sampling.count = samples};
    return color_of(scene, NULL, &params);
}

/* The bright pixels: their centre of gravity, relative to the middle of the picture, and their mean
   square and largest distance from it, in pixels. */
struct patch {
    double center[2], mean2, farthest;
};

static struct patch measure(const struct image *image)
{
    struct patch patch = {0};
    double sum = red_sum(image);
    assert_true(sum > 0.0);
    for (uint32_t y = 0; y < image->height; ++y) {
        for (uint32_t x = 0; x < image->width; ++x) {
            double v = red(image, x, y) / sum;
            double dx = x + 0.5 - 0.5 * image->width, dy = y + 0.5 - 0.5 * image->height;
            patch.center[0] += v * dx;
            patch.center[1] += v * dy;
            patch.mean2 += v * (dx * dx + dy * dy);
            if (v > 0.0)
                patch.farthest = fmax(patch.farthest, hypot(dx, dy));
        }
    }
    return patch;
}

/* Balls behind the focus, in front of it and in it. In a plane at distance 1 a point is blurred to
   a circle of radius lens * |1 / z - 1 / focus|. The mean square distance from the middle of an
   evenly bright disk is half of its squared radius; with 64 points of the lens it is within 2 % of
   that. */
TEST(blur_has_its_size)
{
    const double pixel = 2.0 * tan(0.3) / 75.0, ball = 1.5; /* radius of the ball, in pixels */
    const double depths[] = {10.0, 3.5, 5.0};
    for (int i = 0; i < 3; ++i) {
        double blur = 2.0 * fabs(1.0 / depths[i] - 0.2) / pixel;
        double expected = sqrt(0.5 * (blur * blur + ball * ball));
        own_image image = lens_picture(depths[i], 2.0f, 64, ball * pixel);
        struct patch p = measure(&image);
        print_message("  at %g: radius %.2f of %.2f pixels, rms %.2f of %.2f, centre %.3f %.3f\n",
                      depths[i], p.farthest, blur + ball, sqrt(p.mean2), expected, p.center[0],
                      p.center[1]);
        assert_true(fabs(p.farthest - (blur + ball)) <= 1.0);
        assert_true(fabs(sqrt(p.mean2) - expected) <= 0.02 * expected + 0.05);
        assert_true(hypot(p.center[0], p.center[1]) < 0.006 * blur + 0.05);
    }
}

TEST(a_lens_that_is_left_out_is_a_pinhole)
{
    struct scene *scene = floor_scene(1);
    scene->cameras[0].lens_radius = 0.3f;
    whit_renderer_params params = picture_params;
    own_fixture f = fixture_open(scene, NULL, &params);
    assert_true(renderer_compiles(f.renderer, SCENE_EFFECT_LENS));
    params.effects_removed = UINT64_C(1) << SCENE_EFFECT_LENS;
    fixture_renew(&f, &params);
    assert_false(renderer_compiles(f.renderer, SCENE_EFFECT_LENS));
}

TEST(one_sample_is_a_pinhole)
{
    own_image lens = lens_picture(10.0, 2.0f, 1, 0.03), hole = lens_picture(10.0, 0.0f, 1, 0.03);
    assert_same_image("one sample", &lens, &hole);
}

/* All rays of one place of a pixel meet in one point of the focus plane, whatever the point of the
   lens; the points of the lens fill its disk evenly. */
TEST(lens_rays_meet_in_focus)
{
    struct gpu_frame frame = {.eye = {1, 2, 3},
                              .width = 30,
                              .height = 20,
                              .inv_width = 1.0f / 30.0f,
                              .inv_height = 1.0f / 20.0f,
                              .right = {0.9f, 0, 0},
                              .up = {0, 0.6f, 0},
                              .forward = {0, 0, -1},
                              .lens_radius = 0.5f,
                              .focus_distance = 4.0f};
    for (uint32_t count = 4; count <= 64; count *= 4) {
        double sum[2] = {0, 0}, square = 0.0;
        for (uint32_t i = 0; i < count; ++i) {
            struct gpu_chunk sample;
            struct gpu_ray ray;
            camera_sample(&frame, i, &sample);
            camera_ray(&frame, CAMERA_LENS, 11, 7, &sample, &ray);
            double t = (3.0 - 4.0 - (double)ray.origin[2]) / (double)ray.dir[2];
            double x = (double)ray.origin[0] + t * (double)ray.dir[0];
            double y = (double)ray.origin[1] + t * (double)ray.dir[1];
            float place[2];
            camera_mirror_sample(sample.sample_xy, 11, 7, place);
            double at_x = (23.0 + (double)place[0]) / 30.0 - 1.0;
            double at_y = (15.0 + (double)place[1]) / 20.0 - 1.0;
            assert_true(fabs(x - (1.0 + 4.0 * 0.9 * at_x)) < 2e-6);
            assert_true(fabs(y - (2.0 - 4.0 * 0.6 * at_y)) < 2e-6);
            double aside[2] = {(double)ray.origin[0] - 1.0, (double)ray.origin[1] - 2.0};
            double r2 = (aside[0] * aside[0] + aside[1] * aside[1]) / 0.25;
            assert_true(r2 <= 1.0);
            sum[0] += aside[0], sum[1] += aside[1];
            square += r2;
        }
        assert_true(hypot(sum[0], sum[1]) < 0.5 * 0.5); /* the sum is below half of the radius */
        assert_true(fabs(square / count - 0.5) <= 0.6 / count); /* 0.5 for the whole disk */
    }
}

/* ---- The panorama ---- */

static struct scene *panorama_scene(const double eye[3], const double target[3])
{
    struct scene *scene = dark_scene(eye, target);
    scene->cameras[0].kind = WHIT_CAMERA_PANORAMA;
    scene->cameras[0].up[0] = 0.2;
    return scene;
}

static void unit_of(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; ++i)
        v[i] /= length;
}

static void swap_halves(struct image *image)
{
    uint32_t half = image->width / 2;
    for (uint32_t i = 0; i < image->width * image->height; ++i) {
        if (i % image->width >= half)
            continue;
        float *left = &image->pixels[4 * i], *right = &image->pixels[4 * (i + half)], kept[4];
        memcpy(kept, left, sizeof kept);
        memcpy(left, right, sizeof kept);
        memcpy(right, kept, sizeof kept);
    }
}

TEST(markers_are_where_they_should)
{
    enum { WIDTH = 180, HEIGHT = 90 };
    const double places[][2] = {{0, 0}, {90, 0}, {-135, 45}, {60, -70}, {179, 10}, {-30, 80}};
    const double eye[3] = {3, -1, 2}, target[3] = {-4, 2, 5}, up[3] = {0.2, 1, 0};
    double forward[3], right[3], above[3];
    for (int i = 0; i < 3; ++i)
        forward[i] = target[i] - eye[i];
    unit_of(forward);
    double3_cross(forward, up, right);
    unit_of(right);
    double3_cross(right, forward, above);
    for (size_t p = 0; p < sizeof places / sizeof *places; ++p) {
        double longitude = places[p][0] * PI / 180.0, latitude = places[p][1] * PI / 180.0, at[3];
        for (int i = 0; i < 3; ++i)
            at[i] = eye[i] + 10.0 * (cos(latitude) *
                                         (cos(longitude) * forward[i] + sin(longitude) * right[i]) +
                                     sin(latitude) * above[i]);
        struct scene *scene = panorama_scene(eye, target);
        add_marker(scene, 0.5, at[0], at[1], at[2]); /* less than 3 degrees: no seam in between */
        const whit_renderer_params params = {.width = WIDTH, .height = HEIGHT, .sampling.count = 4};
        own_image image = color_of(scene, NULL, &params);
        if (places[p][0] > 170.0) /* across the seam the picture goes on */
            swap_halves(&image);
        struct patch seen = measure(&image);
        double x = (places[p][0] > 170.0 ? places[p][0] - 180.0 : places[p][0]) / 360.0 * WIDTH;
        double y = -places[p][1] / 180.0 * HEIGHT;
        print_message("  %g %g: %.2f %.2f, expected %.2f %.2f\n", places[p][0], places[p][1],
                      seen.center[0], seen.center[1], x, y);
        assert_true(fabs(seen.center[0] - x) < 0.5 && fabs(seen.center[1] - y) < 0.5);
    }
}

/* Seen from the middle of a box each face covers a sixth of the sphere. */
TEST(panorama_sees_all_around)
{
    struct scene *scene = panorama_scene((double[]){0, 0, 0}, (double[]){1, 2, 3});
    add_object(scene, mesh_box(2, 2, 2), unlit(1, 1, 1), 0, 0, 0);
    for (uint32_t face = 0; face < 6; ++face) {
        uint32_t index = scene_put_material(scene, unlit((float)(1 << face), 1, 1));
        scene->meshes[0].materials[2 * face] = scene->meshes[0].materials[2 * face + 1] = index;
    }
    const whit_renderer_params params = {.width = 128, .height = 64};
    own_image image = color_of(scene, NULL, &params);
    double shares[6] = {0}, all = 0.0;
    for (uint32_t y = 0; y < 64; ++y) {
        for (uint32_t x = 0; x < 128; ++x) {
            double weight = cos(((y + 0.5) / 64.0 - 0.5) * PI);
            int face = (int)lround(log2(red(&image, x, y)));
            assert_true(face >= 0 && face < 6);
            shares[face] += weight;
            all += weight;
        }
    }
    for (int face = 0; face < 6; ++face)
        assert_true(fabs(shares[face] / all - 1.0 / 6.0) < 0.005);
}

/* ---- Odd views ---- */

TEST(view_along_up_has_a_picture)
{
    struct scene *scene = dark_scene((double[]){0, 5, 0}, (double[]){0, 0, 0});
    add_object(scene, mesh_plane(1), matte(1, 1, 1), 0, 0, 0);
    scene_put_sun(scene, 0, -1, 0, 1.0f);
    scene->cameras[0].up[1] = 1.0; /* parallel to the view, as a file may have it */
    scene->cameras[0].up[2] = 0.0;
    whit_renderer_params params = picture_params;
    const whit_camera views[] = {{.name = NULL},
                                 CAMERA_AT(0, 5, 0, 0, 0, 0, 0, 1, 0, 40),
                                 CAMERA_AT(0, 5, 0, 0, 0, 0, 0, -7, 0, 40),
                                 CAMERA_AT(0, 5, 0, 0, 0, 0, 0, 0, 0, 40),
                                 CAMERA_AT(0, 5, 0, 0, 0, 0, 1e-30, 1e30, 0, 40)};
    own_fixture f = fixture_open(scene, NULL, &params);
    for (size_t i = 0; i < sizeof views / sizeof *views; ++i) {
        params.camera = views[i];
        fixture_renew(&f, &params);
        own_image image = render(&f);
        assert_finite(&image);
        assert_near(middle(&image)[0], 1.0, 2e-6);
        /* The floor is seen upright or turned by a quarter: as wide as high. */
        uint32_t lit = 0;
        for (uint32_t p = 0; p < 33 * 33; ++p)
            lit += image.pixels[4 * p] > 0.5f;
        uint32_t side = (uint32_t)lround(sqrt((double)lit));
        assert_int_equal(side * side, lit);
    }
}

/* A ray through the top row's middle leaves the direction of view by half the angle of view, less
   half a pixel. */
TEST(angles_of_view_are_kept)
{
    const double angles[] = {1e-3, 0.01, 1.0, 90.0, 179.0, 179.9};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; ++i) {
        struct scene *scene = dark_scene((double[]){0, 0, 0}, (double[]){0, 0, -1});
        set_rgb(scene->environment.zenith, 1, 1, 1);
        add_marker(scene, 0.5, 0, 0, -1e5);
        const whit_renderer_params params = {
            .width = 9, .height = 101, .camera = CAMERA_AT(0, 0, 0, 0, 0, -1, 0, 1, 0, angles[i])};
        own_fixture f = fixture_open(scene, NULL, &params);
        own_image image = render(&f);
        assert_finite(&image);
        float angle = (float)(angles[i] * PI / 180.0); /* as the camera holds it */
        double half = tan(0.5 * (double)angle) * 100.0 / 101.0;
        struct gpu_chunk sample;
        struct gpu_ray ray;
        camera_sample(&f.renderer->frame, 0, &sample);
        camera_ray(&f.renderer->frame, CAMERA_PERSPECTIVE, 4, 0, &sample, &ray);
        assert_near(ray.dir[1], half / sqrt(1.0 + half * half), 1e-6);
        assert_near(ray.dir[2], -1.0 / sqrt(1.0 + half * half), 1e-6);
        /* The sky's gradient makes the pixel's value the y of the ray's direction. */
        assert_near(image.pixels[4 * 4], (double)ray.dir[1], 1e-6);
    }
}

/* Camera rays that lie in the edge between two triangles, or in the plane of a face. */
TEST(rays_along_edges_hit)
{
    enum { SIDE = 64 };
    struct scene *scene = dark_scene((double[]){0, 0, 5}, (double[]){0, 0, 0});
    scene->cameras[0].kind = WHIT_CAMERA_ORTHOGRAPHIC;
    scene->cameras[0].height = 2.0f;
    /* Its diagonals go through pixel middles. */
    add_object(scene, mesh_box(4, 4, 1), unlit(1, 1, 1), 0, 0, 0);
    const whit_renderer_params params = {.width = SIDE, .height = SIDE};
    own_image image = color_of(scene, NULL, &params);
    assert_range(&image, 1, 1);
}

TEST(faces_seen_edge_on_are_finite)
{
    struct scene *scene = dark_scene((double[]){0, 1, 5}, (double[]){0, 1, 0});
    struct scene_material m = matte(1, 1, 1);
    set_rgb(m.specular, 1, 1, 1);
    /* Its top is in the plane of the middle row and of the light. */
    add_object(scene, mesh_box(1, 2, 1), m, 0, 0, 0);
    scene_put_sun(scene, 0, 0, -1, 1.0f);
    own_image image = color_of(scene, NULL, &picture_params);
    assert_finite(&image);
}

/* Every pixel of pictures of odd sizes sees what the C traversal of its ray hits. */
TEST(sizes_may_be_odd)
{
    const uint32_t sizes[][2] = {{1, 1}, {1, 4096}, {4096, 1}, {37, 23}, {8, 9}, {65, 1}};
    struct scene *scene = dark_scene((double[]){2, 6, 8}, (double[]){0, 0, 0});
    add_object(scene, mesh_terrain(10.0, 2.0, 40, 3), material_plain("ground"), 0, 0, 0);
    whit_renderer_params params = {.width = 1, .height = 1};
    own_fixture f = fixture_open(scene, NULL, &params);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        params.width = sizes[i][0];
        params.height = sizes[i][1];
        fixture_renew(&f, &params);
        own_picture picture = render_picture(&f);
        assert_finite(&picture.color);
        uint32_t bad = 0, hits = 0, status = 0;
        struct gpu_chunk sample;
        camera_sample(&f.renderer->frame, 0, &sample);
        for (uint32_t p = 0; p < params.width * params.height; ++p) {
            struct gpu_ray ray;
            struct gpu_hit hit;
            camera_ray(&f.renderer->frame, CAMERA_PERSPECTIVE, p % params.width, p / params.width,
                       &sample, &ray);
            traverse_ray(f.accel, NULL, &ray, &hit, NULL, &status);
            bad += hit.primitive != picture.ids.words[2 * p + 1];
            hits += hit.primitive != HIT_NONE;
        }
        assert_int_equal(bad, 0);
        assert_true(hits > 0);
    }
}

/* Two walls, one a millionth away and one a million, which in the picture meet at one edge. */
TEST(near_and_far_share_a_picture)
{
    struct scene *scene = dark_scene((double[]){0, 0, 0}, (double[]){0, 0, -1});
    struct scene_material near = unlit(0.25f, 0.25f, 0.25f), far = unlit(0.75f, 0.75f, 0.75f);
    /* Faces towards the eye at z = -1e-6 and -1e6; the near one left of x = 0. */
    add_object(scene, mesh_box(2e-6, 2e-6, 1e-7), near, -1e-6, 0, -1.05e-6);
    add_object(scene, mesh_box(2e6, 2e6, 1e5), far, 0, 0, -1.05e6);
    const whit_renderer_params params = {.width = 40, .height = 20, .sampling.count = 4};
    own_image image = color_of(scene, NULL, &params);
    for (uint32_t p = 0; p < 40 * 20; ++p)
        assert_near(image.pixels[4 * p], p % 40 < 20 ? 0.25 : 0.75, 0.0);
}
