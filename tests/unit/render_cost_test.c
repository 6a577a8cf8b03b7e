/* What the kernels count against what the C traversal counts, and traversals of every order. */
#include "render/renderer.h"
#include "render_fixture.h"
#include "render_scenes.h"
#include "tree_fixture.h"
#include "twin/traverse.h"

enum { RAYS = 6000, ORDERS = 3 };

static const char *const order_names[ORDERS] = {"distance", "sign", "basic"};

static struct fixture open_counting(struct scene *scene, uint32_t order)
{
    const struct render_params params = {
        .width = 16, .height = 16, .depth = 4, .order = order, .count = true};
    return fixture_open(scene, NULL, &params);
}

/* Half of them towards random points in the scene's bounds, half anywhere. */
static void make_rays(const struct fixture *f, struct gpu_ray *rays)
{
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(f->scene, 0.0, &pose), WHIT_OK);
    uint64_t state = 77;
    for (uint32_t i = 0; i < RAYS; ++i) {
        rays[i] = (struct gpu_ray){.t_max = i % 8 == 7 ? 0.7f : INFINITY};
        for (int k = 0; k < 3; ++k) {
            double center = 0.5 * (pose.lo[k] + pose.hi[k]), size = pose.hi[k] - pose.lo[k] + 1e-3;
            rays[i].origin[k] = (float)(center + size * 1.2 * (double)random_float_signed(&state));
            double at = center + 0.5 * size * (double)random_float_signed(&state);
            rays[i].dir[k] =
                i & 1 ? random_float_signed(&state) : (float)(at - (double)rays[i].origin[k]);
        }
    }
    rays[1] = (struct gpu_ray){.dir = {0, 0, 0}}; /* not even started, but a ray */
    scene_pose_finish(&pose);
}

/* Device and C agree on every hit and every cost. The sum over all rays is added to *sum. */
static void check_costs(struct fixture *f, uint32_t order, bool any, struct gpu_cost *sum)
{
    struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
    struct gpu_hit *hits = array_alloc(RAYS, sizeof *hits);
    struct gpu_cost *costs = array_alloc(RAYS, sizeof *costs);
    assert_true(rays && hits && costs);
    make_rays(f, rays);
    assert_int_equal(renderer_trace(f->renderer, rays, RAYS, any, hits, costs), WHIT_OK);
    uint32_t hits_bad = 0, costs_bad = 0, status = 0;
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_hit twin;
        struct gpu_cost cost = {0};
        traverse_float(f->accel, order, &rays[i], any, HIT_NONE, HIT_NONE, &twin, &cost, &status);
        hits_bad += any ? (twin.primitive == HIT_NONE) != (hits[i].primitive == HIT_NONE)
                        : memcmp(&twin, &hits[i], sizeof twin) != 0;
        costs_bad += memcmp(&cost, &costs[i], sizeof cost) != 0;
        sum->rays += cost.rays;
        sum->inner_nodes += cost.inner_nodes;
        sum->leaves += cost.leaves;
        sum->instances += cost.instances;
        sum->triangles += cost.triangles;
        sum->stack = cost.stack > sum->stack ? cost.stack : sum->stack;
        sum->depth = cost.depth > sum->depth ? cost.depth : sum->depth;
    }
    assert_int_equal(hits_bad, 0);
    assert_int_equal(costs_bad, 0);
    assert_int_equal(status, 0);
    free(rays);
    free(hits);
    free(costs);
}

static void check_scene(struct scene *(*make)(void), bool instanced)
{
    struct gpu_cost closest[ORDERS] = {{0}}, any[ORDERS] = {{0}};
    for (uint32_t order = 0; order < ORDERS; ++order) {
        struct fixture f = open_counting(make(), order);
        assert_int_equal(f.accel->single_identity, !instanced);
        check_costs(&f, order, false, &closest[order]);
        check_costs(&f, order, true, &any[order]);
        const struct gpu_cost *c = &closest[order];
        print_message("  %-8s %u rays: %u pairs (any: %u), %u leaves, %u instances, %u triangles; "
                      "stack %u, depth %u\n",
                      order_names[order], c->rays, c->inner_nodes, any[order].inner_nodes,
                      c->leaves, c->instances, c->triangles, c->stack, c->depth);
        assert_int_equal(c->rays, RAYS);
        assert_true((c->instances > 0) == instanced);
        assert_true(c->leaves > 0 && c->leaves <= c->triangles);
        assert_true(any[order].triangles < c->triangles);
        /* Boxes of the deepest pair are at most as deep as the trees. */
        assert_true(c->depth <= f.accel->mesh_depth + (instanced ? f.accel->instance_depth : 0));
        fixture_close(&f);
    }
    assert_true(closest[ORDER_DISTANCE].inner_nodes < closest[ORDER_BASIC].inner_nodes);
    assert_true(closest[ORDER_SIGN].inner_nodes < closest[ORDER_BASIC].inner_nodes);
}

