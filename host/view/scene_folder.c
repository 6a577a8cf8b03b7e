#include "view/scene_folder.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"

static int is_scene(const struct dirent *entry)
{
    static const char *const endings[] = {"json", "obj", "gltf", "glb", "ply",
                                          "stl",  "fbx", "dae",  "3mf", "off"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; ++i) {
        if (path_is(entry->d_name, endings[i]))
            return entry->d_name[0] != '.';
    }
    return 0;
}

static int compare_names(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

bool scene_folder_find(const char *path, int by, char *found, size_t found_bytes)
{
    const char *name = path_name(path);
    int folder_bytes = (int)(name - path), own = by > 0 ? -1 : 0;
    struct dirent **entries = NULL;
    snprintf(found, found_bytes, "%.*s", folder_bytes, path);
    int count = scandir(found[0] ? found : ".", &entries, is_scene, compare_names);
    for (int i = 0; i < count; ++i) {
        if (strcmp(entries[i]->d_name, name) == 0)
            own = i;
    }
    bool any = count > 0;
    if (any) {
        const char *next = entries[(own + count + by) % count]->d_name;
        any = strcmp(next, name) != 0;
        snprintf(found, found_bytes, "%.*s%s", folder_bytes, path, next);
    }
    for (int i = 0; i < count; ++i)
        free(entries[i]);
    free(entries);
    return any;
}
