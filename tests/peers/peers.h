/* Parts of `hits`: rays, the comparison with other tracers, and the search for leaks. */
#ifndef TESTS_PEERS_H
#define TESTS_PEERS_H

#include "../random.h"
#include "accel/accel.h"

extern const struct log peers_log;

/* ---- rays.c ---- */

enum ray_kind {
    RAYS_PRIMARY, /* from the scene's first camera, jittered over a 16:9 picture */
    RAYS_RANDOM,  /* between random points in and around the bounds */
    RAYS_AIMED,   /* at vertices and points of edges */
    RAYS_KINDS
};

/* From `origin`, rounded to float, to what `target` is from there. */
struct gpu_ray ray_to(const double origin[3], const double target[3]);

/* A vertex (every second time) or a point of an edge of a random triangle, in world space. */
void random_target(const struct scene *scene, const struct scene_pose *pose, uint64_t *state,
                   double out[3]);

void rays_fill(enum ray_kind kind, const struct scene *scene, const struct scene_pose *pose,
               uint64_t seed, struct gpu_ray *rays, uint64_t count);

/* ---- embree.c ---- */

struct embree;

/* NULL where it is not built in or does not start. Meshes are placed in world space in float, so
   that its triangles of moved instances differ from whit's by that rounding. */
struct embree *embree_create(const struct scene *scene, const struct scene_pose *pose, bool robust);
void embree_destroy(struct embree *embree);
/* Only t and ids of the hit are set. */
void embree_trace(const struct embree *embree, const struct gpu_ray *ray, struct gpu_hit *hit);

/* ---- leaks.c ---- */

/* Rays from inside closed spheres; 0 when none gets out, and the copy of the traversal that was
   built with contraction leaks. */
int leaks_count(uint64_t ray_count, uint64_t seed);

#endif
