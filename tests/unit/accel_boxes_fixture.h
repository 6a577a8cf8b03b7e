/* Boxes, and trees over them that are checked from end to end. */
#ifndef TESTS_ACCEL_BOXES_FIXTURE_H
#define TESTS_ACCEL_BOXES_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <stdalign.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"
#include "random_fixture.h"

static const struct log silent;

static inline struct bvh_box *boxes_alloc(uint32_t count)
{
    struct bvh_box *boxes = calloc(count ? count : 1, sizeof *boxes);
    assert_non_null(boxes);
    return boxes;
}

/* Of three random corners around a random centre. */
static inline struct bvh_box *soup(uint32_t count, float size)
{
    struct bvh_box *boxes = boxes_alloc(count);
    for (uint32_t i = 0; i < count; ++i) {
        for (int a = 0; a < 3; ++a) {
            float centre = random_float(&random_state);
            boxes[i].lo[a] = FLT_MAX, boxes[i].hi[a] = -FLT_MAX;
            for (int k = 0; k < 3; ++k) {
                float x = centre + size * (random_float(&random_state) - 0.5f);
                boxes[i].lo[a] = fminf(boxes[i].lo[a], x);
                boxes[i].hi[a] = fmaxf(boxes[i].hi[a], x);
            }
        }
    }
    return boxes;
}

static inline bool boxes_equal(const struct gpu_bvh_node *node, const struct bvh_box *box)
{
    bool equal = true;
    for (int a = 0; a < 3; ++a)
        equal &= node->lo[a] == box->lo[a] && node->hi[a] == box->hi[a];
    return equal;
}

static inline void box_unite(struct bvh_box *a, const float lo[3], const float hi[3])
{
    for (int i = 0; i < 3; ++i) {
        a->lo[i] = fminf(a->lo[i], lo[i]);
        a->hi[i] = fmaxf(a->hi[i], hi[i]);
    }
}

struct found {
    uint32_t depth, leaves;
    double cost; /* not yet divided by the root's area */
    double traversal_cost;
};

static inline double area(const struct gpu_bvh_node *n)
{
    double x = (double)n->hi[0] - (double)n->lo[0], y = (double)n->hi[1] - (double)n->lo[1],
           z = (double)n->hi[2] - (double)n->lo[2];
    return x * y + y * z + z * x;
}

/* Every box is exactly the union of what is below; depth and cost are counted on the way. */
static inline void walk_exact(const struct bvh *bvh, const struct bvh_box *boxes, uint32_t index,
                              uint32_t depth, struct found *found)
{
    const struct gpu_bvh_node *node = &bvh->nodes[index];
    struct bvh_box sum = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    if (bvh_count(node) > 0) {
        for (uint32_t i = 0; i < bvh_count(node); ++i) {
            const struct bvh_box *box = &boxes[bvh->order[node->first + i]];
            box_unite(&sum, box->lo, box->hi);
        }
        found->depth = depth > found->depth ? depth : found->depth;
        found->cost += area(node) * bvh_count(node);
        ++found->leaves;
    } else {
        const struct gpu_bvh_node *pair = &bvh->nodes[node->first];
        box_unite(&sum, pair[0].lo, pair[0].hi);
        box_unite(&sum, pair[1].lo, pair[1].hi);
        found->cost += area(node) * found->traversal_cost;
        walk_exact(bvh, boxes, node->first, depth + 1, found);
        walk_exact(bvh, boxes, node->first + 1, depth + 1, found);
    }
    assert_true(boxes_equal(node, &sum));
}

/* A triangle for each box, which is its box. */
static inline struct bvh_triangles triangles_of_boxes(const struct bvh_box *boxes, uint32_t count)
{
    float *positions = calloc(9 * (size_t)count + 1, sizeof *positions);
    uint32_t *indices = calloc(3 * (size_t)count + 1, sizeof *indices);
    assert_non_null(positions);
    assert_non_null(indices);
    for (uint32_t i = 0; i < count; ++i) {
        const float *lo = boxes[i].lo, *hi = boxes[i].hi;
        const float corners[9] = {lo[0], lo[1], lo[2], hi[0], hi[1], lo[2], lo[0], hi[1], hi[2]};
        memcpy(&positions[9 * (size_t)i], corners, sizeof corners);
    }
    for (uint32_t i = 0; i < 3 * count; ++i)
        indices[i] = i;
    return (struct bvh_triangles){positions, indices, NULL};
}

