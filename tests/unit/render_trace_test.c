/* The ray batch kernel against its C twin, bit for bit, and both against every triangle in turn. */
#include "ray_fixture.h"
#include "twin/traverse.h"

/* A ray is blocked up to t_max just when its closest hit is that near; a third of the rays end
   exactly there, or one float before. */
static void check_any_against_closest(struct fixture *f, const char *label)
{
    enum { MANY = 180000 };
    struct gpu_ray *rays = array_alloc(MANY, sizeof *rays);
    struct gpu_hit *closest = array_alloc(MANY, sizeof *closest);
    struct gpu_hit *any = array_alloc(MANY, sizeof *any);
    assert_true(rays && closest && any);
    for (uint32_t i = 0; i < MANY / RAYS; ++i)
        aim_rays(f, rays + (size_t)i * RAYS, 1000 + i);
    for (uint32_t i = 0; i < MANY; ++i)
        rays[i].t_max = INFINITY;
    assert_int_equal(renderer_trace(f->renderer, rays, MANY, false, closest, NULL), WHIT_OK);
    uint32_t blocked = 0, bad = 0;
    uint64_t state = 11;
    for (uint32_t i = 0; i < MANY; ++i) {
        rays[i].t_max = 2.0f * fabsf(random_float_signed(&state));
        if (closest[i].primitive != HIT_NONE && i % 3 == 0)
            rays[i].t_max = i & 1 ? closest[i].t : nextafterf(closest[i].t, -INFINITY);
    }
    assert_int_equal(renderer_trace(f->renderer, rays, MANY, true, any, NULL), WHIT_OK);
    for (uint32_t i = 0; i < MANY; ++i) {
        bool wanted = closest[i].primitive != HIT_NONE && closest[i].t <= rays[i].t_max;
        blocked += wanted;
        bad += wanted != (any[i].primitive != HIT_NONE);
    }
    print_message("  %s: %u rays, %u blocked; any-hit unlike closest %u\n", label, MANY, blocked,
                  bad);
    assert_true(blocked > MANY / 100);
    assert_true(blocked < MANY);
    assert_int_equal(bad, 0);
    free(rays);
    free(closest);
    free(any);
}

static void check_rays(struct fixture *f, const char *label)
{
    struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
    struct gpu_hit *device = array_alloc(RAYS, sizeof *device);
    struct gpu_hit *any = array_alloc(RAYS, sizeof *any);
    assert_non_null(rays);
    assert_non_null(device);
    assert_non_null(any);
    aim_rays(f, rays, 7);
    assert_int_equal(renderer_trace(f->renderer, rays, RAYS, false, device, NULL), WHIT_OK);
    assert_int_equal(renderer_trace(f->renderer, rays, RAYS, true, any, NULL), WHIT_OK);
    uint32_t hits = 0, twin_bad = 0, brute_bad = 0, any_bad = 0, status = 0;
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_hit twin, brute;
        traverse_float(f->accel, ORDER_DISTANCE, &rays[i], false, HIT_NONE, HIT_NONE, &twin, NULL,
                       &status);
        hits += twin.primitive != HIT_NONE;
        twin_bad += memcmp(&twin, &device[i], sizeof twin) != 0;
        any_bad += (any[i].primitive != HIT_NONE) != (twin.primitive != HIT_NONE);
        if (i % 8 < 4) {
            traverse_brute_float(f->accel, &rays[i], &brute);
            brute_bad += memcmp(&twin, &brute, sizeof twin) != 0;
        }
    }
    print_message("  %s: %u rays, %u hit; device unlike twin %u, any-hit unlike closest %u; tree "
                  "unlike brute force %u of %u\n",
                  label, RAYS, hits, twin_bad, any_bad, brute_bad, RAYS / 2);
    assert_true(hits > RAYS / 10);
    assert_true(hits < RAYS);
    assert_int_equal(twin_bad, 0);
    assert_int_equal(any_bad, 0);
    assert_int_equal(brute_bad, 0);
    assert_int_equal(status, 0);
    free(rays);
    free(device);
    free(any);
    check_any_against_closest(f, label);
}

static void check_mesh(struct scene_mesh mesh, const char *label)
{
    struct scene *scene = scene_begin(&fixture_log, "test");
    scene_put(scene, mesh, NULL);
    struct fixture f = fixture_open(scene, NULL, NULL);
    assert_true(f.accel->single_identity);
    check_rays(&f, label);
    fixture_close(&f);
}