static void one_mesh_costs_the_same(void **state)
{
    (void)state;
    check_scene(terrain_scene, false);
}

static void instances_cost_the_same(void **state)
{
    (void)state;
    check_scene(ring_scene, true);
}

/* Margins of boxes change what is visited, on both sides alike, but no hit. */
static void clipped_trees_cost_the_same(void **state)
{
    (void)state;
    struct scene *(*const make[])(void) = {terrain_scene, ring_scene};
    for (int i = 0; i < 2; ++i) {
        struct gpu_cost plain = {0}, clipped = {0};
        struct scene *scene = make[i]();
        const struct render_params params = {.width = 16, .height = 16, .count = true};
        struct fixture f = fixture_open(scene, NULL, &params);
        check_costs(&f, ORDER_DISTANCE, false, &plain);
        f.accel->clipped = true;
        renderer_destroy(f.renderer);
        assert_int_equal(renderer_create(&fixture_log, f.device, f.accel, &params, &f.renderer),
                         WHIT_OK);
        check_costs(&f, ORDER_DISTANCE, false, &clipped);
        assert_true(clipped.inner_nodes > plain.inner_nodes);
        fixture_close(&f);
    }
}

/* One tree for all instances, in world space. */
static void flat_trees_cost_the_same(void **state)
{
    (void)state;
    const struct accel_params flat = {.flatten = true};
    const struct render_params params = {
        .width = 16, .height = 16, .order = ORDER_SIGN, .count = true};
    struct gpu_cost sum = {0};
    struct fixture f = fixture_open(ring_scene(), &flat, &params);
    assert_true(f.accel->flat);
    check_costs(&f, ORDER_SIGN, false, &sum);
    check_costs(&f, ORDER_SIGN, true, &sum);
    assert_int_equal(sum.instances, 0);
    fixture_close(&f);
}

static void costs_must_be_asked_for(void **state)
{
    (void)state;
    struct fixture f = fixture_open(terrain_scene(), NULL, NULL);
    struct gpu_ray ray = {{0, 0, 5}, 0, {0, 0, -1}, INFINITY};
    struct gpu_hit hit;
    struct gpu_cost cost;
    struct image image = {0};
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, &cost), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    assert_int_equal(renderer_read_costs(f.renderer, RAY_PRIMARY, &image), WHIT_ERROR_USAGE);
    fixture_close(&f);
}

/* ---- Trees ---- */

/* A scene whose only mesh tree is a hand-written chain. */
static struct accel *caterpillar_accel(struct scene **scene, uint32_t depth)
{
    struct scene_mesh mesh = mesh_zeroed(3 * (depth + 1), depth + 1);
    for (uint32_t i = 0; i <= depth; ++i) {
        caterpillar_corners(i, &mesh.positions[9 * (size_t)i]);
        for (uint32_t k = 0; k < 3; ++k)
            mesh.indices[3 * i + k] = 3 * i + k;
    }
    *scene = scene_begin(&fixture_log, "caterpillar");
    scene_put(*scene, mesh, NULL);
    assert_int_equal(scene_freeze(*scene), WHIT_OK);
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
        float corners[9];
        caterpillar_corners(i, corners);
        triangle->primitive = i;
        memcpy(triangle->v0, corners, sizeof triangle->v0);
        memcpy(triangle->v1, corners + 3, sizeof triangle->v1);
        memcpy(triangle->v2, corners + 6, sizeof triangle->v2);
    }
    return accel;
}

static whit_result trace_caterpillar(struct device *device, struct accel *accel, uint32_t depth,
                                     const struct render_params *params, struct gpu_hit hits[2],
                                     struct gpu_cost costs[2])
{
    struct renderer *renderer;
    assert_int_equal(renderer_create(&fixture_log, device, accel, params, &renderer), WHIT_OK);
    struct gpu_ray rays[2] = {caterpillar_ray(depth, false), caterpillar_ray(depth, true)};
    whit_result result =
        renderer_trace(renderer, rays, 2, false, hits, params->count ? costs : NULL);
    renderer_destroy(renderer);
    return result;
}

