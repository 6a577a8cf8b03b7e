/* Compares the reference with formulas: rays within 1e-12, pictures within rounding to float. */
#include "media_fixture.h"
#include "reference_fixture.h"
#include "scene/pose.h"
#include "unit.h"

struct drawn {
    struct scene *scene;
    struct accel *accel;
    struct reference *reference;
};

static struct drawn open_with(struct scene *scene, const whit_accel_params *trees,
                              const struct reference_params *params)
{
    struct drawn d = {.scene = scene};
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    assert_int_equal(accel_create(&fixture_log, scene, trees, &d.accel), WHIT_OK);
    assert_int_equal(reference_create(&fixture_log, d.accel, params, &d.reference), WHIT_OK);
    return d;
}

static struct drawn open_reference(struct scene *scene, const whit_renderer_params *picture)
{
    const struct reference_params params = {.picture = *picture};
    return open_with(scene, NULL, &params);
}

static void close_reference(struct drawn *d)
{
    reference_destroy(d->reference);
    accel_destroy(d->accel);
    scene_destroy(d->scene);
}

static struct image draw(const struct drawn *d)
{
    struct image image = {0};
    whit_stats stats;
    assert_int_equal(reference_render(d->reference, &image, NULL, &stats), WHIT_OK);
    return image;
}

static const whit_renderer_params one_pixel = {.width = 1, .height = 1, .depth = 8};

static const struct reference_ray *find_ray(const struct rays *rays, enum reference_kind kind,
                                            uint32_t parent)
{
    for (uint32_t i = 0; i < rays->count; ++i) {
        if (rays->all[i].kind == kind && rays->all[i].parent == parent)
            return &rays->all[i];
    }
    fail_msg("no ray of kind %d below ray %u", kind, parent);
    return NULL;
}

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, expected, tolerance);
}

/* A camera at (0, 0, 0) that looks along -z, turned towards +x by `angle`, at a face at z = -4. */
static struct scene *facing_scene(double angle, struct scene_material m)
{
    struct scene *scene = dark_scene((double[]){0, 0, 0}, (double[]){sin(angle), 0, -cos(angle)});
    add_object(scene, mesh_box(400, 400, 2), m, 0, 0, -5);
    return scene;
}

static double facing_angle(const struct reference_ray *ray)
{
    return atan2(hypot(ray->dir[0], ray->dir[1]), -ray->dir[2]);
}

/* ---- Optics ---- */

static void check_glass(double angle, double ior, bool schlick)
{
    whit_renderer_params params = one_pixel;
    params.schlick = schlick;
    struct drawn d = open_reference(facing_scene(angle, clear_glass((float)ior, 0)), &params);
    struct rays rays = reference_rays(d.reference, 0, 0, 0);
    double cos_in = -rays.all[0].dir[2], n = (double)(float)ior;
    double share = fresnel(cos_in, 1.0, n), f0 = (n - 1) * (n - 1) / ((n + 1) * (n + 1));
    if (schlick)
        share = f0 + (1.0 - f0) * pow(1.0 - cos_in, 5);
    const struct reference_ray *reflected = find_ray(&rays, REFERENCE_REFLECTED, 0);
    const struct reference_ray *refracted = find_ray(&rays, REFERENCE_REFRACTED, 0);
    for (int c = 0; c < 3; ++c) {
        assert_close(reflected->weight[c], share, 1e-10);
        assert_close(refracted->weight[c], 1.0 - share, 1e-10);
    }
    double in = facing_angle(&rays.all[0]);
    assert_close(sin(facing_angle(refracted)), sin(in) / n, 1e-12);
    assert_close(reflected->dir[0], rays.all[0].dir[0], 1e-12);
    assert_close(reflected->dir[2], -rays.all[0].dir[2], 1e-12);
    assert_close(rays.all[0].t, 4.0 / cos_in, 1e-12 * rays.all[0].t);
    /* The ray that leaves the slab on the other side, parallel to the camera ray. */
    const struct reference_ray *out =
        find_ray(&rays, REFERENCE_REFRACTED, (uint32_t)(refracted - rays.all));
    assert_close(out->dir[0], rays.all[0].dir[0], 1e-12);
    assert_close(refracted->t, 2.0 / cos(facing_angle(refracted)), 1e-10);
    assert_int_equal(refracted->medium, refracted->material);
    assert_int_equal(out->medium, REFERENCE_NONE);
    free(rays.all);
    close_reference(&d);
}