static void sphere_equals_twin(void **state)
{
    (void)state;
    check_mesh(mesh_sphere(1.0, 40, 20), "sphere");
}

static void box_equals_twin(void **state)
{
    (void)state;
    check_mesh(mesh_box(2.0, 1.0, 3.0), "box");
}

static void terrain_equals_twin(void **state)
{
    (void)state;
    check_mesh(mesh_terrain(10.0, 2.0, 24, 3), "terrain");
}

static void far_sphere_equals_twin(void **state)
{
    (void)state;
    struct scene_mesh mesh = mesh_sphere(2.0, 40, 20);
    const float offset[3] = {148376.0f, 1234.0f, -223423.0f};
    for (size_t i = 0; i < 3 * (size_t)mesh.vertex_count; ++i)
        mesh.positions[i] += offset[i % 3];
    check_mesh(mesh, "sphere far from the origin");
}

static void soup_equals_twin(void **state)
{
    (void)state;
    uint32_t count = 500;
    uint64_t random = 99;
    struct scene_mesh mesh = mesh_zeroed(3 * count, count);
    for (uint32_t i = 0; i < 3 * count; ++i) {
        /* Every tenth triangle repeats its neighbour: ties. */
        uint32_t source = i / 3 % 10 == 9 ? i - 3 : i;
        for (uint32_t k = 0; k < 3; ++k)
            mesh.positions[3 * i + k] =
                source == i ? random_float_signed(&random) * 3.0f : mesh.positions[3 * source + k];
        mesh.indices[i] = i;
    }
    check_mesh(mesh, "soup with duplicates");
}

static void instances_equal_twin(void **state)
{
    (void)state;
    struct scene *scene = scene_begin(&fixture_log, "rings");
    scene_put_mesh(scene, mesh_torus(1.0, 0.3, 20, 10));
    uint64_t random = 5;
    for (int i = 0; i < 40; ++i) {
        struct affine placed = placement_random(&random, 6.0, i % 3 == 0);
        scene_put_again(scene, 0, &(struct put){.matrix = &placed});
    }
    scene_put_again(scene, 0, NULL);
    scene_put_again(scene, 0, NULL); /* the same place twice: ties between instances */
    struct fixture f = fixture_open(scene, NULL, NULL);
    assert_false(f.accel->single_identity);
    check_rays(&f, "42 instances");
    fixture_close(&f);
}

static struct fixture open_at(struct scene *scene, uint32_t numerics)
{
    const struct render_params params = {
        .width = 16, .height = 16, .depth = 4, .numerics = numerics};
    return fixture_open(scene, NULL, &params);
}

static const char *const level_names[] = {
    [NUMERICS_WATERTIGHT] = "watertight", [NUMERICS_EXACT] = "exact"};

/* Of the device's hits, those unlike the twin's, bit for bit. */
static uint32_t count_unlike_twin(const struct fixture *f, uint32_t numerics, bool any,
                                  const struct gpu_ray *rays, uint32_t count, struct gpu_hit *hits)
{
    const struct traverse_params twin = {
        .numerics = numerics, .any = any, .skip_instance = HIT_NONE, .skip_primitive = HIT_NONE};
    uint32_t unlike = 0, status = 0;
    assert_int_equal(renderer_trace(f->renderer, rays, count, any, hits, NULL), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i) {
        struct gpu_hit hit;
        traverse_ray(f->accel, &twin, &rays[i], &hit, NULL, &status);
        unlike += any ? (hit.primitive != HIT_NONE) != (hits[i].primitive != HIT_NONE)
                      : memcmp(&hit, &hits[i], sizeof hit) != 0;
    }
    assert_int_equal(status, 0);
    return unlike;
}

/* A ring with vertices of integers; edges and vertices are at multiples of a half. */
static struct scene *integer_ring(void)
{
    struct scene_mesh mesh = mesh_torus(1.0, 0.45, 40, 20);
    for (uint32_t i = 0; i < 3 * mesh.vertex_count; ++i)
        mesh.positions[i] = rintf(18.0f * mesh.positions[i]);
    struct scene *scene = scene_begin(&fixture_log, "test");
    scene_put(scene, mesh, NULL);
    return scene;
}

