/* Meshes at which ray tracers fail, and scenes of them. */
#ifndef HARD_MESH_H
#define HARD_MESH_H

#include "hard/hard.h"

/* The built-in ones, quick or not. */
const struct hard_case *hard_cases(uint32_t *count);

WHIT_CHECK whit_result hard_scene_init(const whit_log *log, const struct hard_case *hard,
                                       struct hard_scene *out);
/* A scene of the user's at one time; `scene` is borrowed. */
WHIT_CHECK whit_result hard_scene_borrow(const whit_log *log, const struct scene *scene,
                                         double time_s, bool flatten, struct hard_scene *out);
/* A frozen scene of one mesh, which is taken over; `place` NULL: where it is. */
WHIT_CHECK whit_result hard_scene_of_mesh(const whit_log *log, const char *name,
                                          struct scene_mesh *mesh, const struct affine *place,
                                          struct scene **out);

/* All triangles of a scene as one mesh, changed: as vertices, each computed in double and rounded
   to float, which makes a mesh of its own; or as an instance of the mesh as it is in the world. */
struct hard_variant {
    const char *name;
    double scale, offset; /* offset on every axis: up, down, up */
    bool turned, mirrored, instanced;
};
const struct hard_variant *hard_variants(uint32_t *count);
/* out->scene is NULL where no triangle is left with an area. */
WHIT_CHECK whit_result hard_scene_vary(const whit_log *log, const struct hard_scene *given,
                                       const struct hard_variant *variant, struct hard_scene *out);

void hard_scene_finish(struct hard_scene *hard);

#endif
