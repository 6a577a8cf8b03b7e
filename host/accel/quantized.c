/* Boxes of a tree as integers on a grid over its box, rounded outwards (Mahovsky and Wyvill 2006,
   Memory-Conserving Bounding Volume Hierarchies with Coherent Raytracing, section 3; here with one
   grid for all nodes). The step is a power of two and the same on all axes, so that rays change
   their unit without rounding: see shaders/bind/quantized.glsl. */
#include <math.h>
#include <string.h>

#include "accel/extent.h"
#include "accel/quantized.h"
#include "base/array.h"

/* By how much sides of boxes get longer: a step on average by rounding outwards, and at least an
   eighth of a step at each end by the margin of rays. */
static const double WIDER_STEPS = 1.25;
/* The share of its area by which a box may grow. Rays visit nodes in proportion to areas, and save
   about 0.13 of the time by nodes of 16 bytes (docs/performance.md). */
static const double GROWTH_MAX = 0.25;

static double longest_side(const struct bvh_box *box)
{
    double longest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        longest = fmax(longest, (double)box->hi[axis] - (double)box->lo[axis]);
    return longest;
}

bool accel_can_quantize(const struct accel_mesh *mesh)
{
    double longest = longest_side(&mesh->box);
    return mesh->root != BVH_EMPTY_REF && longest > 1e-20 && longest < 1e20;
}

static double grid_step(const struct accel_mesh *mesh)
{
    int exponent;
    (void)frexp(longest_side(&mesh->box) / (QUANTIZED_STEPS - 1), &exponent);
    return ldexp(1.0, exponent);
}

static bool grows_much(const struct gpu_bvh_node *node, double wider)
{
    double length = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        length += (double)node->hi[axis] - (double)node->lo[axis];
    return wider * (2.0 * length + 3.0 * wider) > GROWTH_MAX * bvh_half_area(node);
}

bool accel_quantizes_well(const struct accel *accel, const struct accel_mesh *mesh)
{
    double wider = WIDER_STEPS * grid_step(mesh);
    uint32_t large = 0;
    for (uint32_t i = 2; i < mesh->node_count; ++i)
        large += grows_much(&accel->nodes[mesh->first_node + i], wider);
    return large < mesh->node_count / 2;
}

static uint32_t pack_side(double lo, double hi, double step)
{
    uint32_t first = (uint32_t)floor(lo / step), last = (uint32_t)ceil(hi / step);
    return first | last << 16;
}

struct gpu_quantized_node *accel_quantize(const struct accel *accel, const struct accel_mesh *mesh)
{
    uint32_t count = mesh->first_node + mesh->node_count;
    struct gpu_quantized_node *grid = array_alloc_zeroed(count, sizeof *grid);
    if (!grid)
        return NULL;
    double step = grid_step(mesh), origin[3];
    for (int axis = 0; axis < 3; ++axis)
        origin[axis] = (double)mesh->box.lo[axis];
    const struct gpu_quantized_grid head = {{mesh->box.lo[0], mesh->box.lo[1], mesh->box.lo[2]},
                                            (float)(1.0 / step)};
    memcpy(grid, &head, sizeof head);
    for (uint32_t i = mesh->first_node + 2; i < count; ++i) {
        const struct bvh_box box = bvh_node_box(&accel->nodes[i]);
        uint32_t sides[3];
        for (int axis = 0; axis < 3; ++axis)
            sides[axis] = pack_side((double)box.lo[axis] - origin[axis],
                                    (double)box.hi[axis] - origin[axis], step);
        grid[i] = (struct gpu_quantized_node){sides[0], sides[1], sides[2],
                                              accel_node_ref(&accel->nodes[i])};
    }
    return grid;
}
