/* Every builder on one, two and four threads, under ThreadSanitizer: it reports any two accesses to
   the same bytes that nothing orders. And the trees are the same. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../random.h"
#include "accel/accel.h"
#include "base/array.h"

enum { THREADS_MAX = 4 };

/* From some 2,000 on a tree is built by several threads. */
static const uint32_t counts[] = {1, 2, 3, 40, 300, 2200, 2500, 4500};
enum { MESHES = sizeof counts / sizeof *counts };

static void print_message(void *user, whit_log_level level, const char *message)
{
    (void)user, (void)level;
    fprintf(stderr, "%s\n", message);
}

static const struct log to_stderr = {.fn = print_message, .level = WHIT_LOG_WARNING};

static const struct bvh_params builders[] = {
    {.builder = BVH_BINNED},
    {.builder = BVH_BINNED, .bins = 7, .leaf_limit = 1},
    {.builder = BVH_MEDIAN},
    {.builder = BVH_SWEEP},
    {.builder = BVH_SPATIAL, .spatial_alpha = 1e-8f},
    {.builder = BVH_SWEEP, .optimize = true},
    {.builder = BVH_SPATIAL, .spatial_alpha = 1e-8f, .optimize = true},
};

struct mesh {
    struct bvh_triangles triangles;
    float *positions;
    uint32_t *indices;
    struct bvh_box *boxes;
    uint32_t count;
};

/* Triangles of one size, or large ones among them, or many that are the same. */
static bool mesh_init(struct mesh *mesh, uint32_t number)
{
    uint64_t state = number;
    mesh->count = counts[number];
    mesh->positions = array_alloc(9 * (size_t)mesh->count, sizeof *mesh->positions);
    mesh->indices = array_alloc(3 * (size_t)mesh->count, sizeof *mesh->indices);
    mesh->boxes = array_alloc(mesh->count, sizeof *mesh->boxes);
    if (!mesh->positions || !mesh->indices || !mesh->boxes)
        return false;
    for (uint32_t i = 0; i < mesh->count; ++i) {
        struct bvh_box *box = &mesh->boxes[i];
        float *corners = &mesh->positions[9 * (size_t)i];
        float size = number % 2 && i % 8 == 0 ? 1.0f : 0.02f;
        for (uint32_t k = 0; k < 9; ++k)
            corners[k] = (k < 3 ? random_float(&state) : corners[k - 3]) +
                         size * (random_float(&state) - 0.5f);
        if (number % 3 == 2 && i % 4 == 0)
            memcpy(corners, mesh->positions, 9 * sizeof *corners);
        for (uint32_t k = 0; k < 3; ++k) {
            mesh->indices[3 * i + k] = 3 * i + k;
            box->lo[k] = fminf(corners[k], fminf(corners[k + 3], corners[k + 6]));
            box->hi[k] = fmaxf(corners[k], fmaxf(corners[k + 3], corners[k + 6]));
        }
    }
    mesh->triangles = (struct bvh_triangles){mesh->positions, mesh->indices, NULL};
    return true;
}

static void mesh_finish(struct mesh *mesh)
{
    free(mesh->positions);
    free(mesh->indices);
    free(mesh->boxes);
}

static bool trees_equal(const struct bvh *a, const struct bvh *b)
{
    return a->node_count == b->node_count && a->reference_count == b->reference_count &&
           memcmp(a->nodes, b->nodes, a->node_count * sizeof *a->nodes) == 0 &&
           memcmp(a->order, b->order, a->reference_count * sizeof *a->order) == 0;
}

static bool check(const struct mesh *mesh, const struct bvh_params *builder)
{
    struct bvh one = {0}, other = {0};
    struct bvh_params params = *builder;
    params.triangles = &mesh->triangles;
    params.thread_count = 1;
    bool good = bvh_build(&to_stderr, mesh->boxes, mesh->count, &params, &one) == WHIT_OK;
    for (params.thread_count = 2; good && params.thread_count <= THREADS_MAX;
         params.thread_count *= 2) {
        good = bvh_build(&to_stderr, mesh->boxes, mesh->count, &params, &other) == WHIT_OK &&
               trees_equal(&one, &other);
        bvh_finish(&other);
    }
    bvh_finish(&one);
    return good;
}

int main(void)
{
    bool good = true;
    for (uint32_t m = 0; good && m < MESHES; ++m) {
        struct mesh mesh = {0};
        good = mesh_init(&mesh, m);
        for (size_t b = 0; good && b < sizeof builders / sizeof *builders; ++b) {
            good = check(&mesh, &builders[b]);
            if (!good)
                fprintf(stderr, "mesh %u, builder %zu: no tree, or another one\n", m, b);
        }
        mesh_finish(&mesh);
    }
    return good ? 0 : 1;
}
