/* glTF and GLB: all that whit reads of it by itself, and any answer of assimp to what Draco packs.
 */
#include "fuzz.h"

#include <string.h>

static void run(const uint8_t *data, size_t size_bytes)
{
    bool binary = size_bytes >= 4 && memcmp(data, "glTF", 4) == 0;
    fuzz_load(fuzz_file(binary ? "model.glb" : "model.gltf", data, size_bytes));
}

const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(192) << 20};
