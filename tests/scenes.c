#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "random.h"
#include "scene/shapes.h"

static void expect(bool good, const char *what)
{
    if (good)
        return;
    fprintf(stderr, "tests/scenes.c: %s\n", what);
    abort();
}

static uint32_t added(uint32_t index)
{
    expect(index != SCENE_NONE, "nothing could be added to a scene");
    return index;
}

static void *copy_of(const void *bytes, size_t count, size_t element_bytes)
{
    void *copy = array_copy(bytes, count, element_bytes);
    expect(copy, "no memory");
    return copy;
}

/* ---- Meshes ---- */

static struct scene_mesh made(const struct scene_mesh *mesh, whit_result result)
{
    expect(result == WHIT_OK, "a shape could not be made");
    return *mesh;
}

struct scene_mesh mesh_box(double x, double y, double z)
{
    struct scene_mesh mesh;
    return made(&mesh, shape_box((double[]){x, y, z}, &mesh));
}

struct scene_mesh mesh_plane(double size)
{
    struct scene_mesh mesh;
    return made(&mesh, shape_plane(size, size, 1, 1.0, &mesh));
}

struct scene_mesh mesh_sphere(double radius, uint32_t segments, uint32_t rings)
{
    struct scene_mesh mesh;
    return made(&mesh, shape_sphere(radius, segments, rings, &mesh));
}

struct scene_mesh mesh_icosphere(double radius, uint32_t level)
{
    struct scene_mesh mesh;
    return made(&mesh, shape_icosphere(radius, level, &mesh));
}

struct scene_mesh mesh_torus(double radius, double tube, uint32_t segments, uint32_t sides)
{
    struct scene_mesh mesh;
    return made(&mesh, shape_torus(radius, tube, segments, sides, &mesh));
}

struct scene_mesh mesh_terrain(double size, double height, uint32_t steps, uint32_t seed)
{
    struct scene_mesh mesh;
    return made(&mesh, shape_terrain(size, height, steps, seed, &mesh));
}

struct scene_mesh mesh_balls(const double *spheres, uint32_t count)
{
    struct scene_mesh mesh;
    return made(&mesh, shape_balls(spheres, count, &mesh));
}

struct scene_mesh mesh_zeroed(uint32_t vertex_count, uint32_t triangle_count)
{
    struct scene_mesh mesh = {.vertex_count = vertex_count, .triangle_count = triangle_count};
    mesh.positions = array_alloc_zeroed(vertex_count, 3 * sizeof *mesh.positions);
    mesh.indices = array_alloc_zeroed(triangle_count, 3 * sizeof *mesh.indices);
    mesh.materials = array_alloc_zeroed(triangle_count, sizeof *mesh.materials);
    expect(mesh.positions && mesh.indices && mesh.materials, "no memory");
    return mesh;
}

struct scene_mesh mesh_triangles(const float *corners, uint32_t triangle_count)
{
    struct scene_mesh mesh = mesh_zeroed(3 * triangle_count, triangle_count);
    memcpy(mesh.positions, corners, 9 * sizeof *corners * triangle_count);
    for (uint32_t i = 0; i < 3 * triangle_count; ++i)
        mesh.indices[i] = i;
    return mesh;
}

struct scene_mesh mesh_wearing(struct scene_mesh mesh, uint32_t material)
{
    for (uint32_t i = 0; i < scene_mesh_primitives(&mesh); ++i)
        mesh.materials[i] = material;
    return mesh;
}

/* ---- Materials ---- */

struct scene_material material_grey(const char *name)
{
    struct scene_material material;
    scene_material_init(&material, NULL);
    free(material.name);
    material.name = (char *)name;
    return material;
}

struct scene_material material_plain(const char *name)
{
    struct scene_material material = material_grey(name);
    memset(material.ambient, 0, sizeof material.ambient);
    memset(material.specular, 0, sizeof material.specular);
    return material;
}

/* ---- Scenes ---- */

struct scene *scene_begin(const whit_log *log, const char *name)
{
    struct scene *scene = scene_create(log, name);
    expect(scene, "no memory");
    return scene;
}

uint32_t scene_put_mesh(struct scene *scene, struct scene_mesh mesh)
{
    if (scene->material_count == 0)
        scene_put_material(scene, material_grey("grey"));
    return added(scene_add_mesh(scene, mesh));
}

uint32_t scene_put(struct scene *scene, struct scene_mesh mesh, const struct put *put)
{
    if (put && put->material)
        mesh = mesh_wearing(mesh, scene_put_material(scene, *put->material));
    if (put && put->name)
        mesh.name = string_copy(put->name);
    uint32_t index = scene_put_mesh(scene, mesh);
    scene_put_again(scene, index, put);
    return index;
}