TEST(glass_follows_fresnel_and_snell)
{
    static const double angles[] = {0.0, 0.2, 0.9, 1.2, 1.5};
    static const double iors[] = {1.33, 1.5, 2.42};
    for (size_t i = 0; i < 30; ++i)
        check_glass(angles[i / 6], iors[i / 2 % 3], i % 2);
}

/* Rays inside of glass of index 1.5, just below and beyond the critical angle of 41.8 degrees. */
TEST(light_is_reflected_whole_from_inside)
{
    for (int beyond = 0; beyond < 2; ++beyond) {
        double angle = (41.81 + (beyond ? 0.02 : -0.02)) * PI / 180.0;
        struct scene *scene =
            dark_scene((double[]){0, 0, 0}, (double[]){sin(angle), 0, -cos(angle)});
        add_object(scene, mesh_box(100, 100, 8), clear_glass(1.5f, 0), 0, 0, 0);
        struct drawn d = open_reference(scene, &one_pixel);
        struct rays rays = reference_rays(d.reference, 0, 0, 0);
        assert_int_not_equal(rays.all[0].medium, REFERENCE_NONE);
        double share = fresnel(-rays.all[0].dir[2], 1.5, 1.0);
        const struct reference_ray *reflected = find_ray(&rays, REFERENCE_REFLECTED, 0);
        assert_close(reflected->weight[0], share, 1e-7);
        assert_true(beyond ? share == 1.0 : share < 0.99);
        free(rays.all);
        close_reference(&d);
    }
}

TEST(bodies_absorb_by_beer)
{
    const double absorption[3] = {0.1, 0.7, 3.0};
    struct scene_material m = clear_glass(1.0f, 0);
    for (int c = 0; c < 3; ++c)
        m.absorption[c] = (float)absorption[c];
    struct scene *scene = facing_scene(0.5, m);
    set_sky(scene, 1, 1, 1);
    struct drawn d = open_reference(scene, &one_pixel);
    struct rays rays = reference_rays(d.reference, 0, 0, 0);
    own_image image = draw(&d);
    double path = 2.0 / -rays.all[0].dir[2];
    for (int c = 0; c < 3; ++c) {
        double expected = exp(-(double)(float)absorption[c] * path);
        assert_near(image.pixels[c], expected, 1e-7);
        /* Rays start some 2e-11 off these faces. */
        assert_close(rays.all[rays.count - 1].weight[c], expected, 1e-10);
    }
    free(rays.all);
    close_reference(&d);
}

/* A furnace test: without absorption, under a sky of 1, the weights of rays that reach the sky and
   of rays that were cut add up to 1. */
static void check_furnace(const struct drawn *d, uint32_t x, uint32_t y)
{
    struct rays rays = reference_rays(d->reference, x, y, 0);
    double sum = 0.0;
    for (uint32_t i = 0; i < rays.count; ++i) {
        bool cut = rays.all[i].end == WHIT_PROBE_DEPTH || rays.all[i].end == WHIT_PROBE_BAILOUT;
        sum += rays.all[i].radiance[0] + (cut ? rays.all[i].weight[0] : 0.0);
    }
    assert_close(sum, 1.0, 1e-11);
    free(rays.all);
}

TEST(nothing_is_lost_in_a_furnace)
{
    struct scene *scene = dark_scene((double[]){0, 0, 6}, (double[]){0, 0, 0});
    set_sky(scene, 1, 1, 1);
    add_object(scene, mesh_torus(1.0, 0.35, 24, 12), clear_glass(1.5f, 2), 0, 0, 0);
    add_object(scene, mesh_sphere(0.9, 24, 12), clear_glass(1.33f, 1), 0.3, 0, 0);
    add_object(scene, mesh_box(3, 3, 1), clear_glass(1.1f, 0), 0, 0, -0.5);
    struct scene_material sheet = clear_glass(1.5f, 0);
    sheet.thin_walled = true;
    add_object(scene, mesh_box(5, 1, 0.1), sheet, 0, 1, 2);
    const whit_renderer_params params = {.width = 24, .height = 24, .depth = 20, .bailout = 1e-4};
    struct drawn d = open_reference(scene, &params);
    for (uint32_t i = 0; i < 24 * 24; ++i)
        check_furnace(&d, i % 24, i / 24);
    close_reference(&d);
}

/* ---- Light ---- */

/* Gives the light in the one pixel of a picture of the scene, which is freed. */
static double pixel_light(struct scene *scene, const struct reference_params *params)
{
    struct drawn d = open_with(scene, NULL, params);
    own_image image = draw(&d);
    double light = (double)image.pixels[0];
    close_reference(&d);
    return light;
}

