/* Checks that a tree is sound, and that it is the tree of these primitives. Nothing read here is
   trusted: every index is checked before it is followed, and no node is entered twice. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/extent.h"
#include "accel/flat.h"
#include "accel/pose.h"
#include "accel/validate.h"
#include "base/array.h"
#include "bvh/complete.h"

/* One tree inside arrays that may hold others. */
struct view {
    const whit_log *log;
    const char *name;
    const struct gpu_bvh_node *nodes; /* the whole array */
    uint32_t first_node, node_count;  /* those of this tree; the first is the root */
    uint32_t first_slot, slot_count;  /* the slots that its leaves may name */
    uint32_t primitive_count; /* each is in the leaves once, or at least once with `split` */
    bool split;               /* primitives may have several slots; every slot is used */
    uint32_t leaf_limit;
    /* The primitive in a slot, and the box of the record there. */
    uint32_t (*primitive)(const void *user, uint32_t slot);
    struct bvh_box (*box)(const void *user, uint32_t slot);
    const void *user;
};

/* A node still to be checked. */
struct visit {
    uint32_t node, depth;
};

struct walk {
    struct visit *stack;
    uint8_t *pair_seen, *slot_seen, *primitive_seen;
    struct bvh_box *parts; /* with `split`: for each primitive, the union of its parts in leaves */
    uint32_t top, pairs, slots, primitives;
    uint32_t depth;
};

#define REFUSE(view, ...)                                                                          \
    do {                                                                                           \
        refuse((view), __VA_ARGS__);                                                               \
        return false;                                                                              \
    } while (0)

static void refuse(const struct view *view, const char *what, uint32_t where)
{
    log_error(view->log, "%s: %s (%u)", view->name, what, where);
}

static bool box_holds(const float lo[3], const float hi[3], const float inner_lo[3],
                      const float inner_hi[3])
{
    bool holds = true;
    for (int i = 0; i < 3; ++i)
        holds &= lo[i] <= inner_lo[i] && hi[i] >= inner_hi[i]; /* false for NaN */
    return holds;
}

/* Checks that the box of leaf `node` overlaps `box`, the box of one of its primitives, and adds the
   overlap to the bounds of all parts of that primitive found so far. */
static bool check_part(const struct view *view, struct walk *walk, uint32_t primitive,
                       const struct bvh_box *box, const struct gpu_bvh_node *node)
{
    struct bvh_box *parts = &walk->parts[primitive];
    for (int i = 0; i < 3; ++i) {
        float lo = node->lo[i] > box->lo[i] ? node->lo[i] : box->lo[i];
        float hi = node->hi[i] < box->hi[i] ? node->hi[i] : box->hi[i];
        if (!(lo <= hi))
            REFUSE(view, "a leaf holds nothing of its primitive", primitive);
        parts->lo[i] = lo < parts->lo[i] ? lo : parts->lo[i];
        parts->hi[i] = hi > parts->hi[i] ? hi : parts->hi[i];
    }
    return true;
}

static bool check_slot(const struct view *view, struct walk *walk, uint32_t slot,
                       const struct gpu_bvh_node *node)
{
    uint32_t primitive = view->primitive(view->user, slot);
    if (primitive >= view->primitive_count)
        REFUSE(view, "a leaf names a primitive out of range, at record", slot);
    if (walk->slot_seen[slot - view->first_slot]++)
        REFUSE(view, "two leaves share a record", slot);
    if (walk->primitive_seen[primitive] && !view->split)
        REFUSE(view, "a primitive is in the tree twice", primitive);
    for (uint32_t other = node->first; view->split && other < slot; ++other) {
        if (view->primitive(view->user, other) == primitive)
            REFUSE(view, "a primitive is in a leaf twice", primitive);
    }
    walk->primitives += !walk->primitive_seen[primitive];
    walk->primitive_seen[primitive] = 1;
    ++walk->slots;
    struct bvh_box box = view->box(view->user, slot);
    if (view->split)
        return check_part(view, walk, primitive, &box, node);
    if (!box_holds(node->lo, node->hi, box.lo, box.hi))
        REFUSE(view, "a leaf does not contain its primitive", primitive);
    return true;
}

