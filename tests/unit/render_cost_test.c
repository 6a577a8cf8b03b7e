/* Compares the counters of kernels with those of the float mirror, in traversals of every order. */
#include "ray_fixture.h"
#include "render_scenes.h"
#include "tree_fixture.h"
#include "unit.h"

enum { RAYS = 6000, ORDERS = 3 };

static const char *const order_names[ORDERS] = {"distance", "sign", "basic"};

static struct fixture open_counting(struct scene *scene, uint32_t order)
{
    const whit_renderer_params params = {
        .width = 16, .height = 16, .depth = 4, .traversal = order, .count = true};
    return fixture_open(scene, NULL, &params);
}

/* Asserts that device and float mirror agree on all hits and costs. Gives the sum of costs. */
static whit_cost check_costs(const struct fixture *f, bool any)
{
    struct gpu_ray rays[RAYS];
    struct gpu_hit hits[RAYS];
    whit_cost sum = {0};
    aim_at_bounds(f, rays, RAYS, 77);
    struct unlike unlike = trace_beside_twin(f, any, rays, RAYS, hits, &sum);
    assert_int_equal(unlike.hits, 0);
    assert_int_equal(unlike.costs, 0);
    return sum;
}

static void check_scene(struct scene *(*make)(void), bool instanced)
{
    whit_cost all[ORDERS];
    for (uint32_t order = 0; order < ORDERS; ++order) {
        own_fixture f = open_counting(make(), order);
        assert_int_equal(f.accel->single_identity, !instanced);
        whit_cost c = all[order] = check_costs(&f, false), any = check_costs(&f, true);
        print_message("  %-8s %u rays: %u pairs (any: %u), %u leaves, %u instances, %u triangles; "
                      "stack %u, depth %u\n",
                      order_names[order], (uint32_t)c.rays, (uint32_t)c.inner_nodes,
                      (uint32_t)any.inner_nodes, (uint32_t)c.leaves, (uint32_t)c.instances,
                      (uint32_t)c.triangles, c.stack, c.depth);
        assert_int_equal(c.rays, RAYS);
        assert_true((c.instances > 0) == instanced);
        assert_true(c.leaves > 0 && c.leaves <= c.triangles);
        assert_true(any.triangles < c.triangles);
        /* Boxes of the deepest pair are at most as deep as the trees. */
        assert_true(c.depth <= f.accel->mesh_depth + (instanced ? f.accel->instance_depth : 0));
    }
    assert_true(all[ORDER_DISTANCE].inner_nodes < all[ORDER_BASIC].inner_nodes);
    assert_true(all[ORDER_SIGN].inner_nodes < all[ORDER_BASIC].inner_nodes);
}

TEST(one_mesh_costs_the_same)
{
    check_scene(terrain_scene, false);
}

TEST(instances_cost_the_same)
{
    check_scene(ring_scene, true);
}

/* The margins of boxes change the boxes that are visited, on the device as in the float mirror, but
   no hit. */
TEST_BY_TURNS(clipped_trees_cost_the_same, 0, 2)
{
    struct scene *(*const make[])(void) = {terrain_scene, ring_scene};
    for (int i = 0; i < 2; ++i) {
        const whit_renderer_params params = {.width = 16, .height = 16, .count = true};
        own_fixture f = fixture_open(make[i](), NULL, &params);
        whit_cost plain = check_costs(&f, false);
        f.accel->clipped = true;
        fixture_renew(&f, &params);
        assert_true(check_costs(&f, false).inner_nodes > plain.inner_nodes);
    }
}

/* One tree for all instances, in world space. */
TEST_BY_TURNS(flat_trees_cost_the_same, 1, 2)
{
    const whit_accel_params flat = {.instances = WHIT_INSTANCES_OFF};
    const whit_renderer_params params = {
        .width = 16, .height = 16, .traversal = ORDER_SIGN, .count = true};
    own_fixture f = fixture_open(ring_scene(), &flat, &params);
    assert_true(f.accel->flat);
    for (int any = 0; any < 2; ++any)
        assert_int_equal(check_costs(&f, any).instances, 0);
}

TEST(costs_must_be_asked_for)
{
    own_fixture f = fixture_open(terrain_scene(), NULL, NULL);
    struct gpu_ray ray = {{0, 0, 5}, 0, {0, 0, -1}, INFINITY};
    struct gpu_hit hit;
    struct gpu_cost cost;
    struct image image = {0};
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, &cost), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    assert_int_equal(renderer_read_costs(f.renderer, RAY_PRIMARY, &image), WHIT_ERROR_USAGE);
}

