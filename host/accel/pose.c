/* Instances at one time, and the tree over them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/extent.h"
#include "accel/flat.h"
#include "accel/pose.h"
#include "base/array.h"
#include "base/clock.h"
#include "base/text.h"
#include "base/threads.h"
#include "base/vec.h"
#include "bvh/complete.h"

enum { CHUNK_INSTANCES = 512 }; /* filled by one call */

/* Traversal transforms rays into object space in float. That moves a hit by a few roundings (2^-24
   each) of the coordinates involved, so boxes in world space are widened by 16 of them. */
static const double WIDENING = 0x1p-20;

/* How far errors of a coordinate in world space come back from object space, as a share of that
   coordinate: on the same axis, and on each axis from the two others together. */
struct spread {
    double own[3], others[3];
};

static void spread_raise(struct spread *spread, const struct spread *by)
{
    for (int i = 0; i < 3; ++i) {
        spread->own[i] = fmax(spread->own[i], by->own[i]);
        spread->others[i] = fmax(spread->others[i], by->others[i]);
    }
}

/* The world-space box of an instance, widened. A point p reaches object space as inverse * (p -
   origin): errors relative to |p - origin| on one world axis come back on the others multiplied by
   |forward| * |inverse|, which gives *spread. What they have from the box and the instance's origin
   is in this margin; what they have from the ray's origin is in the ray's (instances_slack). */
static struct bvh_box world_box(const struct affine *forward, const struct affine *inverse,
                                const struct bvh_box *box, struct spread *spread)
{
    struct accel_extent extent = accel_transformed_box(forward->m, box);
    struct bvh_box out;
    for (int r = 0; r < 3; ++r) {
        double margin = 0.0;
        spread->others[r] = 0.0;
        for (int c = 0; c < 3; ++c) {
            double part = 0.0;
            for (int k = 0; k < 3; ++k)
                part += fabs(forward->m[4 * r + k]) * fabs(inverse->m[4 * k + c]);
            margin += part * extent.size[c];
            if (c == r)
                spread->own[r] = part;
            else
                spread->others[r] += part;
        }
        out.lo[r] = float_below(extent.lo[r] - margin * WIDENING);
        out.hi[r] = float_above(extent.hi[r] + margin * WIDENING);
    }
    return out;
}

static bool row_store(float out[3], const double *row)
{
    for (int c = 0; c < 3; ++c)
        out[c] = (float)row[c];
    return isfinite(out[0]) && isfinite(out[1]) && isfinite(out[2]);
}

/* Half the longest side of the box; 0 for an empty one. */
static float box_reach(const struct bvh_box *box)
{
    float reach = 0.0f;
    for (int i = 0; i < 3; ++i) {
        float half = box->hi[i] * 0.5f - box->lo[i] * 0.5f;
        reach = half > reach ? half : reach;
    }
    return reach;
}

void accel_instance_enter(struct gpu_instance *out, const struct accel_mesh *mesh)
{
    out->root = mesh->root;
    out->center_x = mesh->box.lo[0] * 0.5f + mesh->box.hi[0] * 0.5f;
    out->center_y = mesh->box.lo[1] * 0.5f + mesh->box.hi[1] * 0.5f;
    out->center_z = mesh->box.lo[2] * 0.5f + mesh->box.hi[2] * 0.5f;
    out->reach = box_reach(&mesh->box);
    out->hull = mesh->hull;
}

/* False when floats cannot hold the transform. */
static bool instance_fill(const struct affine *forward, const struct affine *inverse,
                          const struct accel_mesh *mesh, uint32_t mesh_index,
                          struct gpu_instance *out)
{
    *out = (struct gpu_instance){
        .origin_x = (float)forward->m[3],
        .origin_y = (float)forward->m[7],
        .origin_z = (float)forward->m[11],
        .shade_base = mesh->shade_base,
        .mesh = mesh_index,
    };
    accel_instance_enter(out, mesh);
    bool good = isfinite(out->origin_x) && isfinite(out->origin_y) && isfinite(out->origin_z);
    good &= row_store(out->inverse0, &inverse->m[0]);
    good &= row_store(out->inverse1, &inverse->m[4]);
    good &= row_store(out->inverse2, &inverse->m[8]);
    good &= row_store(out->forward0, &forward->m[0]);
    good &= row_store(out->forward1, &forward->m[4]);
    good &= row_store(out->forward2, &forward->m[8]);
    return good;
}

