/* End-point overlap: how much surface lies in boxes that it does not belong to. */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/threads.h"
#include "base/vec.h"
#include "bvh/clip.h"
#include "twin/epo.h"

/* ---- Areas ---- */

static double polygon_area(const struct clip_polygon *polygon)
{
    double sum[3] = {0};
    const double *o = polygon->at[0];
    for (uint32_t i = 1; i + 1 < polygon->count; ++i) {
        const double *p = polygon->at[i], *q = polygon->at[i + 1];
        double a[3], b[3], twice[3];
        for (int k = 0; k < 3; ++k) {
            a[k] = p[k] - o[k];
            b[k] = q[k] - o[k];
        }
        double3_cross(a, b, twice);
        for (int k = 0; k < 3; ++k)
            sum[k] += twice[k];
    }
    return 0.5 * sqrt(double3_dot(sum, sum));
}

double epo_clipped_area(const float a[3], const float b[3], const float c[3],
                        const struct bvh_box *box)
{
    const struct clip_triangle triangle = {{a, b, c}};
    struct clip_polygon room[2];
    const struct clip_polygon *polygon = clip_triangle(&triangle, box, room);
    return polygon ? polygon_area(polygon) : 0.0;
}

/* The area of a sphere inside the box, to a few percent: the share of points inside, out of points
   spread evenly over the sphere (a spiral by the golden angle, with equal area per point). */
static double epo_sphere_area(const float center[3], float radius, const struct bvh_box *box)
{
    enum { POINTS = 256 };
    const double golden_angle = 2.399963229728653;
    double r = (double)radius;
    uint32_t inside = 0;
    for (int i = 0; i < POINTS; ++i) {
        double height = 1.0 - (2.0 * i + 1.0) / POINTS, ring = sqrt(1.0 - height * height);
        const double dir[3] = {ring * cos(golden_angle * i), height, ring * sin(golden_angle * i)};
        bool in = true;
        for (int k = 0; k < 3; ++k) {
            double at = (double)center[k] + r * dir[k];
            in &= at >= (double)box->lo[k] && at <= (double)box->hi[k];
        }
        inside += in;
    }
    return 4.0 * PI * r * r * inside / POINTS;
}

static double epo_area(const struct gpu_triangle *record, const struct bvh_box *box)
{
    if (record->flags & TRIANGLE_SPHERE)
        return epo_sphere_area(record->v0, record->v1[0], box);
    return epo_clipped_area(record->v0, record->v1, record->v2, box);
}

/* ---- One tree ---- */

/* A triangle in a leaf. In the sorted array, the places of one triangle are side by side. */
struct place {
    uint32_t instance, primitive, leaf, record;
};

/* The leaves below a node, as a range of numbers counted from the left. */
struct leaves {
    uint32_t begin, end;
};

enum { TRIANGLES_A_TASK = 256 };

struct walk {
    const struct gpu_bvh_node *nodes; /* of all meshes */
    const struct gpu_triangle *triangles;
    uint32_t first_node, first_triangle, place_count, triangle_count;
    struct leaves *leaves; /* one for each node */
    struct place *places;
    uint32_t *firsts;     /* [triangle]: its first place; at the end place_count */
    struct bvh_epo *sums; /* one for each task */
};

static uint32_t number_leaves(struct walk *walk, uint32_t node, uint32_t begin)
{
    const struct gpu_bvh_node *at = &walk->nodes[node];
    uint32_t count = bvh_count(at), end = begin + 1;
    for (uint32_t i = 0; i < count; ++i) {
        const struct gpu_triangle *triangle = &walk->triangles[at->first + i];
        walk->places[walk->place_count++] = (struct place){
            triangle->flags >> TRIANGLE_INSTANCE_SHIFT, triangle->primitive, begin, at->first + i};
    }
    if (count == 0) {
        end = number_leaves(walk, at->first, begin);
        end = number_leaves(walk, at->first + 1, end);
    }
    walk->leaves[node - walk->first_node] = (struct leaves){begin, end};
    return end;
}

static int compare_places(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    if (x->instance != y->instance)
        return x->instance < y->instance ? -1 : 1;
    if (x->primitive != y->primitive)
        return x->primitive < y->primitive ? -1 : 1;
    return x->leaf < y->leaf ? -1 : x->leaf > y->leaf;
}

