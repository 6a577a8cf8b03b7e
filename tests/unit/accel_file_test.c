/* Saved trees: what is read is what was written, and nothing else is read. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../random.h"
#include "../scenes.h"
#include "accel/accel.h"
#include "accel/bvh_file.h"
#include "base/file.h"
#include "base/hash.h"

static char folder[] = "/tmp/whit_accel_file_XXXXXX";
static char path[64], other[64];

/* Messages of the library: how many, and the last one. */
static struct {
    uint32_t count;
    char text[512];
} said;

static void listen(void *user, whit_log_level level, const char *message)
{
    (void)user;
    (void)level;
    ++said.count;
    snprintf(said.text, sizeof said.text, "%s", message);
}

static const struct log heard = {.fn = listen, .level = WHIT_LOG_WARNING};

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/a.bvh", folder);
    snprintf(other, sizeof other, "%s/b.bvh", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(path);
    unlink(other);
    return rmdir(folder);
}

static struct scene *spheres(uint32_t first, uint32_t second, double radius, bool painted)
{
    struct scene *scene = scene_begin(&heard, "balls");
    struct scene_material paint = material_grey("paint");
    paint.diffuse[0] = painted ? 0.25f : 0.75f;
    scene_put_material(scene, paint);
    scene_put(scene, mesh_sphere(radius, first, first), NULL);
    scene_put(scene, mesh_sphere(radius, second, second), NULL);
    return scene_ready(scene);
}

/* Long thin triangles that cross, opaque or of glass. */
static struct scene *needles(bool glass)
{
    enum { COUNT = 200 };
    float corners[9 * COUNT];
    uint64_t random = 3;
    for (uint32_t i = 0; i < 9 * COUNT; ++i) {
        corners[i] = random_float(&random);
        if (i % 9 >= 6) /* the third corner is near the second */
            corners[i] = corners[i - 3] + 0.01f * corners[i];
    }
    struct scene *scene = scene_begin(&heard, "needles");
    struct scene_material needle = material_grey("needle");
    needle.transmission[0] = glass ? 0.5f : 0.0f;
    scene_put(scene, mesh_triangles(corners, COUNT), &(struct put){.material = &needle});
    return scene_ready(scene);
}

static whit_result create(const struct scene *scene, const struct bvh_params *mesh,
                          const char *file, struct accel **accel)
{
    struct accel_params params = {.mesh = *mesh, .tree_file = file, .validate = true};
    params.mesh.thread_count = params.instances.thread_count = 1;
    said.count = 0;
    return accel_create(&heard, scene, &params, accel);
}

static void save(const struct scene *scene, const struct bvh_params *mesh, const char *file)
{
    struct accel *accel;
    assert_int_equal(create(scene, mesh, NULL, &accel), WHIT_OK);
    assert_int_equal(bvh_file_write(accel, file), WHIT_OK);
    accel_destroy(accel);
}

static uint8_t *bytes_of(const char *file, size_t *size)
{
    uint8_t *bytes;
    assert_int_equal(file_read(&heard, NULL, file, 0, &bytes, size), WHIT_OK);
    return bytes;
}

static void write_bytes(const uint8_t *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* Gives it a checksum that fits, as who damages a file on purpose would. */
static void sign(uint8_t *bytes, size_t size)
{
    uint64_t checksum = hash_bytes(HASH_START, bytes, size - sizeof checksum);
    memcpy(bytes + size - sizeof checksum, &checksum, sizeof checksum);
}

/* One error, which names the file. */
static void assert_refused(const struct scene *scene, const char *pattern)
{
    static const struct bvh_params defaults;
    struct accel *accel;
    assert_int_equal(create(scene, &defaults, path, &accel), WHIT_ERROR_INPUT);
    assert_null(accel);
    assert_int_equal(said.count, 1);
    assert_memory_equal(said.text, path, strlen(path));
    if (!strstr(said.text, pattern))
        fail_msg("`%s` lacks `%s`", said.text, pattern);
}

/* The same of bytes in memory, of which thousands can be tried; exactly as long as they are said to
   be, for sanitizers. */
static whit_result parse(const struct scene *scene, const uint8_t *bytes, size_t size)
{
    struct bvh_params params = {0};
    struct bvh *trees = calloc(scene->mesh_count, sizeof *trees);
    uint8_t *copy = malloc(size ? size : 1);
    assert_true(trees && copy);
    memcpy(copy, bytes, size);
    said.count = 0;
    whit_result result = bvh_file_parse(&heard, path, copy, size, scene, &params, trees);
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        assert_true(result == WHIT_OK || !trees[i].nodes);
        bvh_finish(&trees[i]);
    }
    free(trees);
    free(copy);
    assert_int_equal(said.count, result == WHIT_OK ? 0 : 1);
    return result;
}

