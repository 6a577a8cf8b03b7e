/* Meshes made by formula. Each fills *out: positions, normals, uvs, indices, and material 0 for all
   triangles until the caller sets out->materials. Where the shape is closed, so is the mesh,
   without gaps. Outward faces are counter-clockwise. WHIT_ERROR_USAGE for parameters out of range,
   WHIT_ERROR_MEMORY. Release with scene_mesh_finish. */
#ifndef SCENE_SHAPES_H
#define SCENE_SHAPES_H

#include "scene/scene.h"

WHIT_CHECK whit_result shape_box(const double size[3], struct scene_mesh *out);
/* In the xz plane, +y up, `steps` x `steps` quads; uv runs 0..uv_scale. */
WHIT_CHECK whit_result shape_plane(double width, double depth, uint32_t steps, double uv_scale,
                                   struct scene_mesh *out);
/* Latitude-longitude: 2 * segments * (rings - 1) triangles, segments >= 3, rings >= 2. */
WHIT_CHECK whit_result shape_sphere(double radius, uint32_t segments, uint32_t rings,
                                    struct scene_mesh *out);
/* Subdivided icosahedron: 20 * 4^level triangles, level <= 8. */
WHIT_CHECK whit_result shape_icosphere(double radius, uint32_t level, struct scene_mesh *out);
WHIT_CHECK whit_result shape_torus(double radius, double tube, uint32_t segments, uint32_t sides,
                                   struct scene_mesh *out);
/* Closed, along +y, capped. radius_top 0: a cone. */
WHIT_CHECK whit_result shape_cylinder(double radius, double radius_top, double height,
                                      uint32_t segments, struct scene_mesh *out);
/* Height field over [-size/2, size/2]^2 from seeded value noise: 2 * steps^2 triangles. */
WHIT_CHECK whit_result shape_terrain(double size, double height, uint32_t steps, uint32_t seed,
                                     struct scene_mesh *out);
/* Needles in random directions, with their middles in a cube of side `size`: 4 * count triangles,
   of which three in four are long and thin. `width`: of a needle's base. */
WHIT_CHECK whit_result shape_strands(double size, double length, double width, uint32_t count,
                                     uint32_t seed, struct scene_mesh *out);
/* A hall of two storeys, open above, around the z axis with its floor at y = 0; 18 wide, 4 * bays
   long, 15.5 high. It has a few large walls and fine ornaments, which `level` (1 to 8) refines.
   With vertex colours; not closed. */
WHIT_CHECK whit_result shape_atrium(uint32_t bays, uint32_t level, struct scene_mesh *out);
/* Centre and radius of every sphere of a sphereflake (Haines' SPD): level 0 is one sphere, each has
   nine children at a third of its size. *spheres holds count * 4 doubles; free() it. */
WHIT_CHECK whit_result shape_sphereflake(double radius, uint32_t level, double **spheres,
                                         uint32_t *count);
/* A mesh of sphere primitives: `spheres` holds centre and radius of each, all below 1e18.
   scene_freeze drops those whose radius is not above 0. */
WHIT_CHECK whit_result shape_balls(const double *spheres, uint32_t count, struct scene_mesh *out);

#endif