static void find_triangles(struct walk *walk)
{
    qsort(walk->places, walk->place_count, sizeof *walk->places, compare_places);
    for (uint32_t i = 0; i < walk->place_count; ++i) {
        const struct place *at = &walk->places[i];
        if (i == 0 || at->instance != at[-1].instance || at->primitive != at[-1].primitive)
            walk->firsts[walk->triangle_count++] = i;
    }
    walk->firsts[walk->triangle_count] = walk->place_count;
}

static bool belongs(const struct walk *walk, uint32_t triangle, uint32_t node)
{
    const struct leaves *leaves = &walk->leaves[node - walk->first_node];
    for (uint32_t i = walk->firsts[triangle]; i < walk->firsts[triangle + 1]; ++i) {
        if (walk->places[i].leaf >= leaves->begin && walk->places[i].leaf < leaves->end)
            return true;
    }
    return false;
}

/* Adds to *sum, for `node` and each node below it whose subtree does not contain the triangle, the
   area of the triangle inside the node's box: once, or in a leaf once for each of its triangles. */
static void add_overlap(const struct walk *walk, uint32_t triangle, uint32_t node, double *sum)
{
    const struct gpu_bvh_node *at = &walk->nodes[node];
    const struct gpu_triangle *t = &walk->triangles[walk->places[walk->firsts[triangle]].record];
    struct bvh_box box = bvh_node_box(at);
    double area = epo_area(t, &box);
    if (area == 0.0)
        return;
    uint32_t count = bvh_count(at);
    if (!belongs(walk, triangle, node))
        *sum += area * (count ? count : 1);
    if (count == 0) {
        add_overlap(walk, triangle, at->first, sum);
        add_overlap(walk, triangle, at->first + 1, sum);
    }
}

static void run_task(void *context, uint32_t index)
{
    const struct walk *walk = context;
    static const struct bvh_box everything = {{-INFINITY, -INFINITY, -INFINITY},
                                              {INFINITY, INFINITY, INFINITY}};
    uint32_t begin = index * TRIANGLES_A_TASK;
    uint32_t left = walk->triangle_count - begin;
    uint32_t end = begin + (left < TRIANGLES_A_TASK ? left : TRIANGLES_A_TASK);
    struct bvh_epo sum = {0};
    for (uint32_t i = begin; i < end; ++i) {
        const struct gpu_triangle *t = &walk->triangles[walk->places[walk->firsts[i]].record];
        sum.surface += epo_area(t, &everything);
        add_overlap(walk, i, walk->first_node, &sum.overlap);
    }
    walk->sums[index] = sum;
}

whit_result accel_mesh_epo(const struct accel *accel, uint32_t mesh_index, struct bvh_epo *epo)
{
    const struct accel_mesh *mesh = &accel->meshes[mesh_index];
    *epo = (struct bvh_epo){0};
    if (mesh->node_count == 0)
        return WHIT_OK;
    uint32_t task_count = (mesh->record_count + TRIANGLES_A_TASK - 1) / TRIANGLES_A_TASK;
    struct walk walk = {
        .nodes = accel->nodes,
        .triangles = accel->triangles,
        .first_node = mesh->first_node,
        .leaves = array_alloc(mesh->node_count, sizeof *walk.leaves),
        .places = array_alloc(mesh->record_count, sizeof *walk.places),
        .firsts = array_alloc((size_t)mesh->record_count + 1, sizeof *walk.firsts),
        .sums = array_alloc_zeroed(task_count, sizeof *walk.sums),
    };
    whit_result result = WHIT_OK;
    if (walk.leaves && walk.places && walk.firsts && walk.sums) {
        number_leaves(&walk, mesh->first_node, 0);
        find_triangles(&walk);
        threads_for(accel->params.threads,
                    (walk.triangle_count + TRIANGLES_A_TASK - 1) / TRIANGLES_A_TASK, run_task,
                    &walk);
    } else {
        log_error(&accel->log, "%s: out of memory for a report on its trees", accel->scene->name);
        result = WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; result == WHIT_OK && i < task_count; ++i) {
        epo->overlap += walk.sums[i].overlap;
        epo->surface += walk.sums[i].surface;
    }
    free(walk.leaves);
    free(walk.places);
    free(walk.firsts);
    free(walk.sums);
    return result;
}
