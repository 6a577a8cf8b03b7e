/* spirv_exact NAME IN.spv OUT.h

   Writes the words of a module, with every float operation marked NoContraction (shader/exact.h),
   as a C array NAME. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "shader/exact.h"

enum { COLUMNS = 8 };

static void fail(const char *path, const char *why)
{
    fprintf(stderr, "spirv_exact: %s: %s\n", path, why);
    exit(1);
}

static uint32_t *read_words(const char *path, size_t *count)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0)
        fail(path, "cannot be read");
    long bytes = ftell(file);
    rewind(file);
    if (bytes <= 0 || bytes % 4 != 0)
        fail(path, "not SPIR-V");
    *count = (size_t)bytes / 4;
    uint32_t *words = malloc((size_t)bytes);
    if (!words || fread(words, 4, *count, file) != *count)
        fail(path, "cannot be read");
    fclose(file);
    return words;
}

int main(int argc, char **argv)
{
    static const char *const reasons[] = {
        [EXACT_DAMAGED] = "damaged, or not SPIR-V of this machine's byte order",
        [EXACT_NO_TYPES] = "the module has no types",
        [EXACT_NO_MEMORY] = "out of memory",
    };
    if (argc != 4)
        fail("usage", "spirv_exact NAME IN.spv OUT.h");
    size_t count, exact_count = 0;
    uint32_t *words = read_words(argv[2], &count), *exact;
    enum shader_exact end = shader_exact(words, count, &exact, &exact_count);
    if (end != EXACT_DONE)
        fail(argv[2], reasons[end]);
    FILE *file = fopen(argv[3], "w");
    if (!file)
        fail(argv[3], "cannot be written");
    fprintf(file, "#include <stdint.h>\nstatic const uint32_t %s[] = {\n", argv[1]);
    for (size_t i = 0; i < exact_count; ++i)
        fprintf(file, "0x%08x,%s", exact[i], (i + 1) % COLUMNS ? " " : "\n");
    fprintf(file, "};\n");
    free(exact);
    free(words);
    if (ferror(file) || fclose(file) != 0)
        fail(argv[3], "cannot be written");
    return 0;
}