static void assert_bytes_refused(const struct scene *scene, const uint8_t *bytes, size_t size,
                                 const char *pattern)
{
    assert_int_equal(parse(scene, bytes, size), WHIT_ERROR_INPUT);
    assert_memory_equal(said.text, path, strlen(path));
    if (!strstr(said.text, pattern))
        fail_msg("`%s` lacks `%s`", said.text, pattern);
}

/* ---- Round trips ---- */

static const struct bvh_params builds[] = {
    {.builder = BVH_BINNED},
    {.builder = BVH_BINNED, .bins = 7, .leaf_limit = 15, .traversal_cost = 2.5f},
    {.builder = BVH_MEDIAN, .leaf_limit = 1},
    {.builder = BVH_BINNED, .optimize = true},
    {.builder = BVH_SPATIAL, .spatial_alpha = 1e-8f, .spatial_budget = 1.0f},
};

static void assert_same(const struct accel *a, const struct accel *b)
{
    assert_int_equal(a->node_count, b->node_count);
    assert_int_equal(a->record_count, b->record_count);
    assert_memory_equal(a->nodes, b->nodes, a->node_count * sizeof *a->nodes);
    assert_memory_equal(a->triangles, b->triangles, a->record_count * sizeof *a->triangles);
    assert_int_equal(a->mesh_depth, b->mesh_depth);
    assert_int_equal(a->clipped, b->clipped);
    for (uint32_t i = 0; i < a->mesh_count; ++i)
        assert_true(a->meshes[i].sah_cost == b->meshes[i].sah_cost);
}

static void trees_come_back(void **state)
{
    (void)state;
    struct scene *scene = spheres(30, 7, 1.0, false);
    for (size_t i = 0; i < sizeof builds / sizeof builds[0]; ++i) {
        static const struct bvh_params defaults;
        struct accel *built, *loaded;
        assert_int_equal(create(scene, &builds[i], NULL, &built), WHIT_OK);
        assert_int_equal(bvh_file_write(built, path), WHIT_OK);
        assert_int_equal(create(scene, &defaults, path, &loaded), WHIT_OK);
        assert_int_equal(said.count, 0);
        assert_same(built, loaded);
        assert_int_equal(loaded->params.mesh.builder, builds[i].builder);
        assert_int_equal(loaded->params.mesh.bins, builds[i].bins);
        assert_int_equal(loaded->params.mesh.optimize, builds[i].optimize);
        assert_int_equal(bvh_file_write(loaded, other), WHIT_OK);
        size_t first_size, second_size;
        uint8_t *first = bytes_of(path, &first_size), *second = bytes_of(other, &second_size);
        assert_int_equal(first_size, second_size);
        assert_memory_equal(first, second, first_size);
        free(first);
        free(second);
        accel_destroy(built);
        accel_destroy(loaded);
    }
    scene_destroy(scene);
}

static void paint_does_not_matter(void **state)
{
    (void)state;
    struct scene *grey = spheres(9, 5, 1.0, false), *painted = spheres(9, 5, 1.0, true);
    struct accel *accel;
    save(grey, &builds[0], path);
    assert_int_equal(create(painted, &builds[0], path, &accel), WHIT_OK);
    accel_destroy(accel);
    scene_destroy(grey);
    scene_destroy(painted);
}

/* A filter must be met once, so no leaf may hold a part of one: for trees that split triangles the
   paint does matter. */
static void split_filters_are_refused(void **state)
{
    (void)state;
    static const struct bvh_params spatial = {
        .builder = BVH_SPATIAL, .spatial_alpha = 1e-9f, .spatial_budget = 2.0f, .leaf_limit = 1};
    struct scene *solid = needles(false), *glass = needles(true);
    struct accel *accel;
    assert_int_equal(create(solid, &spatial, NULL, &accel), WHIT_OK);
    assert_true(accel->record_count > accel->triangle_count);
    accel_destroy(accel);
    save(solid, &spatial, path);
    assert_int_equal(create(solid, &spatial, path, &accel), WHIT_OK);
    accel_destroy(accel);
    assert_refused(glass, "splits a triangle that filters light");
    save(glass, &spatial, path);
    assert_int_equal(create(solid, &spatial, path, &accel), WHIT_OK);
    accel_destroy(accel);
    scene_destroy(solid);
    scene_destroy(glass);
}

/* ---- Refusals ---- */

