/* Renderers without trees give the hits, pictures and ids that trees give, whatever the number of
   triangles. */
#include "messages_fixture.h"
#include "ray_fixture.h"
#include "render/probe.h"
#include "render_scenes.h"
#include "unit.h"

enum { RAYS = 500 };

/* The stack is as deep as with trees, so that the kernels are the same. */
static const whit_accel_params no_trees = {.build = WHIT_BUILD_NONE, .instance_refit = true};

/* Compares hits and costs with those of the float mirror, and hits with those of `trees`, which are
   of the same scene. */
static void check_hits(struct fixture *f, const struct accel *trees)
{
    const uint32_t in_mesh = f->scene->meshes[0].triangle_count;
    struct gpu_ray rays[RAYS];
    struct gpu_hit hits[RAYS];
    uint32_t status = 0;
    aim_at_bounds(f, rays, RAYS, 31);
    check_rays(f, "without trees", rays, RAYS, hits);
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_hit twin, tree, brute;
        struct gpu_cost cost = {0};
        traverse_ray(f->accel, NULL, &rays[i], &twin, &cost, &status);
        traverse_ray(trees, NULL, &rays[i], &tree, NULL, &status);
        traverse_ray(f->accel, &(struct traverse_params){.brute = true}, &rays[i], &brute, NULL,
                     &status);
        assert_memory_equal(&tree, &hits[i], sizeof tree);
        assert_memory_equal(&brute, &hits[i], sizeof brute);
        /* All triangles share one box, and no hit lies before it that would rule it out: a ray
           tests all triangles of a mesh or none. */
        assert_int_equal(cost.triangles % in_mesh, 0);
        assert_int_equal(cost.leaves * BVH_LEAF_MAX / in_mesh, cost.triangles / in_mesh);
        assert_true(hits[i].primitive == HIT_NONE || cost.triangles > 0);
    }
}

/* All nodes of [first, first + count), but for the unused one, have the same box. */
static void check_boxes(const struct accel *accel, uint32_t first, uint32_t count)
{
    const struct gpu_bvh_node *nodes = &accel->nodes[first];
    for (uint32_t i = 2; i < count; ++i) {
        assert_memory_equal(nodes[i].lo, nodes[0].lo, sizeof nodes->lo);
        assert_memory_equal(nodes[i].hi, nodes[0].hi, sizeof nodes->hi);
    }
}

/* All triangles lie in one plane, so that their box is flat. */
static struct scene *plain_scene(void)
{
    struct scene *scene = scene_begin(&fixture_log, "plain");
    scene_put(scene, mesh_terrain(10.0, 1e-30, 40, 3), NULL);
    return scene;
}

TEST(rays_equal_those_of_trees)
{
    struct scene *(*const make[])(void) = {terrain_scene, plain_scene, ring_scene};
    for (int i = 0; i < 3; ++i) {
        const whit_renderer_params params = {.width = 16, .height = 16, .count = true};
        own_fixture f = fixture_open(make[i](), &no_trees, &params);
        const struct accel_mesh *mesh = &f.accel->meshes[0];
        check_boxes(f.accel, 0, f.accel->instance_node_count);
        check_boxes(f.accel, mesh->first_node, mesh->node_count);
        struct accel *trees;
        assert_int_equal(accel_create(&fixture_log, f.scene, NULL, &trees), WHIT_OK);
        check_hits(&f, trees);
        accel_destroy(trees);
    }
}

/* Triangles one behind the other; every ray that meets their only box tests all of them. Each is an
   instance of one triangle (`apart`), or all are one mesh. The nearest may be anywhere in their
   order. */
static struct scene *stack_scene(uint32_t count, bool apart)
{
    struct scene *scene = scene_begin(&fixture_log, "stack");
    uint32_t in_mesh = apart ? 1 : count;
    float(*corners)[9] = array_alloc(in_mesh, sizeof *corners);
    assert_non_null(corners);
    for (uint32_t i = 0; i < in_mesh; ++i) {
        float z = (float)(i * 7919 % count);
        memcpy(corners[i], (float[9]){0, 0, z, 1, 1, z, 0.5f, 1, z}, sizeof corners[i]);
    }
    uint32_t index = scene_put_mesh(scene, mesh_triangles(corners[0], in_mesh));
    free(corners);
    for (uint32_t i = 0; i < count / in_mesh; ++i) {
        double t[3] = {0, 0, apart ? (double)(i * 7919 % count) : 0}, q[4] = {0, 0, 0, 1};
        struct affine placed = affine_from_trs(t, q, (double[3]){1, 1, 1});
        scene_put_again(scene, index, &(struct put){.matrix = &placed});
    }
    return scene;
}

/* Traces 16 rays whose t_min are at different places in the stack; the last ray misses all of it.
   Compares the hits with those of the float mirror. */
static whit_result trace_stack(const struct fixture *f, uint32_t count)
{
    struct gpu_ray rays[16];
    struct gpu_hit hits[16], twin;
    for (int i = 0; i < 16; ++i)
        rays[i] = (struct gpu_ray){{i == 15 ? 0.9f : 0.5f, i == 15 ? 0.1f : 0.75f, -1},
                                   (float)(count / 15 * (uint32_t)i),
                                   {0, 0, 1},
                                   INFINITY};
    for (int any = 0; any < 2; ++any) {
        whit_result result = renderer_trace(f->renderer, rays, 16, any, hits, NULL);
        if (result != WHIT_OK)
            return result;
        for (int i = 0; i < 16; ++i) {
            uint32_t status = 0;
            traverse_ray(f->accel, &(struct traverse_params){.any = any}, &rays[i], &twin, NULL,
                         &status);
            if (!any)
                assert_memory_equal(&hits[i], &twin, sizeof twin);
            assert_int_equal(twin.primitive == HIT_NONE, i == 15);
            assert_int_equal(hits[i].primitive == HIT_NONE, i == 15);
        }
    }
    return WHIT_OK;
}