/* ---- Trees ---- */

/* A scene whose only mesh tree is a hand-written chain. */
static struct accel *caterpillar_accel(struct scene **scene, uint32_t depth)
{
    float(*corners)[9] = array_alloc(depth + 1, sizeof *corners);
    assert_non_null(corners);
    for (uint32_t i = 0; i <= depth; ++i)
        caterpillar_corners(i, corners[i]);
    *scene = scene_begin(&fixture_log, "caterpillar");
    scene_put(*scene, mesh_triangles(corners[0], depth + 1), NULL);
    scene_ready(*scene);
    struct accel *accel;
    assert_int_equal(accel_create(&fixture_log, *scene, NULL, &accel), WHIT_OK);
    uint32_t base = accel->meshes[0].first_node;
    struct gpu_bvh_node *nodes = caterpillar_nodes(depth, base);
    assert_non_null(nodes);
    memcpy(nodes, accel->nodes, base * sizeof *nodes);
    free(accel->nodes);
    accel->nodes = nodes;
    accel->node_count = base + 2 * depth + 2;
    accel->meshes[0].node_count = 2 * depth + 2;
    accel->meshes[0].root = nodes[base].first;
    accel->meshes[0].depth = accel->mesh_depth = depth;
    for (uint32_t i = 0; i <= depth; ++i) { /* leaf k holds triangle k */
        struct gpu_triangle *triangle = &accel->triangles[i];
        triangle->primitive = i;
        memcpy(triangle->v0, corners[i], sizeof triangle->v0);
        memcpy(triangle->v1, corners[i] + 3, sizeof triangle->v1);
        memcpy(triangle->v2, corners[i] + 6, sizeof triangle->v2);
    }
    free(corners);
    return accel;
}

/* Traces through a chain of `depth` nodes, while the renderer is told that its depth is `stated`.
 */
static whit_result trace_caterpillar(uint32_t depth, uint32_t stated,
                                     const whit_renderer_params *params, struct gpu_hit hits[2],
                                     struct gpu_cost costs[2])
{
    own_fixture f = {.device = fixture_device()};
    f.accel = caterpillar_accel(&f.scene, depth);
    f.accel->mesh_depth = stated;
    fixture_renew(&f, params);
    struct gpu_ray rays[2] = {caterpillar_ray(depth, false), caterpillar_ray(depth, true)};
    return renderer_trace(f.renderer, rays, 2, false, hits, params->count ? costs : NULL);
}

/* Deep trees are traversed with the short stack of lavapipe, and without it. */
TEST_BY_TURNS(deep_trees_are_walked, 0, 2)
{
    const uint32_t depths[] = {31, 32, 33, 63, 64, 65, 128, 200};
    for (uint32_t d = 0; d < sizeof depths / sizeof *depths; ++d) {
        uint32_t depth = depths[d];
        const whit_renderer_params params = {
            .width = 8, .height = 8, .traversal = d % ORDERS, .count = d % 2};
        struct gpu_hit hits[2];
        struct gpu_cost costs[2];
        assert_int_equal(trace_caterpillar(depth, depth, &params, hits, costs), WHIT_OK);
        assert_int_equal(hits[0].primitive, 0);
        assert_int_equal(hits[1].primitive, depth);
        if (params.count) {
            assert_int_equal(costs[1].stack, depth);
            assert_int_equal(costs[1].depth, depth);
        }
    }
}

/* A tree deeper than stated is an error, not a hit. */
TEST_BY_TURNS(understated_depth_is_reported, 1, 2)
{
    for (uint32_t order = 0; order < ORDERS; ++order) {
        const whit_renderer_params params = {
            .width = 8, .height = 8, .traversal = order, .count = order == ORDER_SIGN};
        struct gpu_hit hits[2];
        struct gpu_cost costs[2];
        assert_int_equal(trace_caterpillar(65, 32, &params, hits, costs), WHIT_ERROR_STATUS);
    }
}

