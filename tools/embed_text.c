/* embed_text FOLDER OUT.h NAME...

   Writes the files FOLDER/NAME as rows of an array {name, text, bytes}, whose texts end with a 0
   that `bytes` does not count. */
#include <stdio.h>
#include <stdlib.h>

enum { COLUMNS = 24, PATH_BYTES = 4096 };

static void fail(const char *path, const char *why)
{
    fprintf(stderr, "embed_text: %s: %s\n", path, why);
    exit(1);
}

static void put_text(FILE *out, const char *folder, const char *name, int number)
{
    char path[PATH_BYTES];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "rb");
    if (!file)
        fail(path, "cannot be read");
    fprintf(out, "static const char text_%d[] = {\n", number);
    int byte, count = 0;
    while ((byte = fgetc(file)) != EOF) {
        if (byte == 0)
            fail(path, "holds a byte 0");
        fprintf(out, "%d,%s", byte < 128 ? byte : byte - 256, ++count % COLUMNS ? "" : "\n");
    }
    if (ferror(file) || fclose(file) != 0)
        fail(path, "cannot be read");
    fprintf(out, "0};\n");
}

int main(int argc, char **argv)
{
    if (argc < 4)
        fail("usage", "embed_text FOLDER OUT.h NAME...");
    FILE *out = fopen(argv[2], "w");
    if (!out)
        fail(argv[2], "cannot be written");
    for (int i = 3; i < argc; ++i)
        put_text(out, argv[1], argv[i], i);
    fprintf(out, "const struct shader_source shader_sources[] = {\n");
    for (int i = 3; i < argc; ++i)
        fprintf(out, "{\"%s\", text_%d, sizeof text_%d - 1},\n", argv[i], i, i);
    fprintf(out, "};\nconst uint32_t shader_source_count = %d;\n", argc - 3);
    if (ferror(out) || fclose(out) != 0)
        fail(argv[2], "cannot be written");
    return 0;
}
