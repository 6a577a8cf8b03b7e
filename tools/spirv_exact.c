/* spirv_exact NAME IN.spv OUT.h

   Marks every float operation of a module NoContraction, as if every variable of its GLSL were
   `precise`, and writes the words as a C array NAME. Without it a driver may fuse or reorder what
   GLSL did not mark, differently in each specialised variant, and pictures would differ in their
   last bits (docs/numerics.md). Lays out modules as SPIR-V 1.5 section 2.4 says: decorations stand
   before types. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    SPIRV_MAGIC = 0x07230203,
    HEADER_WORDS = 5,
    OP_TYPE_VOID = 19,
    OP_DECORATE = 71,
    OP_DOT = 148,
    DECORATION_NO_CONTRACTION = 42,
    COLUMNS = 8,
};

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
    if (bytes < HEADER_WORDS * 4 || bytes % 4 != 0)
        fail(path, "not SPIR-V");
    *count = (size_t)bytes / 4;
    uint32_t *words = malloc((size_t)bytes);
    if (!words || fread(words, 4, *count, file) != *count || words[0] != SPIRV_MAGIC)
        fail(path, "not SPIR-V of this machine's byte order");
    fclose(file);
    return words;
}

/* FNegate, FAdd, FSub, FMul, FDiv, FRem, FMod, and products up to Dot. */
static bool is_float_operation(uint32_t op)
{
    return op == 127 || op == 129 || op == 131 || op == 133 || op == 136 || op == 140 ||
           op == 141 || (op >= 142 && op <= OP_DOT);
}

struct output {
    FILE *file;
    size_t count;
};

static void put(struct output *out, uint32_t word)
{
    fprintf(out->file, "0x%08x,%s", word, ++out->count % COLUMNS ? " " : "\n");
}

/* One decoration for each float operation that has none yet. */
static void put_decorations(struct output *out, const uint32_t *words, size_t count, bool *marked)
{
    for (size_t at = HEADER_WORDS; at < count; at += words[at] >> 16) {
        if (!is_float_operation(words[at] & 0xffff) || marked[words[at + 2]])
            continue;
        put(out, 3u << 16 | OP_DECORATE);
        put(out, words[at + 2]);
        put(out, DECORATION_NO_CONTRACTION);
    }
}

int main(int argc, char **argv)
{
    if (argc != 4)
        fail("usage", "spirv_exact NAME IN.spv OUT.h");
    size_t count;
    uint32_t *words = read_words(argv[2], &count);
    bool *marked = calloc(words[3], sizeof *marked);
    if (!marked)
        fail(argv[2], "out of memory");
    size_t types_at = 0;
    for (size_t at = HEADER_WORDS; at < count; at += words[at] >> 16) {
        uint32_t length = words[at] >> 16, op = words[at] & 0xffff;
        if (length == 0 || length > count - at)
            fail(argv[2], "damaged");
        if (op == OP_TYPE_VOID && types_at == 0)
            types_at = at;
        if (op == OP_DECORATE && words[at + 2] == DECORATION_NO_CONTRACTION)
            marked[words[at + 1]] = true;
    }
    struct output out = {.file = fopen(argv[3], "w")};
    if (!out.file || types_at == 0)
        fail(argv[3], "cannot be written, or the module has no types");
    fprintf(out.file, "#include <stdint.h>\nstatic const uint32_t %s[] = {\n", argv[1]);
    for (size_t at = 0; at < types_at; ++at)
        put(&out, words[at]);
    put_decorations(&out, words, count, marked);
    for (size_t at = types_at; at < count; ++at)
        put(&out, words[at]);
    fprintf(out.file, "};\n");
    free(marked);
    free(words);
    if (ferror(out.file) || fclose(out.file) != 0)
        fail(argv[3], "cannot be written");
    return 0;
}
