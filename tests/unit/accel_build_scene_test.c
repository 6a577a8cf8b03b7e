/* The arrays of a whole scene: the place of each mesh, the records of triangles, and instances at
   any pose. */
#include "accel/pose.h"
#include "accel_fixture.h"
#include "oracle/oracle.h"
#include "unit.h"

static uint32_t add_sphere(struct scene *scene, uint32_t segments, uint32_t rings)
{
    return scene_put_mesh(scene, mesh_sphere(1.0, segments, rings));
}

static struct affine placed(double x, double y, double z, double angle, double sx, double sy,
                            double sz)
{
    const double at[3] = {x, y, z}, scale[3] = {sx, sy, sz};
    const double rotation[4] = {0.3 * sin(angle), 0.9 * sin(angle), -0.3 * sin(angle), cos(angle)};
    return affine_from_trs(at, rotation, scale);
}

static whit_accel_params by_threads(uint32_t count)
{
    return (whit_accel_params){.threads = count};
}

/* Two large meshes, three small ones and one without triangles; rotated, mirrored, far away. */
static struct scene *mixed_scene(void)
{
    struct scene *scene = scene_begin(&silent, "test");
    static const uint32_t sizes[] = {4, 90, 7, 80, 3};
    for (size_t i = 0; i < 5; ++i)
        add_sphere(scene, sizes[i], sizes[i]);
    uint32_t empty = scene_put_mesh(scene, (struct scene_mesh){0});
    scene_put_again(scene, empty, NULL);
    for (uint32_t i = 0; i < 40; ++i) {
        struct affine m = placed(3.0 * i, i % 7, 1e4 * (i % 3), i, i % 2 ? -1 : 1, 2.0, 0.01);
        scene_put_again(scene, i % 5, &(struct put){.matrix = &m});
        if (i % 10 == 0)
            scene_put_again(scene, empty, &(struct put){.matrix = &m});
    }
    return scene;
}

TEST(meshes_lie_side_by_side)
{
    own_world world = world_of(mixed_scene(), by_threads(2));
    const struct scene *scene = world.scene;
    const struct accel *accel = world.accel;
    uint32_t nodes = accel->instance_node_capacity, triangles = 0;
    assert_int_equal(accel->mesh_count, scene->mesh_count);
    for (uint32_t i = 0; i < accel->mesh_count; ++i) {
        const struct accel_mesh *mesh = &accel->meshes[i];
        assert_int_equal(mesh->first_node, nodes);
        assert_int_equal(mesh->first_node % 2, 0);
        assert_int_equal(mesh->first_triangle, triangles);
        assert_int_equal(mesh->shade_base, triangles);
        assert_int_equal(mesh->triangle_count, scene->meshes[i].triangle_count);
        assert_int_equal(mesh->root == BVH_EMPTY_REF, mesh->triangle_count == 0);
        nodes += mesh->node_count;
        triangles += mesh->triangle_count;
        for (int a = 0; a < 3 && mesh->triangle_count; ++a) {
            assert_true(mesh->box.lo[a] == scene->meshes[i].lo[a]);
            assert_true(mesh->box.hi[a] == scene->meshes[i].hi[a]);
        }
    }
    assert_int_equal(accel->node_count, nodes);
    assert_int_equal(accel->triangle_count, triangles);
    assert_int_equal((uintptr_t)accel->nodes % 64, 0);
    assert_true(accel_bytes(accel) >= 32 * (uint64_t)nodes + 48 * (uint64_t)triangles);
}

TEST(same_bytes_for_any_thread_count)
{
    own_world world = world_of(mixed_scene(), by_threads(1));
    const struct accel *one = world.accel;
    for (uint32_t threads = 2; threads <= 4; threads += 2) {
        own_accel *other = accel_of(world.scene, by_threads(threads));
        assert_int_equal(other->node_count, one->node_count);
        assert_memory_equal(other->nodes, one->nodes, one->node_count * sizeof *one->nodes);
        assert_memory_equal(other->triangles, one->triangles,
                            one->record_count * sizeof *one->triangles);
        assert_memory_equal(other->instances, one->instances,
                            one->instance_count * sizeof *one->instances);
    }
}

/* The leaf of the instance tree that has `instance`. */
static const struct gpu_bvh_node *instance_leaf(const struct accel *accel, uint32_t instance)
{
    for (uint32_t i = 0; i < accel->instance_node_count; ++i) {
        const struct gpu_bvh_node *node = &accel->nodes[i];
        if (bvh_count(node) == 1 && node->first == instance)
            return node;
    }
    return NULL;
}

