/* Compares the kernel of ray batches with the float mirror, bit for bit, and both with brute force
   over all triangles. */
#include "../cases.h"
#include "../wrapped.h"
#include "device/buffer.h"
#include "ray_fixture.h"
#include "scene/pose.h"
#include "unit.h"

#define RAYS cases_of(32000)

/* Any-hit finds a hit up to t_max exactly if the closest hit is that near; a third of the rays end
   exactly there, or one float before. */
static void check_any_against_closest(struct fixture *f, const char *label)
{
    const uint32_t many = 6 * RAYS;
    own_memory struct gpu_ray *rays = array_alloc(many, sizeof *rays);
    own_memory struct gpu_hit *closest = array_alloc(many, sizeof *closest);
    own_memory struct gpu_hit *any = array_alloc(many, sizeof *any);
    assert_true(rays && closest && any);
    for (uint32_t i = 0; i < many / RAYS; ++i)
        aim_rays(f, rays + (size_t)i * RAYS, RAYS, 1000 + i);
    for (uint32_t i = 0; i < many; ++i)
        rays[i].t_max = INFINITY;
    assert_int_equal(renderer_trace(f->renderer, rays, many, false, closest, NULL), WHIT_OK);
    uint32_t blocked = 0, bad = 0;
    uint64_t state = 11;
    for (uint32_t i = 0; i < many; ++i) {
        rays[i].t_max = 2.0f * fabsf(random_float_signed(&state));
        if (closest[i].primitive != HIT_NONE && i % 3 == 0)
            rays[i].t_max = i & 1 ? closest[i].t : nextafterf(closest[i].t, -INFINITY);
    }
    assert_int_equal(renderer_trace(f->renderer, rays, many, true, any, NULL), WHIT_OK);
    for (uint32_t i = 0; i < many; ++i) {
        bool wanted = closest[i].primitive != HIT_NONE && closest[i].t <= rays[i].t_max;
        blocked += wanted;
        bad += wanted != (any[i].primitive != HIT_NONE);
    }
    print_message("  %s: %u rays, %u blocked; any-hit unlike closest %u\n", label, many, blocked,
                  bad);
    assert_true(blocked > many / 100);
    assert_true(blocked < many);
    assert_int_equal(bad, 0);
}

static void check_scene(struct scene *scene, const char *label)
{
    own_fixture f = fixture_open(scene, NULL, NULL);
    own_memory struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(RAYS, sizeof *hits);
    uint32_t status = 0;
    assert_true(rays && hits);
    assert_int_equal(f.accel->single_identity, f.scene->instance_count == 1);
    aim_rays(&f, rays, RAYS, 7);
    check_rays(&f, label, rays, RAYS, hits);
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_hit brute;
        if (i % 8 >= 4)
            continue;
        traverse_ray(f.accel, &(struct traverse_params){.brute = true}, &rays[i], &brute, NULL,
                     &status);
        if (memcmp(&hits[i], &brute, sizeof brute) != 0)
            fail_msg("%s: tree unlike brute force at ray %u", label, i);
    }
    check_any_against_closest(&f, label);
}

static struct scene_mesh far_sphere(void)
{
    struct scene_mesh mesh = mesh_sphere(2.0, 40, 20);
    const float offset[3] = {148376.0f, 1234.0f, -223423.0f};
    for (size_t i = 0; i < 3 * (size_t)mesh.vertex_count; ++i)
        mesh.positions[i] += offset[i % 3];
    return mesh;
}

/* Every tenth triangle repeats its neighbour, so that hits tie. */
static struct scene_mesh soup(void)
{
    enum { TRIANGLES = 500 };
    float corners[9 * TRIANGLES];
    uint64_t random = 99;
    for (uint32_t i = 0; i < 9 * TRIANGLES; ++i)
        corners[i] = i / 9 % 10 == 9 ? corners[i - 9] : random_float_signed(&random) * 3.0f;
    return mesh_triangles(corners, TRIANGLES);
}

static struct scene *scene_of(struct scene_mesh mesh)
{
    struct scene *scene = scene_begin(&fixture_log, "test");
    scene_put(scene, mesh, NULL);
    return scene;
}

