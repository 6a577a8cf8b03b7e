/* Meshes at which ray tracers fail, and scenes of them. */
#ifndef HARD_MESH_H
#define HARD_MESH_H

#include "hard/hard.h"

/* The built-in cases, in the order of the table. */
const struct hard_case *hard_cases(uint32_t *count);

WHIT_CHECK whit_result hard_scene_init(const whit_log *log, const struct hard_case *hard,
                                       struct hard_scene *out);
/* A user's scene at one time; `scene` is borrowed. */
WHIT_CHECK whit_result hard_scene_borrow(const whit_log *log, const struct scene *scene,
                                         double time_s, bool flatten, struct hard_scene *out);
/* A frozen scene of one mesh, which it takes over, as an instance at `place`; NULL: without a
   transform. */
WHIT_CHECK whit_result hard_scene_of_mesh(const whit_log *log, const char *name,
                                          struct scene_mesh *mesh, const struct affine *place,
                                          struct scene **out);

/* A scene made of all triangles of another scene as one mesh with a transform. Either its vertices
   are transformed, in double and rounded to float; or (`instanced`) the mesh stays and an instance
   has the transform. */
struct hard_variant {
    const char *name;
    double scale, offset; /* offset: +offset on x and z, -offset on y */
    bool turned, mirrored, instanced;
};
const struct hard_variant *hard_variants(uint32_t *count);
/* out->scene is NULL where no triangle is left with an area. */
WHIT_CHECK whit_result hard_scene_vary(const whit_log *log, const struct hard_scene *given,
                                       const struct hard_variant *variant, struct hard_scene *out);

void hard_scene_finish(struct hard_scene *hard);

#endif