/* Checks the boxes of instances: every vertex, transformed by the pose's matrix in double, is
   inside with a margin, and the margin is small. */
static void assert_posed(const struct accel *accel, const struct scene_pose *pose)
{
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        const struct gpu_bvh_node *leaf = instance_leaf(accel, i);
        const struct scene_mesh *mesh = &accel->scene->meshes[accel->scene->instances[i].mesh];
        assert_int_equal(leaf != NULL, mesh->triangle_count > 0);
        for (uint32_t v = 0; leaf && v < mesh->vertex_count; ++v) {
            const float *p = mesh->positions + 3 * (size_t)v;
            double world[3];
            affine_point(&pose->instances[i],
                         (const double[3]){(double)p[0], (double)p[1], (double)p[2]}, world);
            for (int a = 0; a < 3; ++a) {
                double room = 0x1p-21 * fabs(world[a]);
                assert_true((double)leaf->lo[a] + room <= world[a]);
                assert_true((double)leaf->hi[a] - room >= world[a]);
            }
        }
        for (int a = 0; leaf && a < 3; ++a)
            assert_true((double)leaf->hi[a] - (double)leaf->lo[a] < 10.0);
    }
}

TEST(instances_are_boxed_wherever_they_are)
{
    own_world world = world_of(mixed_scene(), by_threads(1));
    struct accel *accel = world.accel;
    struct scene_pose *pose = &world.pose;
    assert_posed(accel, pose);
    assert_false(accel->single_identity);
    struct gpu_bvh_node mesh_node = accel->nodes[accel->meshes[1].first_node + 2];
    for (uint32_t i = 0; i < pose->instance_count; ++i) {
        pose->instances[i].m[3] += 1e5 + 17.0 * (i % 5);
        pose->instances[i].m[7] -= 3.0 * i;
    }
    assert_int_equal(accel_pose(accel, pose), WHIT_OK);
    assert_int_equal(accel_validate(accel), WHIT_OK);
    assert_posed(accel, pose);
    assert_memory_equal(&mesh_node, &accel->nodes[accel->meshes[1].first_node + 2],
                        sizeof mesh_node);
}

TEST(inverse_and_forward_are_inverse)
{
    own_world world = world_of(mixed_scene(), by_threads(1));
    const struct scene *scene = world.scene;
    const struct accel *accel = world.accel;
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        const struct gpu_instance *in = &accel->instances[i];
        const float *f[3] = {in->forward0, in->forward1, in->forward2};
        const float *b[3] = {in->inverse0, in->inverse1, in->inverse2};
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                double sum = 0.0, size = 0.0;
                for (int k = 0; k < 3; ++k) {
                    sum += (double)b[r][k] * (double)f[k][c];
                    size += fabs((double)b[r][k] * (double)f[k][c]);
                }
                assert_true(fabs(sum - (r == c)) <= 0x1p-22 * size);
            }
        }
        assert_int_equal(in->mesh, scene->instances[i].mesh);
        assert_int_equal(in->root, accel->meshes[in->mesh].root);
        assert_int_equal(in->shade_base, accel->meshes[in->mesh].shade_base);
    }
}

TEST(one_instance_at_the_origin_is_told_apart)
{
    struct affine moved = affine_identity(), same = affine_identity();
    moved.m[7] = 1e-30;
    const struct affine *matrices[] = {NULL, &same, &moved};
    for (int k = 0; k < 3; ++k) {
        struct scene *scene = scene_begin(&silent, "test");
        scene_put(scene, mesh_sphere(1.0, 8, 8), &(struct put){.matrix = matrices[k]});
        own_world world = world_of(scene, by_threads(1));
        const struct accel *accel = world.accel;
        assert_int_equal(accel->single_identity, k < 2);
        assert_int_equal(accel->instance_root, 1u << BVH_COUNT_SHIFT);
        assert_int_equal(accel->instance_depth, 0);
    }
}

/* As a tree over instances, and as a single one. */
TEST(scenes_without_anything)
{
    for (int k = 0; k < 6; ++k) {
        struct scene *scene = scene_begin(&silent, "test");
        if (k / 2 > 0) {
            uint32_t mesh = scene_put_mesh(scene, (struct scene_mesh){0});
            for (int i = 1; i < k / 2; ++i)
                scene_put_again(scene, mesh, NULL);
        }
        own_world world =
            world_of(scene, (whit_accel_params){.instances = k % 2 ? WHIT_INSTANCES_OFF
                                                                   : WHIT_INSTANCES_ON});
        const struct accel *accel = world.accel;
        assert_int_equal(accel->instance_root, BVH_EMPTY_REF);
        assert_int_equal(accel->instance_node_count, 0);
        assert_false(accel->single_identity);
        const struct gpu_ray ray = {.dir = {0.1f, 0.2f, -1}, .t_max = INFINITY};
        struct oracle_hit sure;
        oracle_trace(accel, &ray, false, &sure);
        assert_int_equal(sure.primitive, HIT_NONE);
        for (uint32_t order = ORDER_DISTANCE; order <= ORDER_BASIC; ++order)
            assert_int_equal(
                trace_with(accel, (struct traverse_params){.order = order}, &ray, NULL).primitive,
                HIT_NONE);
    }
}

