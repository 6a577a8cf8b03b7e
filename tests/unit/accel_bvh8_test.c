/* Trees with eight children per node have the leaves of the binary trees, each once and with the
   same box. */
#include "../wrapped.h"
#include "accel/bvh8.h"
#include "accel/pose.h"
#include "accel_fixture.h"
#include "unit.h"

struct leaves {
    struct gpu_bvh_node all[20000];
    uint32_t count, depth;
};

static void add_leaf(struct leaves *leaves, const struct gpu_bvh_node *leaf)
{
    assert_true(leaves->count < sizeof leaves->all / sizeof *leaves->all);
    leaves->all[leaves->count] = *leaf;
    leaves->all[leaves->count++].count = bvh_count(leaf);
}

/* Collects all leaves. `width`: children per node. `ref`: in binary trees the first child's index,
   in trees of eight the node's. */
static void collect(const struct gpu_bvh_node *nodes, uint32_t ref, uint32_t width, uint32_t depth,
                    struct leaves *leaves)
{
    const struct gpu_bvh_node *children = &nodes[width == 8 ? (size_t)ref * 8 : ref];
    leaves->depth = depth > leaves->depth ? depth : leaves->depth;
    for (uint32_t i = 0; i < width; ++i) {
        bool absent = width == 8 && children[i].lo[0] == 3e38f;
        if (bvh_count(&children[i]) > 0 && !absent)
            add_leaf(leaves, &children[i]);
        else if (!absent)
            collect(nodes, children[i].first, width, depth + 1, leaves);
    }
}

static int compare_leaves(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct gpu_bvh_node));
}

static void check_tree(const struct accel *accel, uint32_t root, uint32_t root8, uint32_t depth8)
{
    own_memory struct leaves *two = calloc(1, sizeof *two), *eight = calloc(1, sizeof *eight);
    assert_true(two && eight);
    collect(accel->nodes, root, 2, 1, two);
    collect(accel->bvh8.nodes, root8, 8, 1, eight);
    assert_int_equal(two->count, eight->count);
    qsort(two->all, two->count, sizeof *two->all, compare_leaves);
    qsort(eight->all, eight->count, sizeof *eight->all, compare_leaves);
    assert_memory_equal(two->all, eight->all, two->count * sizeof *two->all);
    assert_true(eight->depth <= depth8 && (two->count <= 8 || eight->depth < two->depth));
    print_message("  %u leaves, depth %u of two, %u of eight\n", two->count, two->depth,
                  eight->depth);
}

static struct world world_of_rings(bool flat)
{
    struct scene *scene = scene_begin(&silent, "wide");
    scene_put(scene, mesh_terrain(10.0, 2.0, 60, 3), NULL);
    uint32_t ring = scene_put_mesh(scene, mesh_torus(1.0, 0.3, 20, 10));
    random_state = 5;
    for (int i = 0; i < 30; ++i) {
        struct affine placed = placement_random(&random_state, 4.0, i % 3 == 0);
        scene_put_again(scene, ring, &(struct put){.matrix = &placed});
    }
    return world_of(
        scene, (whit_accel_params){.instances = flat ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON});
}

static void check_trees(struct accel *accel)
{
    assert_int_equal(accel_widen(accel), WHIT_OK);
    for (uint32_t i = 0; i < accel->mesh_count; ++i)
        check_tree(accel, accel->meshes[i].root, accel->bvh8.mesh_roots[i], accel->bvh8.mesh_depth);
    if (!accel->flat)
        check_tree(accel, accel->instance_root, accel->bvh8.instance_root,
                   accel->bvh8.instance_depth);
}

/* The second time only the trees of meshes that have moved are made again. */
TEST(leaves_are_those_of_two)
{
    for (int flat = 0; flat < 2; ++flat) {
        own_world world = world_of_rings(flat);
        check_trees(world.accel);
        check_trees(world.accel);
    }
}

static uint32_t reallocs_left = UINT32_MAX;

WRAPPED(void *, realloc, void *block, size_t size_bytes)
{
    return reallocs_left-- > 0 ? __real_realloc(block, size_bytes) : NULL;
}

/* Where memory ran out, the next try begins anew. */
TEST(trees_made_in_part_are_not_kept)
{
    own_world world = world_of_rings(false);
    for (uint32_t left = 0; left < 3; ++left) {
        reallocs_left = left;
        whit_result result = accel_widen(world.accel);
        reallocs_left = UINT32_MAX;
        assert_int_equal(result, WHIT_ERROR_MEMORY);
        check_trees(world.accel);
        accel_bvh8_finish(&world.accel->bvh8);
    }
}
