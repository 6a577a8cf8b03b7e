/* Builds scenes for tests, in three calls:

       struct scene *scene = scene_begin(&log, "name");
       scene_put(scene, mesh_box(1, 1, 1), &(struct put){.at = {0, 2, 0}});
       scene_ready(scene);

   Any number of meshes, lights, ... may be added in between. An error ends the program with a
   message, since no test expects one. Only base/ and scene/ are used here. */
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
/* Sphere primitives: `spheres` has centre and radius of each. */
struct scene_mesh mesh_balls(const double *spheres, uint32_t count);
/* A mesh whose positions and indices are all 0. */
struct scene_mesh mesh_zeroed(uint32_t vertex_count, uint32_t triangle_count);
/* `corners`: nine numbers per triangle; vertices are not shared. */
struct scene_mesh mesh_triangles(const float *corners, uint32_t triangle_count);
/* The same mesh with this material for all its primitives. */
struct scene_mesh mesh_wearing(struct scene_mesh mesh, uint32_t material);

/* ---- Materials; names are borrowed, and copied when put into a scene ---- */

struct scene_material material_grey(const char *name); /* see scene_material_init */
/* A grey material without ambient light and highlight. */
struct scene_material material_plain(const char *name);

static inline void set_rgb(float *rgb, float r, float g, float b)
{
    rgb[0] = r;
    rgb[1] = g;
    rgb[2] = b;
}

/* ---- Scenes ---- */

static inline void drop_scene(struct scene **at)
{
    scene_destroy(*at);
}

/* Freed at the end of its block: own_scene *scene = ...; */
#define own_scene __attribute__((cleanup(drop_scene), unused)) struct scene

/* Freed at the end of its block; for sources that have scene/pose.h. */
#define own_pose  __attribute__((cleanup(scene_pose_finish), unused)) struct scene_pose

/* Begins an empty scene. `log` may be NULL. */
struct scene *scene_begin(const whit_log *log, const char *name);

/* How an instance is put into a scene. Zeroed, or a NULL pointer to it: untransformed, with the
   mesh's own materials. At most one of matrix, node and at is set. */
struct put {
    const char *name;                      /* of mesh and instance; NULL: none */
    const struct scene_material *material; /* for the whole mesh; NULL: the mesh's own ones */
    const struct affine *matrix;           /* local matrix of the instance, below no node */
    const uint32_t *node;                  /* node that the instance is below */
    double at[3];                          /* not (0, 0, 0): below a new node, translated by this */
};

/* Adds the mesh, whose ownership it takes, and one instance of it; gives the index of the mesh. */
uint32_t scene_put(struct scene *scene, struct scene_mesh mesh, const struct put *put);
/* Adds one more instance of a mesh, ignoring put->material; gives the index of the instance. */
uint32_t scene_put_again(struct scene *scene, uint32_t mesh, const struct put *put);
/* Adds a mesh without an instance; also a grey material if the scene has none yet. */
uint32_t scene_put_mesh(struct scene *scene, struct scene_mesh mesh);

/* Each gives the index of what it adds. */
uint32_t scene_put_material(struct scene *scene, struct scene_material material);
uint32_t scene_put_node(struct scene *scene, uint32_t parent, double x, double y, double z);
uint32_t scene_put_matrix(struct scene *scene, uint32_t parent, const struct affine *matrix);
/* `rgba`: four bytes a texel, copied. */
uint32_t scene_put_texture(struct scene *scene, uint32_t width, uint32_t height,
                           const uint8_t *rgba);
uint32_t scene_put_light(struct scene *scene, struct scene_light light);
/* A grey directional light that travels along (x, y, z), which may have any length. */
uint32_t scene_put_sun(struct scene *scene, double x, double y, double z, float strength);
/* A grey point light with falloff. */
uint32_t scene_put_lamp(struct scene *scene, double x, double y, double z, float strength);
/* A pinhole camera; up is +y, or -z for a vertical view. */
uint32_t scene_put_camera(struct scene *scene, const double eye[3], const double target[3],
                          double fov_y);
/* Linear keys: three (rotations: four) values each, copied. */
void scene_put_channel(struct scene *scene, uint32_t node, enum scene_path path, uint32_t keys,
                       const float *times_s, const float *values);

/* Freezes the scene, and gives it back. */
struct scene *scene_ready(struct scene *scene);
/* Whether one of the scene's notes has this text. */
bool scene_noted(const struct scene *scene, const char *text);

/* ---- Placements ---- */

/* A random matrix: translated by less than `spread`, rotated, and scaled by 0.34 to 1.66 per
   axis. */
struct affine placement_random(uint64_t *random, double spread, bool mirrored);

/* Initializer of a whit_camera: eye, target, up and vertical angle in degrees. */
#define CAMERA_AT(ex, ey, ez, tx, ty, tz, ux, uy, uz, fov)                                         \
    {                                                                                              \
        .own = true, .eye = {ex, ey, ez}, .target = {tx, ty, tz}, .up = {ux, uy, uz},              \
        .fov_y_degrees = fov                                                                       \
    }

#endif
