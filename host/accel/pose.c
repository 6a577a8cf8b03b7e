/* Instances at one time, and the tree over them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel_inside.h"
#include "base/array.h"
#include "base/clock.h"

/* Traversal takes rays into object space in float. That moves a hit by a few roundings (2^-24 each)
   of the coordinates involved; boxes in world space are wider by 16 of them. */
static const double WIDENING = 0x1p-20;

struct accel_extent accel_transformed_box(const double rows[12], const struct bvh_box *box)
{
    struct accel_extent out;
    for (int r = 0; r < 3; ++r) {
        double t = rows[4 * r + 3];
        out.lo[r] = out.hi[r] = t;
        out.size[r] = fabs(t);
        for (int c = 0; c < 3; ++c) {
            double a = rows[4 * r + c] * (double)box->lo[c];
            double b = rows[4 * r + c] * (double)box->hi[c];
            out.lo[r] += a < b ? a : b;
            out.hi[r] += a < b ? b : a;
            out.size[r] += fabs(a) > fabs(b) ? fabs(a) : fabs(b);
        }
    }
    return out;
}

static float float_below(double value)
{
    float rounded = (float)value;
    return (double)rounded > value ? nextafterf(rounded, -INFINITY) : rounded;
}

static float float_above(double value)
{
    float rounded = (float)value;
    return (double)rounded < value ? nextafterf(rounded, INFINITY) : rounded;
}

/* A point p reaches object space as inverse * (p - origin): errors relative to |p - origin| on one
   world axis come back on the others as |forward| * |inverse|. */