TEST(meshes_equal_twin)
{
    check_scene(scene_of(mesh_sphere(1.0, 40, 20)), "sphere");
    check_scene(scene_of(mesh_box(2.0, 1.0, 3.0)), "box");
    check_scene(scene_of(mesh_terrain(10.0, 2.0, 24, 3)), "terrain");
    check_scene(scene_of(far_sphere()), "sphere far from the origin");
    check_scene(scene_of(soup()), "soup with duplicates");
}

static struct scene *forty_rings(void)
{
    struct scene *scene = scene_begin(&fixture_log, "rings");
    uint64_t random = 5;
    scene_put_mesh(scene, mesh_torus(1.0, 0.3, 20, 10));
    for (int i = 0; i < 40; ++i) {
        struct affine placed = placement_random(&random, 6.0, i % 3 == 0);
        scene_put_again(scene, 0, &(struct put){.matrix = &placed});
    }
    return scene;
}

TEST(instances_equal_twin)
{
    struct scene *scene = forty_rings();
    scene_put_again(scene, 0, NULL);
    scene_put_again(scene, 0, NULL); /* an instance at the same place, so that hits tie */
    check_scene(scene, "42 instances");
}

static struct fixture open_at(struct scene *scene, uint32_t numerics)
{
    const whit_renderer_params params = {.width = 16, .height = 16, .numerics = numerics};
    return fixture_open(scene, NULL, &params);
}

static const char *const level_names[] = {
    [NUMERICS_WATERTIGHT] = "watertight", [NUMERICS_EXACT] = "exact"};

/* A ring with vertices of integers; edges and vertices are at multiples of a half. */
static struct scene *integer_ring(void)
{
    struct scene_mesh mesh = mesh_torus(1.0, 0.45, 40, 20);
    for (uint32_t i = 0; i < 3 * mesh.vertex_count; ++i)
        mesh.positions[i] = rintf(18.0f * mesh.positions[i]);
    return scene_of(mesh);
}

/* Runs of 64 rays from one point in about the same direction: towards the scene, or along an axis,
   so that signs differ and components are 0. Every seventh run has all directions, every eleventh
   has different origins, and in every fifth one ray has another interval. */
static void aim_packets(const struct fixture *f, struct gpu_ray *rays, uint32_t count)
{
    own_pose pose;
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
}

