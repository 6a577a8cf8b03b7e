/* OBJ: what is repaired and read of its text before assimp sees it, and any answer of assimp. */
#include "fuzz.h"

#include <string.h>

static void prepare(void)
{
    static const char library[] = "newmtl m1\nKd 1 0 0\nmap_Kd t.png\nnewmtl m2\nKa 1 1 1\nd 0.5\n";
    fuzz_file("model.mtl", library, strlen(library));
    fuzz_file("other.mtl", library, strlen(library));
}

static void run(const uint8_t *data, size_t size_bytes)
{
    fuzz_load(fuzz_file("model.obj", data, size_bytes));
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(64) << 20};