static const struct reference_params of_one_pixel = {
    .picture = {.width = 1, .height = 1, .depth = 8}};

/* A floor of a material, seen from above, at (0, 0, 0) in the middle. */
static struct scene *floor_of(struct scene_material m)
{
    struct scene *scene = dark_scene((double[]){0, 8, 0}, (double[]){0, 0, 0});
    add_object(scene, mesh_plane(40), m, 0, 0, 0);
    return scene;
}

TEST(light_falls_with_cosine_and_square)
{
    struct scene *scene = floor_scene(8);
    scene_put_lamp(scene, 3, 4, 0, 100);
    assert_close(pixel_light(scene, &of_one_pixel), 100 / 25.0 * 0.8, 2e-6);
    scene = floor_scene(8);
    scene_put_sun(scene, -3, -4, 0, 2);
    assert_close(pixel_light(scene, &of_one_pixel), 2 * 0.8, 2e-7);
}

/* Blinn-Phong: (n . h)^shininess; GGX where light, eye and normal coincide: 1 / (4 alpha^2). */
TEST(highlights_follow_their_formulas)
{
    struct scene_material m = matte(0, 0, 0);
    set_rgb(m.specular, 0.7f, 0.7f, 0.7f);
    m.shininess = 30;
    struct scene *scene = floor_of(m);
    scene_put_sun(scene, -sin(0.4), -cos(0.4), 0, 1);
    assert_close(pixel_light(scene, &of_one_pixel), 0.7 * pow(cos(0.2), 30), 1e-7);
    m = matte(0.6f, 0.6f, 0.6f);
    m.model = WHIT_MODEL_METAL_ROUGH;
    set_rgb(m.specular, 1, 1, 1);
    m.metallic = 1;
    m.roughness = 0.5f;
    scene = floor_of(m);
    scene_put_sun(scene, 0, -1, 0, 1);
    assert_close(pixel_light(scene, &of_one_pixel), 0.6 / (4 * 0.0625), 1e-6);
}

/* A rectangle parallel to the floor: 4 times the closed form of one quarter. */
TEST(emitters_follow_their_form_factor)
{
    struct scene *scene = floor_scene(8);
    scene_put_light(scene, (struct scene_light){.kind = WHIT_LIGHT_RECTANGLE,
                                                .node = SCENE_NONE,
                                                .position = {-1, 2, -1.5},
                                                .edge_u = {2, 0, 0},
                                                .edge_v = {0, 0, 3},
                                                .color = {5, 5, 5}});
    double a = 0.5, b = 0.75, ra = sqrt(1 + a * a), rb = sqrt(1 + b * b);
    double factor = 4 / (2 * PI) * (a / ra * atan(b / ra) + b / rb * atan(a / rb));
    assert_close(pixel_light(scene, &of_one_pixel), 5 * factor, 2e-6);
}

/* A sheet whose corner is 0.3 and 0.2 beside a point 2 above the floor, and an endless one: closed
   forms as for the rectangle above. */
TEST(wide_emitters_fill_their_part_of_the_sky)
{
    const double widths[] = {1e5, 1e9, 1e12, 1e15}, x = 0.3, z = 0.2;
    double a = sqrt(4 + x * x), b = sqrt(4 + z * z);
    double quarter =
        0.25 - x / a / 4 - z / b / 4 + (x / a * atan(z / a) + z / b * atan(x / b)) / (2 * PI);
    for (int i = 0; i < 12; ++i) {
        double wide = widths[i / 3], u = wide * 0.96, v = wide * 0.28, e = x, f = z;
        if (i % 3 == 0)
            e = f = -0.5 * wide;
        struct scene *scene = floor_scene(8);
        scene_put_light(scene, (struct scene_light){
                                   .kind = i % 3 == 2 ? WHIT_LIGHT_TRIANGLE : WHIT_LIGHT_RECTANGLE,
                                   .node = SCENE_NONE,
                                   .position = {e * 0.96 - f * 0.28, 2, e * 0.28 + f * 0.96},
                                   .edge_u = {u, 0, v},
                                   .edge_v = {-v, 0, u},
                                   .color = {5, 5, 5}});
        assert_close(pixel_light(scene, &of_one_pixel), i % 3 ? 5 * quarter : 5.0, 1e-4);
    }
}

/* Light through sheets is multiplied by 1 - opacity for each; with whole_stops by the rounded value
   of the kernels. */
