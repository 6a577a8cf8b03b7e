/* The validator: trees with words written over are refused, or still the trees of their scene. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "accel/validate.h"
#include "trees.h"

enum { BUILD_COUNT = 6, FLAT = 2, PATCH_BYTES = 7, PATCHES_MAX = 64 };

static struct accel *accels[FUZZ_SCENE_COUNT][BUILD_COUNT][FLAT];

static void prepare(void)
{
    for (int kind = 0; kind < FUZZ_SCENE_COUNT; kind++) {
        struct scene *scene = fuzz_scene_make((enum fuzz_scene)kind);
        for (uint32_t i = 0; i < BUILD_COUNT * FLAT; i++) {
            whit_accel_params params = fuzz_tree_params(i / FLAT);
            params.instances = i % FLAT ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON;
            struct accel **out = &accels[kind][i / FLAT][i % FLAT];
            fuzz_check(accel_create(&fuzz_log, scene, &params, out) == WHIT_OK, "no trees");
            fuzz_check(accel_validate(*out) == WHIT_OK, "trees that are refused as they are");
        }
    }
}

/* Memory that patches may change: the words that the validator checks. */
struct area {
    uint8_t *bytes;
    size_t size_bytes; /* of all elements */
    size_t stride, used_bytes;
};

static uint32_t list_areas(struct accel *accel, struct area areas[4])
{
    uint32_t meshes = accel->flat ? 1 : accel->mesh_count;
    areas[0] = (struct area){(uint8_t *)accel->nodes, accel->node_count * sizeof *accel->nodes,
                             sizeof *accel->nodes, sizeof *accel->nodes};
    areas[1] =
        (struct area){(uint8_t *)accel->triangles, accel->record_count * sizeof *accel->triangles,
                      sizeof *accel->triangles, offsetof(struct gpu_triangle, shadow)};
    areas[2] = (struct area){(uint8_t *)accel->meshes, meshes * sizeof *accel->meshes,
                             sizeof *accel->meshes, offsetof(struct accel_mesh, sah_cost)};
    /* root, shade_base and mesh; not the matrices, which no tree is checked against. */
    areas[3] = (struct area){(uint8_t *)accel->instances + offsetof(struct gpu_instance, root),
                             accel->instance_count * sizeof *accel->instances,
                             sizeof *accel->instances, 12};
    return 4;
}

/* One patch: the area, the element and word, and the word's new value, or a bit to flip in it. */
static void patch(struct accel *accel, const uint8_t *data)
{
    struct area areas[4], *area = &areas[data[0] % list_areas(accel, areas)];
    size_t elements = area->size_bytes / area->stride;
    if (elements == 0)
        return;
    size_t element = (data[1] | (size_t)(data[2] >> 4) << 8) % elements;
    uint8_t *at = area->bytes + element * area->stride + data[2] % 16 * 4 % area->used_bytes;
    uint32_t word, value;
    memcpy(&word, at, 4);
    memcpy(&value, data + 3, 4);
    word = data[0] & 128 ? word ^ 1u << value % 32 : data[0] & 64 ? word + (value & 15) - 8 : value;
    memcpy(at, &word, 4);
}

struct kept {
    void *nodes, *triangles, *meshes, *instances;
};

static void *keep(const void *from, size_t bytes)
{
    void *copy = malloc(bytes ? bytes : 1);
    fuzz_check(copy, "out of memory");
    return bytes ? memcpy(copy, from, bytes) : copy;
}

static void give_back(void *to, void *kept, size_t bytes)
{
    if (bytes)
        memcpy(to, kept, bytes);
    free(kept);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    if (size_bytes < 2)
        return;
    struct accel *accel =
        accels[data[0] % FUZZ_SCENE_COUNT][data[1] / FLAT % BUILD_COUNT][data[1] % FLAT];
    size_t node_bytes = accel->node_count * sizeof *accel->nodes;
    size_t triangle_bytes = accel->record_count * sizeof *accel->triangles;
    size_t mesh_bytes = (accel->flat ? 1 : accel->mesh_count) * sizeof *accel->meshes;
    size_t instance_bytes = accel->instance_count * sizeof *accel->instances;
    struct kept kept = {keep(accel->nodes, node_bytes), keep(accel->triangles, triangle_bytes),
                        keep(accel->meshes, mesh_bytes), keep(accel->instances, instance_bytes)};
    size_t patches = (size_bytes - 2) / PATCH_BYTES;
    for (size_t i = 0; i < patches && i < PATCHES_MAX; i++)
        patch(accel, data + 2 + i * PATCH_BYTES);
    fuzz_log_clear();
    whit_result result = accel_validate(accel);
    fuzz_check(result == WHIT_OK || result == WHIT_ERROR_FAILED, "the result is %d", (int)result);
    if (result == WHIT_OK)
        fuzz_check_rays(accel);
    give_back(accel->nodes, kept.nodes, node_bytes);
    give_back(accel->triangles, kept.triangles, triangle_bytes);
    give_back(accel->meshes, kept.meshes, mesh_bytes);
    give_back(accel->instances, kept.instances, instance_bytes);
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(1) << 20};