/* Buffers that are kept from pose to pose: at ten thousand instances, fresh memory costs as much as
   filling it. */
struct accel_posing {
    struct gpu_instance *instances; /* exchanged with accel->instances */
    struct bvh_box *boxes;          /* [rank]: of instances that are not empty */
    uint32_t *ranks;                /* [instance]: its rank; UINT32_MAX: it is empty */
    uint32_t *indices;              /* [rank]: its instance */
    uint32_t *bad;         /* [chunk]: its first instance without an inverse, or UINT32_MAX */
    struct spread *spread; /* [chunk]: the largest of its instances */
    struct bvh_box slack;  /* of node 1, see instances_slack */
    uint32_t count;        /* of ranks */
    bool has_tree;
};

void accel_posing_destroy(struct accel_posing *posing)
{
    if (!posing)
        return;
    free(posing->instances);
    free(posing->boxes);
    free(posing->ranks);
    free(posing->indices);
    free(posing->bad);
    free(posing->spread);
    free(posing);
}

static uint32_t chunk_count(uint32_t instances)
{
    return (instances + CHUNK_INSTANCES - 1) / CHUNK_INSTANCES;
}

static struct accel_posing *posing_create(uint32_t count)
{
    struct accel_posing *posing = array_alloc_zeroed(1, sizeof *posing);
    if (!posing)
        return NULL;
    posing->instances = array_alloc_aligned(count, sizeof *posing->instances);
    posing->boxes = array_alloc(count, sizeof *posing->boxes);
    posing->ranks = array_alloc_zeroed(count, sizeof *posing->ranks);
    posing->indices = array_alloc(count, sizeof *posing->indices);
    posing->bad = array_alloc(chunk_count(count), sizeof *posing->bad);
    posing->spread = array_alloc(chunk_count(count), sizeof *posing->spread);
    if (posing->instances && posing->boxes && posing->ranks && posing->indices && posing->bad &&
        posing->spread)
        return posing;
    accel_posing_destroy(posing);
    return NULL;
}

/* Gives each instance that is not empty a rank. True: all ranks are as before. */
static bool rank_instances(const struct accel *accel, struct accel_posing *posing)
{
    bool same = true;
    uint32_t count = 0;
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        bool empty = accel->meshes[accel->scene->instances[i].mesh].triangle_count == 0;
        uint32_t rank = empty ? UINT32_MAX : count;
        same &= posing->ranks[i] == rank;
        posing->ranks[i] = rank;
        if (!empty)
            posing->indices[count++] = i;
    }
    same &= posing->count == count;
    posing->count = count;
    return same;
}

struct filling {
    const struct accel *accel;
    const struct scene_pose *pose;
    struct accel_posing *posing;
    const struct accel_mesh *meshes; /* of the scene */
};

static void fill_chunk(void *user, uint32_t chunk)
{
    const struct filling *filling = user;
    const struct accel *accel = filling->accel;
    struct accel_posing *posing = filling->posing;
    uint32_t begin = chunk * CHUNK_INSTANCES, left = accel->instance_count - begin;
    uint32_t end = begin + (left < CHUNK_INSTANCES ? left : CHUNK_INSTANCES);
    posing->bad[chunk] = UINT32_MAX;
    posing->spread[chunk] = (struct spread){.own = {0}};
    for (uint32_t i = begin; i < end; ++i) {
        const struct affine *forward = &filling->pose->instances[i];
        uint32_t mesh_index = accel->scene->instances[i].mesh;
        const struct accel_mesh *mesh = &filling->meshes[mesh_index];
        struct affine inverse;
        if (!affine_is_finite(forward) || !affine_invert(forward, &inverse) ||
            !instance_fill(forward, &inverse, mesh, mesh_index, &posing->instances[i])) {
            posing->bad[chunk] = i;
            return;
        }
        struct spread spread;
        if (posing->ranks[i] == UINT32_MAX)
            continue;
        posing->boxes[posing->ranks[i]] = world_box(forward, &inverse, &mesh->box, &spread);
        spread_raise(&posing->spread[chunk], &spread);
    }
}

