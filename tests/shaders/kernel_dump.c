/* Writes FOLDER/<kernel>.spv for each embedded kernel, and prints the specialization constants,
   one `id name default` a line. */
#include <stdio.h>
#include <stdlib.h>

#include "abi/spec.h"
#include "kernels.h"

int main(int argc, char **argv)
{
    if (argc != 2)
        return EXIT_FAILURE;
    for (int i = 0; i < KERNEL_COUNT; ++i) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s.spv", argv[1], kernels[i].name);
        FILE *stream = fopen(path, "wb");
        if (!stream || fwrite(kernels[i].words, 1, kernels[i].bytes, stream) != kernels[i].bytes ||
            fclose(stream) != 0)
            return EXIT_FAILURE;
    }
#define PRINT_CONSTANT(id, name, value) printf("%d %s %u\n", id, #name, (unsigned)(value));
    GPU_SPEC_LIST(PRINT_CONSTANT)
    return EXIT_SUCCESS;
}
