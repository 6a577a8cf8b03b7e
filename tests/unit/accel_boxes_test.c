/* The boxes that views draw: the nodes at a level of a tree and the leaves above it, in world
   space. */
#include "accel_fixture.h"

#include "accel/boxes.h"
#include "unit.h"

struct seen {
    whit_box boxes[4096];
    uint32_t count, max;
};

static bool keep_box(void *user, const whit_box *box)
{
    struct seen *seen = user;
    assert_in_range(seen->count, 0, 4095);
    seen->boxes[seen->count++] = *box;
    return seen->count < seen->max;
}

static struct world placed_spheres(bool flatten)
{
    struct scene *scene = scene_begin(&silent, "spheres");
    scene_put_mesh(scene, mesh_sphere(1.0, 16, 8));
    const double turned[4] = {0.0, 0.3826834323650898, 0.0, 0.9238795325112867};
    for (int i = 0; i < 5; ++i) {
        const double to[3] = {4.0 * i, 0.0, 0.0}, scale[3] = {1.0, 2.0, 1.0};
        struct affine m = affine_from_trs(to, turned, scale);
        scene_put_again(scene, 0, &(struct put){.matrix = &m});
    }
    return world_of(
        scene, (whit_accel_params){.instances = flatten ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON});
}

/* Collects the boxes of a level, at most `max`. */
static const struct seen *see(const struct world *world, bool instances, uint32_t level,
                              uint32_t max)
{
    static struct seen seen;
    seen.count = 0;
    seen.max = max;
    accel_boxes(world->accel, &world->pose, instances, level, keep_box, &seen);
    return &seen;
}

/* Checks that every vertex of an instance is in one of its boxes, in the box's space, which its
   three edges span. */
static void check_covered(const struct world *w, const struct seen *seen, uint32_t instance)
{
    const struct scene_mesh *mesh = &w->scene->meshes[0];
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        bool inside = false;
        double p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = (double)mesh->positions[3 * v + (uint32_t)k];
        affine_point(&w->pose.instances[instance], p, p);
        for (uint32_t b = 0; b < seen->count && !inside; ++b) {
            const whit_box *box = &seen->boxes[b];
            inside = box->instance == instance || box->instance == HIT_NONE;
            for (int k = 0; k < 3 && inside; ++k) {
                double along = 0.0, length = 0.0;
                for (int c = 0; c < 3; ++c) {
                    double edge = (double)box->corners[1 << k][c] - (double)box->corners[0][c];
                    along += (p[c] - (double)box->corners[0][c]) * edge;
                    length += edge * edge;
                }
                inside = along >= -1e-4 * length - 1e-5 && along <= length * 1.0001 + 1e-5;
            }
        }
        assert_true(inside);
    }
}

TEST(mesh_trees_level_by_level)
{
    own_world w = placed_spheres(false);
    assert_int_equal(see(&w, false, 0, UINT32_MAX)->count, 5); /* one root for each instance */
    for (uint32_t level = 0; level < 6; ++level) {
        const struct seen *seen = see(&w, false, level, UINT32_MAX);
        for (uint32_t i = 0; i < seen->count; ++i) {
            const whit_box *box = &seen->boxes[i];
            assert_true(box->level == level || (box->leaf && box->level < level));
        }
        for (uint32_t i = 0; i < 5; ++i)
            check_covered(&w, seen, i);
    }
    const struct seen *leaves = see(&w, false, 127, UINT32_MAX);
    for (uint32_t i = 0; i < leaves->count; ++i)
        assert_true(leaves->boxes[i].leaf);
}

TEST(instances_and_one_tree)
{
    own_world w = placed_spheres(false), flat = placed_spheres(true);
    const struct seen *root = see(&w, true, 0, UINT32_MAX);
    assert_int_equal(root->count, 1);
    check_covered(&w, root, 0);
    check_covered(&w, root, 4);
    assert_int_equal(see(&w, true, 127, UINT32_MAX)->count, 5); /* one leaf for each instance */
    assert_int_equal(see(&flat, true, 2, UINT32_MAX)->count, 0);
    const struct seen *seen = see(&flat, false, 2, UINT32_MAX);
    assert_int_equal(seen->count, 4);
    for (uint32_t i = 0; i < 5; ++i)
        check_covered(&flat, seen, i);
}

TEST(who_asks_can_stop)
{
    own_world w = placed_spheres(false);
    assert_int_equal(see(&w, false, 4, 3)->count, 3);
}
