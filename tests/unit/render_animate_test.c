/* A renderer is set to several times in turn: each picture is, byte for byte, that of a renderer
   that was made for this time. */
#include "accel/pose.h"
#include "ray_fixture.h"
#include "render_scenes.h"
#include "unit.h"

static const whit_renderer_params animate_params = {
    .width = 40, .height = 32, .depth = 4, .packets = WHIT_PACKETS_ON};

/* ---- Scenes ---- */

static struct scene *spin(void)
{
    return file_scene("spin");
}

/* A glass ball whose scale becomes negative, a lamp of triangles, a point light, and the camera,
   all on nodes that move. */
static struct scene *everything_moves(void)
{
    static const float times[] = {0, 1, 2};
    struct scene *scene = scene_begin(&fixture_log, "animation");
    struct scene_material glass = material_grey("glass"), glow = material_grey("glow");
    set_rgb(glass.transmission, 0.9f, 0.9f, 0.9f);
    set_rgb(glow.emission, 12, 12, 12);
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
                   .kind = WHIT_LIGHT_POINT, .node = point, .color = {2, 2, 1}, .falloff = true});
    scene_put_camera(scene, (double[]){0, 2.2, 6}, (double[]){0, 0.8, 0}, 0.7);
    scene->cameras[0].node = eye;
    return scene;
}

/* One object that moves, but is where its file puts it at 0 s and at 2 s: an object without a
   transform gets another kernel. */
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

/* Evenly spaced at 0 s; at 1 s each is 1.8 times as far away as the one before, so that a tree that
   is built by areas is deep. */
