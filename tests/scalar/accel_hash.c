/* Prints a hash of the tree of every builder over some boxes: the same whatever f4.h is made of. */
#include <stdio.h>
#include <stdlib.h>

#include "../random.h"
#include "accel/accel.h"

enum { COUNT = 6000 };

/* Every other triangle is one of a grid, where planes cost the same but for rounding. */
static void triangles_make(float *positions, uint32_t *indices, struct bvh_box *boxes)
{
    uint64_t state = 1;
    for (uint32_t i = 0; i < COUNT; ++i) {
        struct bvh_box *box = &boxes[i];
        for (uint32_t k = 0; k < 9; ++k) {
            float *at = &positions[9 * i + k];
            *at = k < 3 ? random_float(&state) : at[-3] + 0.05f * (random_float(&state) - 0.5f);
            if (i % 2 == 0) {
                const uint32_t cell[3] = {i % 13, i / 13 % 17, i / 221};
                *at = 0.1f * (float)cell[k % 3] + (k / 3 == k % 3 ? 0.07f : 0.0f);
            }
            if (k < 3 || *at < box->lo[k % 3])
                box->lo[k % 3] = *at;
            if (k < 3 || *at > box->hi[k % 3])
                box->hi[k % 3] = *at;
        }
        for (uint32_t k = 0; k < 3; ++k)
            indices[3 * i + k] = 3 * i + k;
    }
}

/* FNV-1a */
static uint64_t hash(uint64_t sum, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; ++i)
        sum = (sum ^ ((const uint8_t *)bytes)[i]) * 0x100000001b3u;
    return sum;
}

int main(void)
{
    static float positions[9 * COUNT];
    static uint32_t indices[3 * COUNT];
    static struct bvh_box boxes[COUNT];
    triangles_make(positions, indices, boxes);
    const struct bvh_triangles triangles = {positions, indices, NULL};
    const struct log silent = {0};
    static const struct bvh_params builders[] = {
        {.builder = BVH_BINNED},
        {.builder = BVH_BINNED, .bins = 7, .leaf_limit = 1},
        {.builder = BVH_MEDIAN},
        {.builder = BVH_SWEEP},
        {.builder = BVH_SPATIAL, .spatial_alpha = 1e-8f},
        {.builder = BVH_SWEEP, .optimize = true},
    };
    for (size_t i = 0; i < sizeof builders / sizeof *builders; ++i) {
        struct bvh_params params = builders[i];
        struct bvh bvh;
        params.triangles = &triangles;
        if (bvh_build(&silent, boxes, COUNT, &params, &bvh) != WHIT_OK)
            return 1;
        uint64_t sum = hash(0xcbf29ce484222325u, bvh.nodes, bvh.node_count * sizeof *bvh.nodes);
        sum = hash(sum, bvh.order, bvh.reference_count * sizeof *bvh.order);
        printf("%zu: %u nodes %016llx\n", i, bvh.node_count, (unsigned long long)sum);
        bvh_finish(&bvh);
    }
    return 0;
}
