/* Estimates of the memory that a scene will take once it is drawn, made before it is allocated: its
   records, what is derived from them, the trees, and the copies on the device. */
#ifndef SCENE_AFFORD_H
#define SCENE_AFFORD_H

#include "scene/scene.h"

/* Bytes per triangle, sphere and instance for trees and the device's records, on host and device
   together, at the peak of the build. */
enum {
    SCENE_TREE_TRIANGLE_BYTES = 190,
    SCENE_TREE_SPHERE_BYTES = 350,
    SCENE_TREE_INSTANCE_BYTES = 600,
};

/* Each gives bytes. `vertex_bytes`: size of all attributes of one vertex on the host. */
uint64_t scene_node_cost(uint64_t count);
uint64_t scene_instance_cost(uint64_t count);
uint64_t scene_triangle_cost(uint64_t triangles, uint64_t vertices, uint64_t vertex_bytes);
uint64_t scene_sphere_cost(uint64_t count);
uint64_t scene_texel_cost(uint64_t width, uint64_t height);
/* scene_texel_cost, and a third of the texture once more for its mipmap levels on the device. */
uint64_t scene_texture_cost(uint64_t width, uint64_t height);

/* Adds `bytes` to scene->memory_taken for `what` ("a texture of 4 x 4 pixels"). Where that would
   exceed memory_limit, adds nothing, logs one error that names `what`, and gives false. */
bool scene_afford(struct scene *scene, uint64_t bytes, const char *what, ...) WHIT_PRINTF(3, 4);
/* The same check without adding, for what is made from a finished scene; errors go to `log`. */
bool scene_could_afford(const struct scene *scene, const whit_log *log, uint64_t bytes,
                        const char *what);
/* Bytes left below the memory limit; UINT64_MAX without a limit. */
uint64_t scene_room(const struct scene *scene);
/* Takes `bytes`, which scene_afford added for something that is freed, off memory_taken. */
void scene_give_back(struct scene *scene, uint64_t bytes);
/* Half of this machine's physical memory, in bytes; 0: unknown. */
uint64_t scene_default_memory_limit(void);

#endif