/* Identical triangles: the first one is hit, whatever the order. */
TEST(duplicates_give_the_first)
{
    for (uint32_t order = 0; order < ORDERS; ++order) {
        const uint32_t count = 1000;
        struct scene_mesh mesh = mesh_zeroed(3, count);
        caterpillar_corners(0, mesh.positions);
        for (uint32_t k = 0; k < 3 * count; ++k)
            mesh.indices[k] = k % 3;
        struct scene *scene = scene_begin(&fixture_log, "alike");
        scene_put(scene, mesh, NULL);
        own_fixture f = open_counting(scene, order);
        struct gpu_ray rays[64];
        struct gpu_hit hits[64];
        uint64_t random = 3;
        for (int r = 0; r < 64; ++r) {
            float x = 0.3f * random_float_signed(&random), away = r & 1 ? -1.0f : 1.0f;
            rays[r] = (struct gpu_ray){
                {x, 0.3f * random_float_signed(&random), away}, 0, {0, 0, -away}, INFINITY};
        }
        assert_int_equal(trace_beside_twin(&f, false, rays, 64, hits, NULL).hits, 0);
        for (int r = 0; r < 64; ++r)
            assert_int_equal(hits[r].primitive, 0);
    }
}

/* A tree that is one leaf has no boxes to test. */
TEST(a_leaf_alone_has_no_boxes)
{
    float corners[9];
    caterpillar_corners(0, corners);
    struct scene *scene = scene_begin(&fixture_log, "triangle");
    scene_put(scene, mesh_triangles(corners, 1), NULL);
    own_fixture f = open_counting(scene, ORDER_DISTANCE);
    struct gpu_ray ray = caterpillar_ray(0, true);
    struct gpu_hit hit;
    struct gpu_cost cost;
    const struct gpu_cost expected = {.rays = 1, .leaves = 1, .triangles = 1};
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, &cost), WHIT_OK);
    assert_int_equal(hit.primitive, 0);
    assert_memory_equal(&cost, &expected, sizeof cost);
}

/* ---- Pictures ---- */

struct counted {
    struct picture picture;
    struct image costs[RAY_KIND_COUNT];
};

static struct counted render_counted(const struct fixture *f)
{
    struct counted counted = {.picture = render_picture(f)};
    for (uint32_t k = 0; k < RAY_KIND_COUNT; ++k)
        assert_int_equal(renderer_read_costs(f->renderer, k, &counted.costs[k]), WHIT_OK);
    return counted;
}

static void counted_finish(struct counted *counted)
{
    picture_finish(&counted->picture);
    for (uint32_t k = 0; k < RAY_KIND_COUNT; ++k)
        image_finish(&counted->costs[k]);
}

static const struct gpu_cost *costs_of(const struct counted *counted, uint32_t kind)
{
    return (const struct gpu_cost *)counted->costs[kind].words;
}

/* The costs of every camera ray are those of the same ray in the float mirror. */
static void check_primary(const struct fixture *f, const struct counted *counted, uint32_t kind)
{
    const struct gpu_cost *costs = costs_of(counted, RAY_PRIMARY);
    const struct image *ids = &counted->picture.ids;
    const struct traverse_params order = {.order = (uint32_t)f->renderer->params.traversal};
    uint32_t bad = 0, ids_bad = 0, status = 0;
    struct gpu_chunk first;
    camera_sample(&f->renderer->frame, 0, &first);
    for (uint32_t i = 0; i < ids->width * ids->height; ++i) {
        struct gpu_ray ray;
        struct gpu_hit hit;
        struct gpu_cost cost = {0};
        camera_ray(&f->renderer->frame, kind, i % ids->width, i / ids->width, &first, &ray);
        traverse_ray(f->accel, &order, &ray, &hit, &cost, &status);
        bad += memcmp(&cost, &costs[i], sizeof cost) != 0;
        ids_bad += hit.primitive != ids->words[2 * i + 1] || hit.instance != ids->words[2 * i];
    }
    assert_int_equal(bad, 0);
    assert_int_equal(ids_bad, 0);
    assert_int_equal(status, 0);
}

static void check_sums(const struct counted *counted)
{
    const whit_stats *stats = &counted->picture.stats;
    for (uint32_t k = 0; k < RAY_KIND_COUNT; ++k) {
        whit_cost sum = {0};
        for (uint32_t i = 0; i < counted->costs[k].width * counted->costs[k].height; ++i)
            cost_add(&sum, &costs_of(counted, k)[i]);
        assert_memory_equal(&sum, &stats->costs[k], sizeof sum);
        assert_true(sum.inner_nodes > 0);
    }
    assert_true(stats->costs[RAY_PRIMARY].rays == stats->rays_primary);
    assert_true(stats->costs[RAY_SHADOW].rays == stats->rays_shadow);
    assert_true(stats->costs[RAY_REFLECTED].rays == stats->rays_reflected);
    assert_true(stats->costs[RAY_REFRACTED].rays == stats->rays_refracted);
    assert_true(stats->stages[RENDER_STAGE_CAMERA].rays == stats->rays_primary);
}

