/* kernel_dump FOLDER
   writes FOLDER/<kernel>.spv for each embedded kernel and FOLDER/portable_<kernel>.spv, in which
   nothing is left to drivers, and prints the specialization constants, one `id name default` a
   line.
   kernel_dump OUT.spv KERNEL "id:value id:value ..."
   writes a kernel with its constants filled in, as drivers get it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "abi/spec.h"
#include "device/specialize.h"
#include "kernels.h"
#include "shader/portable.h"

/* All that there is to ask, and nothing of the device's own. */
static const struct portable_params portable = {
    .asks_nearest = true, .asks_special = true, .asks_denormals = true};

static bool write_file(const char *path, const void *data, size_t bytes)
{
    FILE *stream = fopen(path, "wb");
    return stream && fwrite(data, 1, bytes, stream) == bytes && fclose(stream) == 0;
}

/* The kernel called `name`; *words is the caller's to free(). */
static bool find_kernel(const char *name, uint32_t **words, size_t *count)
{
    static const char prefix[] = "portable_";
    bool made = strncmp(name, prefix, strlen(prefix)) == 0;
    char why[PORTABLE_WHY_BYTES];
    name += made ? strlen(prefix) : 0;
    for (int i = 0; i < KERNEL_COUNT; ++i) {
        if (strcmp(kernels[i].name, name) != 0)
            continue;
        *count = kernels[i].bytes / sizeof **words;
        if (made) {
            if (shader_make_portable(&portable, kernels[i].words, *count, words, count, why) ==
                WHIT_OK)
                return true;
            fprintf(stderr, "%s: %s\n", name, why);
            return false;
        }
        *words = malloc(kernels[i].bytes);
        if (*words)
            memcpy(*words, kernels[i].words, kernels[i].bytes);
        return *words;
    }
    return false;
}

static int write_evaluated(const char *path, const char *name, const char *values)
{
    const struct gpu_spec defaults = GPU_SPEC_DEFAULTS;
    uint32_t spec[GPU_SPEC_COUNT], *whole = NULL, *words = NULL;
    size_t whole_count = 0, count = 0;
    memcpy(spec, &defaults, sizeof spec);
    for (int length = 0; *values; values += length) {
        unsigned id, value;
        if (sscanf(values, " %u:%u %n", &id, &value, &length) != 2 || id >= GPU_SPEC_COUNT)
            return EXIT_FAILURE;
        spec[id] = value;
    }
    if (!find_kernel(name, &whole, &whole_count) ||
        spirv_evaluate(whole, whole_count, spec, GPU_SPEC_COUNT, &words, &count) != WHIT_OK)
        words = NULL;
    free(whole);
    bool written = words && write_file(path, words, count * sizeof *words);
    free(words);
    return written ? EXIT_SUCCESS : EXIT_FAILURE;
}

static bool write_whole(const char *folder, const char *name)
{
    char path[4096];
    uint32_t *words = NULL;
    size_t count = 0;
    snprintf(path, sizeof path, "%s/%s.spv", folder, name);
    bool written =
        find_kernel(name, &words, &count) && write_file(path, words, count * sizeof *words);
    free(words);
    return written;
}

int main(int argc, char **argv)
{
    if (argc == 4)
        return write_evaluated(argv[1], argv[2], argv[3]);
    if (argc != 2)
        return EXIT_FAILURE;
    for (int i = 0; i < 2 * KERNEL_COUNT; ++i) {
        char name[64];
        snprintf(name, sizeof name, "%s%s", i % 2 ? "portable_" : "", kernels[i / 2].name);
        if (!write_whole(argv[1], name))
            return EXIT_FAILURE;
    }
#define PRINT_CONSTANT(id, name, value) printf("%d %s %u\n", id, #name, (unsigned)(value));
    GPU_SPEC_LIST(PRINT_CONSTANT)
    return EXIT_SUCCESS;
}