TEST(filters_multiply)
{
    for (int stops = 0; stops < 2; ++stops) {
        struct scene *scene = floor_scene(8);
        struct scene_material sheet = matte(0, 0, 0);
        sheet.alpha = SCENE_ALPHA_BLEND;
        sheet.opacity = 0.3f;
        add_object(scene, mesh_plane(2), sheet, 4, 1, 0);
        add_object(scene, mesh_plane(2), sheet, 6, 1.5, 0);
        scene_put_sun(scene, -4, -1, 0, 1);
        struct reference_params params = of_one_pixel;
        params.whole_stops = stops;
        double open = 1 / sqrt(17.0), opacity = (double)0.3f;
        double share =
            stops ? exp2(2 * -round(-64 * log2(1 - opacity)) / 64) : (1 - opacity) * (1 - opacity);
        assert_close(pixel_light(scene, &params), open * share, 2e-8);
    }
}

/* ---- Pictures and trees ---- */

static struct scene *crowded_scene(void)
{
    struct scene *scene = dark_scene((double[]){0, 3, 9}, (double[]){0, 0.5, 0});
    set_sky(scene, 0.9f, 0.5f, 0.1f);
    struct scene_material shiny = material_plain("mirror");
    set_rgb(shiny.reflection, 0.8f, 0.8f, 0.8f);
    add_object(scene, mesh_plane(20), matte(0.6f, 0.5f, 0.4f), 0, 0, 0);
    add_object(scene, mesh_sphere(1.0, 16, 8), clear_glass(1.5f, 0), -1.2, 1, 0);
    add_object(scene, mesh_torus(1.0, 0.3, 16, 8), shiny, 1.2, 1, 0);
    scene_put_lamp(scene, 4, 6, 3, 30);
    scene_put_lamp(scene, -4, 6, 5, 30);
    return scene;
}

TEST(threads_draw_the_same_bytes)
{
    const whit_renderer_params picture = {
        .width = 37, .height = 41, .depth = 6, .sampling.count = 4};
    struct drawn d = open_reference(crowded_scene(), &picture);
    own_image first = draw(&d);
    for (uint32_t threads = 1; threads < 4; ++threads) {
        const struct reference_params params = {.picture = picture, .thread_count = threads};
        own_picture other = reference_picture(d.accel, &params);
        assert_same_image("threads", &other.color, &first);
    }
    close_reference(&d);
}

static void check_tree(const struct reference_ray *rays, uint32_t count, double sum[3])
{
    for (uint32_t i = 0; i < count; ++i) {
        assert_true(i == 0 ? rays[i].parent == REFERENCE_NONE : rays[i].parent < i);
        assert_close(rays[i].dir[0] * rays[i].dir[0] + rays[i].dir[1] * rays[i].dir[1] +
                         rays[i].dir[2] * rays[i].dir[2],
                     1.0, 1e-12);
        assert_int_equal(rays[i].light != REFERENCE_NONE, rays[i].kind == REFERENCE_SHADOW);
        bool met = rays[i].end == WHIT_PROBE_DIVIDED || rays[i].end == WHIT_PROBE_OPAQUE ||
                   rays[i].end == WHIT_PROBE_BLOCKED;
        assert_int_equal(rays[i].instance != REFERENCE_NONE, met);
        assert_int_equal(rays[i].material != REFERENCE_NONE, met);
        for (int c = 0; c < 3; ++c)
            sum[c] += rays[i].radiance[c];
    }
}

TEST(ray_trees_add_up_to_pixels)
{
    const whit_renderer_params picture = {.width = 16, .height = 16, .depth = 5};
    struct drawn d = open_reference(crowded_scene(), &picture);
    own_image image = draw(&d);
    uint32_t kinds = 0, ends = 0;
    for (uint32_t i = 0; i < 256; ++i) {
        struct rays rays = reference_rays(d.reference, i % 16, i / 16, 0);
        double sum[3] = {0};
        check_tree(rays.all, rays.count, sum);
        for (int c = 0; c < 3; ++c)
            assert_near(image.pixels[4 * i + (uint32_t)c], sum[c], 1e-6);
        for (uint32_t k = 0; k < rays.count; ++k) {
            kinds |= 1u << rays.all[k].kind;
            ends |= 1u << rays.all[k].end;
        }
        free(rays.all);
    }
    assert_int_equal(kinds, 15);
    assert_int_equal(ends & (1u << WHIT_PROBE_MISSED | 1u << WHIT_PROBE_DIVIDED |
                             1u << WHIT_PROBE_OPAQUE | 1u << WHIT_PROBE_REACHED |
                             1u << WHIT_PROBE_BLOCKED | 1u << WHIT_PROBE_DEPTH |
                             1u << WHIT_PROBE_BAILOUT),
                     ends);
    close_reference(&d);
}

