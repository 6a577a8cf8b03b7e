/* kernel_dump FOLDER
   writes FOLDER/<kernel>.spv for each embedded kernel, and prints the specialization constants, one
   `id name default` a line.
   kernel_dump OUT.spv KERNEL "id:value id:value ..."
   writes a kernel with its constants filled in, as drivers get it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "abi/spec.h"
#include "device/specialize.h"
#include "kernels.h"

static bool write_file(const char *path, const void *data, size_t bytes)
{
    FILE *stream = fopen(path, "wb");
    return stream && fwrite(data, 1, bytes, stream) == bytes && fclose(stream) == 0;
}

static int write_evaluated(const char *path, const char *name, const char *values)
{
    const struct gpu_spec defaults = GPU_SPEC_DEFAULTS;
    uint32_t spec[GPU_SPEC_COUNT], *words = NULL;
    size_t count = 0;
    memcpy(spec, &defaults, sizeof spec);
    for (int length = 0; *values; values += length) {
        unsigned id, value;
        if (sscanf(values, " %u:%u %n", &id, &value, &length) != 2 || id >= GPU_SPEC_COUNT)
            return EXIT_FAILURE;
        spec[id] = value;
    }
    for (int i = 0; i < KERNEL_COUNT; ++i) {
        if (strcmp(kernels[i].name, name) == 0 &&
            spirv_evaluate(kernels[i].words, kernels[i].bytes / sizeof *words, spec, GPU_SPEC_COUNT,
                           &words, &count) != WHIT_OK)
            return EXIT_FAILURE;
    }
    bool written = words && write_file(path, words, count * sizeof *words);
    free(words);
    return written ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    if (argc == 4)
        return write_evaluated(argv[1], argv[2], argv[3]);
    if (argc != 2)
        return EXIT_FAILURE;
    for (int i = 0; i < KERNEL_COUNT; ++i) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s.spv", argv[1], kernels[i].name);
        if (!write_file(path, kernels[i].words, kernels[i].bytes))
            return EXIT_FAILURE;
    }
#define PRINT_CONSTANT(id, name, value) printf("%d %s %u\n", id, #name, (unsigned)(value));
    GPU_SPEC_LIST(PRINT_CONSTANT)
    return EXIT_SUCCESS;
}