/* Runs of 64 rays from one point, about the same way: towards the scene, or along an axis, so
   that signs differ and components are 0. Every seventh goes all ways, every eleventh starts all
   over the place, and of every fifth one ray has another interval. */
static void aim_packets(const struct fixture *f, struct gpu_ray *rays, uint32_t count)
{
    struct scene_pose pose;
    uint64_t random = 17;
    double target[3], middle[3] = {0}, way[3];
    assert_int_equal(scene_pose_init(f->scene, 0.0, &pose), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t packet = i / 64, axis = packet % 3;
        if (i % 64 == 0)
            aim_at_scene(f, &pose, &random, target);
        rays[i] = (struct gpu_ray){.t_max = i % 4 ? INFINITY : 1.0f};
        for (uint32_t k = 0; k < 3; ++k) {
            if (i % 1024 == 0)
                middle[k] = (double)(float)(0.5 * (pose.lo[k] + pose.hi[k]) +
                                            1.5 * (pose.hi[k] - pose.lo[k] + 1e-3) *
                                                random_signed(&random));
            way[k] = packet % 2 ? target[k] - middle[k] : k == axis ? -1.0 : 0.0;
            double origin = packet % 2 || k == axis ? middle[k] : target[k];
            rays[i].origin[k] = (float)(origin + (packet % 11 == 10 ? random_signed(&random) : 0));
        }
        double size = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
        double wide = packet % 7 == 6 ? 3.0 : packet % 13 == 12 ? 0.0 : 0.03;
        for (uint32_t k = 0; k < 3; ++k)
            rays[i].dir[k] = (float)(way[k] + (i % 3 || packet % 2 ? wide * size : 0.0) *
                                                  random_signed(&random));
        if (packet % 5 == 4 && i % 64 == 9)
            rays[i].t_min = 0.25f;
    }
    scene_pose_finish(&pose);
}

static void check_packets(struct scene *scene, const struct accel_params *params, const char *label)
{
    enum { MANY = 70000 }; /* the last packet is not full */
    const struct render_params on = {.width = 16, .height = 16, .packets = RENDER_PACKETS_ON};
    struct fixture f = fixture_open(scene, params, &on);
    struct gpu_ray *rays = array_alloc(MANY, sizeof *rays);
    struct gpu_hit *hits = array_alloc(MANY, sizeof *hits);
    assert_true(rays && hits);
    aim_packets(&f, rays, MANY);
    for (int any = 0; any < 2; ++any) {
        uint32_t unlike = count_unlike_twin(&f, NUMERICS_WATERTIGHT, any, rays, MANY, hits),
                 met = 0;
        for (uint32_t i = 0; i < MANY; ++i)
            met += hits[i].primitive != HIT_NONE;
        uint64_t together = renderer_trace_together(f.renderer);
        print_message("  %s, %s: %u rays, %u met, %u in packets; unlike the twin %u\n", label,
                      any ? "any" : "closest", MANY, met, (uint32_t)together, unlike);
        assert_int_equal(unlike, 0);
        assert_true(met > MANY / 10 && met < MANY);
        if (device_get_info(f.device)->subgroup_size == 8) {
            assert_true(together > MANY / 2 && together < MANY);
        }
    }
    free(rays);
    free(hits);
    fixture_close(&f);
}

static void packets_equal_twin(void **state)
{
    (void)state;
    struct scene *scene = scene_begin(&fixture_log, "torus");
    scene_put(scene, mesh_torus(1.0, 0.45, 60, 30), NULL);
    check_packets(scene, NULL, "torus");
    check_packets(integer_ring(), NULL, "ring of integers");
    scene = scene_begin(&fixture_log, "rings");
    scene_put_mesh(scene, mesh_torus(1.0, 0.3, 20, 10));
    uint64_t random = 5;
    for (int i = 0; i < 40; ++i) {
        struct affine placed = placement_random(&random, 6.0, i % 3 == 0);
        scene_put_again(scene, 0, &(struct put){.matrix = &placed});
    }
    const struct accel_params flat = {.stack_floor = 32, .flatten = true};
    check_packets(scene, &flat, "one tree of 40 instances");
}

