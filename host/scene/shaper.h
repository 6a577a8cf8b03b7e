/* A mesh under construction, for shapes by formula. */
#ifndef SCENE_SHAPER_H
#define SCENE_SHAPER_H

#include "scene/scene.h"

/* Arrays at their final size, filled front to back. A zeroed shaper that is `measuring` only counts
   vertices and corners. */
struct shaper {
    struct scene_mesh mesh;
    uint32_t vertex, corner;
    bool measuring;
    float color[3]; /* of the vertices to come, where the mesh has colours */
};

/* WHIT_ERROR_USAGE for too many, WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result shaper_init(struct shaper *shaper, uint64_t vertices, uint64_t triangles);
/* Gives the mesh vertex colours. */
WHIT_CHECK whit_result shaper_add_colors(struct shaper *shaper);
/* `normal` need not be unit. */
uint32_t shaper_vertex(struct shaper *shaper, const double position[3], const double normal[3],
                       double u, double v);
void shaper_triangle(struct shaper *shaper, uint32_t a, uint32_t b, uint32_t c);
/* Corners in counter-clockwise order. */
void shaper_quad(struct shaper *shaper, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

/* Exactly periodic: the last step of a circle lands on the bits of the first. */
void shape_circle_point(uint32_t step, uint32_t steps, double *cosine, double *sine);
/* A length that makes sense. */
bool shape_positive(double value);

#endif