/* The width is no multiple of 8, and tiles are smaller than the picture. */
TEST(pictures_cost_the_same)
{
    for (uint32_t order = 0; order < ORDERS; ++order) {
        whit_renderer_params params = {.width = 45,
                                       .height = 30,
                                       .depth = 5,
                                       .camera = GLASS_CAMERA,
                                       .traversal = order,
                                       .tile_size = 16,
                                       .count = true};
        own_fixture f = fixture_open(glass_scene(), NULL, &params);
        struct counted counted = render_counted(&f);
        check_primary(&f, &counted, CAMERA_PERSPECTIVE);
        check_sums(&counted);
        params.count = false;
        fixture_renew(&f, &params);
        own_picture plain = render_picture(&f);
        assert_same_picture("counting", &counted.picture, &plain);
        counted_finish(&counted);
    }
}

static struct scene *seen_by(struct scene *scene, const struct scene_camera *camera)
{
    struct scene_camera own = *camera;
    own.name = string_copy("camera");
    own.node = SCENE_NONE;
    own.up[1] = 1.0;
    assert_int_not_equal(scene_add_camera(scene, own), SCENE_NONE);
    return scene;
}

/* The camera is so far away that the last bit of a camera ray is a tenth of a triangle wide. The
   panorama, which cannot zoom in, looks at a terrain with triangles that are smaller by the same
   factor. The first of several samples is not in the middle of pixel and lens. */
TEST(camera_rays_are_those_of_c)
{
    static const struct scene_camera cameras[] = {
        [CAMERA_PERSPECTIVE] = {.eye = {30011, 70003, 50021}, .fov_y = 1.1e-4f},
        [CAMERA_ORTHOGRAPHIC] = {.kind = WHIT_CAMERA_ORTHOGRAPHIC,
                                 .eye = {30011, 70003, 50021},
                                 .height = 10.0f},
        [CAMERA_LENS] = {.eye = {30011, 70003, 50021},
                         .fov_y = 1.1e-4f,
                         .lens_radius = 1.0f,
                         .focus_distance = 60000.0f},
        [CAMERA_PANORAMA] = {.kind = WHIT_CAMERA_PANORAMA,
                             .eye = {0.1, 2.1, 0.2},
                             .target = {3, 1, 2}},
    };
    for (uint32_t kind = 0; kind < 4; ++kind) {
        for (uint32_t samples = 1; samples <= 64; samples *= kind == CAMERA_LENS ? 4 : 64) {
            whit_renderer_params params = {
                .width = 90, .height = 70, .sampling.count = samples, .count = true};
            own_fixture f = fixture_open(seen_by(terrain_scene(), &cameras[kind]), NULL, &params);
            struct counted counted = render_counted(&f);
            check_primary(&f, &counted, kind);
            assert_true(counted.picture.stats.costs[RAY_PRIMARY].leaves > 90 * 70 / 4 * samples);
            counted_finish(&counted);
        }
    }
}

/* The sums of costs are over all samples; each pixel's costs are those of its first sample alone.
 */
TEST(samples_add_up)
{
    whit_renderer_params params = {.width = 40,
                                   .height = 24,
                                   .depth = 5,
                                   .camera = GLASS_CAMERA,
                                   .sampling.count = 4,
                                   .count = true};
    own_fixture f = fixture_open(glass_scene(), NULL, &params);
    struct counted counted = render_counted(&f);
    const whit_stats first = counted.picture.stats;
    for (uint32_t i = 0; i < 40 * 24; ++i)
        assert_int_equal(costs_of(&counted, RAY_PRIMARY)[i].rays, 1);
    assert_int_equal(first.costs[RAY_PRIMARY].rays, 4 * 40 * 24);
    assert_true(first.costs[RAY_SHADOW].rays == first.rays_shadow);
    assert_true(first.costs[RAY_REFLECTED].rays == first.rays_reflected);
    counted_finish(&counted);
    /* A second picture counts the same: nothing is left over from the first. */
    counted = render_counted(&f);
    assert_memory_equal(first.costs, counted.picture.stats.costs, sizeof first.costs);
    counted_finish(&counted);
}