static void check_packets(struct scene *scene, const whit_accel_params *params, const char *label)
{
    const uint32_t many = cases_of(70000); /* the last packet is not full */
    const whit_renderer_params on = {.width = 16, .height = 16, .packets = WHIT_PACKETS_ON};
    own_fixture f = fixture_open(scene, params, &on);
    own_memory struct gpu_ray *rays = array_alloc(many, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(many, sizeof *hits);
    assert_true(rays && hits);
    aim_packets(&f, rays, many);
    for (int any = 0; any < 2; ++any) {
        uint32_t unlike = trace_beside_twin(&f, any, rays, many, hits, NULL).hits;
        uint32_t met = count_met(hits, many);
        uint64_t together = renderer_trace_together(f.renderer);
        print_message("  %s, %s: %u rays, %u met, %u in packets; unlike the twin %u\n", label,
                      any ? "any" : "closest", many, met, (uint32_t)together, unlike);
        assert_int_equal(unlike, 0);
        assert_true(met > many / 10 && met < many);
        if (device_get_info(f.device)->subgroup_size == 8) {
            assert_true(together > many / 2 && together < many);
        }
    }
}

TEST(packets_equal_twin)
{
    check_packets(scene_of(mesh_torus(1.0, 0.45, 60, 30)), NULL, "torus");
    check_packets(integer_ring(), NULL, "ring of integers");
    const whit_accel_params flat = {.instances = WHIT_INSTANCES_OFF};
    check_packets(forty_rings(), &flat, "one tree of 40 instances");
}

/* Layers of slivers along one diagonal: rays beside the diagonal meet every box and no triangle. So
   a packet opens every node of eight children once, and tests every triangle once. Rays of another
   direction are no packet, and count one by one. */
TEST(packets_count_what_they_visit)
{
    enum { LAYERS = 700, PACKET = 64, MANY = 2 * PACKET };
    static const float sliver[9] = {0, 0, 0, 1, 1, 0, 0.99f, 1, 0};
    const whit_renderer_params on = {
        .width = 16, .height = 16, .packets = WHIT_PACKETS_ON, .count = true};
    own_fixture f = fixture_open(scene_of(mesh_stack(LAYERS, sliver, 2, 0.001f)), NULL, &on);
    struct gpu_ray rays[MANY];
    struct gpu_hit hits[MANY];
    struct gpu_cost costs[MANY], alone = {0};
    uint32_t status = 0;
    if (device_get_info(f.device)->subgroup_size != 8)
        return;
    for (int i = 0; i < MANY; ++i)
        rays[i] =
            (struct gpu_ray){{0.8f, 0.2f, -1}, 0, {0, 0, i < PACKET || i % 2 ? 1 : -1}, INFINITY};
    assert_int_equal(renderer_trace(f.renderer, rays, MANY, false, hits, costs), WHIT_OK);
    assert_int_equal(renderer_trace_together(f.renderer), PACKET);
    traverse_ray(f.accel, NULL, &rays[0], &hits[0], &alone, &status);
    print_message("  a packet: %u nodes, %u triangles; a ray: %u nodes, %u triangles\n",
                  costs[0].inner_nodes, costs[0].triangles, alone.inner_nodes, alone.triangles);
    assert_int_equal(costs[0].rays, 1);
    assert_int_equal(costs[0].inner_nodes, f.accel->bvh8.mesh_node_count);
    assert_int_equal(costs[0].triangles, LAYERS);
    for (int i = 1; i < PACKET; ++i)
        assert_int_equal(costs[i].rays + costs[i].inner_nodes + costs[i].triangles, 0);
    for (int i = PACKET; i < MANY; ++i) {
        assert_int_equal(costs[i].inner_nodes, i % 2 ? alone.inner_nodes : 1);
        assert_int_equal(costs[i].triangles, i % 2 ? LAYERS : 0);
    }
}

/* The name of a buffer that the device has no memory for; whether buffers cannot be read. */
static const char *no_room;
static bool unreadable;

WRAPPED(whit_result, buffer_create, struct device *device, uint64_t size_bytes, uint32_t uses,
        const char *name, struct buffer **out)
{
    return no_room && strcmp(name, no_room) == 0
               ? WHIT_ERROR_MEMORY
               : __real_buffer_create(device, size_bytes, uses, name, out);
}

WRAPPED(whit_result, buffer_read, struct buffer *buffer, uint64_t offset_bytes, void *data,
        uint64_t size_bytes)
{
    return unreadable && size_bytes == sizeof(struct gpu_work)
               ? WHIT_ERROR_DEVICE
               : __real_buffer_read(buffer, offset_bytes, data, size_bytes);
}

/* A batch is large enough for packets, but the memory for their nodes is missing at first. */
TEST(packets_are_tried_again)
{
    enum { MANY = 1 << 17 };
    const whit_renderer_params small = {.width = 16, .height = 16};
    own_fixture f = fixture_open(scene_of(mesh_torus(1.0, 0.45, 60, 30)), NULL, &small);
    own_memory struct gpu_ray *rays = array_alloc(MANY, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(MANY, sizeof *hits);
    assert_true(rays && hits);
    if (device_get_info(f.device)->subgroup_size != 8)
        return;
    aim_packets(&f, rays, MANY);
    no_room = "nodes of eight";
    assert_int_equal(renderer_trace(f.renderer, rays, MANY, false, hits, NULL), WHIT_ERROR_MEMORY);
    no_room = NULL;
    unreadable = true;
    assert_int_equal(renderer_trace(f.renderer, rays, MANY, false, hits, NULL), WHIT_ERROR_DEVICE);
    assert_int_equal(renderer_trace_together(f.renderer), 0);
    unreadable = false;
    assert_int_equal(trace_beside_twin(&f, false, rays, MANY, hits, NULL).hits, 0);
    assert_true(renderer_trace_together(f.renderer) > MANY / 2);
}

/* So many views would be drawn in packets, for whose nodes there is no memory. */
TEST(a_picture_is_drawn_after_views_without_packets)
{
    enum { VIEWS = 256 };
    const whit_renderer_params params = {.width = 64, .height = 64};
    static const whit_camera cameras[VIEWS];
    own_fixture f = fixture_open(scene_of(mesh_torus(1.0, 0.45, 60, 30)), NULL, &params);
    if (device_get_info(f.device)->subgroup_size != 8)
        return;
    own_picture before = render_picture(&f);
    no_room = "nodes of eight";
    assert_int_equal(renderer_render_views(f.renderer, cameras, VIEWS), WHIT_ERROR_MEMORY);
    no_room = NULL;
    own_picture after = render_picture(&f);
    assert_same_picture("after views", &after, &before);
}

/* A ray along an axis at multiples of a half, from far away; every fifth ray is from a vertex. */
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
static void check_ends(const struct fixture *f, struct gpu_ray *rays, uint32_t count)
{
    own_memory struct gpu_hit *first = array_alloc(count, sizeof *first);
    own_memory struct gpu_hit *hits = array_alloc(count, sizeof *hits);
    assert_true(first && hits);
    uint32_t lost = 0, at_start = 0;
    uint32_t unlike = trace_beside_twin(f, false, rays, count, first, NULL).hits;
    for (uint32_t i = 0; i < count; ++i) {
        at_start += first[i].t == 0.0f;
        rays[i].t_max = first[i].t;
    }
    unlike += trace_beside_twin(f, false, rays, count, hits, NULL).hits;
    for (uint32_t i = 0; i < count; ++i)
        lost += memcmp(&hits[i], &first[i], sizeof *hits) != 0;
    unlike += trace_beside_twin(f, true, rays, count, hits, NULL).hits;
    for (uint32_t i = 0; i < count; ++i) {
        lost += (hits[i].primitive != HIT_NONE) != (first[i].primitive != HIT_NONE);
        rays[i].t_max = nextafterf(first[i].t, -INFINITY);
    }
    unlike += trace_beside_twin(f, true, rays, count, hits, NULL).hits;
    uint32_t met = count_met(first, count), early = count_met(hits, count);
    print_message(
        "  %s: %u rays along axes of integers, %u hit, %u at their start; unlike twin %u, "
        "lost at the end %u, met before it %u\n",
        level_names[f->renderer->params.numerics], count, met, at_start, unlike, lost, early);
    assert_int_equal(unlike + lost + early, 0);
    assert_true(met > count / 4 && at_start > count / 10);
}

TEST(integers_equal_twin)
{
    const uint32_t levels[] = {NUMERICS_WATERTIGHT, NUMERICS_EXACT};
    for (int l = 0; l < 2; ++l) {
        own_fixture f = open_at(integer_ring(), levels[l]);
        own_memory struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
        uint64_t random = 3;
        assert_non_null(rays);
        for (uint32_t i = 0; i < RAYS; ++i)
            rays[i] = ray_along_axis(f.scene, i, &random);
        check_ends(&f, rays, RAYS);
    }
}

static void check_degenerate_rays(uint32_t numerics)
{
    own_fixture f = open_at(scene_of(mesh_sphere(1.0, 16, 8)), numerics);
    const struct gpu_ray rays[] = {
        {{NAN, 0, 0}, 0, {0, 0, 1}, INFINITY},
        {{INFINITY, 0, 0}, 0, {0, 0, 1}, INFINITY},
        {{-INFINITY, 0, 0}, 0, {0, 0, 1}, INFINITY},
        {{0, 0, 0}, 0, {0, NAN, 1}, INFINITY},
        {{0, 0, 0}, 0, {0, INFINITY, 1}, INFINITY},
        {{0, 0, 0}, 0, {0, -INFINITY, 1}, INFINITY},
        {{0, 0, 0}, 0, {0, 0, 0}, INFINITY},
        {{0, 0, 0}, NAN, {0, 0, 1}, INFINITY},
        {{0, 0, 0}, 5, {0, 0, 1}, 2},
        {{0, 0, 0}, 0, {0, 0, 1}, 0},
        {{0, 0, 0}, 0, {0, 0, 1}, -1},
        {{0, 0, 0}, INFINITY, {0, 0, 1}, INFINITY},
        {{0, 0, 0}, 0, {0, 0, 1}, NAN}, /* a t_max of NaN is no limit */
        {{0, 0, 5},
         -INFINITY,
         {0, 0, 1e-39f},
         INFINITY}, /* t may be -infinity: 1 / dir is infinite */
    };
    enum { COUNT = sizeof rays / sizeof *rays, MISSES = COUNT - 2 };
    struct gpu_hit hits[COUNT];
    assert_int_equal(trace_beside_twin(&f, false, rays, COUNT, hits, NULL).hits, 0);
    for (uint32_t i = 0; i < MISSES; ++i)
        assert_int_equal(hits[i].primitive, HIT_NONE);
    print_message("  %s: 0 hits of %u degenerate rays\n", level_names[numerics], (unsigned)MISSES);
}

TEST(degenerate_rays_miss)
{
    check_degenerate_rays(NUMERICS_WATERTIGHT);
    check_degenerate_rays(NUMERICS_EXACT);
}

/* Reciprocals of denormals may be infinite, and tests of boxes would take a ray for one that stands
   still. Rays at a tiny sphere, of which every second has one normal component. */
TEST(denormal_directions_equal_twin)
{
    own_fixture f = open_at(scene_of(mesh_sphere(0x1p-40, 16, 8)), NUMERICS_EXACT);
    enum { COUNT = 4000 };
    own_memory struct gpu_ray *rays = array_alloc(COUNT, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(COUNT, sizeof *hits);
    uint32_t met = 0;
    uint64_t random = 5;
    assert_true(rays && hits);
    for (uint32_t i = 0; i < COUNT; ++i) {
        rays[i] = (struct gpu_ray){.t_max = INFINITY};
        for (uint32_t k = 0; k < 3; ++k) {
            float at = 0x1p-40f * (float)random_signed(&random);
            rays[i].origin[k] = i % 6 == 2 * k ? 0x1p-10f : 2.0f * at;
            rays[i].dir[k] = (at - rays[i].origin[k]) * 0x1p-94f;
        }
    }
    assert_int_equal(trace_beside_twin(&f, false, rays, COUNT, hits, NULL).hits, 0);
    for (uint32_t i = 0; i < COUNT; ++i)
        met += hits[i].primitive != HIT_NONE;
    print_message("  0 of %u rays differ, %u hit\n", (unsigned)COUNT, met);
    assert_true(met > COUNT / 4);
}

TEST(empty_scene_misses)
{
    own_fixture f = fixture_open(scene_begin(&fixture_log, "empty"), NULL, NULL);
    struct gpu_ray ray = {{0, 0, 5}, 0, {0, 0, -1}, INFINITY};
    struct gpu_hit hit;
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, NULL), WHIT_OK);
    assert_int_equal(hit.primitive, HIT_NONE);
}

/* Layers of slivers along one diagonal: a ray beside the diagonal meets every box and no triangle.
   That takes more loop iterations than lavapipe allows, and the kernel must report it. */
TEST(cut_traversals_are_reported)
{
    enum { COUNT = 70000 };
    static const float sliver[9] = {0, 0, 0, 1, 1, 0, 0.99f, 1, 0};
    own_fixture f = fixture_open(scene_of(mesh_stack(COUNT, sliver, 2, 0.001f)), NULL, NULL);
    struct gpu_ray rays[8];
    struct gpu_hit hits[8], twin;
    uint32_t status = 0;
    for (int i = 0; i < 8; ++i)
        rays[i] = (struct gpu_ray){{0.8f, 0.2f, -1}, 0, {0, 0, 1}, INFINITY};
    struct gpu_cost counts = {0};
    traverse_ray(f.accel, NULL, &rays[0], &twin, &counts, &status);
    assert_int_equal(twin.primitive, HIT_NONE);
    assert_int_equal(counts.triangles, COUNT); /* the ray does test every triangle */
    whit_result result = renderer_trace(f.renderer, rays, 8, false, hits, NULL);
    print_message("  %u pairs and %u triangles for one ray: %s\n", counts.inner_nodes,
                  counts.triangles, whit_result_name(result));
    if (device_get_limits(f.device)->loop_limited) {
        assert_int_equal(result, WHIT_ERROR_STATUS);
    } else {
        assert_int_equal(result, WHIT_OK);
        assert_int_equal(hits[0].primitive, HIT_NONE);
    }
}
