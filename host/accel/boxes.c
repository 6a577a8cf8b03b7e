#include "accel/boxes.h"

struct walk {
    const struct accel *accel;
    const struct affine *to_world; /* NULL: nodes are in world space */
    uint32_t instance, level;
    bool (*fn)(void *user, const whit_box *box);
    void *user;
};

static bool give(const struct walk *walk, const struct gpu_bvh_node *node, uint32_t level)
{
    whit_box box = {.instance = walk->instance, .level = level, .leaf = bvh_count(node) > 0};
    for (uint32_t i = 0; i < 8; ++i) {
        double corner[3];
        for (uint32_t k = 0; k < 3; ++k)
            corner[k] = (double)(i >> k & 1 ? node->hi[k] : node->lo[k]);
        if (walk->to_world)
            affine_point(walk->to_world, corner, corner);
        for (int k = 0; k < 3; ++k)
            box.corners[i][k] = (float)corner[k];
    }
    return walk->fn(walk->user, &box);
}

/* The recursion is bounded by the depth of trees, BVH_DEPTH_MAX. */
static bool visit(const struct walk *walk, uint32_t index, uint32_t level)
{
    const struct gpu_bvh_node *node = &walk->accel->nodes[index];
    if (level == walk->level || bvh_count(node) > 0)
        return give(walk, node, level);
    return visit(walk, node->first, level + 1) && visit(walk, node->first + 1, level + 1);
}

void accel_boxes(const struct accel *accel, const struct scene_pose *pose, bool over_instances,
                 uint32_t level, bool (*fn)(void *user, const whit_box *box), void *user)
{
    struct walk walk = {
        .accel = accel, .instance = HIT_NONE, .level = level, .fn = fn, .user = user};
    if (over_instances) {
        if (accel->instance_node_count > 0 && accel->instance_root != BVH_EMPTY_REF)
            visit(&walk, 0, 0);
        return;
    }
    uint32_t count = accel->flat ? 1 : pose->instance_count;
    for (uint32_t i = 0; i < count; ++i) {
        const struct accel_mesh *mesh =
            &accel->meshes[accel->flat ? 0 : accel->scene->instances[i].mesh];
        walk.instance = accel->flat ? HIT_NONE : i;
        walk.to_world = accel->flat ? NULL : &pose->instances[i];
        if (mesh->root != BVH_EMPTY_REF && !visit(&walk, mesh->first_node, 0))
            return;
    }
}
