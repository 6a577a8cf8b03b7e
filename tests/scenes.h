/* Scenes of tests, each in three calls:

       struct scene *scene = scene_begin(&log, "name");
       scene_put(scene, mesh_box(1, 1, 1), &(struct put){.at = {0, 2, 0}});
       scene_ready(scene);

   Between the first and the last one any number of meshes, lights, ... may be put into it. What
   runs out of memory or is refused ends the program with a message: no test expects it. Only base/
   and scene/ are used here. */
#ifndef TESTS_SCENES_H
#define TESTS_SCENES_H

#include <stddef.h>

#include "scene/scene.h"

/* ---- Meshes; triangles of material 0 ---- */

struct scene_mesh mesh_box(double x, double y, double z);
struct scene_mesh mesh_plane(double size); /* two triangles of the xz plane */
struct scene_mesh mesh_sphere(double radius, uint32_t segments, uint32_t rings);
struct scene_mesh mesh_icosphere(double radius, uint32_t level);
struct scene_mesh mesh_torus(double radius, double tube, uint32_t segments, uint32_t sides);
struct scene_mesh mesh_terrain(double size, double height, uint32_t steps, uint32_t seed);
/* Spheres as such: `spheres` has centre and radius of each. */
struct scene_mesh mesh_balls(const double *spheres, uint32_t count);
/* Positions and indices of zeros. */
struct scene_mesh mesh_zeroed(uint32_t vertex_count, uint32_t triangle_count);
/* `corners`: nine numbers of each triangle; vertices are not shared. */
struct scene_mesh mesh_triangles(const float *corners, uint32_t triangle_count);
/* The same mesh, every primitive of it of this material. */
struct scene_mesh mesh_wearing(struct scene_mesh mesh, uint32_t material);

/* ---- Materials: their names are not theirs, and copied where they are put into a scene ---- */

struct scene_material material_grey(const char *name); /* see scene_material_init */
/* Neither ambient light nor a highlight. */
struct scene_material material_plain(const char *name);

/* ---- Scenes ---- */

/* Empty. `log` may be NULL. */
struct scene *scene_begin(const whit_log *log, const char *name);

/* How an instance is put into a scene; all zeros, or NULL for a pointer to it: where its mesh is,
   under the mesh's own materials. Of matrix, node and at only one is meant at a time. */
struct put {
    const char *name;                      /* of mesh and instance; NULL: none */
    const struct scene_material *material; /* all of the mesh; NULL: as the mesh says */
    const struct affine *matrix;           /* the instance's own, below no node */
    const uint32_t *node;                  /* the instance is below it */
    double at[3];                          /* not (0, 0, 0): below a new node that is moved there */
};

/* Adds the mesh, which is taken over, and one instance of it; the index of the mesh. */
uint32_t scene_put(struct scene *scene, struct scene_mesh mesh, const struct put *put);
/* Once more a mesh that the scene has, put->material apart; the index of the instance. */
uint32_t scene_put_again(struct scene *scene, uint32_t mesh, const struct put *put);
/* A mesh without an instance. Where the scene has no material so far, a grey one is added. */
uint32_t scene_put_mesh(struct scene *scene, struct scene_mesh mesh);

/* Each gives the index of what it adds. */
uint32_t scene_put_material(struct scene *scene, struct scene_material material);
uint32_t scene_put_node(struct scene *scene, uint32_t parent, double x, double y, double z);
uint32_t scene_put_matrix(struct scene *scene, uint32_t parent, const struct affine *matrix);
/* `rgba`: four bytes a texel, copied. */
uint32_t scene_put_texture(struct scene *scene, uint32_t width, uint32_t height,
                           const uint8_t *rgba);
uint32_t scene_put_light(struct scene *scene, struct scene_light light);
/* Grey light that travels along a direction of any length. */
uint32_t scene_put_sun(struct scene *scene, double x, double y, double z, float strength);
/* A grey point light with falloff. */
uint32_t scene_put_lamp(struct scene *scene, double x, double y, double z, float strength);
/* A pinhole; up is +y, or -z where the view is upright. */
uint32_t scene_put_camera(struct scene *scene, const double eye[3], const double target[3],
                          double fov_y);
/* Linear keys: three (rotations: four) values each, copied. */
void scene_put_channel(struct scene *scene, uint32_t node, enum scene_path path, uint32_t keys,
                       const float *times_s, const float *values);

/* Freezes it; the same scene. */
struct scene *scene_ready(struct scene *scene);
/* One of its notes has this text. */
bool scene_noted(const struct scene *scene, const char *text);

/* ---- Placements ---- */

/* Moved by less than `spread` along each axis, turned, stretched by 0.34 to 1.66 along each axis.
 */
struct affine placement_random(uint64_t *random, double spread, bool mirrored);

/* whit_camera of eye, target, up and vertical angle in degrees. */
#define CAMERA_AT(ex, ey, ez, tx, ty, tz, ux, uy, uz, fov)                                         \
    {                                                                                              \
        .own = true, .eye = {ex, ey, ez}, .target = {tx, ty, tz}, .up = {ux, uy, uz},              \
        .fov_y_degrees = fov                                                                       \
    }

#endif
