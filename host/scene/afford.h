/* What a scene takes in memory once it is drawn, before any of it is asked for: its records, what
   is derived from them, the trees, and the copies on the device. */
#ifndef SCENE_AFFORD_H
#define SCENE_AFFORD_H

#include "scene/scene.h"

/* Bytes for the trees over primitives and over instances and for the device's records, on host and
   device together, while trees are built. */
enum {
    SCENE_TREE_TRIANGLE_BYTES = 190,
    SCENE_TREE_SPHERE_BYTES = 350,
    SCENE_TREE_INSTANCE_BYTES = 600,
};

/* In bytes. `vertex_bytes` are those of all attributes of one vertex on the host. */
uint64_t scene_node_cost(uint64_t count);
uint64_t scene_instance_cost(uint64_t count);
uint64_t scene_triangle_cost(uint64_t triangles, uint64_t vertices, uint64_t vertex_bytes);
uint64_t scene_sphere_cost(uint64_t count);
uint64_t scene_texel_cost(uint64_t width, uint64_t height);
/* The same with what its smaller levels take on the device: a third. */
uint64_t scene_texture_cost(uint64_t width, uint64_t height);

/* Counts `bytes` for `what` ("a texture of 4 x 4 pixels"). False, after one error that names it,
   and nothing counted, when the scene would take more than its memory_limit. */
bool scene_afford(struct scene *scene, uint64_t bytes, const char *what, ...) WHIT_PRINTF(3, 4);
/* The same without counting, for what is made of a scene that is whole; errors go to `log`. */
bool scene_could_afford(const struct scene *scene, const whit_log *log, uint64_t bytes,
                        const char *what);
/* Bytes that it may take yet. */
uint64_t scene_room(const struct scene *scene);
/* Gives back what was counted for something that is gone again. */
void scene_give_back(struct scene *scene, uint64_t bytes);
/* Half of what this machine has. */
uint64_t scene_default_memory_limit(void);

#endif