static void other_scenes_are_refused(void **state)
{
    (void)state;
    struct scene *scene = spheres(9, 5, 1.0, false);
    struct scene *larger = spheres(9, 5, nextafter(1.0f, 2.0f) + 1e-6, false);
    struct scene *finer = spheres(9, 6, 1.0, false), *swapped = spheres(5, 9, 1.0, false);
    struct scene *empty = scene_create(&heard, "empty");
    assert_non_null(empty);
    assert_int_equal(scene_freeze(empty), WHIT_OK);
    save(scene, &builds[0], path);
    assert_refused(larger, "the triangles of balls are others");
    assert_refused(finer, "the triangles of balls are others");
    assert_refused(swapped, "the triangles of balls are others");
    assert_refused(empty, "2 meshes, but empty has 0");
    scene_destroy(scene);
    scene_destroy(larger);
    scene_destroy(finer);
    scene_destroy(swapped);
    scene_destroy(empty);
}

static void every_flipped_byte_is_refused(void **state)
{
    (void)state;
    struct scene *scene = spheres(4, 3, 1.0, false);
    save(scene, &builds[0], path);
    size_t size;
    uint8_t *bytes = bytes_of(path, &size);
    for (size_t i = 0; i < size; ++i) {
        for (int bit = 0; bit < 8; bit += 7) {
            bytes[i] ^= (uint8_t)(1 << bit);
            assert_bytes_refused(scene, bytes, size, "");
            bytes[i] ^= (uint8_t)(1 << bit);
        }
    }
    free(bytes);
    scene_destroy(scene);
}

static void every_other_length_is_refused(void **state)
{
    (void)state;
    struct scene *scene = spheres(4, 3, 1.0, false);
    save(scene, &builds[0], path);
    size_t size;
    uint8_t *bytes = bytes_of(path, &size);
    for (size_t i = 0; i < size; ++i)
        assert_bytes_refused(scene, bytes, i, i == 0 ? "" : "cut short");
    uint8_t *longer = calloc(size + 1, 1);
    assert_non_null(longer);
    memcpy(longer, bytes, size);
    write_bytes(longer, size + 1);
    assert_refused(scene, "too long");
    free(longer);
    free(bytes);
    scene_destroy(scene);
}

/* Right checksums over wrong words: refused, or by chance still these trees. Nothing is read or
   written out of bounds, as a build with sanitizers shows. */
static void signed_garbage_does_no_harm(void **state)
{
    (void)state;
    struct scene *scene = spheres(6, 4, 1.0, false);
    save(scene, &builds[0], path);
    size_t size;
    uint8_t *bytes = bytes_of(path, &size);
    uint64_t random = 5;
    uint32_t refused = 0;
    for (int round = 0; round < 3000; ++round) {
        uint8_t *copy = malloc(size);
        assert_non_null(copy);
        memcpy(copy, bytes, size);
        for (int k = 0; k <= round % 3; ++k) {
            uint32_t bits = random_bits(&random);
            uint32_t words[] = {0, 1, UINT32_MAX, bits, 0x7fc00000u, 128, 0x0fffffffu, 2};
            /* A third of them in the headers. */
            size_t at = (bits >> 4) % (round % 3 == 0 ? 104 : size - 8);
            memcpy(copy + (at & ~(size_t)3), &words[bits >> 29], 4);
        }
        sign(copy, size);
        whit_result result = parse(scene, copy, size);
        assert_true(result == WHIT_OK || result == WHIT_ERROR_INPUT);
        refused += result != WHIT_OK;
        free(copy);
    }
    assert_true(refused > 2000);
    free(bytes);
    scene_destroy(scene);
}

enum { HEADER_BYTES = 80, MESH_BYTES = 24, NODE_BYTES = 32 };