static inline void triangles_free(const struct bvh_triangles *triangles)
{
    free((void *)(uintptr_t)triangles->positions);
    free((void *)(uintptr_t)triangles->indices);
}

/* A tree that holds what bvh_validate does not look at. */
static inline void check_whole(const struct bvh *bvh, const struct bvh_box *boxes,
                               double traversal_cost)
{
    struct found found = {.traversal_cost = traversal_cost};
    walk_exact(bvh, boxes, 0, 0, &found);
    assert_int_equal(found.depth, bvh->depth);
    assert_int_equal(found.leaves, bvh->leaf_count);
    double root = area(&bvh->nodes[0]);
    if (root > 0.0)
        assert_true(fabs(found.cost / root - bvh->sah_cost) <= 1e-9 * bvh->sah_cost);
}

static inline void build_and_check(const struct bvh_box *boxes, uint32_t count,
                                   const struct bvh_params *params, struct bvh *bvh)
{
    uint32_t limit = params && params->leaf_limit ? params->leaf_limit : 4;
    assert_int_equal(bvh_build(&silent, boxes, count, params, bvh), WHIT_OK);
    assert_int_equal(bvh_validate(&silent, bvh, boxes, limit), WHIT_OK);
    assert_int_equal(bvh->primitive_count, count);
    assert_true(bvh->leaf_largest <= limit);
    assert_true(isfinite(bvh->sah_cost));
    assert_true(bvh->depth < 128);
    if (count > 0 && bvh->reference_count == count)
        check_whole(bvh, boxes,
                    params && params->traversal_cost > 0.0f ? (double)params->traversal_cost : 1.0);
}

/* Every builder, several leaf limits and bin counts. */
static const struct bvh_params every_builder[] = {
    {.builder = BVH_BINNED, .thread_count = 1},
    {.builder = BVH_BINNED, .thread_count = 2, .leaf_limit = 1, .bins = 7},
    {.builder = BVH_BINNED, .thread_count = 1, .leaf_limit = BVH_LEAF_MAX, .bins = 256},
    {.builder = BVH_BINNED, .thread_count = 1, .leaf_limit = 2, .bins = 2},
    {.builder = BVH_BINNED, .thread_count = 2, .leaf_limit = 1, .optimize = true},
    {.builder = BVH_MEDIAN, .thread_count = 2},
    {.builder = BVH_SWEEP, .thread_count = 2},
    {.builder = BVH_SWEEP, .thread_count = 1, .leaf_limit = 1},
    {.builder = BVH_SWEEP, .thread_count = 1, .leaf_limit = BVH_LEAF_MAX, .traversal_cost = 3.0f},
    {.builder = BVH_SPATIAL, .thread_count = 2},
    {.builder = BVH_SPATIAL, .thread_count = 1, .leaf_limit = 1, .spatial_alpha = 1e-9f},
};
enum { EVERY_BUILDER = sizeof every_builder / sizeof *every_builder };
_Static_assert(BVH_NONE == 4, "every builder is in the list");

/* All of them on the same boxes. */
static inline void check_all(const struct bvh_box *boxes, uint32_t count)
{
    struct bvh_triangles triangles = triangles_of_boxes(boxes, count);
    for (size_t i = 0; i < EVERY_BUILDER; ++i) {
        struct bvh_params params = every_builder[i];
        struct bvh bvh;
        params.triangles = &triangles;
        build_and_check(boxes, count, &params, &bvh);
        bvh_finish(&bvh);
    }
    triangles_free(&triangles);
}

/* Any finite bits, up to the largest float. */
static inline struct bvh_box *garbage(uint32_t count)
{
    struct bvh_box *boxes = boxes_alloc(count);
    for (uint32_t i = 0; i < 3 * count; ++i) {
        float x[2];
        for (int k = 0; k < 2; ++k) {
            uint32_t bits;
            do {
                bits = random_bits(&random_state);
                memcpy(&x[k], &bits, sizeof bits);
            } while (!isfinite(x[k]));
        }
        boxes[i / 3].lo[i % 3] = fminf(x[0], x[1]);
        boxes[i / 3].hi[i % 3] = fmaxf(x[0], x[1]);
    }
    return boxes;
}

static inline void keep_message(void *user, whit_log_level level, const char *message)
{
    assert_int_equal(level, WHIT_LOG_ERROR);
    strncat(user, message, 200);
}

#endif
