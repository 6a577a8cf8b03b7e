#include "oracle/conservative.h"

#include <math.h>

#include "accel/accel.h"

#define INTERVAL_GROWTH 0x1p-18
#define DENORMAL        0x1p-149

enum { STACK_SIZE = 512 };

/* Like fmin and fmax, which compilers may make calls of. */
static double smaller(double a, double b)
{
    return a < b ? a : b;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Whether an interval that begins at t = `start` may still matter. */
static bool begins_in_time(const struct conservative_walk *walk, double start)
{
    return start - INTERVAL_GROWTH * fabs(start) - DENORMAL <=
           smaller(walk->limit, walk->ray.t_max);
}

double conservative_entry(const struct conservative_walk *walk, const float box_lo[3],
                          const float box_hi[3])
{
    const struct conservative_ray *ray = &walk->ray;
    double lo[3], hi[3], far = 0.0;
    for (int i = 0; i < 3; ++i) {
        lo[i] = (double)box_lo[i] - ray->origin[i];
        hi[i] = (double)box_hi[i] - ray->origin[i];
        far = larger(far, larger(fabs(lo[i]), fabs(hi[i])));
    }
    double growth = far * ray->growth + ray->margin;
    double start = -INFINITY, end = INFINITY;
    for (int i = 0; i < 3; ++i) {
        if (ray->dir[i] == 0.0) {
            if (lo[i] - growth > 0.0 || hi[i] + growth < 0.0)
                return INFINITY;
            continue;
        }
        double a = (lo[i] - growth) / ray->dir[i], b = (hi[i] + growth) / ray->dir[i];
        start = larger(start, smaller(a, b));
        end = smaller(end, larger(a, b));
    }
    bool reached = start <= end && begins_in_time(walk, start) &&
                   end + INTERVAL_GROWTH * fabs(end) + DENORMAL >= ray->t_min;
    return reached ? start : INFINITY;
}

/* A node, and the t at which the ray enters its box. */
struct entered {
    uint32_t node;
    double entry;
};

static struct entered enter_node(const struct conservative_walk *walk, uint32_t index)
{
    const struct gpu_bvh_node *node = &walk->accel->nodes[index];
    return (struct entered){index, conservative_entry(walk, node->lo, node->hi)};
}

static void visit_records(struct conservative_walk *walk, uint32_t first, uint32_t count,
                          uint32_t instance)
{
    for (uint32_t i = 0; i < count && !walk->done; ++i) {
        bool flat = walk->accel->flat;
        uint32_t flags = walk->accel->triangles[first + i].flags;
        walk->visit(walk, first + i, flat ? flags >> TRIANGLE_INSTANCE_SHIFT : instance);
    }
}

static void visit_instance(struct conservative_walk *walk, uint32_t index);

/* Walks the tree of a mesh, of this instance, or with HIT_NONE that over instances. */
static void walk_tree(struct conservative_walk *walk, uint32_t root, uint32_t instance)
{
    struct entered stack[STACK_SIZE];
    uint32_t top = 0;
    stack[top++] = enter_node(walk, root);
    while (top > 0 && !walk->done) {
        struct entered at = stack[--top];
        const struct gpu_bvh_node *node = &walk->accel->nodes[at.node];
        if (at.entry == INFINITY || !begins_in_time(walk, at.entry))
            continue;
        if (bvh_count(node) > 0) {
            if (instance == HIT_NONE)
                visit_instance(walk, node->first);
            else
                visit_records(walk, node->first, bvh_count(node), instance);
            continue;
        }
        struct entered a = enter_node(walk, node->first), b = enter_node(walk, node->first + 1);
        bool b_nearer = b.entry < a.entry;
        stack[top++] = b_nearer ? a : b;
        stack[top++] = b_nearer ? b : a;
    }
}

static void visit_mesh(struct conservative_walk *walk, const struct accel_mesh *mesh,
                       uint32_t instance)
{
    if (walk->brute)
        visit_records(walk, mesh->first_triangle, mesh->record_count, instance);
    else if (mesh->node_count > 0)
        walk_tree(walk, mesh->first_node, instance);
}

static void visit_instance(struct conservative_walk *walk, uint32_t index)
{
    const struct gpu_instance *instance = &walk->accel->instances[index];
    struct conservative_ray world = walk->ray;
    if (instance->root == BVH_EMPTY_REF)
        return;
    if (walk->accel->single_identity || walk->enter(walk, index))
        visit_mesh(walk, &walk->accel->meshes[instance->mesh], index);
    walk->ray = world;
}

void conservative_walk_run(struct conservative_walk *walk)
{
    const struct accel *accel = walk->accel;
    walk->brute |= accel->mesh_depth + 2 > STACK_SIZE || accel->instance_depth + 2 > STACK_SIZE;
    if (accel->flat) {
        visit_mesh(walk, &accel->meshes[0], 0);
        return;
    }
    if (walk->brute) {
        for (uint32_t i = 0; i < accel->instance_count && !walk->done; ++i)
            visit_instance(walk, i);
    } else if (accel->instance_root != BVH_EMPTY_REF) {
        walk_tree(walk, 0, HIT_NONE);
    }
}