TEST(many_instances_in_one_place)
{
    enum { COUNT = 3000 };
    struct scene *scene = scene_begin(&silent, "test");
    uint32_t mesh = add_sphere(scene, 4, 3);
    for (int i = 0; i < COUNT; ++i)
        scene_put_again(scene, mesh, NULL);
    own_world world = world_of(scene, by_threads(2));
    const struct accel *accel = world.accel;
    assert_int_equal(accel->instance_node_count, 2 * COUNT);
    assert_true(accel->instance_depth <= 12);
}

TEST(matrices_without_inverse_are_refused)
{
    struct scene *scene = scene_begin(&silent, "test");
    uint32_t mesh = add_sphere(scene, 4, 3);
    scene_put_again(scene, mesh, NULL);
    scene_put_again(scene, mesh, NULL);
    own_world world = world_of(scene, by_threads(1));
    struct accel *accel = world.accel;
    struct scene_pose *pose = &world.pose;
    const double bad[] = {0.0, (double)NAN, (double)INFINITY, 1e-60, 1e60};
    for (int k = 0; k < 5; ++k) {
        pose->instances[1].m[0] = bad[k];
        assert_int_equal(accel_pose(accel, pose), WHIT_ERROR_INPUT);
        assert_string_equal(messages.last_error,
                            "test: instance 1 ``: its matrix has no inverse in range at 0 s");
        assert_int_equal(accel_validate(accel), WHIT_OK); /* unchanged */
    }
    /* These matrices are of rank 2, 1 and 0: no single entry shows that they have no inverse. The
       second one is of rank 3 by rounding alone: in double 0.1 + 0.4 is 0.5, but 0.3 + 0.6 is not
       0.9. */
    const double flat[4][9] = {{1, 2, 3, 4, 5, 6, 5, 7, 9},
                               {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.5, 0.7, 0.9},
                               {1, 2, 3, 2, 4, 6, -1, -2, -3},
                               {0, 0, 0, 0, 0, 0, 0, 0, 0}};
    for (int k = 0; k < 4; ++k) {
        for (int i = 0; i < 9; ++i)
            pose->instances[1].m[i / 3 * 4 + i % 3] = flat[k][i];
        assert_int_equal(accel_pose(accel, pose), WHIT_ERROR_INPUT);
    }
    pose->instances[1] = affine_identity();
    pose->instances[1].m[0] = -1.0;
    assert_int_equal(accel_pose(accel, pose), WHIT_OK);
}

/* ---- Moving instances ---- */

enum { MOVING = 60 };

static const whit_accel_params ways[] = {
    {.instance_build = WHIT_BUILD_BINNED},
    {.instance_build = WHIT_BUILD_MEDIAN},
    {.instance_build = WHIT_BUILD_BINNED, .instance_refit = true},
    {.instance_build = WHIT_BUILD_MEDIAN, .instance_refit = true},
};
enum { WAYS = sizeof ways / sizeof *ways };

static struct scene *moving_scene(void)
{
    struct scene *scene = scene_begin(&silent, "test");
    add_sphere(scene, 12, 8);
    add_sphere(scene, 6, 5);
    uint32_t empty = scene_put_mesh(scene, (struct scene_mesh){0});
    for (uint32_t i = 0; i < MOVING; ++i)
        scene_put_again(scene, i % 16 == 7 ? empty : i % 2, NULL);
    return scene;
}

/* Moves instances of various sizes and shapes, also mirrored ones, through each other. */
static void move_all(struct scene_pose *pose, double t)
{
    for (uint32_t i = 0; i < pose->instance_count; ++i) {
        double a = 0.7 * i + t, size = 1.1 + 0.7 * sin(1.3 * i + 2.0 * t);
        pose->instances[i] = placed(9.0 * sin(a), 5.0 * cos(1.7 * a), 8.0 * sin(0.6 * a + i), a,
                                    i % 3 ? size : -size, 0.5 * size, 1.5 * size);
    }
}

