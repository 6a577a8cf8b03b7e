/* Checks split triangles: each must lie in its leaves with all of its area, and be the same
   triangle in each of them. It tests sample points, and does not use the clipper that made the
   parts. */
#include <stdlib.h>
#include <string.h>

#include "accel/extent.h"
#include "accel/validate.h"
#include "base/array.h"

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
static bool is_same_record(const whit_log *log, const char *name,
                           const struct gpu_triangle *triangles, struct seen *seen, uint32_t slot)
{
    if (seen->slot == 0)
        seen->slot = slot + 1;
    if (memcmp(&triangles[seen->slot - 1], &triangles[slot], sizeof *triangles) == 0)
        return true;
    log_error(log, "%s: two records of one primitive differ (%u)", name, slot);
    return false;
}

whit_result accel_validate_parts(const whit_log *log, const char *name,
                                 const struct gpu_bvh_node *nodes, uint32_t node_count,
                                 const struct gpu_triangle *triangles, uint32_t primitive_count,
                                 uint32_t (*primitive)(const void *user, uint32_t slot),
                                 const void *user)
{
    struct seen *seen = array_alloc_zeroed(primitive_count, sizeof *seen);
    if (!seen) {
        log_error(log, "%s: out of memory for validation", name);
        return WHIT_ERROR_MEMORY;
    }
    bool same = true;
    for (uint32_t i = 0; same && i < node_count; ++i) {
        for (uint32_t k = 0; same && i != 1 && k < bvh_count(&nodes[i]); ++k) {
            uint32_t slot = nodes[i].first + k;
            struct seen *of = &seen[primitive(user, slot)];
            of->points |= points_inside(&triangles[slot], &nodes[i]);
            same = is_same_record(log, name, triangles, of, slot);
        }
    }
    uint32_t first_bad = 0;
    while (first_bad < primitive_count && seen[first_bad].points == (1u << POINTS) - 1)
        ++first_bad;
    free(seen);
    if (!same)
        return WHIT_ERROR_FAILED;
    if (first_bad == primitive_count)
        return WHIT_OK;
    log_error(log, "%s: a part of a primitive is in none of its leaves (%u)", name, first_bad);
    return WHIT_ERROR_FAILED;
}