static struct scene *strung_out(void)
{
    enum { COUNT = 64 };
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

static struct picture take_anew(const struct fixture *f, whit_instances instances, double time_s)
{
    const whit_accel_params trees = {.instances = instances};
    struct fixture anew = {.device = f->device};
    whit_renderer_params params = animate_params;
    params.time_s = time_s;
    assert_int_equal(accel_create(&fixture_log, f->scene, &trees, &anew.accel), WHIT_OK);
    fixture_renew(&anew, &params);
    struct picture picture = render_picture(&anew);
    renderer_destroy(anew.renderer);
    accel_destroy(anew.accel);
    return picture;
}

enum { TIMES = 3, STEPS = 6 };

/* Sets the renderer to the times in several orders. The pictures of neighbouring times differ. */
static void check_any_order(const char *name, struct scene *scene, const double times_s[TIMES],
                            const whit_accel_params *params)
{
    static const int order[STEPS] = {1, 2, 0, 2, 1, 1};
    struct picture anew[TIMES];
    own_fixture f = fixture_open(scene, params, &animate_params);
    for (int i = 0; i < TIMES; ++i)
        anew[i] = take_anew(&f, params->instances, times_s[i]);
    for (int i = 0; i < 2; ++i)
        assert_true(pixels_unlike(&anew[i].color, &anew[i + 1].color) > 0);
    for (int i = 0; i < STEPS; ++i) {
        assert_int_equal(renderer_set_time(f.renderer, times_s[order[i]]), WHIT_OK);
        own_picture picture = render_picture(&f);
        print_message("  %s at %g s, step %d\n", name, times_s[order[i]], i);
        assert_same_picture(name, &picture, &anew[order[i]]);
    }
    for (int i = 0; i < TIMES; ++i)
        picture_finish(&anew[i]);
}

TEST(pictures_are_those_of_new_renderers)
{
    static const struct {
        const char *name;
        struct scene *(*make)(void);
        double times_s[TIMES];
        whit_accel_params trees;
    } rows[] = {
        {"a scene file", spin, {0.0, 0.7, 3.1}, {0}},
        {"lights, cameras and glass", everything_moves, {0.0, 0.9, 2.0}, {0}},
        {"a refitted tree",
         strung_out,
         {0.0, 0.5, 1.0},
         {.instance_refit = true, .instance_build = WHIT_BUILD_MEDIAN}},
        {"an object that leaves its place", leaves_its_place, {0.0, 0.5, 1.0}, {0}},
        {"trees that get deeper", strung_out, {0.0, 0.5, 1.0}, {0}},
        {"a flattened scene", everything_moves, {0.0, 0.9, 2.0}, {.instances = WHIT_INSTANCES_OFF}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i)
        check_any_order(rows[i].name, rows[i].make(), rows[i].times_s, &rows[i].trees);
}

static const struct pipeline *shading_of(const struct fixture *f)
{
    return f->renderer->picture.stages.set.passes[STAGE_SHADE].pipeline;
}

TEST_BY_TURNS(a_deeper_tree_gets_a_larger_stack, 0, 2)
{
    own_fixture f = fixture_open(strung_out(), NULL, &animate_params);
    uint32_t depth = f.accel->instance_depth, size = f.renderer->node_stack_size;
    const struct pipeline *pipeline = shading_of(&f);
    assert_int_equal(renderer_set_time(f.renderer, 0.01), WHIT_OK);
    if (f.accel->instance_depth <= depth)
        assert_ptr_equal(shading_of(&f), pipeline);
    assert_int_equal(renderer_set_time(f.renderer, 1.0), WHIT_OK);
    assert_true(f.accel->instance_depth > depth + 2);
    assert_true(f.renderer->node_stack_size > size);
    assert_true(f.renderer->node_stack_size >= accel_stack_size(f.accel));
    size = f.renderer->node_stack_size;
    pipeline = shading_of(&f);
    assert_int_equal(renderer_set_time(f.renderer, 0.0), WHIT_OK);
    assert_int_equal(f.renderer->node_stack_size, size);
    assert_ptr_equal(shading_of(&f), pipeline);
}

/* Rods that lie along an axis at 0 s. At 1 s they are turned, and spatial splits clip them: rays
   then need a margin, for which there are other kernels. */
static struct scene *turned_rods(void)
{
    static const float times[] = {0, 1}, turn[] = {0, 0, 0, 1, 0, 0, 0.38268343f, 0.92387953f};
    struct scene *scene = scene_begin(&fixture_log, "animation");
    uint32_t mesh = scene_put_mesh(scene, mesh_box(10, 0.1, 0.1));
    for (int i = 0; i < 8; ++i) {
        uint32_t node = scene_put_node(scene, SCENE_NONE, 0, 0.3 * i, 0);
        scene_put_again(scene, mesh, &(struct put){.node = &node});
        scene_put_channel(scene, node, SCENE_PATH_ROTATION, 2, times, turn);
    }
    return scene;
}

TEST(trees_that_get_clipped_have_other_kernels)
{
    static const whit_accel_params trees = {.build = WHIT_BUILD_SPATIAL,
                                            .instances = WHIT_INSTANCES_OFF};
    whit_renderer_params params = animate_params;
    own_fixture f = fixture_open(turned_rods(), &trees, &params);
    own_picture before = render_picture(&f);
    bool was_clipped = f.accel->clipped;
    assert_int_equal(renderer_set_time(f.renderer, 1.0), WHIT_OK);
    own_picture after = render_picture(&f);
    assert_true(f.accel->clipped && !was_clipped);
    params.time_s = 1.0;
    own_renderer fresh = fixture_beside(&f, &params);
    own_picture expected = render_picture(&fresh);
    assert_same_picture("clipped", &after, &expected);
    assert_int_equal(after.stats.kernel_instructions, expected.stats.kernel_instructions);
}

/* Kernels are made late, when the trees may be at the time of another renderer. */
TEST(renderers_of_one_tree_at_two_times)
{
    whit_renderer_params params = animate_params;
    own_fixture f = fixture_open(leaves_its_place(), NULL, &params);
    params.time_s = 1.0;
    own_renderer later = fixture_beside(&f, &params);
    for (int i = 0; i < 2; ++i) {
        own_picture picture = render_picture(i ? &later : &f);
        own_picture anew = take_anew(&f, 0, i);
        assert_same_picture("two times", &picture, &anew);
    }
}

/* The root mean square difference over all channels, relative to the mean of the first image. */
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

/* A flattened scene's vertices differ in their last bits, and so do the pictures; a ray at an edge
   may pass it on the other side. At 0.9 s the glass is a mirrored instance: with inside and outside
   exchanged, or with a normal by the wrong matrix, the difference would be 0.1 or more. */
TEST_BY_TURNS(a_flattened_scene_looks_the_same, 1, 2)
{
    static const double times_s[] = {0.0, 0.9, 2.0};
    own_fixture f = fixture_open(everything_moves(), NULL, &animate_params);
    for (int i = 0; i < 3; ++i) {
        own_picture instanced = take_anew(&f, WHIT_INSTANCES_ON, times_s[i]);
        own_picture flat = take_anew(&f, WHIT_INSTANCES_OFF, times_s[i]);
        double off = difference(&instanced.color, &flat.color);
        print_message("  at %g s: differs by %.2g\n", times_s[i], off);
        assert_true(off < 1e-4);
        assert_same_image("identities", &instanced.ids, &flat.ids);
    }
}

/* Batches of rays are traced in the scene at the time of the pictures. */
TEST(traced_rays_follow)
{
    own_fixture f = fixture_open(leaves_its_place(), NULL, &animate_params);
    const struct gpu_ray ray = {.origin = {1.3f, 0, 5}, .dir = {0, 0, -1}, .t_max = INFINITY};
    static const double times_s[] = {0.0, 1.0, 0.0, 2.0, 1.0};
    for (int i = 0; i < 5; ++i) {
        struct gpu_hit hit;
        assert_int_equal(renderer_set_time(f.renderer, times_s[i]), WHIT_OK);
        assert_int_equal(trace_beside_twin(&f, false, &ray, 1, &hit, NULL).hits, 0);
        assert_int_equal(hit.primitive != HIT_NONE, times_s[i] == 1.0);
    }
}

TEST(an_old_picture_is_not_taken_for_a_new_one)
{
    own_fixture f = fixture_open(leaves_its_place(), NULL, &animate_params);
    struct image image = render(&f), again = {0};
    assert_int_equal(renderer_set_time(f.renderer, 1.0), WHIT_OK);
    assert_int_equal(renderer_read_color(f.renderer, &again), WHIT_ERROR_USAGE);
    image_finish(&image);
}
