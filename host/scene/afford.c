#include "scene/afford.h"

#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

enum {
    NAME_BYTES = 32, /* a short one, as malloc rounds it up */
    DEVICE_COPIES = 2,
};

uint64_t scene_node_cost(uint64_t count)
{
    return count * (sizeof(struct scene_node) + NAME_BYTES + sizeof(struct affine));
}

uint64_t scene_instance_cost(uint64_t count)
{
    return count * (sizeof(struct scene_instance) + NAME_BYTES + sizeof(struct affine) +
                    SCENE_TREE_INSTANCE_BYTES);
}

uint64_t scene_triangle_cost(uint64_t triangles, uint64_t vertices, uint64_t vertex_bytes)
{
    return triangles * (DEVICE_COPIES * 4 * sizeof(uint32_t) + SCENE_TREE_TRIANGLE_BYTES) +
           vertices * DEVICE_COPIES * vertex_bytes;
}

uint64_t scene_sphere_cost(uint64_t count)
{
    return count * (5 * sizeof(float) + SCENE_TREE_SPHERE_BYTES);
}

uint64_t scene_texel_cost(uint64_t width, uint64_t height)
{
    return width * height * DEVICE_COPIES * 4;
}

bool scene_afford(struct scene *scene, uint64_t bytes, const char *what, ...)
{
    uint64_t limit = scene->memory_limit, taken = scene->memory_taken;
    if (!limit || (taken <= limit && bytes <= limit - taken)) {
        scene->memory_taken += bytes;
        return true;
    }
    char text[256];
    va_list args;
    va_start(args, what);
    vsnprintf(text, sizeof text, what, args);
    va_end(args);
    const double mebibyte = 1 << 20;
    log_error(&scene->log,
              "%s: %s would take %.4g MiB of memory, with what comes before it %.4g MiB; the limit "
              "is %.4g MiB (--memory-limit)",
              scene->name, text, (double)bytes / mebibyte,
              ((double)taken + (double)bytes) / mebibyte, (double)limit / mebibyte);
    return false;
}

uint64_t scene_default_memory_limit(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && page_bytes > 0 ? (uint64_t)pages * (uint64_t)page_bytes / 2 : 0;
}