static whit_result instances_fill(const struct accel *accel, const struct scene_pose *pose,
                                  struct accel_posing *posing)
{
    struct filling filling = {accel, pose, posing,
                              accel->flat ? accel_flat_meshes(accel->world) : accel->meshes};
    uint32_t chunks = chunk_count(accel->instance_count);
    threads_for(accel->params.threads, chunks, fill_chunk, &filling);
    for (uint32_t c = 0; c < chunks; ++c) {
        uint32_t i = posing->bad[c];
        if (i == UINT32_MAX)
            continue;
        const char *name = accel->scene->instances[i].name;
        return log_failure(&accel->log, WHIT_ERROR_INPUT,
                           "%s: instance %u `%s`: its matrix has no inverse in range at %g s",
                           accel->scene->name, i, text_token(name).text, pose->time_s);
    }
    return WHIT_OK;
}

/* Copies the tree to accel->nodes. Leaves of the copy name instances; those of `tree` name places
   in its order of instances that are not empty. */
static void tree_place(struct accel *accel, const struct bvh *tree, const uint32_t *indices)
{
    memset(accel->nodes + tree->node_count, 0,
           (accel->instance_node_capacity - tree->node_count) * sizeof *accel->nodes);
    for (uint32_t i = 0; i < tree->node_count; ++i) {
        accel->nodes[i] = tree->nodes[i];
        if (bvh_count(&accel->nodes[i]) > 0)
            accel->nodes[i].first = indices[tree->order[accel->nodes[i].first]];
    }
    accel->instance_node_count = tree->node_count;
    accel->instance_depth = tree->depth;
    accel->instance_root = tree->node_count ? accel_node_ref(&accel->nodes[0]) : BVH_EMPTY_REF;
}

static whit_result tree_build(struct accel *accel, const struct accel_posing *posing)
{
    const whit_accel_params params = {
        .build = accel->params.instance_build, .leaf_limit = 1, .threads = accel->params.threads};
    struct bvh tree;
    whit_result result = bvh_build(&accel->log, posing->boxes, posing->count, NULL, &params, &tree);
    if (result == WHIT_OK)
        tree_place(accel, &tree, posing->indices);
    bvh_finish(&tree);
    return result;
}

/* Sets new boxes from the leaves up; they are exact unions, so that parents hold their children. */
static void subtree_refit(struct gpu_bvh_node *nodes, uint32_t node,
                          const struct accel_posing *posing)
{
    struct gpu_bvh_node *at = &nodes[node];
    if (bvh_count(at) > 0) {
        const struct bvh_box *box = &posing->boxes[posing->ranks[at->first]];
        memcpy(at->lo, box->lo, sizeof at->lo);
        memcpy(at->hi, box->hi, sizeof at->hi);
        return;
    }
    struct gpu_bvh_node *a = &nodes[at->first], *b = a + 1;
    subtree_refit(nodes, at->first, posing);
    subtree_refit(nodes, at->first + 1, posing);
    bvh_set_axis(a);
    for (int i = 0; i < 3; ++i) {
        at->lo[i] = a->lo[i] < b->lo[i] ? a->lo[i] : b->lo[i];
        at->hi[i] = a->hi[i] > b->hi[i] ? a->hi[i] : b->hi[i];
    }
}

/* Sets the margin that a ray brings to the boxes of the tree, by its origin: in the box of node 1,
   beside the root, which no ray is tested against. */