/* Along an axis at multiples of a half: from far away; every fifth from a vertex. */
static struct gpu_ray ray_along_axis(const struct scene *scene, uint32_t i, uint64_t *state)
{
    const struct scene_mesh *mesh = &scene->meshes[0];
    struct gpu_ray ray = {.t_max = INFINITY};
    uint32_t axis = i % 3, vertex = random_below(state, mesh->vertex_count);
    float up = random_below(state, 2) ? 1.0f : -1.0f;
    for (uint32_t k = 0; k < 3; ++k) {
        ray.origin[k] = i % 5 ? rintf(54.0f * random_float_signed(state)) * 0.5f
                              : mesh->positions[3 * vertex + k];
        ray.dir[k] = random_below(state, 2) ? 0.0f : -0.0f;
    }
    ray.dir[axis] = up;
    if (i % 5)
        ray.origin[axis] = -1000.0f * up;
    return ray;
}

/* W3, T6 and B8 of docs/hard-cases.md on the device: intervals that end, or begin and end, at a hit
   keep it; those that end one float before it are empty. */
static void check_ends(const struct fixture *f, uint32_t numerics, struct gpu_ray *rays,
                       uint32_t count)
{
    struct gpu_hit *first = array_alloc(count, sizeof *first);
    struct gpu_hit *hits = array_alloc(count, sizeof *hits);
    assert_true(first && hits);
    uint32_t met = 0, lost = 0, early = 0, at_start = 0;
    uint32_t unlike = count_unlike_twin(f, numerics, false, rays, count, first);
    for (uint32_t i = 0; i < count; ++i) {
        met += first[i].primitive != HIT_NONE;
        at_start += first[i].t == 0.0f;
        rays[i].t_max = first[i].t;
    }
    unlike += count_unlike_twin(f, numerics, false, rays, count, hits);
    for (uint32_t i = 0; i < count; ++i)
        lost += memcmp(&hits[i], &first[i], sizeof *hits) != 0;
    unlike += count_unlike_twin(f, numerics, true, rays, count, hits);
    for (uint32_t i = 0; i < count; ++i) {
        lost += (hits[i].primitive != HIT_NONE) != (first[i].primitive != HIT_NONE);
        rays[i].t_max = nextafterf(first[i].t, -INFINITY);
    }
    unlike += count_unlike_twin(f, numerics, true, rays, count, hits);
    for (uint32_t i = 0; i < count; ++i)
        early += hits[i].primitive != HIT_NONE;
    print_message(
        "  %s: %u rays along axes of integers, %u hit, %u at their start; unlike twin %u, "
        "lost at the end %u, met before it %u\n",
        level_names[numerics], count, met, at_start, unlike, lost, early);
    assert_int_equal(unlike + lost + early, 0);
    assert_true(met > count / 4 && at_start > count / 10);
    free(first);
    free(hits);
}

static void integers_equal_twin(void **state)
{
    (void)state;
    const uint32_t levels[] = {NUMERICS_WATERTIGHT, NUMERICS_EXACT};
    for (int l = 0; l < 2; ++l) {
        struct fixture f = open_at(integer_ring(), levels[l]);
        struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
        uint64_t random = 3;
        assert_non_null(rays);
        for (uint32_t i = 0; i < RAYS; ++i)
            rays[i] = ray_along_axis(f.scene, i, &random);
        check_ends(&f, levels[l], rays, RAYS);
        free(rays);
        fixture_close(&f);
    }
}

static void check_degenerate_rays(uint32_t numerics)
{
    struct scene *scene = scene_begin(&fixture_log, "test");
    scene_put(scene, mesh_sphere(1.0, 16, 8), NULL);
    struct fixture f = open_at(scene, numerics);
    const float bad[] = {NAN, INFINITY, -INFINITY};
    struct gpu_ray rays[16];
    struct gpu_hit hits[16];
    uint32_t count = 0;
    for (int i = 0; i < 3; ++i) {
        rays[count++] = (struct gpu_ray){{bad[i], 0, 0}, 0, {0, 0, 1}, INFINITY};
        rays[count++] = (struct gpu_ray){{0, 0, 0}, 0, {0, bad[i], 1}, INFINITY};
    }
    rays[count++] = (struct gpu_ray){{0, 0, 0}, 0, {0, 0, 0}, INFINITY};
    rays[count++] = (struct gpu_ray){{0, 0, 0}, NAN, {0, 0, 1}, INFINITY};
    rays[count++] = (struct gpu_ray){{0, 0, 0}, 0, {0, 0, 1}, NAN};
    rays[count++] = (struct gpu_ray){{0, 0, 0}, 5, {0, 0, 1}, 2};
    rays[count++] = (struct gpu_ray){{0, 0, 0}, 0, {0, 0, 1}, 0};
    rays[count++] = (struct gpu_ray){{0, 0, 0}, 0, {0, 0, 1}, -1};
    rays[count++] = (struct gpu_ray){{0, 0, 0}, INFINITY, {0, 0, 1}, INFINITY};
    assert_int_equal(count_unlike_twin(&f, numerics, false, rays, count, hits), 0);
    for (uint32_t i = 0; i < count; ++i)
        if (i != 8) /* a t_max that is not a number bounds nothing */
            assert_int_equal(hits[i].primitive, HIT_NONE);
    print_message("  %s: 0 hits of %u degenerate rays\n", level_names[numerics], count - 1);
    fixture_close(&f);
}

