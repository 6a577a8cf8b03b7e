#include "scene/afford.h"

#include "base/text.h"
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

enum {
    NAME_BYTES = 32,   /* a short name, as malloc rounds it up */
    DEVICE_COPIES = 2, /* one array on the host, one on the device */
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

uint64_t scene_texture_cost(uint64_t width, uint64_t height)
{
    return scene_texel_cost(width, height) + width * height * 4 / 3;
}

uint64_t scene_room(const struct scene *scene)
{
    uint64_t limit = scene->memory_limit, taken = scene->memory_taken;
    return !limit ? UINT64_MAX : limit > taken ? limit - taken : 0;
}

bool scene_could_afford(const struct scene *scene, const whit_log *log, uint64_t bytes,
                        const char *what)
{
    uint64_t limit = scene->memory_limit, taken = scene->memory_taken;
    const double mebibyte = 1 << 20;
    if (bytes <= scene_room(scene))
        return true;
    log_error(log,
              "%s: %s would take %.4g MiB of memory, with what comes before it %.4g MiB; the limit "
              "is %.4g MiB (--memory-limit)",
              scene->name, what, (double)bytes / mebibyte,
              ((double)taken + (double)bytes) / mebibyte, (double)limit / mebibyte);
    return false;
}

bool scene_afford(struct scene *scene, uint64_t bytes, const char *what, ...)
{
    char text[256];
    va_list args;
    va_start(args, what);
    text_print(text, sizeof text, what, args);
    va_end(args);
    bool good = scene_could_afford(scene, &scene->log, bytes, text);
    scene->memory_taken += good ? bytes : 0;
    return good;
}

void scene_give_back(struct scene *scene, uint64_t bytes)
{
    scene->memory_taken -= bytes < scene->memory_taken ? bytes : scene->memory_taken;
}

uint64_t scene_default_memory_limit(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && page_bytes > 0 ? (uint64_t)pages * (uint64_t)page_bytes / 2 : 0;
}