/* Checks that the parts of each primitive together cover its box. */
static bool check_parts(const struct view *view, const struct walk *walk)
{
    for (uint32_t i = 0; i < view->slot_count; ++i) {
        uint32_t slot = view->first_slot + i;
        struct bvh_box box = view->box(view->user, slot);
        const struct bvh_box *parts = &walk->parts[view->primitive(view->user, slot)];
        if (!box_holds(parts->lo, parts->hi, box.lo, box.hi))
            REFUSE(view, "the leaves of a primitive do not cover it, record", slot);
    }
    return true;
}

static bool check_leaf(const struct view *view, struct walk *walk, struct visit at)
{
    const struct gpu_bvh_node *node = &view->nodes[at.node];
    uint32_t end = view->first_slot + view->slot_count;
    if (bvh_count(node) > view->leaf_limit)
        REFUSE(view, "a leaf is over the limit, node", at.node);
    if (node->first < view->first_slot || node->first > end || bvh_count(node) > end - node->first)
        REFUSE(view, "a leaf reaches out of range, node", at.node);
    for (uint32_t i = 0; i < bvh_count(node); ++i) {
        if (!check_slot(view, walk, node->first + i, node))
            return false;
    }
    if (at.depth > walk->depth)
        walk->depth = at.depth;
    return true;
}

static bool check_inner(const struct view *view, struct walk *walk, struct visit at)
{
    const struct gpu_bvh_node *node = &view->nodes[at.node];
    uint32_t end = view->first_node + view->node_count;
    if (node->first % 2 != 0)
        REFUSE(view, "children do not start at an even node, node", at.node);
    if (node->first < view->first_node + 2 || node->first >= end)
        REFUSE(view, "children out of range, node", at.node);
    if (walk->pair_seen[(node->first - view->first_node) / 2]++)
        REFUSE(view, "children have two parents, node", at.node);
    for (uint32_t i = 0; i < 2; ++i) {
        const struct gpu_bvh_node *child = &view->nodes[node->first + i];
        if (!box_holds(node->lo, node->hi, child->lo, child->hi))
            REFUSE(view, "a child is not inside its parent, node", node->first + i);
        walk->stack[walk->top++] = (struct visit){node->first + i, at.depth + 1};
    }
    ++walk->pairs;
    return true;
}

static bool is_first_of_pair(const struct view *view, uint32_t index)
{
    uint32_t local = index - view->first_node;
    return local >= 2 && local % 2 == 0;
}

/* `count` may hold only the number of primitives and, in the first node of a pair, its axis and
   which node is the lower one. */
static bool check_count(const struct view *view, uint32_t index)
{
    uint32_t allowed = BVH_COUNT_MASK;
    if (is_first_of_pair(view, index))
        allowed |= BVH_AXIS_MASK << BVH_AXIS_SHIFT | BVH_SECOND_LOW;
    if (view->nodes[index].count & ~allowed)
        REFUSE(view, "stray bits in a count, node", index);
    return true;
}

static bool check_axis(const struct view *view, uint32_t index)
{
    if (!is_first_of_pair(view, index))
        return true;
    struct gpu_bvh_node pair[2] = {view->nodes[index], view->nodes[index + 1]};
    bvh_set_axis(pair);
    if (view->nodes[index].count != pair[0].count)
        REFUSE(view, "the axis is not that of the pair, node", index);
    return true;
}