/* With the short stack of lavapipe and without it. */
static void deep_trees_are_walked(void **state)
{
    (void)state;
    const uint32_t depths[] = {31, 32, 33, 63, 64, 65, 128, 200};
    struct device *device = fixture_device();
    for (uint32_t d = 0; d < sizeof depths / sizeof *depths; ++d) {
        uint32_t depth = depths[d];
        const struct render_params params = {
            .width = 8, .height = 8, .order = d % ORDERS, .count = d % 2};
        struct scene *scene;
        struct accel *accel = caterpillar_accel(&scene, depth);
        struct gpu_hit hits[2];
        struct gpu_cost costs[2];
        assert_int_equal(trace_caterpillar(device, accel, depth, &params, hits, costs), WHIT_OK);
        assert_int_equal(hits[0].primitive, 0);
        assert_int_equal(hits[1].primitive, depth);
        if (params.count) {
            assert_int_equal(costs[1].stack, depth);
            assert_int_equal(costs[1].depth, depth);
        }
        accel_destroy(accel);
        scene_destroy(scene);
    }
    fixture_validate();
}

/* A tree deeper than stated is an error, not a hit. */
static void understated_depth_is_reported(void **state)
{
    (void)state;
    struct device *device = fixture_device();
    for (uint32_t order = 0; order < ORDERS; ++order) {
        const struct render_params params = {
            .width = 8, .height = 8, .order = order, .count = order == ORDER_SIGN};
        struct scene *scene;
        struct accel *accel = caterpillar_accel(&scene, 65);
        accel->mesh_depth = 32;
        struct gpu_hit hits[2];
        struct gpu_cost costs[2];
        assert_int_equal(trace_caterpillar(device, accel, 65, &params, hits, costs),
                         WHIT_ERROR_STATUS);
        accel_destroy(accel);
        scene_destroy(scene);
    }
    fixture_validate();
}

/* Identical triangles: the first one is hit, whatever the order. */
static void duplicates_give_the_first(void **state)
{
    (void)state;
    for (uint32_t order = 0; order < ORDERS; ++order) {
        const uint32_t count = 1000;
        uint32_t status = 0;
        struct scene_mesh mesh = mesh_zeroed(3, count);
        caterpillar_corners(0, mesh.positions);
        for (uint32_t k = 0; k < 3 * count; ++k)
            mesh.indices[k] = k % 3;
        struct scene *scene = scene_begin(&fixture_log, "alike");
        scene_put(scene, mesh, NULL);
        struct fixture f = open_counting(scene, order);
        struct gpu_ray rays[64];
        struct gpu_hit hits[64];
        uint64_t random = 3;
        for (int r = 0; r < 64; ++r)
            rays[r] = (struct gpu_ray){{0.3f * random_float_signed(&random),
                                        0.3f * random_float_signed(&random), r & 1 ? -1.0f : 1.0f},
                                       0,
                                       {0, 0, r & 1 ? 1.0f : -1.0f},
                                       INFINITY};
        assert_int_equal(renderer_trace(f.renderer, rays, 64, false, hits, NULL), WHIT_OK);
        for (int r = 0; r < 64; ++r) {
            struct gpu_hit twin;
            traverse_float(f.accel, order, &rays[r], false, HIT_NONE, HIT_NONE, &twin, NULL,
                           &status);
            assert_int_equal(hits[r].primitive, 0);
            assert_memory_equal(&twin, &hits[r], sizeof twin);
        }
        fixture_close(&f);
    }
}

/* A tree that is one leaf has no boxes to test. */
static void a_leaf_alone_has_no_boxes(void **state)
{
    (void)state;
    float corners[9];
    caterpillar_corners(0, corners);
    struct scene *scene = scene_begin(&fixture_log, "triangle");
    scene_put(scene, mesh_triangles(corners, 1), NULL);
    struct fixture f = open_counting(scene, ORDER_DISTANCE);
    struct gpu_ray ray = caterpillar_ray(0, true);
    struct gpu_hit hit;
    struct gpu_cost cost;
    const struct gpu_cost expected = {.rays = 1, .leaves = 1, .triangles = 1};
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, &cost), WHIT_OK);
    assert_int_equal(hit.primitive, 0);
    assert_memory_equal(&cost, &expected, sizeof cost);
    fixture_close(&f);
}

