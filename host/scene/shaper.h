/* A mesh under construction, for shapes by formula. */
#ifndef SCENE_SHAPER_H
#define SCENE_SHAPER_H

#include "scene/scene.h"

/* The mesh's arrays have their final size and are filled front to back. A zeroed shaper with
   `measuring` set only counts vertices and corners, to find that size. */
struct shaper {
    struct scene_mesh *mesh;
    uint32_t vertex, corner;
    bool measuring;
    float color[3]; /* of the vertices to come, where the mesh has colours */
};

/* Begins *mesh, which is empty afterwards where that fails: WHIT_ERROR_USAGE for too many vertices
   or triangles, WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result shaper_init(struct shaper *shaper, struct scene_mesh *mesh,
                                   uint64_t vertices, uint64_t triangles);
/* Gives the mesh vertex colours. */
WHIT_CHECK whit_result shaper_add_colors(struct shaper *shaper);
/* `normal` need not be unit. */
uint32_t shaper_vertex(struct shaper *shaper, const double position[3], const double normal[3],
                       double u, double v);
void shaper_triangle(struct shaper *shaper, uint32_t a, uint32_t b, uint32_t c);
/* Corners in counter-clockwise order. */
void shaper_quad(struct shaper *shaper, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
/* The quads between (rows + 1) x (columns + 1) vertices from `first` on, row by row. */
void shaper_grid(struct shaper *shaper, uint32_t first, uint32_t rows, uint32_t columns);

/* Cosine and sine of angle 2 pi * step / steps. Step `steps` gives the same bits as step 0. */
void shape_circle_point(uint32_t step, uint32_t steps, double *cosine, double *sine);
/* Whether a length is above 0 and at most 1e17. */
bool shape_positive(double value);

#endif