static bool walk_run(const struct view *view, struct walk *walk)
{
    walk->stack[walk->top++] = (struct visit){view->first_node, 0};
    while (walk->top > 0) {
        struct visit at = walk->stack[--walk->top];
        const struct gpu_bvh_node *node = &view->nodes[at.node];
        if (!bvh_box_is_sane(node->lo, node->hi))
            REFUSE(view, "a box is not finite, or inside out, node", at.node);
        if (!check_count(view, at.node) ||
            !(bvh_count(node) > 0 ? check_leaf(view, walk, at) : check_inner(view, walk, at)) ||
            !check_axis(view, at.node))
            return false;
    }
    if (2 + 2 * (uint64_t)walk->pairs != view->node_count)
        REFUSE(view, "nodes are not reached from the root; reached pairs", walk->pairs);
    if (walk->primitives != view->primitive_count)
        REFUSE(view, "primitives are missing; found", walk->primitives);
    if (!view->split)
        return true;
    if (walk->slots != view->slot_count)
        REFUSE(view, "records are in no leaf; found", walk->slots);
    return check_parts(view, walk);
}

static bool walk_alloc(const struct view *view, struct walk *walk)
{
    /* Each pair enters the stack once, so node_count bounds the stack. */
    *walk = (struct walk){
        .stack = array_alloc((size_t)view->node_count + 2, sizeof *walk->stack),
        .pair_seen = array_alloc_zeroed(view->node_count / 2 + 1, 1),
        .slot_seen = array_alloc_zeroed(view->slot_count, 1),
        .primitive_seen = array_alloc_zeroed(view->primitive_count, 1),
    };
    if (!walk->stack || !walk->pair_seen || !walk->slot_seen || !walk->primitive_seen)
        return false;
    if (!view->split)
        return true;
    walk->parts = array_alloc(view->primitive_count, sizeof *walk->parts);
    for (uint32_t i = 0; walk->parts && i < view->primitive_count; ++i)
        walk->parts[i] =
            (struct bvh_box){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    return walk->parts != NULL;
}

static void walk_finish(struct walk *walk)
{
    free(walk->stack);
    free(walk->pair_seen);
    free(walk->slot_seen);
    free(walk->primitive_seen);
    free(walk->parts);
}

static bool stated(const struct view *view, const char *what, uint32_t said, uint32_t found)
{
    if (said == found)
        return true;
    log_error(view->log, "%s: the stated %s is %u, but it is %u", view->name, what, said, found);
    return false;
}

static uint32_t root_of(const struct view *view)
{
    return view->node_count ? accel_node_ref(&view->nodes[view->first_node]) : BVH_EMPTY_REF;
}

static whit_result nodes_check(const struct view *view, struct walk *walk)
{
    if ((uintptr_t)&view->nodes[view->first_node] % 64 != 0 || view->node_count % 2 != 0) {
        refuse(view, "nodes are not in aligned pairs; count", view->node_count);
        return WHIT_ERROR_FAILED;
    }
    whit_result result = WHIT_ERROR_MEMORY;
    if (walk_alloc(view, walk))
        result = walk_run(view, walk) ? WHIT_OK : WHIT_ERROR_FAILED;
    else
        log_error(view->log, "%s: out of memory for validation", view->name);
    walk_finish(walk);
    return result;
}

/* Checks the tree of `view`, and the depth and root that are stated for it. */
static whit_result tree_check(const struct view *view, uint32_t depth, uint32_t root)
{
    struct walk walk = {0};
    whit_result result = WHIT_OK;
    if (view->node_count > 0) {
        result = nodes_check(view, &walk);
    } else if (view->primitive_count > 0) {
        refuse(view, "no nodes for primitives", view->primitive_count);
        result = WHIT_ERROR_FAILED;
    }
    if (result == WHIT_OK &&
        !(stated(view, "depth", depth, walk.depth) && stated(view, "root", root, root_of(view))))
        result = WHIT_ERROR_FAILED;
    return result;
}

/* ---- One tree ---- */

struct bvh_user {
    const struct bvh *bvh;
    const struct bvh_box *boxes;
};

static uint32_t bvh_primitive(const void *user, uint32_t slot)
{
    return ((const struct bvh_user *)user)->bvh->order[slot];
}

static struct bvh_box bvh_primitive_box(const void *user, uint32_t slot)
{
    const struct bvh_user *u = user;
    return u->boxes[u->bvh->order[slot]];
}

whit_result bvh_validate(const whit_log *log, const struct bvh *bvh, const struct bvh_box *boxes,
                         uint32_t leaf_limit)
{
    struct bvh_user user = {bvh, boxes};
    struct view view = {
        .log = log,
        .name = "tree",
        .nodes = bvh->nodes,
        .node_count = bvh->node_count,
        .slot_count = bvh->reference_count,
        .primitive_count = bvh->primitive_count,
        .split = bvh->reference_count > bvh->primitive_count,
        .leaf_limit = leaf_limit < BVH_LEAF_MAX ? leaf_limit : BVH_LEAF_MAX,
        .primitive = bvh_primitive,
        .box = bvh_primitive_box,
        .user = &user,
    };
    return tree_check(&view, bvh->depth, root_of(&view));
}

/* ---- Split triangles ---- */

/* The sample points: the triangle's points whose barycentric coordinates are multiples of 1/6,
   corners included; one bit each. */
enum { STEPS = 6, POINTS = (STEPS + 1) * (STEPS + 2) / 2 };

/* A coordinate of sample point (i, j), clamped to the triangle's box against rounding. */
static double point_along(const struct gpu_triangle *t, int i, int j, int axis)
{
    double a = (double)t->v0[axis], b = (double)t->v1[axis], c = (double)t->v2[axis];
    double at = (a * i + b * j + c * (STEPS - i - j)) / STEPS;
    double lo = a < b ? a : b, hi = a > b ? a : b;
    lo = c < lo ? c : lo;
    hi = c > hi ? c : hi;
    return at < lo ? lo : at > hi ? hi : at;
}

static uint32_t points_inside(const struct gpu_triangle *t, const struct gpu_bvh_node *node)
{
    uint32_t inside = 0;
    int point = 0;
    if (t->flags & TRIANGLE_SPHERE) {
        struct bvh_box box = accel_record_box(t);
        bool in = true;
        for (int axis = 0; axis < 3; ++axis)
            in &= box.lo[axis] >= node->lo[axis] && box.hi[axis] <= node->hi[axis];
        return in ? (1u << POINTS) - 1 : 0;
    }
    for (int i = 0; i <= STEPS; ++i) {
        for (int j = 0; i + j <= STEPS; ++j, ++point) {
            bool in = true;
            for (int axis = 0; axis < 3 && in; ++axis) {
                double at = point_along(t, i, j, axis);
                in = at >= (double)node->lo[axis] && at <= (double)node->hi[axis];
            }
            inside |= (uint32_t)in << point;
        }
    }
    return inside;
}

/* For one primitive: a bit for each sample point that is inside its leaves; and 1 + its first slot,
   0: none yet. */
struct seen {
    uint32_t points, slot;
};

/* All records of a primitive must be equal: else a hit would depend on which one a ray meets. */
static bool is_same_record(const struct view *view, const struct gpu_triangle *triangles,
                           struct seen *seen, uint32_t slot)
{
    if (seen->slot == 0)
        seen->slot = slot + 1;
    if (memcmp(&triangles[seen->slot - 1], &triangles[slot], sizeof *triangles) == 0)
        return true;
    REFUSE(view, "two records of one primitive differ", slot);
}

/* Checks split triangles: each must lie in its leaves with all of its area, and be the same
   triangle in each of them. It tests sample points, and does not use the clipper that made the
   parts. */
static whit_result parts_check(const struct view *view, const struct accel *accel)
{
    const struct gpu_bvh_node *nodes = &view->nodes[view->first_node];
    if (!view->split)
        return WHIT_OK;
    struct seen *seen = array_alloc_zeroed(view->primitive_count, sizeof *seen);
    if (!seen)
        return log_failure(view->log, WHIT_ERROR_MEMORY, "%s: out of memory for validation",
                           view->name);
    bool same = true;
    for (uint32_t i = 0; same && i < view->node_count; ++i) {
        for (uint32_t k = 0; same && i != 1 && k < bvh_count(&nodes[i]); ++k) {
            uint32_t slot = nodes[i].first + k;
            struct seen *of = &seen[view->primitive(view->user, slot)];
            of->points |= points_inside(&accel->triangles[slot], &nodes[i]);
            same = is_same_record(view, accel->triangles, of, slot);
        }
    }
    uint32_t first_bad = 0;
    while (first_bad < view->primitive_count && seen[first_bad].points == (1u << POINTS) - 1)
        ++first_bad;
    free(seen);
    if (same && first_bad == view->primitive_count)
        return WHIT_OK;
    if (same)
        refuse(view, "a part of a primitive is in none of its leaves", first_bad);
    return WHIT_ERROR_FAILED;
}

/* ---- Trees of a scene ---- */

struct mesh_user {
    const struct accel *accel;
    const struct scene_mesh *mesh; /* NULL: one tree for all */
};

static uint32_t mesh_primitive(const void *user, uint32_t slot)
{
    return ((const struct mesh_user *)user)->accel->triangles[slot].primitive;
}

static struct bvh_box mesh_primitive_box(const void *user, uint32_t slot)
{
    return accel_record_box(&((const struct mesh_user *)user)->accel->triangles[slot]);
}

/* The record's primitive, numbered through all instances; UINT32_MAX: the record names none. */
static uint32_t flat_primitive(const void *user, uint32_t slot)
{
    const struct accel *accel = ((const struct mesh_user *)user)->accel;
    const struct gpu_triangle *t = &accel->triangles[slot];
    uint32_t instance = t->flags >> TRIANGLE_INSTANCE_SHIFT;
    if (instance >= accel->instance_count)
        return UINT32_MAX;
    uint32_t mesh = accel->scene->instances[instance].mesh;
    if (t->primitive >= scene_mesh_primitives(&accel->scene->meshes[mesh]))
        return UINT32_MAX;
    return accel_flat_first(accel->world, instance) + t->primitive;
}

/* Whether `v` is `p` under the instance's transform, within 8 roundings: the record was computed in
   double, but the instance has its matrix in float. `in` NULL: whether both are the same. */
static bool is_placed(const struct gpu_instance *in, const float *p, const float v[3])
{
    if (!in)
        return memcmp(v, p, 3 * sizeof *v) == 0;
    const float *rows[3] = {in->forward0, in->forward1, in->forward2};
    const float origin[3] = {in->origin_x, in->origin_y, in->origin_z};
    bool placed = true;
    for (int r = 0; r < 3; ++r) {
        double sum = (double)origin[r], size = fabs(sum);
        for (int c = 0; c < 3; ++c) {
            double part = (double)rows[r][c] * (double)p[c];
            sum += part;
            size += fabs(part);
        }
        placed &= fabs(sum - (double)v[r]) <= size * 0x1p-21;
    }
    return placed;
}

/* Whether a record is its triangle or sphere; in a tree for all, under its instance's transform. */
static bool record_matches(const struct mesh_user *user, const struct gpu_triangle *t)
{
    const struct accel *accel = user->accel;
    const struct gpu_instance *in =
        user->mesh ? NULL : &accel->instances[t->flags >> TRIANGLE_INSTANCE_SHIFT];
    const struct scene_mesh *mesh = in ? &accel->scene->meshes[in->mesh] : user->mesh;
    if (!(t->flags & TRIANGLE_SPHERE) != !mesh->sphere_count)
        return false;
    if (mesh->sphere_count) {
        const float *sphere = &mesh->spheres[4 * (size_t)t->primitive];
        double radius = (double)sphere[3] * (in ? (double)in->forward0[0] : 1.0);
        return is_placed(in, sphere, t->v0) &&
               fabs(radius - (double)t->v1[0]) <= (in ? radius * 0x1p-21 : 0.0);
    }
    const uint32_t *corner = &mesh->indices[3 * (size_t)t->primitive];
    return is_placed(in, &mesh->positions[3 * (size_t)corner[0]], t->v0) &&
           is_placed(in, &mesh->positions[3 * (size_t)corner[1]], t->v1) &&
           is_placed(in, &mesh->positions[3 * (size_t)corner[2]], t->v2);
}

static bool records_match(const struct view *view, const struct mesh_user *user)
{
    for (uint32_t i = 0; i < view->slot_count; ++i) {
        if (!record_matches(user, &user->accel->triangles[view->first_slot + i]))
            REFUSE(view, "a record is not its triangle", view->first_slot + i);
    }
    return true;
}

static struct view view_over(const struct accel_mesh *m, const struct mesh_user *user)
{
    const struct accel *accel = user->accel;
    const struct view view = {
        .log = &accel->log,
        .name = !user->mesh        ? "the tree over all triangles"
                : user->mesh->name ? user->mesh->name
                                   : "mesh",
        .nodes = accel->nodes,
        .first_node = m->first_node,
        .node_count = m->node_count,
        .first_slot = m->first_triangle,
        .slot_count = m->record_count,
        .primitive_count = m->triangle_count,
        .split = m->record_count > m->triangle_count,
        .leaf_limit = accel->params.leaf_limit ? accel->params.leaf_limit : 4,
        .primitive = user->mesh ? mesh_primitive : flat_primitive,
        .box = mesh_primitive_box,
        .user = user,
    };
    return view;
}

static whit_result validate_mesh(const struct accel *accel, uint32_t index)
{
    const struct accel_mesh *m = &accel->meshes[index];
    const struct mesh_user user = {accel, &accel->scene->meshes[index]};
    const struct view view = view_over(m, &user);
    bool placed = m->first_node >= accel->instance_node_capacity &&
                  m->first_node <= accel->node_count &&
                  m->node_count <= accel->node_count - m->first_node &&
                  m->first_triangle <= accel->record_count &&
                  m->record_count <= accel->record_count - m->first_triangle &&
                  m->triangle_count == scene_mesh_primitives(user.mesh);
    if (!placed) {
        refuse(&view, "its nodes or triangles are out of range, mesh", index);
        return WHIT_ERROR_FAILED;
    }
    whit_result result = tree_check(&view, m->depth, m->root);
    if (result == WHIT_OK && !records_match(&view, &user))
        result = WHIT_ERROR_FAILED;
    return result == WHIT_OK ? parts_check(&view, accel) : result;
}

static bool flat_instances_match(const struct view *view, const struct accel *accel)
{
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        if (accel->instances[i].mesh != accel->scene->instances[i].mesh)
            REFUSE(view, "an instance does not refer to its mesh", i);
    }
    return true;
}

