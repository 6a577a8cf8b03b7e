/* One renderer at one time after another: the pictures are those of renderers made at these times,
   byte for byte. */
#include "load/load.h"
#include "render/renderer.h"
#include "render_fixture.h"
#include "twin/traverse.h"

static const struct render_params animate_params = {
    .width = 40, .height = 32, .depth = 4, .packets = RENDER_PACKETS_ON};

/* ---- Scenes ---- */

static struct scene *spin(void)
{
    struct scene *scene = scene_begin(&fixture_log, "animation");
    assert_int_equal(roots_init(&scene->roots, WHIT_SCENES_DIR "/spin.json"), WHIT_OK);
    assert_int_equal(load_scene_file(scene, WHIT_SCENES_DIR "/spin.json", NULL), WHIT_OK);
    return scene;
}

/* A glass ball that turns inside out on its way, a lamp of triangles, a lamp that is a point, and
   the camera, all on nodes that move. */
static struct scene *everything_moves(void)
{
    static const float times[] = {0, 1, 2};
    struct scene *scene = scene_begin(&fixture_log, "animation");
    struct scene_material glass = material_grey("glass"), glow = material_grey("glow");
    for (int i = 0; i < 3; ++i) {
        glass.transmission[i] = 0.9f;
        glow.emission[i] = 12.0f;
    }
    glass.fresnel = true;
    uint32_t ball = scene_put_node(scene, SCENE_NONE, 0, 1, 0);
    uint32_t light = scene_put_node(scene, SCENE_NONE, 0, 3, 0);
    uint32_t point = scene_put_node(scene, SCENE_NONE, 1, 2, 1);
    uint32_t eye = scene_put_node(scene, SCENE_NONE, 0, 0, 0);
    scene_put(scene, mesh_plane(12), NULL);
    scene_put(scene, mesh_sphere(0.8, 20, 12), &(struct put){.material = &glass, .node = &ball});
    scene_put(scene, mesh_plane(0.8), &(struct put){.material = &glow, .node = &light});
    scene_put_channel(scene, ball, SCENE_PATH_TRANSLATION, 3, times,
                      (float[]){0, 1, 0, 1, 1, 0, 0, 1.5f, 1});
    scene_put_channel(scene, ball, SCENE_PATH_SCALE, 3, times,
                      (float[]){1, 1, 1, -1, 0.7f, 1, 1, -1, 0.5f});
    scene_put_channel(scene, light, SCENE_PATH_TRANSLATION, 3, times,
                      (float[]){0, 3, 0, 1.5f, 2.5f, 0, -1, 3, 1});
    scene_put_channel(scene, point, SCENE_PATH_TRANSLATION, 3, times,
                      (float[]){1, 2, 1, -1, 2, 1, -1, 3, -1});
    scene_put_channel(scene, eye, SCENE_PATH_TRANSLATION, 3, times,
                      (float[]){0, 0, 0, 0.3f, 0.2f, 0, 0.6f, 0, 0.4f});
    scene_put_light(
        scene, (struct scene_light){
                   .kind = SCENE_LIGHT_POINT, .node = point, .color = {2, 2, 1}, .falloff = true});
    scene_put_camera(scene, (double[]){0, 2.2, 6}, (double[]){0, 0.8, 0}, 0.7);
    scene->cameras[0].node = eye;
    return scene;
}

/* One object, in its place at 0 s and at 2 s: without a transform the kernel is another one. */
static struct scene *leaves_its_place(void)
{
    static const float times[] = {0, 1, 2};
    struct scene *scene = scene_begin(&fixture_log, "animation");
    struct scene_material mirror = material_grey("mirror");
    mirror.reflection[0] = mirror.reflection[1] = 0.5f;
    uint32_t node = scene_put_node(scene, SCENE_NONE, 0, 0, 0);
    scene_put(scene, mesh_sphere(1, 20, 12), &(struct put){.material = &mirror, .node = &node});
    scene_put_channel(scene, node, SCENE_PATH_TRANSLATION, 3, times,
                      (float[]){0, 0, 0, 0.5f, 0, 0, 0, 0, 0});
    return scene;
}

/* Even at first, then each twice as far as the one before: a tree by areas is deep there. */
static struct scene *strung_out(void)
{
    enum { COUNT = 24 };
    static const float times[] = {0, 1};
    struct scene *scene = scene_begin(&fixture_log, "animation");
    uint32_t mesh = scene_put_mesh(scene, mesh_sphere(0.4, 20, 12));
    double far = 0.001;
    for (int i = 0; i < COUNT; ++i, far *= 1.8) {
        uint32_t node = scene_put_node(scene, SCENE_NONE, 0, 0, 0);
        float x = (float)(i % 5), y = (float)(i / 5), size = (float)far * 0.6f;
        scene_put_again(scene, mesh, &(struct put){.node = &node});
        scene_put_channel(scene, node, SCENE_PATH_TRANSLATION, 2, times,
                          (float[]){x, y, 0, (float)far, (float)far * 0.5f, 0});
        scene_put_channel(scene, node, SCENE_PATH_SCALE, 2, times,
                          (float[]){1, 1, 1, size, size, size});
    }
    return scene;
}

