/* MTL: a library's text, and what each of its materials means. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "load/mtl_material.h"
#include "scene/scene.h"

static void make_materials(struct scene *scene, const struct mtl_library *library)
{
    enum { MATERIALS_MAX = 64 };
    for (uint32_t i = 0; i < library->count && i < MATERIALS_MAX; i++) {
        struct scene_material material = {0};
        const struct mtl_entry *entry = &library->entries[i];
        fuzz_check(mtl_find(library, entry->name), "`%s` is not found", entry->name);
        fuzz_check(mtl_material(scene, entry, NULL, &material) == WHIT_OK, "`%s` is no material",
                   entry->name);
        fuzz_check(scene_add_material(scene, material) != SCENE_NONE, "out of memory");
    }
}

static void run(const uint8_t *data, size_t size_bytes)
{
    struct scene *scene = scene_create(&fuzz_log, "mtl");
    struct mtl_library library = {0};
    char *text = malloc(size_bytes + 1);
    fuzz_check(scene && text, "out of memory");
    memcpy(text, data, size_bytes);
    text[size_bytes] = 0;
    fuzz_log_clear();
    fuzz_check(mtl_parse(scene, "a/model.mtl", text, &library), "out of memory");
    make_materials(scene, &library);
    fuzz_check(scene_freeze(scene) == WHIT_OK, "materials that cannot be frozen");
    fuzz_check_errors(WHIT_OK, "");
    mtl_finish(&library);
    scene_destroy(scene);
    free(text);
}

const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(64) << 20};