static whit_result validate_flat(const struct accel *accel)
{
    const struct accel_mesh *m = &accel->meshes[0];
    const struct mesh_user user = {accel, NULL};
    const struct view view = view_over(m, &user);
    if (m->first_node != 0 || m->first_triangle != 0 || m->node_count > accel->node_count ||
        m->record_count != accel->record_count || m->triangle_count > m->record_count ||
        m->triangle_count != accel_flat_first(accel->world, accel->instance_count)) {
        refuse(&view, "its nodes or records are out of range; records", m->record_count);
        return WHIT_ERROR_FAILED;
    }
    if (!flat_instances_match(&view, accel))
        return WHIT_ERROR_FAILED;
    whit_result result = tree_check(&view, m->depth, m->root);
    if (result == WHIT_OK && !(stated(&view, "depth of all meshes", accel->mesh_depth, m->depth) &&
                               records_match(&view, &user)))
        result = WHIT_ERROR_FAILED;
    return result == WHIT_OK ? parts_check(&view, accel) : result;
}

/* ---- The tree over instances ---- */

struct instance_user {
    const struct accel *accel;
    const uint32_t *dense; /* [instance]: its number among those that are not empty */
};

static uint32_t instance_primitive(const void *user, uint32_t slot)
{
    return ((const struct instance_user *)user)->dense[slot];
}