uint32_t scene_put_again(struct scene *scene, uint32_t mesh, const struct put *put)
{
    static const struct put nothing;
    put = put ? put : &nothing;
    struct scene_instance instance = {.mesh = mesh, .node = SCENE_NONE};
    instance.name = string_copy(put->name);
    if (put->matrix) {
        instance.has_local = true;
        instance.local = *put->matrix;
    }
    if (put->node)
        instance.node = *put->node;
    else if (put->at[0] != 0.0 || put->at[1] != 0.0 || put->at[2] != 0.0)
        instance.node = scene_put_node(scene, SCENE_NONE, put->at[0], put->at[1], put->at[2]);
    return added(scene_add_instance(scene, instance));
}

uint32_t scene_put_material(struct scene *scene, struct scene_material material)
{
    material.name = string_copy(material.name);
    return added(scene_add_material(scene, material));
}

uint32_t scene_put_node(struct scene *scene, uint32_t parent, double x, double y, double z)
{
    struct scene_node node;
    scene_node_init(&node, "node", parent);
    node.translation[0] = x;
    node.translation[1] = y;
    node.translation[2] = z;
    return added(scene_add_node(scene, node));
}

uint32_t scene_put_matrix(struct scene *scene, uint32_t parent, const struct affine *matrix)
{
    struct scene_node node;
    scene_node_init(&node, "node", parent);
    node.has_matrix = true;
    node.matrix = *matrix;
    return added(scene_add_node(scene, node));
}

uint32_t scene_put_texture(struct scene *scene, uint32_t width, uint32_t height,
                           const uint8_t *rgba)
{
    struct scene_texture texture = {
        .name = string_copy("texture"), .width = width, .height = height};
    texture.rgba = copy_of(rgba, (size_t)width * height, 4);
    return added(scene_add_texture(scene, texture));
}

uint32_t scene_put_light(struct scene *scene, struct scene_light light)
{
    if (!light.name)
        light.name = string_copy("light");
    return added(scene_add_light(scene, light));
}

uint32_t scene_put_sun(struct scene *scene, double x, double y, double z, float strength)
{
    double length = sqrt(x * x + y * y + z * z);
    return scene_put_light(scene,
                           (struct scene_light){.name = string_copy("sun"),
                                                .kind = WHIT_LIGHT_DIRECTIONAL,
                                                .node = SCENE_NONE,
                                                .direction = {x / length, y / length, z / length},
                                                .color = {strength, strength, strength}});
}

uint32_t scene_put_lamp(struct scene *scene, double x, double y, double z, float strength)
{
    return scene_put_light(scene, (struct scene_light){.name = string_copy("lamp"),
                                                       .kind = WHIT_LIGHT_POINT,
                                                       .node = SCENE_NONE,
                                                       .position = {x, y, z},
                                                       .color = {strength, strength, strength},
                                                       .falloff = true});
}

uint32_t scene_put_camera(struct scene *scene, const double eye[3], const double target[3],
                          double fov_y)
{
    bool upright = eye[0] == target[0] && eye[2] == target[2];
    struct scene_camera camera = {.name = string_copy("camera"),
                                  .kind = WHIT_CAMERA_PERSPECTIVE,
                                  .node = SCENE_NONE,
                                  .up = {0, upright ? 0 : 1, upright ? -1 : 0},
                                  .fov_y = (float)fov_y};
    memcpy(camera.eye, eye, sizeof camera.eye);
    memcpy(camera.target, target, sizeof camera.target);
    return added(scene_add_camera(scene, camera));
}

void scene_put_channel(struct scene *scene, uint32_t node, enum scene_path path, uint32_t keys,
                       const float *times_s, const float *values)
{
    size_t width = path == SCENE_PATH_ROTATION ? 4 : 3;
    struct scene_channel channel = {.node = node,
                                    .path = path,
                                    .interpolation = SCENE_LINEAR,
                                    .key_count = keys,
                                    .times_s = copy_of(times_s, keys, sizeof *times_s),
                                    .values = copy_of(values, width * keys, sizeof *values)};
    added(scene_add_channel(scene, channel));
}

struct scene *scene_ready(struct scene *scene)
{
    expect(scene_freeze(scene) == WHIT_OK, "a scene could not be frozen");
    return scene;
}

bool scene_noted(const struct scene *scene, const char *text)
{
    for (uint32_t i = 0; i < scene->note_count; ++i) {
        if (strstr(scene->notes[i].text, text))
            return true;
    }
    return false;
}

/* ---- Placements ---- */

struct affine placement_random(uint64_t *random, double spread, bool mirrored)
{
    double t[3], q[4], s[3];
    for (int k = 0; k < 3; ++k) {
        t[k] = spread * (double)random_float_signed(random);
        s[k] = 1.0 + 0.66 * (double)random_float_signed(random);
    }
    for (int k = 0; k < 4; ++k)
        q[k] = (double)random_float_signed(random);
    s[0] = mirrored ? -s[0] : s[0];
    return affine_from_trs(t, q, s);
}
