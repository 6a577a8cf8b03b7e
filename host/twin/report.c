/* Measures the shape of the mesh trees and the visits of random lines: predicted from areas, and
   counted on the CPU. */
#include <math.h>
#include <stdlib.h>

#include "accel/pose.h"
#include "base/array.h"
#include "base/random.h"
#include "base/threads.h"
#include "base/vec.h"
#include "twin/epo.h"
#include "twin/report.h"
#include "twin/traverse.h"

enum { RAYS_A_TASK = 1024 };

/* ---- Shape ---- */

/* Sums over the nodes of one tree. */
struct tally {
    double inner, leaves, shared; /* half areas; each leaf's times its triangles */
};

static double shared_area(const struct gpu_bvh_node *a, const struct gpu_bvh_node *b)
{
    struct gpu_bvh_node shared = {.count = 0};
    bool some = true;
    for (int i = 0; i < 3; ++i) {
        shared.lo[i] = a->lo[i] > b->lo[i] ? a->lo[i] : b->lo[i];
        shared.hi[i] = a->hi[i] < b->hi[i] ? a->hi[i] : b->hi[i];
        some &= shared.lo[i] <= shared.hi[i];
    }
    return some ? bvh_half_area(&shared) : 0.0;
}

static void add_leaf(whit_accel_report *report, uint32_t count, uint32_t depth)
{
    uint32_t bin = depth < WHIT_DEPTH_BINS ? depth : WHIT_DEPTH_BINS - 1;
    ++report->leaves_at_depth[bin];
    ++report->leaves_of_size[count];
}

static void add_nodes(const struct gpu_bvh_node *nodes, uint32_t node, uint32_t depth,
                      struct tally *tally, whit_accel_report *report)
{
    const struct gpu_bvh_node *at = &nodes[node], *children = &nodes[at->first];
    uint32_t count = bvh_count(at);
    if (count > 0) {
        tally->leaves += bvh_half_area(at) * count;
        add_leaf(report, count, depth);
        return;
    }
    tally->inner += bvh_half_area(at);
    tally->shared += shared_area(&children[0], &children[1]);
    add_nodes(nodes, at->first, depth + 1, tally, report);
    add_nodes(nodes, at->first + 1, depth + 1, tally, report);
}

/* ---- Random lines ---- */

/* A random line, uniform among all that meet the box: it enters at a uniform point of the surface,
   with directions by the cosine to the normal there (Santalo 1976, "Integral geometry and geometric
   probability"). The ray starts before the box. */
static struct gpu_ray random_line(const struct bvh_box *box, uint64_t *random)
{
    double size[3], faces[3], length = 0.0;
    for (int i = 0; i < 3; ++i)
        size[i] = (double)box->hi[i] - (double)box->lo[i];
    for (int i = 0; i < 3; ++i) {
        faces[i] = size[(i + 1) % 3] * size[(i + 2) % 3];
        length += size[i];
    }
    double choice = splitmix64_unit(random) * (faces[0] + faces[1] + faces[2]);
    int axis = choice < faces[0] ? 0 : choice < faces[0] + faces[1] ? 1 : 2;
    double up = splitmix64_unit(random) < 0.5 ? 1.0 : -1.0;
    double square = splitmix64_unit(random), angle = 2.0 * PI * splitmix64_unit(random);
    double dir[3], at[3];
    dir[axis] = up * sqrt(1.0 - square);
    dir[(axis + 1) % 3] = sqrt(square) * cos(angle);
    dir[(axis + 2) % 3] = sqrt(square) * sin(angle);
    for (int i = 0; i < 3; ++i)
        at[i] = (double)box->lo[i] + size[i] * splitmix64_unit(random);
    at[axis] = (double)(up > 0.0 ? box->lo[axis] : box->hi[axis]);
    struct gpu_ray ray = {.t_min = 0.0f, .t_max = INFINITY};
    for (int i = 0; i < 3; ++i) {
        ray.origin[i] = (float)(at[i] - length * dir[i]);
        ray.dir[i] = (float)dir[i];
    }
    return ray;
}

struct measuring {
    const struct accel *accel;
    const double *area_ends; /* running sum of the areas of the meshes' boxes */
    uint32_t ray_count;
    struct gpu_cost *costs; /* one for each task */
    uint32_t *statuses;
};

static uint32_t mesh_at(const struct measuring *measuring, double area)
{
    uint32_t first = 0, last = measuring->accel->mesh_count - 1;
    while (first < last) {
        uint32_t middle = first + (last - first) / 2;
        if (area < measuring->area_ends[middle])
            last = middle;
        else
            first = middle + 1;
    }
    return first;
}