static struct bvh_box world_box(const struct affine *forward, const struct affine *inverse,
                                const struct bvh_box *box)
{
    struct accel_extent extent = accel_transformed_box(forward->m, box);
    struct bvh_box out;
    for (int r = 0; r < 3; ++r) {
        double margin = 0.0;
        for (int c = 0; c < 3; ++c) {
            double spread = 0.0;
            for (int k = 0; k < 3; ++k)
                spread += fabs(forward->m[4 * r + k]) * fabs(inverse->m[4 * k + c]);
            margin += spread * extent.size[c];
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

/* Half the longest side; 0 for an empty box. */
static float box_reach(const struct bvh_box *box)
{
    float reach = 0.0f;
    for (int i = 0; i < 3; ++i) {
        float half = box->hi[i] * 0.5f - box->lo[i] * 0.5f;
        reach = half > reach ? half : reach;
    }
    return reach;
}

/* False when floats cannot hold it. */
static bool instance_fill(const struct affine *forward, const struct affine *inverse,
                          const struct accel_mesh *mesh, uint32_t mesh_index,
                          struct gpu_instance *out)
{
    *out = (struct gpu_instance){
        .origin_x = (float)forward->m[3],
        .origin_y = (float)forward->m[7],
        .origin_z = (float)forward->m[11],
        .root = mesh->root,
        .shade_base = mesh->shade_base,
        .mesh = mesh_index,
        .record_count = mesh->record_count,
        .center_x = mesh->box.lo[0] * 0.5f + mesh->box.hi[0] * 0.5f,
        .center_y = mesh->box.lo[1] * 0.5f + mesh->box.hi[1] * 0.5f,
        .center_z = mesh->box.lo[2] * 0.5f + mesh->box.hi[2] * 0.5f,
        .reach = box_reach(&mesh->box),
    };
    bool good = isfinite(out->origin_x) && isfinite(out->origin_y) && isfinite(out->origin_z);
    good &= row_store(out->inverse0, &inverse->m[0]);
    good &= row_store(out->inverse1, &inverse->m[4]);
    good &= row_store(out->inverse2, &inverse->m[8]);
    good &= row_store(out->forward0, &forward->m[0]);
    good &= row_store(out->forward1, &forward->m[4]);
    good &= row_store(out->forward2, &forward->m[8]);
    return good;
}

struct posing {
    struct gpu_instance *instances;
    struct bvh_box *boxes; /* of instances that are not empty */
    uint32_t *indices;     /* which these are */
    uint32_t count;
    struct bvh tree;
};

static whit_result instances_fill(const struct accel *accel, const struct scene_pose *pose,
                                  struct posing *posing)
{
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        uint32_t mesh_index = accel->scene->instances[i].mesh;
        const struct accel_mesh *mesh = &accel->meshes[mesh_index];
        struct affine inverse;
        if (!affine_is_finite(&pose->instances[i]) ||
            !affine_invert(&pose->instances[i], &inverse) ||
            !instance_fill(&pose->instances[i], &inverse, mesh, mesh_index,
                           &posing->instances[i])) {
            log_error(&accel->log, "%s: instance %s: its matrix has no inverse in range at %g s",
                      accel->scene->name, accel->scene->instances[i].name, pose->time_s);
            return WHIT_ERROR_INPUT;
        }
        if (mesh->root == BVH_EMPTY_REF)
            continue;
        posing->boxes[posing->count] = world_box(&pose->instances[i], &inverse, &mesh->box);
        posing->indices[posing->count++] = i;
    }
    return WHIT_OK;
}

static bool is_identity(const struct affine *a)
{
    struct affine identity = affine_identity();
    for (int i = 0; i < 12; ++i) {
        if (a->m[i] != identity.m[i])
            return false;
    }
    return true;
}

/* Nothing fails from here on. */
static void pose_commit(struct accel *accel, const struct scene_pose *pose,
                        const struct posing *posing)
{
    const struct bvh *tree = &posing->tree;
    memcpy(accel->instances, posing->instances, accel->instance_count * sizeof *accel->instances);
    memset(accel->nodes, 0, accel->instance_node_capacity * sizeof *accel->nodes);
    if (tree->node_count > 0)
        memcpy(accel->nodes, tree->nodes, tree->node_count * sizeof *accel->nodes);
    for (uint32_t i = 0; i < tree->node_count; ++i) {
        if (bvh_count(&accel->nodes[i]) > 0)
            accel->nodes[i].first = posing->indices[tree->order[accel->nodes[i].first]];
    }
    accel->instance_node_count = tree->node_count;
    accel->instance_depth = tree->depth;
    accel->instance_root = tree->node_count ? accel_node_ref(&accel->nodes[0]) : BVH_EMPTY_REF;
    accel->single_identity =
        accel->instance_count == 1 && posing->count == 1 && is_identity(&pose->instances[0]);
}

whit_result accel_pose(struct accel *accel, const struct scene_pose *pose)
{
    double begin_ms = clock_ms();
    uint32_t count = accel->instance_count;
    if (pose->instance_count != count) {
        log_error(&accel->log, "%s: a pose of %u instances for a scene of %u", accel->scene->name,
                  pose->instance_count, count);
        return WHIT_ERROR_USAGE;
    }
    struct posing posing = {
        .instances = array_alloc(count, sizeof *posing.instances),
        .boxes = array_alloc(count, sizeof *posing.boxes),
        .indices = array_alloc(count, sizeof *posing.indices),
    };
    whit_result result = WHIT_ERROR_MEMORY;
    if (posing.instances && posing.boxes && posing.indices)
        result = instances_fill(accel, pose, &posing);
    else
        log_error(&accel->log, "%s: out of memory for %u instances", accel->scene->name, count);
    if (result == WHIT_OK)
        result = bvh_build(&accel->log, posing.boxes, posing.count, &accel->params.instances,
                           &posing.tree);
    if (result == WHIT_OK)
        pose_commit(accel, pose, &posing);
    bvh_finish(&posing.tree);
    free(posing.instances);
    free(posing.boxes);
    free(posing.indices);
    accel->instance_build_ms = clock_ms() - begin_ms;
    return result;
}