/* ---- Pictures ---- */

struct picture {
    struct image color, ids;
};

static struct picture take(struct renderer *renderer)
{
    struct picture picture;
    assert_int_equal(renderer_render(renderer), WHIT_OK);
    assert_int_equal(renderer_read_color(renderer, &picture.color), WHIT_OK);
    assert_int_equal(renderer_read_ids(renderer, &picture.ids), WHIT_OK);
    return picture;
}

static bool pictures_are_equal(const struct picture *a, const struct picture *b)
{
    size_t pixels = (size_t)a->color.width * a->color.height;
    return memcmp(a->color.pixels, b->color.pixels, pixels * 4 * sizeof(float)) == 0 &&
           memcmp(a->ids.words, b->ids.words, pixels * 2 * sizeof(uint32_t)) == 0;
}

static void picture_finish(struct picture *picture)
{
    image_finish(&picture->color);
    image_finish(&picture->ids);
}

static struct picture take_anew(const struct fixture *f, bool flatten, double time_s)
{
    const struct accel_params flat = {.flatten = flatten};
    struct accel *accel = NULL;
    struct renderer *renderer = NULL;
    struct render_params params = animate_params;
    params.time_s = time_s;
    assert_int_equal(accel_create(&fixture_log, f->scene, &flat, &accel), WHIT_OK);
    assert_int_equal(renderer_create(&fixture_log, f->device, accel, &params, &renderer), WHIT_OK);
    struct picture picture = take(renderer);
    renderer_destroy(renderer);
    accel_destroy(accel);
    return picture;
}

enum { TIMES = 3, STEPS = 6 };

/* There and back again; each time but the last ones differs from its neighbours. */
static void assert_any_order(struct scene *scene, const double times_s[TIMES],
                             const struct accel_params *params)
{
    static const int order[STEPS] = {1, 2, 0, 2, 1, 1};
    struct picture anew[TIMES];
    struct fixture f = fixture_open(scene, params, &animate_params);
    for (int i = 0; i < TIMES; ++i)
        anew[i] = take_anew(&f, params && params->flatten, times_s[i]);
    assert_false(pictures_are_equal(&anew[0], &anew[1]));
    assert_false(pictures_are_equal(&anew[1], &anew[2]));
    for (int i = 0; i < STEPS; ++i) {
        assert_int_equal(renderer_set_time(f.renderer, times_s[order[i]]), WHIT_OK);
        struct picture picture = take(f.renderer);
        if (!pictures_are_equal(&picture, &anew[order[i]]))
            fail_msg("at %g s, step %d: another picture", times_s[order[i]], i);
        picture_finish(&picture);
    }
    for (int i = 0; i < TIMES; ++i)
        picture_finish(&anew[i]);
    fixture_close(&f);
}

static void a_scene_file_at_any_time(void **state)
{
    (void)state;
    assert_any_order(spin(), (double[]){0.0, 0.7, 3.1}, NULL);
}

static void lights_cameras_and_glass_move(void **state)
{
    (void)state;
    assert_any_order(everything_moves(), (double[]){0.0, 0.9, 2.0}, NULL);
}

static void a_refitted_tree_gives_the_same_pictures(void **state)
{
    (void)state;
    const struct accel_params params = {.update = ACCEL_REFIT,
                                        .instances = {.builder = BVH_MEDIAN}};
    assert_any_order(strung_out(), (double[]){0.0, 0.5, 1.0}, &params);
}

static void an_object_may_leave_its_place(void **state)
{
    (void)state;
    assert_any_order(leaves_its_place(), (double[]){0.0, 0.5, 1.0}, NULL);
}

static void a_deeper_tree_gets_a_larger_stack(void **state)
{
    (void)state;
    const struct accel_params as_deep = {0}; /* as its tree, no deeper */
    struct fixture f = fixture_open(strung_out(), &as_deep, &animate_params);
    uint32_t depth = f.accel->instance_depth, size = f.renderer->node_stack_size;
    struct pipeline *pipeline = f.renderer->picture.stages.set.passes[STAGE_SHADE].pipeline;
    assert_int_equal(renderer_set_time(f.renderer, 0.01), WHIT_OK);
    if (f.accel->instance_depth <= depth)
        assert_ptr_equal(f.renderer->picture.stages.set.passes[STAGE_SHADE].pipeline, pipeline);
    assert_int_equal(renderer_set_time(f.renderer, 1.0), WHIT_OK);
    assert_true(f.accel->instance_depth > depth + 2);
    assert_true(f.renderer->node_stack_size > size);
    assert_true(f.renderer->node_stack_size >= accel_stack_size(f.accel));
    size = f.renderer->node_stack_size;
    pipeline = f.renderer->picture.stages.set.passes[STAGE_SHADE].pipeline;
    assert_int_equal(renderer_set_time(f.renderer, 0.0), WHIT_OK);
    assert_int_equal(f.renderer->node_stack_size, size);
    assert_ptr_equal(f.renderer->picture.stages.set.passes[STAGE_SHADE].pipeline, pipeline);
    fixture_close(&f);
    assert_any_order(strung_out(), (double[]){0.0, 0.5, 1.0}, &as_deep);
}

