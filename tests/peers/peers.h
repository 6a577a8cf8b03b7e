/* Rays, and the comparison with other tracers. */
#ifndef TESTS_PEERS_H
#define TESTS_PEERS_H

#include "../random.h"
#include "accel/accel.h"

extern const whit_log peers_log;

/* ---- rays.c ---- */

enum ray_kind {
    RAYS_PRIMARY, /* from the scene's first camera, for pixels of a 16:9 picture */
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

#endif