/* Camera rays equal those of the kernels (camera_all_rays has their bits) within float rounding. */
TEST(cameras_are_those_of_kernels)
{
    static const struct {
        whit_camera_kind kind;
        float lens;
    } cameras[] = {{WHIT_CAMERA_PERSPECTIVE, 0.0f},
                   {WHIT_CAMERA_ORTHOGRAPHIC, 0.0f},
                   {WHIT_CAMERA_PANORAMA, 0.0f},
                   {WHIT_CAMERA_PERSPECTIVE, 0.2f}};
    for (size_t i = 0; i < 4; ++i) {
        struct scene *scene = dark_scene((double[]){1, 2, 3}, (double[]){0, 0.5, -1});
        scene->cameras[0].kind = cameras[i].kind;
        scene->cameras[0].height = 5.0f;
        scene->cameras[0].lens_radius = cameras[i].lens;
        add_object(scene, mesh_plane(10), material_plain("floor"), 0, 0, 0);
        const whit_renderer_params picture = {
            .width = 13, .height = 9, .depth = 8, .sampling.count = 4};
        struct drawn d = open_reference(scene, &picture);
        struct gpu_frame frame;
        own_pose pose;
        uint32_t kind;
        assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
        assert_int_equal(media_view(&fixture_log, d.accel, &pose, &(whit_camera){.name = NULL}, 13,
                                    9, &frame, &kind),
                         WHIT_OK);
        for (uint32_t k = 0; k < 13 * 9 * 4; ++k) {
            struct gpu_chunk chunk = {0};
            struct gpu_ray ray;
            camera_sample(&frame, k % 4, &chunk);
            camera_ray(&frame, kind, k / 4 % 13, k / 52, &chunk, &ray);
            struct rays rays = reference_rays(d.reference, k / 4 % 13, k / 52, k % 4);
            for (int c = 0; c < 3; ++c) {
                assert_close(rays.all[0].origin[c], (double)ray.origin[c], 1e-6);
                assert_close(rays.all[0].dir[c], (double)ray.dir[c], 5e-7);
            }
            free(rays.all);
        }
        close_reference(&d);
    }
}

/* Pictures do not depend on the kind of tree; a single-level tree has vertices rounded to
   floats. */
TEST(trees_do_not_matter)
{
    const whit_accel_params trees[] = {{.build = WHIT_BUILD_MEDIAN},
                                       {.build = WHIT_BUILD_SPATIAL},
                                       {.build = WHIT_BUILD_NONE},
                                       {.instances = WHIT_INSTANCES_OFF}};
    const struct reference_params params = {.picture = {.width = 24, .height = 24, .depth = 6}};
    struct drawn d = open_reference(crowded_scene(), &params.picture);
    own_image first = draw(&d);
    for (size_t i = 0; i < sizeof trees / sizeof *trees; ++i) {
        struct accel *other = NULL;
        uint32_t over = 0;
        assert_int_equal(accel_create(&fixture_log, d.scene, &trees[i], &other), WHIT_OK);
        own_picture picture = reference_picture(other, &params);
        for (size_t k = 0; k < 4 * 24 * 24; ++k)
            over += fabs((double)picture.color.pixels[k] - (double)first.pixels[k]) > 1e-4;
        if (trees[i].instances == WHIT_INSTANCES_OFF)
            assert_true(over <= 4 * 3);
        else
            assert_same_image("other trees", &picture.color, &first);
        accel_destroy(other);
    }
    close_reference(&d);
}

/* An emissive surface does not light itself: it is in its light's plane, except that a single-level
   tree rounds its corners. */
TEST(emitters_do_not_light_themselves)
{
    const whit_accel_params flat = {.instances = WHIT_INSTANCES_OFF};
    const struct reference_params params = {
        .picture = {.width = 9, .height = 9, .shadows = WHIT_SHADOWS_NONE}};
    const double heights[] = {1.99, 0.7, -3.3, 1001.3};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; ++i) {
        struct drawn d = open_with(glowing_panel(heights[i]), &flat, &params);
        own_image image = draw(&d);
        assert_true(red_sum(&image) == 0.0);
        close_reference(&d);
    }
}