static void instances_slack(struct accel *accel)
{
    struct gpu_bvh_node *node = &accel->nodes[1];
    struct spread max = {.own = {0}};
    for (uint32_t c = 0; c < chunk_count(accel->instance_count); ++c)
        spread_raise(&max, &accel->posing->spread[c]);
    for (int i = 0; i < 3 && accel->instance_node_count > 1; ++i) {
        node->lo[i] = float_above(max.own[i] * WIDENING);
        node->hi[i] = float_above(max.others[i] * WIDENING);
    }
    accel->posing->slack = bvh_node_box(node);
}

bool accel_has_slack(const struct accel *accel)
{
    const struct bvh_box found = bvh_node_box(&accel->nodes[1]);
    return memcmp(&found, &accel->posing->slack, sizeof found) == 0;
}

static void instances_exchange(struct accel *accel)
{
    struct gpu_instance *before = accel->instances;
    accel->instances = accel->posing->instances;
    accel->posing->instances = before;
}

static whit_result pose_flat(struct accel *accel, const struct scene_pose *pose)
{
    struct accel_posing *posing = accel->posing;
    for (uint32_t i = 0; i < accel->instance_count; ++i)
        posing->ranks[i] = UINT32_MAX;
    whit_result result = instances_fill(accel, pose, posing);
    if (result == WHIT_OK)
        result = accel_flat_build(accel, pose);
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; i < accel->instance_count; ++i)
        accel_instance_enter(&posing->instances[i], &accel->meshes[0]);
    instances_exchange(accel);
    return WHIT_OK;
}

/* Moves the instances and their tree to `pose`. Changes nothing on failure. */
static whit_result pose_instances(struct accel *accel, const struct scene_pose *pose)
{
    struct accel_posing *posing = accel->posing;
    bool keep = rank_instances(accel, posing) && posing->has_tree && accel->params.instance_refit &&
                !accel->no_trees;
    whit_result result = instances_fill(accel, pose, posing);
    if (result == WHIT_OK && !keep)
        result = tree_build(accel, posing);
    if (result != WHIT_OK)
        return result;
    if (keep && posing->count > 0)
        subtree_refit(accel->nodes, 0, posing);
    instances_slack(accel);
    posing->has_tree = true;
    instances_exchange(accel);
    accel->single_identity = accel->instance_count == 1 &&
                             accel->meshes[accel->scene->instances[0].mesh].triangle_count > 0 &&
                             affine_is_identity(&pose->instances[0]);
    return WHIT_OK;
}

whit_result accel_pose(struct accel *accel, const struct scene_pose *pose)
{
    double begin_ms = clock_ms();
    uint32_t count = accel->instance_count;
    if (pose->instance_count != count)
        return log_failure(&accel->log, WHIT_ERROR_USAGE,
                           "%s: a pose of %u instances for a scene of %u", accel->scene->name,
                           pose->instance_count, count);
    if (!accel->posing)
        accel->posing = posing_create(count);
    if (!accel->posing)
        return log_failure(&accel->log, WHIT_ERROR_MEMORY, "%s: out of memory for %u instances",
                           accel->scene->name, count);
    accel->posed_s = NAN;
    whit_result result = accel->flat ? pose_flat(accel, pose) : pose_instances(accel, pose);
    if (result == WHIT_OK)
        accel->posed_s = pose->time_s;
    accel->instance_build_ms = clock_ms() - begin_ms;
    return result;
}

whit_result accel_pose_again(struct accel *accel, const struct scene_pose *pose)
{
    return accel->posed_s == pose->time_s ? WHIT_OK : accel_pose(accel, pose);
}

uint32_t accel_stack_size(const struct accel *accel)
{
    uint32_t depth = accel->mesh_depth + (accel->single_identity ? 0 : accel->instance_depth);
    uint32_t steps = (depth + ACCEL_STACK_STEP - 1) / ACCEL_STACK_STEP;
    return steps > 0 ? steps * ACCEL_STACK_STEP : ACCEL_STACK_STEP;
}

uint32_t accel_packet_stack_size(const struct accel *accel)
{
    uint32_t depth = accel->bvh8.mesh_depth + accel->bvh8.instance_depth;
    return depth <= 8 ? 8 : (depth + 3) / 4 * 4;
}
