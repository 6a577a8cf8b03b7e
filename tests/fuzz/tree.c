/* Saved trees: a file that is accepted holds trees by which rays find what they find without. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "trees.h"

static struct scene *scenes[FUZZ_SCENE_COUNT];

static void prepare(void)
{
    for (int kind = 0; kind < FUZZ_SCENE_COUNT; kind++)
        scenes[kind] = fuzz_scene_make((enum fuzz_scene)kind);
}

/* The first byte says which scene the file is for, and whether its checksum is made to fit. */
static void run(const uint8_t *data, size_t size_bytes)
{
    if (size_bytes == 0)
        return;
    size_t file_bytes = size_bytes - 1;
    uint8_t *file = malloc(file_bytes ? file_bytes : 1);
    fuzz_check(file, "out of memory");
    memcpy(file, data + 1, file_bytes);
    if (!(data[0] & 128))
        fuzz_sign_tree(file, file_bytes);
    const char *path = fuzz_file("saved.bvh", file, file_bytes);
    struct accel_params params = {.tree_file = path, .validate = true};
    params.mesh.thread_count = params.instances.thread_count = 1;
    struct accel *accel = NULL;
    fuzz_log_clear();
    whit_result result =
        accel_create(&fuzz_log, scenes[data[0] % FUZZ_SCENE_COUNT], &params, &accel);
    fuzz_check_errors(result, path);
    if (accel)
        fuzz_check_rays(accel);
    accel_destroy(accel);
    free(file);
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(16) << 20};