/* ---- Pictures ---- */

struct picture {
    struct image color, ids, costs[RAY_KIND_COUNT];
    struct render_stats stats;
};

static void render_picture(struct renderer *renderer, bool costs, struct picture *out)
{
    *out = (struct picture){0};
    assert_int_equal(renderer_render(renderer), WHIT_OK);
    assert_int_equal(renderer_read_color(renderer, &out->color), WHIT_OK);
    assert_int_equal(renderer_read_ids(renderer, &out->ids), WHIT_OK);
    for (uint32_t k = 0; costs && k < RAY_KIND_COUNT; ++k)
        assert_int_equal(renderer_read_costs(renderer, k, &out->costs[k]), WHIT_OK);
    renderer_get_stats(renderer, &out->stats);
}

static void picture_finish(struct picture *picture)
{
    image_finish(&picture->color);
    image_finish(&picture->ids);
    for (uint32_t k = 0; k < RAY_KIND_COUNT; ++k)
        image_finish(&picture->costs[k]);
}

/* Every camera ray costs what the C traversal of the same ray costs. */
static void check_primary(const struct fixture *f, uint32_t order, const struct picture *picture,
                          uint32_t kind)
{
    const struct gpu_cost *costs = (const struct gpu_cost *)picture->costs[RAY_PRIMARY].words;
    uint32_t bad = 0, ids_bad = 0, status = 0, width = picture->color.width;
    struct gpu_chunk first;
    camera_sample(&f->renderer->frame, 0, &first);
    for (uint32_t i = 0; i < width * picture->color.height; ++i) {
        struct gpu_ray ray;
        struct gpu_hit hit;
        struct gpu_cost cost = {0};
        camera_ray(&f->renderer->frame, kind, i % width, i / width, &first, &ray);
        traverse_float(f->accel, order, &ray, false, HIT_NONE, HIT_NONE, &hit, &cost, &status);
        bad += memcmp(&cost, &costs[i], sizeof cost) != 0;
        ids_bad += hit.primitive != picture->ids.words[2 * i + 1] ||
                   hit.instance != picture->ids.words[2 * i];
    }
    assert_int_equal(bad, 0);
    assert_int_equal(ids_bad, 0);
    assert_int_equal(status, 0);
}

static void check_sums(const struct picture *picture)
{
    const struct render_stats *stats = &picture->stats;
    for (uint32_t k = 0; k < RAY_KIND_COUNT; ++k) {
        const struct gpu_cost *costs = (const struct gpu_cost *)picture->costs[k].words;
        uint64_t rays = 0, pairs = 0, triangles = 0;
        uint32_t depth = 0;
        for (uint32_t i = 0; i < picture->color.width * picture->color.height; ++i) {
            rays += costs[i].rays;
            pairs += costs[i].inner_nodes;
            triangles += costs[i].triangles;
            depth = costs[i].depth > depth ? costs[i].depth : depth;
        }
        assert_true(rays == stats->costs[k].rays && pairs == stats->costs[k].inner_nodes);
        assert_true(triangles == stats->costs[k].triangles && depth == stats->costs[k].depth);
        assert_true(pairs > 0);
    }
    assert_true(stats->costs[RAY_PRIMARY].rays == stats->rays_primary);
    assert_true(stats->costs[RAY_SHADOW].rays == stats->rays_shadow);
    assert_true(stats->costs[RAY_REFLECTED].rays == stats->rays_reflected);
    assert_true(stats->costs[RAY_REFRACTED].rays == stats->rays_refracted);
}