static struct bvh_box instance_box(const void *user, uint32_t slot)
{
    const struct accel *accel = ((const struct instance_user *)user)->accel;
    const struct gpu_instance *in = &accel->instances[slot];
    const float *forward[3] = {in->forward0, in->forward1, in->forward2};
    const float origin[3] = {in->origin_x, in->origin_y, in->origin_z};
    struct bvh_box box;
    double rows[12];
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            rows[4 * r + c] = (double)forward[r][c];
        rows[4 * r + 3] = (double)origin[r];
    }
    struct accel_extent extent = accel_transformed_box(rows, &accel->meshes[in->mesh].box);
    for (int i = 0; i < 3; ++i) {
        box.lo[i] = (float)extent.lo[i];
        box.hi[i] = (float)extent.hi[i];
    }
    return box;
}

/* Numbers the instances that are not empty; false when one does not refer to its mesh. */
static bool instances_number(const struct accel *accel, uint32_t *dense, uint32_t *count)
{
    *count = 0;
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        const struct gpu_instance *in = &accel->instances[i];
        if (in->mesh >= accel->mesh_count || in->root != accel->meshes[in->mesh].root ||
            in->shade_base != accel->meshes[in->mesh].shade_base) {
            log_error(&accel->log, "instances: %u does not refer to its mesh", i);
            return false;
        }
        dense[i] = in->root == BVH_EMPTY_REF ? UINT32_MAX : (*count)++;
    }
    return true;
}