/* Root mean square over all channels, relative to the mean of the first. */
static double difference(const struct image *a, const struct image *b)
{
    size_t count = 4 * (size_t)a->width * a->height;
    double sum = 0.0, mean = 0.0;
    for (size_t i = 0; i < count; ++i) {
        double off = (double)a->pixels[i] - (double)b->pixels[i];
        sum += off * off;
        mean += (double)a->pixels[i];
    }
    return sqrt(sum / (double)count) / (mean / (double)count);
}

/* The vertices' last bits differ, and so do those of the pictures; a ray at an edge may go the
   other way. At 0.9 s the glass is a mirrored instance: with inside and outside exchanged, or a
   normal by the wrong matrix, the difference is 0.1 or more. */
static void a_flattened_scene_looks_the_same(void **state)
{
    (void)state;
    static const double times_s[] = {0.0, 0.9, 2.0};
    struct fixture f = fixture_open(everything_moves(), NULL, &animate_params);
    for (int i = 0; i < 3; ++i) {
        struct picture instanced = take_anew(&f, false, times_s[i]);
        struct picture flat = take_anew(&f, true, times_s[i]);
        double off = difference(&instanced.color, &flat.color);
        uint32_t other = 0;
        for (uint32_t p = 0; p < 2 * instanced.ids.width * instanced.ids.height; ++p)
            other += instanced.ids.words[p] != flat.ids.words[p];
        print_message("  at %g s: differs by %.2g, %u other identities\n", times_s[i], off, other);
        assert_true(off < 1e-4);
        assert_int_equal(other, 0);
        picture_finish(&instanced);
        picture_finish(&flat);
    }
    fixture_close(&f);
}

static void a_flattened_scene_moves(void **state)
{
    (void)state;
    const struct accel_params params = {.flatten = true};
    assert_any_order(everything_moves(), (double[]){0.0, 0.9, 2.0}, &params);
}

/* Batches of rays see what pictures see. */
static void traced_rays_follow(void **state)
{
    (void)state;
    struct fixture f = fixture_open(leaves_its_place(), NULL, &animate_params);
    const struct gpu_ray ray = {.origin = {1.3f, 0, 5}, .dir = {0, 0, -1}, .t_max = INFINITY};
    static const double times_s[] = {0.0, 1.0, 0.0, 2.0, 1.0};
    for (int i = 0; i < 5; ++i) {
        struct gpu_hit hit, twin;
        uint32_t status = 0;
        assert_int_equal(renderer_set_time(f.renderer, times_s[i]), WHIT_OK);
        assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, NULL), WHIT_OK);
        traverse_float(f.accel, ORDER_DISTANCE, &ray, false, HIT_NONE, HIT_NONE, &twin, NULL,
                       &status);
        assert_int_equal(hit.primitive != HIT_NONE, times_s[i] == 1.0);
        assert_memory_equal(&hit, &twin, sizeof hit);
    }
    fixture_close(&f);
}

static void an_old_picture_is_not_taken_for_a_new_one(void **state)
{
    (void)state;
    struct fixture f = fixture_open(leaves_its_place(), NULL, &animate_params);
    struct picture picture = take(f.renderer);
    struct image image = {0};
    assert_int_equal(renderer_set_time(f.renderer, 1.0), WHIT_OK);
    assert_int_equal(renderer_read_color(f.renderer, &image), WHIT_ERROR_USAGE);
    picture_finish(&picture);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_file_at_any_time),
        cmocka_unit_test(lights_cameras_and_glass_move),
        cmocka_unit_test(a_refitted_tree_gives_the_same_pictures),
        cmocka_unit_test(an_object_may_leave_its_place),
        cmocka_unit_test(a_deeper_tree_gets_a_larger_stack),
        cmocka_unit_test(a_flattened_scene_looks_the_same),
        cmocka_unit_test(a_flattened_scene_moves),
        cmocka_unit_test(traced_rays_follow),
        cmocka_unit_test(an_old_picture_is_not_taken_for_a_new_one),
    };
    return fixture_end(cmocka_run_group_tests(tests, NULL, NULL));
}