/* A width that is no multiple of 8, tiles smaller than the picture. */
static void pictures_cost_the_same(void **state)
{
    (void)state;
    for (uint32_t order = 0; order < ORDERS; ++order) {
        struct render_params params = {.width = 45,
                                       .height = 30,
                                       .depth = 5,
                                       .camera = glass_camera,
                                       .order = order,
                                       .tile_size = 16,
                                       .count = true};
        struct fixture f = fixture_open(glass_scene(), NULL, &params);
        struct picture counted, plain;
        render_picture(f.renderer, true, &counted);
        check_primary(&f, order, &counted, CAMERA_PERSPECTIVE);
        check_sums(&counted);
        renderer_destroy(f.renderer);
        params.count = false;
        assert_int_equal(renderer_create(&fixture_log, f.device, f.accel, &params, &f.renderer),
                         WHIT_OK);
        render_picture(f.renderer, false, &plain);
        assert_memory_equal(counted.color.pixels, plain.color.pixels, 45 * 30 * 16);
        assert_memory_equal(counted.ids.words, plain.ids.words, 45 * 30 * 8);
        picture_finish(&counted);
        picture_finish(&plain);
        fixture_close(&f);
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

/* From so far away that the last bit of a camera ray is a tenth of a triangle; the panorama, which
   cannot look closer, over a terrain of that much smaller triangles. The first sample of several is
   off the middles of pixel and lens. */
static void camera_rays_are_those_of_c(void **state)
{
    (void)state;
    static const struct scene_camera cameras[] = {
        [CAMERA_PERSPECTIVE] = {.eye = {30011, 70003, 50021}, .fov_y = 1.1e-4f},
        [CAMERA_ORTHOGRAPHIC] = {.kind = SCENE_CAMERA_ORTHOGRAPHIC,
                                 .eye = {30011, 70003, 50021},
                                 .height = 10.0f},
        [CAMERA_LENS] = {.eye = {30011, 70003, 50021},
                         .fov_y = 1.1e-4f,
                         .lens_radius = 1.0f,
                         .focus_distance = 60000.0f},
        [CAMERA_PANORAMA] = {.kind = SCENE_CAMERA_PANORAMA,
                             .eye = {0.1, 2.1, 0.2},
                             .target = {3, 1, 2}},
    };
    for (uint32_t kind = 0; kind < 4; ++kind) {
        for (uint32_t samples = 1; samples <= 64; samples *= kind == CAMERA_LENS ? 4 : 64) {
            struct render_params params = {
                .width = 90, .height = 70, .samples = samples, .count = true};
            struct fixture f =
                fixture_open(seen_by(terrain_scene(), &cameras[kind]), NULL, &params);
            struct picture picture;
            render_picture(f.renderer, true, &picture);
            check_primary(&f, ORDER_DISTANCE, &picture, kind);
            assert_true(picture.stats.costs[RAY_PRIMARY].leaves > 90 * 70 / 4 * samples);
            picture_finish(&picture);
            fixture_close(&f);
        }
    }
}

/* Sums are of all samples; pixels hold the first one, whatever came after it. */
static void samples_add_up(void **state)
{
    (void)state;
    struct render_params params = {
        .width = 40, .height = 24, .depth = 5, .camera = glass_camera, .samples = 4, .count = true};
    struct fixture f = fixture_open(glass_scene(), NULL, &params);
    struct picture picture;
    render_picture(f.renderer, true, &picture);
    const struct gpu_cost *costs = (const struct gpu_cost *)picture.costs[RAY_PRIMARY].words;
    for (uint32_t i = 0; i < 40 * 24; ++i)
        assert_int_equal(costs[i].rays, 1);
    assert_int_equal(picture.stats.costs[RAY_PRIMARY].rays, 4 * 40 * 24);
    assert_true(picture.stats.costs[RAY_SHADOW].rays == picture.stats.rays_shadow);
    assert_true(picture.stats.costs[RAY_REFLECTED].rays == picture.stats.rays_reflected);
    picture_finish(&picture);
    /* Again: nothing is left over. */
    struct render_stats first = picture.stats;
    render_picture(f.renderer, true, &picture);
    assert_memory_equal(first.costs, picture.stats.costs, sizeof first.costs);
    picture_finish(&picture);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_mesh_costs_the_same),
        cmocka_unit_test(instances_cost_the_same),
        cmocka_unit_test(clipped_trees_cost_the_same),
        cmocka_unit_test(flat_trees_cost_the_same),
        cmocka_unit_test(costs_must_be_asked_for),
        cmocka_unit_test(deep_trees_are_walked),
        cmocka_unit_test(understated_depth_is_reported),
        cmocka_unit_test(duplicates_give_the_first),
        cmocka_unit_test(a_leaf_alone_has_no_boxes),
        cmocka_unit_test(pictures_cost_the_same),
        cmocka_unit_test(camera_rays_are_those_of_c),
        cmocka_unit_test(samples_add_up),
    };
    return fixture_end(cmocka_run_group_tests(tests, NULL, NULL));
}