/* Bad trees with right checksums. */
static void bad_trees_are_refused(void **state)
{
    (void)state;
    struct scene *scene = spheres(8, 4, 1.0, false);
    save(scene, &builds[0], path);
    size_t size;
    uint8_t *bytes = bytes_of(path, &size);
    const size_t root = HEADER_BYTES + MESH_BYTES;
    const struct {
        size_t at;
        uint32_t word;
        const char *says;
    } cases[] = {
        {8, 2, "version 2"},
        {12, 0x04030201, "another order of bytes"},
        {32, 0x78787878, "builder is not known"},
        {48, 3, "3 meshes"},
        {56, 16, "builder is not known"},
        {HEADER_BYTES, 3, "mesh 0: tree: nodes are not in aligned pairs"},
        {HEADER_BYTES, 0xff00, "counts do not fit"},
        {HEADER_BYTES + 4, 3, "counts do not fit"},
        {HEADER_BYTES + 8, 0x40000000, "counts do not fit"},
        {HEADER_BYTES + 12, 1, "number of leaves"},
        {HEADER_BYTES + 16, 100, "depth"},
        {HEADER_BYTES + 16, 129, "at most 128"},
        {root, 0, "not inside its parent"},
        {root, 0x7fc00000, "not finite"},
        {root + 12, 1, "even"},
        {root + 12, 0x00fffffe, "out of range"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        uint32_t before;
        memcpy(&before, bytes + cases[i].at, sizeof before);
        memcpy(bytes + cases[i].at, &cases[i].word, sizeof before);
        sign(bytes, size);
        assert_bytes_refused(scene, bytes, size, cases[i].says);
        memcpy(bytes + cases[i].at, &before, sizeof before);
    }
    sign(bytes, size);
    assert_int_equal(parse(scene, bytes, size), WHIT_OK);
    free(bytes);
    scene_destroy(scene);
}

/* Leaves get boxes that are too small, one at a time. Where it holds the middle of a triangle, the
   boxes of all its leaves still unite to its own: only its points show what is missing. */
static void lost_parts_are_refused(void **state)
{
    (void)state;
    static const struct bvh_params spatial = {
        .builder = BVH_SPATIAL, .spatial_alpha = 1e-9f, .spatial_budget = 2.0f, .leaf_limit = 1};
    struct scene *scene = needles(false);
    save(scene, &spatial, path);
    size_t size;
    uint8_t *bytes = bytes_of(path, &size);
    uint32_t node_count, by_points = 0;
    memcpy(&node_count, bytes + HEADER_BYTES, sizeof node_count);
    for (uint32_t i = 2; i < node_count && by_points < 5; ++i) {
        uint8_t *at = bytes + HEADER_BYTES + MESH_BYTES + (size_t)i * NODE_BYTES;
        struct gpu_bvh_node before, node;
        memcpy(&before, at, sizeof before);
        if (bvh_count(&before) == 0)
            continue;
        node = before;
        for (int k = 0; k < 3; ++k)
            node.hi[k] = node.lo[k] + (node.hi[k] - node.lo[k]) * 0.25f;
        struct gpu_bvh_node pair[2];
        uint8_t *pair_at = at - (i % 2) * NODE_BYTES;
        memcpy(at, &node, sizeof node);
        memcpy(pair, pair_at, sizeof pair);
        bvh_set_axis(pair);
        memcpy(pair_at, pair, sizeof pair);
        sign(bytes, size);
        assert_bytes_refused(scene, bytes, size, "");
        by_points += strstr(said.text, "in none of its leaves") != NULL;
        memcpy(at, &before, sizeof before);
        memcpy(pair, pair_at, sizeof pair);
        bvh_set_axis(pair);
        memcpy(pair_at, pair, sizeof pair);
    }
    assert_int_equal(by_points, 5);
    free(bytes);
    scene_destroy(scene);
}

static void files_that_are_none_are_refused(void **state)
{
    (void)state;
    struct scene *scene = spheres(4, 3, 1.0, false);
    const uint8_t text[] = "{ \"objects\": [] }";
    write_bytes(text, sizeof text);
    assert_refused(scene, "no file of trees");
    unlink(path);
    assert_refused(scene, "no such file");
    scene_destroy(scene);
}

/* A folder that is not there: an error, and nothing is left behind. */
static void writing_fails_cleanly(void **state)
{
    (void)state;
    struct scene *scene = spheres(4, 3, 1.0, false);
    struct accel *accel;
    assert_int_equal(create(scene, &builds[0], NULL, &accel), WHIT_OK);
    char nowhere[96];
    snprintf(nowhere, sizeof nowhere, "%s/nowhere/a.bvh", folder);
    said.count = 0;
    assert_int_equal(bvh_file_write(accel, nowhere), WHIT_ERROR_OUTPUT);
    assert_int_equal(said.count, 1);
    accel_destroy(accel);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_come_back),
        cmocka_unit_test(paint_does_not_matter),
        cmocka_unit_test(split_filters_are_refused),
        cmocka_unit_test(other_scenes_are_refused),
        cmocka_unit_test(every_flipped_byte_is_refused),
        cmocka_unit_test(every_other_length_is_refused),
        cmocka_unit_test(signed_garbage_does_no_harm),
        cmocka_unit_test(bad_trees_are_refused),
        cmocka_unit_test(lost_parts_are_refused),
        cmocka_unit_test(files_that_are_none_are_refused),
        cmocka_unit_test(writing_fails_cleanly),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