static void degenerate_rays_miss(void **state)
{
    (void)state;
    check_degenerate_rays(NUMERICS_WATERTIGHT);
    check_degenerate_rays(NUMERICS_EXACT);
}

static void empty_scene_misses(void **state)
{
    (void)state;
    struct fixture f = fixture_open(scene_begin(&fixture_log, "empty"), NULL, NULL);
    struct gpu_ray ray = {{0, 0, 5}, 0, {0, 0, -1}, INFINITY};
    struct gpu_hit hit;
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, NULL), WHIT_OK);
    assert_int_equal(hit.primitive, HIT_NONE);
    fixture_close(&f);
}

/* Slivers along one diagonal, layer on layer: a ray beside the diagonal meets every box and no
   triangle. That is more loop turns than lavapipe grants; the kernel must say so. */
static void cut_traversals_are_reported(void **state)
{
    (void)state;
    uint32_t count = 70000;
    struct scene_mesh mesh = mesh_zeroed(3 * count, count);
    for (uint32_t i = 0; i < count; ++i) {
        float z = (float)i * 0.001f;
        const float corners[9] = {0, 0, z, 1, 1, z, 0.99f, 1, z};
        memcpy(&mesh.positions[9 * (size_t)i], corners, sizeof corners);
        for (uint32_t k = 0; k < 3; ++k)
            mesh.indices[3 * i + k] = 3 * i + k;
    }
    struct scene *scene = scene_begin(&fixture_log, "test");
    scene_put(scene, mesh, NULL);
    struct fixture f = fixture_open(scene, NULL, NULL);
    struct gpu_ray rays[8];
    struct gpu_hit hits[8], twin;
    uint32_t status = 0;
    for (int i = 0; i < 8; ++i)
        rays[i] = (struct gpu_ray){{0.8f, 0.2f, -1}, 0, {0, 0, 1}, INFINITY};
    struct gpu_cost counts = {0};
    traverse_float(f.accel, ORDER_DISTANCE, &rays[0], false, HIT_NONE, HIT_NONE, &twin, &counts,
                   &status);
    assert_int_equal(twin.primitive, HIT_NONE);
    assert_int_equal(counts.triangles, count); /* the case is as hard as it should be */
    whit_result result = renderer_trace(f.renderer, rays, 8, false, hits, NULL);
    print_message("  %u pairs and %u triangles for one ray: %s\n", counts.inner_nodes,
                  counts.triangles, whit_result_name(result));
    if (device_get_info(f.device)->loop_limited) {
        assert_int_equal(result, WHIT_ERROR_STATUS);
    } else {
        assert_int_equal(result, WHIT_OK);
        assert_int_equal(hits[0].primitive, HIT_NONE);
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sphere_equals_twin),
        cmocka_unit_test(box_equals_twin),
        cmocka_unit_test(terrain_equals_twin),
        cmocka_unit_test(far_sphere_equals_twin),
        cmocka_unit_test(soup_equals_twin),
        cmocka_unit_test(instances_equal_twin),
        cmocka_unit_test(packets_equal_twin),
        cmocka_unit_test(integers_equal_twin),
        cmocka_unit_test(degenerate_rays_miss),
        cmocka_unit_test(empty_scene_misses),
        cmocka_unit_test(cut_traversals_are_reported),
    };
    return fixture_end(cmocka_run_group_tests(tests, NULL, NULL));
}