static void check_refused(struct scene *scene, const char *why)
{
    struct accel *accel;
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    assert_int_equal(accel_create(&warnings_log, scene, &no_trees, &accel), WHIT_ERROR_USAGE);
    assert_null(accel);
    assert_non_null(strstr(messages.last_error, why));
    scene_destroy(scene);
}

/* The largest number of triangles, or of instances, for which the loop iterations that a driver
   allows are enough: the last one is drawn too, and one more is refused. */
TEST(max_are_drawn_and_more_are_refused)
{
    const struct {
        uint32_t max;
        bool apart;
    } stacks[] = {{40000, false}, {10833, true}};
    for (int i = 0; i < 2; ++i) {
        uint32_t max = stacks[i].max;
        struct fixture f = fixture_open(stack_scene(max, stacks[i].apart), &no_trees, NULL);
        assert_int_equal(trace_stack(&f, max), WHIT_OK);
        fixture_close(&f);
        char why[128];
        snprintf(why, sizeof why,
                 "stack: without trees every ray tests every primitive, and %u over", max + 1);
        check_refused(stack_scene(max + 1, stacks[i].apart), why);
    }
}

static void check_picture(struct scene *scene, struct scene *again,
                          const whit_renderer_params *params)
{
    own_picture with = picture_of(scene, NULL, params);
    own_picture without = picture_of(again, &no_trees, params);
    assert_same_picture("without trees", &with, &without);
    print_message("  %llu shadow, %llu reflected, %llu refracted rays; %u dispatches\n",
                  (unsigned long long)without.stats.rays_shadow,
                  (unsigned long long)without.stats.rays_reflected,
                  (unsigned long long)without.stats.rays_refracted, without.stats.dispatches);
    for (uint32_t k = 0; params->count && k < RAY_KIND_COUNT; ++k) {
        const whit_cost *a = &with.stats.costs[k], *b = &without.stats.costs[k];
        assert_true(a->rays == b->rays && a->triangles < b->triangles);
    }
}

/* The scenes have two lights, four instances, mirror and glass; cut-outs, blending and thin glass;
   media that touch; spheres, and shadows through filters; flat emitters. */
TEST(pictures_equal_those_of_trees)
{
    static const char *const names[] = {"layers", "glass-of-water", "whitted", "room"};
    const whit_renderer_params counted = {.width = 19,
                                          .height = 11,
                                          .depth = 5,
                                          .sampling.count = 4,
                                          .camera = GLASS_CAMERA,
                                          .count = true};
    const whit_renderer_params params = {.width = 12, .height = 9, .depth = 6, .light_samples = 4};
    check_picture(glass_scene(), glass_scene(), &counted);
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        check_picture(file_scene(names[i]), file_scene(names[i]), &params);
}

/* Shadow rays to many lights do not share the loop iterations that a driver allows. */
TEST(many_lights_are_drawn)
{
    struct scene *scene = scene_begin(&fixture_log, "ground");
    scene_put(scene, mesh_terrain(8.0, 0.6, 100, 1), NULL);
    for (uint32_t i = 0; i <= LIGHT_LISTS; ++i)
        scene_put_lamp(scene, 0.1 * i, 5, 0, 1);
    const whit_renderer_params params = {.width = 8, .height = 8};
    own_picture picture = picture_of(scene, &no_trees, &params);
    assert_true(picture.stats.rays_shadow > 0);
}

/* The shadow rays to all points of an area light share the loop iterations that a driver allows:
   too many points are refused, and the kernel itself notices too. */
TEST(many_shadows_are_refused)
{
    struct scene *scene = scene_begin(&fixture_log, "ground");
    scene_put(scene, mesh_terrain(8.0, 0.6, 120, 1), NULL);
    scene_put_light(scene, emitter(WHIT_LIGHT_RECTANGLE, (double[]){0, 5, 0}, (double[]){1, 0, 0},
                                   (double[]){0, 0, 1}, 1));
    own_fixture f = fixture_open(scene, &no_trees, NULL);
    const whit_renderer_params params = {.width = 8, .height = 8, .light_samples = 64};
    renderer_destroy(f.renderer);
    assert_int_equal(renderer_create(&warnings_log, f.device, f.accel, &params, &f.renderer),
                     WHIT_OK);
    bool limited = device_get_limits(f.device)->loop_limited;
    assert_int_equal(renderer_render(f.renderer), limited ? WHIT_ERROR_USAGE : WHIT_OK);
    if (limited) {
        struct probe_report report;
        assert_non_null(
            strstr(messages.last_error, "without trees every ray tests 28800 primitives"));
        assert_int_equal(renderer_probe(f.renderer, 4, 4, 0, &report), WHIT_ERROR_USAGE);
        f.accel->iterations = 0;
        assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_STATUS);
    }
}

TEST(empty_scenes_have_a_picture)
{
    own_fixture f = fixture_open(scene_begin(&fixture_log, "empty"), &no_trees, NULL);
    struct gpu_ray ray = {{0, 0, 5}, 0, {0, 0, -1}, INFINITY};
    struct gpu_hit hit;
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, NULL), WHIT_OK);
    assert_int_equal(hit.primitive, HIT_NONE);
    own_picture picture = render_picture(&f);
    for (uint32_t i = 0; i < 2 * picture.ids.width * picture.ids.height; ++i)
        assert_int_equal(picture.ids.words[i], HIT_NONE);
}