/* Checks that random rays have the same hits in both; gives how many of `count` rays hit. */
static uint32_t same_hits(const struct accel *a, const struct accel *b, uint32_t count)
{
    uint32_t met = 0;
    for (uint32_t i = 0; i < count; ++i) {
        struct gpu_ray ray = ray_from_cube(10.0f, random_point(8.0f));
        struct gpu_hit x = trace(a, &ray);
        struct gpu_hit y = trace_with(b, (struct traverse_params){.order = ORDER_SIGN}, &ray, NULL);
        assert_memory_equal(&x, &y, sizeof x);
        met += x.primitive != HIT_NONE;
    }
    return met;
}

/* Compares each way of updating with a tree built anew, over a thousand steps. */
TEST(moved_instances_are_hit_alike_whatever_the_tree)
{
    own_world fresh = world_of(moving_scene(), (whit_accel_params){0});
    struct accel *all[WAYS];
    for (size_t w = 0; w < WAYS; ++w)
        all[w] = accel_of(fresh.scene, ways[w]);
    size_t mesh_nodes = all[0]->node_count - all[0]->instance_node_capacity;
    own_memory struct gpu_bvh_node *kept = malloc(mesh_nodes * sizeof *kept);
    assert_non_null(kept);
    memcpy(kept, all[2]->nodes + all[2]->instance_node_capacity, mesh_nodes * sizeof *kept);
    uint32_t met = 0;
    for (int step = 0; step < 1000; ++step) {
        move_all(&fresh.pose, 0.01 * step);
        assert_int_equal(accel_pose(fresh.accel, &fresh.pose), WHIT_OK);
        for (size_t w = 0; w < WAYS; ++w) {
            random_state = (uint64_t)step;
            assert_int_equal(accel_pose(all[w], &fresh.pose), WHIT_OK);
            met += same_hits(fresh.accel, all[w], 40);
            if (step % 50 == 0)
                assert_int_equal(accel_validate(all[w]), WHIT_OK);
        }
    }
    assert_true(met > 160 * 1000 / 10);
    assert_memory_equal(kept, all[2]->nodes + all[2]->instance_node_capacity,
                        mesh_nodes * sizeof *kept);
    for (size_t w = 0; w < WAYS; ++w)
        accel_destroy(all[w]);
}

/* A refitted tree keeps the topology of its first pose; a rebuilt one follows the instances. */
TEST(only_a_rebuild_changes_the_tree)
{
    for (size_t w = 0; w < WAYS; ++w) {
        own_world world = world_of(moving_scene(), ways[w]);
        struct accel *accel = world.accel;
        struct gpu_bvh_node before[2 * MOVING];
        uint32_t count = accel->instance_node_count, links = 0, boxes = 0, axes = 0;
        assert_true(count <= 2 * MOVING);
        memcpy(before, accel->nodes, count * sizeof *before);
        move_all(&world.pose, 3.0);
        assert_int_equal(accel_pose(accel, &world.pose), WHIT_OK);
        assert_int_equal(accel->instance_node_count, count);
        for (uint32_t i = 0; i < count; ++i) {
            links += before[i].first != accel->nodes[i].first;
            boxes += memcmp(before[i].lo, accel->nodes[i].lo, sizeof before[i].lo) != 0;
            axes += before[i].count != accel->nodes[i].count;
        }
        assert_true(boxes > count / 2);
        assert_true(axes > 0);
        assert_int_equal(links == 0, ways[w].instance_refit);
    }
}

/* A regression: once only the first object was drawn. */
TEST(every_instance_is_hit)
{
    enum { SIDE = 12 };
    for (size_t w = 0; w < 2 * WAYS; ++w) {
        struct scene *scene = scene_begin(&silent, "test");
        uint32_t mesh = add_sphere(scene, 8, 6);
        for (int i = 0; i < SIDE * SIDE; ++i)
            scene_put_again(scene, mesh, NULL);
        own_world world = world_of(scene, ways[w / 2]);
        for (int i = 0; i < SIDE * SIDE; ++i)
            world.pose.instances[i] = placed(3.0 * (w % 2 ? i / SIDE : i % SIDE),
                                             3.0 * (w % 2 ? i % SIDE : i / SIDE), 0, i, 1, 1, 1);
        assert_int_equal(accel_pose(world.accel, &world.pose), WHIT_OK);
        for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
            const double *m = world.pose.instances[i].m;
            struct gpu_ray ray = ray_along(vec3_make((float)m[3] + 0.1f, (float)m[7] + 0.2f, -9.0f),
                                           vec3_make(0, 0, 1));
            const struct traverse_params basic = {.order = ORDER_BASIC};
            assert_int_equal(trace_with(world.accel, basic, &ray, NULL).instance, i);
        }
    }
}

