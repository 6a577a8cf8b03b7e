/* PLY and STL: the repair of headers, and any answer of assimp. */
#include "fuzz.h"

#include <string.h>

static void run(const uint8_t *data, size_t size_bytes)
{
    bool stl = size_bytes >= 5 && memcmp(data, "solid", 5) == 0;
    fuzz_load(fuzz_file(stl ? "model.stl" : "model.ply", data, size_bytes));
}

const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(64) << 20};