/* Checks the tree over instances. Its leaves name instances; empty ones are not in the tree. */
static whit_result validate_instances(const struct accel *accel)
{
    uint32_t *dense = array_alloc(accel->instance_count, sizeof *dense);
    if (!dense)
        return log_failure(&accel->log, WHIT_ERROR_MEMORY,
                           "instances: out of memory for validation");
    struct instance_user user = {accel, dense};
    struct view view = {
        .log = &accel->log,
        .name = "instances",
        .nodes = accel->nodes,
        .node_count = accel->instance_node_count,
        .slot_count = accel->instance_count,
        .leaf_limit = 1,
        .primitive = instance_primitive,
        .box = instance_box,
        .user = &user,
    };
    whit_result result = WHIT_ERROR_FAILED;
    if (accel->instance_node_count > accel->instance_node_capacity ||
        accel->instance_node_capacity > accel->node_count)
        refuse(&view, "nodes out of range", accel->instance_node_count);
    else if (accel->instance_node_count > 1 && !accel_has_slack(accel))
        refuse(&view, "the margin of rays is not that of the pose, node", 1);
    else if (instances_number(accel, dense, &view.primitive_count))
        result = tree_check(&view, accel->instance_depth, accel->instance_root);
    free(dense);
    return result;
}

whit_result accel_validate(const struct accel *accel)
{
    uint32_t deepest = 0;
    if (accel->flat)
        return validate_flat(accel);
    for (uint32_t i = 0; i < accel->mesh_count; ++i) {
        whit_result result = validate_mesh(accel, i);
        if (result != WHIT_OK)
            return result;
        if (accel->meshes[i].depth > deepest)
            deepest = accel->meshes[i].depth;
    }
    if (accel->mesh_depth != deepest)
        return log_failure(&accel->log, WHIT_ERROR_FAILED,
                           "the stated depth of the meshes is %u, but it is %u", accel->mesh_depth,
                           deepest);
    return validate_instances(accel);
}