/* Traces a line through one mesh in its own space, as if it were the whole scene. */
static void measure_line(const struct measuring *measuring, uint32_t index, struct gpu_cost *cost,
                         uint32_t *status)
{
    double total = measuring->area_ends[measuring->accel->mesh_count - 1];
    uint32_t mesh_index = mesh_at(measuring, ((double)index + 0.5) / measuring->ray_count * total);
    struct accel_mesh *mesh = &measuring->accel->meshes[mesh_index];
    struct gpu_instance instance = {0};
    accel_instance_enter(&instance, mesh);
    struct accel alone = *measuring->accel;
    if (!alone.flat) { /* a flat scene is one mesh already */
        alone.meshes = mesh;
        alone.instances = &instance;
        alone.mesh_count = alone.instance_count = 1;
        alone.instance_root = mesh->root;
        alone.single_identity = true;
    }
    uint64_t random = (uint64_t)index << 20;
    struct gpu_ray ray = random_line(&mesh->box, &random);
    struct gpu_hit hit;
    traverse_ray(&alone, NULL, &ray, &hit, cost, status);
}

static void measure_task(void *context, uint32_t index)
{
    const struct measuring *measuring = context;
    uint32_t begin = index * RAYS_A_TASK, left = measuring->ray_count - begin;
    uint32_t end = begin + (left < RAYS_A_TASK ? left : RAYS_A_TASK);
    for (uint32_t i = begin; i < end; ++i)
        measure_line(measuring, i, &measuring->costs[index], &measuring->statuses[index]);
}

static whit_result add_measured(const struct measuring *measuring, uint32_t task_count,
                                whit_accel_report *report)
{
    uint64_t inner_nodes = 0, triangles = 0;
    uint32_t status = 0;
    for (uint32_t i = 0; i < task_count; ++i) {
        inner_nodes += measuring->costs[i].inner_nodes;
        triangles += measuring->costs[i].triangles;
        status |= measuring->statuses[i];
    }
    if (status)
        return log_failure(&measuring->accel->log, WHIT_ERROR_STATUS,
                           "%s: the traversal reported status %#x", measuring->accel->scene->name,
                           status);
    report->measured_rays = measuring->ray_count;
    report->measured_inner_nodes = (double)inner_nodes / measuring->ray_count;
    report->measured_triangles = (double)triangles / measuring->ray_count;
    return WHIT_OK;
}

static whit_result measure(const struct accel *accel, const double *area_ends, uint32_t ray_count,
                           whit_accel_report *report)
{
    uint32_t task_count = ray_count / RAYS_A_TASK + (ray_count % RAYS_A_TASK != 0);
    struct measuring measuring = {
        .accel = accel,
        .area_ends = area_ends,
        .ray_count = ray_count,
        .costs = array_alloc_zeroed(task_count, sizeof *measuring.costs),
        .statuses = array_alloc_zeroed(task_count, sizeof *measuring.statuses),
    };
    whit_result result = WHIT_ERROR_MEMORY;
    if (measuring.costs && measuring.statuses) {
        threads_for(accel->params.threads, task_count, measure_task, &measuring);
        result = add_measured(&measuring, task_count, report);
    } else {
        log_error(&accel->log, "%s: out of memory for a report on its trees", accel->scene->name);
    }
    free(measuring.costs);
    free(measuring.statuses);
    return result;
}

/* ---- All of them ---- */

struct totals {
    double area, inner, leaves, shared, epo_overlap, epo_surface;
};

static whit_result add_mesh(const struct accel *accel, uint32_t index, struct totals *totals,
                            whit_accel_report *report)
{
    const struct accel_mesh *mesh = &accel->meshes[index];
    struct tally tally = {0};
    struct bvh_epo epo;
    if (mesh->node_count == 0)
        return WHIT_OK;
    add_nodes(accel->nodes, mesh->first_node, 0, &tally, report);
    whit_result result = accel_mesh_epo(accel, index, &epo);
    if (result != WHIT_OK)
        return result;
    totals->area += bvh_half_area(&accel->nodes[mesh->first_node]);
    totals->inner += tally.inner;
    totals->leaves += tally.leaves;
    totals->shared += tally.shared;
    totals->epo_overlap += epo.overlap;
    totals->epo_surface += epo.surface;
    return WHIT_OK;
}

whit_result accel_report(const struct accel *accel, uint32_t ray_count, whit_accel_report *report)
{
    struct totals totals = {0};
    *report = (whit_accel_report){0};
    double *area_ends = array_alloc(accel->mesh_count, sizeof *area_ends);
    if (!area_ends)
        return log_failure(&accel->log, WHIT_ERROR_MEMORY,
                           "%s: out of memory for a report on its trees", accel->scene->name);
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < accel->mesh_count; ++i) {
        result = add_mesh(accel, i, &totals, report);
        area_ends[i] = totals.area;
    }
    if (result == WHIT_OK && totals.area > 0.0) {
        report->predicted_inner_nodes = totals.inner / totals.area;
        report->predicted_triangles = totals.leaves / totals.area;
        report->sah_cost = report->predicted_inner_nodes + report->predicted_triangles;
        report->overlap = totals.inner > 0.0 ? totals.shared / totals.inner : 0.0;
        report->epo = totals.epo_surface > 0.0 ? totals.epo_overlap / totals.epo_surface : 0.0;
        if (ray_count > 0)
            result = measure(accel, area_ends, ray_count, report);
    }
    free(area_ends);
    return result;
}