/* ---- Flags and filters of records for shadow rays ---- */

/* Materials are grey except for the values given here. `flags` and `shadow`: what the records of
   their triangles must have. */
static const struct {
    const char *name;
    float transmission[3], opacity; /* opacity 0 stands for 1 */
    enum scene_alpha alpha;
    bool texture, lamp;
    uint32_t flags, shadow;
} materials[] = {
    {.name = "plain"},
    {.name = "glass", /* half of the light: 64 units of 1/64 stop */
     .transmission = {0.5f, 1.0f, 0.0f},
     .flags = TRIANGLE_FILTER | TRIANGLE_GLASS,
     .shadow = 64u | 0u << 10 | 1023u << 20},
    {.name = "blended",
     .alpha = SCENE_ALPHA_BLEND,
     .opacity = 0.75f,
     .flags = TRIANGLE_FILTER,
     .shadow = 128u | 128u << 10 | 128u << 20},
    {.name = "blended glass", /* a quarter beside it, the rest through it */
     .alpha = SCENE_ALPHA_BLEND,
     .opacity = 0.75f,
     .transmission = {0.0f, 0.0f, 1.0f},
     .flags = TRIANGLE_FILTER | TRIANGLE_GLASS,
     .shadow = 128u | 128u << 10 | 0u << 20},
    {.name = "blended, opaque", .alpha = SCENE_ALPHA_BLEND},
    {.name = "opacity ignored", .opacity = 0.25f},
    {.name = "mask", .alpha = SCENE_ALPHA_MASK, .texture = true, .flags = TRIANGLE_CUTOUT},
    {.name = "mask, solid", .alpha = SCENE_ALPHA_MASK},
    {.name = "lamp", .lamp = true, .flags = TRIANGLE_NO_SHADOW},
};

TEST(materials_become_bits)
{
    for (size_t i = 0; i < sizeof materials / sizeof *materials; ++i) {
        struct scene *scene = scene_begin(&silent, "test");
        struct scene_material material = material_grey("m");
        memcpy(material.transmission, materials[i].transmission, sizeof material.transmission);
        material.opacity = materials[i].opacity > 0.0f ? materials[i].opacity : material.opacity;
        material.alpha = materials[i].alpha;
        material.alpha_cutoff = 0.5f;
        if (materials[i].texture)
            material.textures[SCENE_SLOT_DIFFUSE].texture = 0;
        for (int c = 0; c < 3 && materials[i].lamp; ++c)
            material.emission[c] = 10.0f;
        scene_put_texture(scene, 1, 1, (uint8_t[4]){0});
        scene_put(scene, mesh_sphere(1.0, 4, 3), &(struct put){.material = &material});
        own_world world = world_of(scene, by_threads(1));
        const struct gpu_triangle *triangle = &world.accel->triangles[0];
        if (triangle->flags != materials[i].flags || triangle->shadow != materials[i].shadow)
            fail_msg("%s: flags %x, shadow %x", materials[i].name, triangle->flags,
                     triangle->shadow);
    }
}

/* ---- Broken trees ---- */

TEST(broken_scenes_are_refused)
{
    own_world world = world_of(mixed_scene(), by_threads(2));
    struct accel *accel = world.accel;
    struct accel_mesh *mesh = &accel->meshes[1];
    struct gpu_triangle *triangle = &accel->triangles[mesh->first_triangle];
    struct gpu_instance *instance = &accel->instances[3];
    const struct change changes[] = {
        {&triangle->primitive, triangle->primitive + 1},
        {&triangle->v1[0], float_bits(triangle->v1[0] + 1.0f)},
        {&triangle->v2[2], float_bits(triangle->v2[2] * 0.999f)},
        {&mesh->first_node, mesh->first_node + 2},
        {&mesh->root, mesh->root ^ 1},
        {&mesh->depth, mesh->depth + 1},
        {&accel->mesh_depth, accel->mesh_depth + 1},
        {&instance->root, instance->root ^ 2},
        {&instance->origin_x, float_bits(instance->origin_x + 3.0f)},
        {&accel->instance_depth, accel->instance_depth + 1},
        {&accel->nodes[accel->nodes[0].first].hi[0], float_bits(1e-3f)},
        {&accel->nodes[1].lo[0], float_bits(-1e5f)},
    };
    check_changes(accel, changes, sizeof changes / sizeof *changes);
}
