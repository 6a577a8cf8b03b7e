/* Small scenes with trees of every kind, and what a ray finds in them with and without trees. */
#ifndef TESTS_FUZZ_TREES_H
#define TESTS_FUZZ_TREES_H

#include "accel/accel.h"

enum fuzz_scene {
    FUZZ_SPHERE,    /* one mesh, not moved */
    FUZZ_NEEDLES,   /* long thin triangles that cross */
    FUZZ_BALLS,     /* true spheres */
    FUZZ_INSTANCES, /* two meshes, three instances, moved, turned and mirrored */
    FUZZ_SCENE_COUNT
};

/* Frozen. */
struct scene *fuzz_scene_make(enum fuzz_scene kind);
/* Some parameters for every builder; `which` is taken modulo their number. */
whit_accel_params fuzz_tree_params(uint32_t which);

/* Every order of traversal, and asking for any hit, gives what brute force gives; bad rays hit
   nothing; rays of extreme length only have to end. */
void fuzz_check_ray(const struct accel *accel, const struct gpu_ray *ray);
/* The same for rays from all around, some of them along axes and through vertices. */
void fuzz_check_rays(const struct accel *accel);

#endif
