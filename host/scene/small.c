#include "scene/small.h"

#include <string.h>

#include "base/array.h"
#include "scene/shapes.h"

/* Adds a mesh of one material, moved by `place`. `made`: result of the shape's function. */
static bool put(struct scene *scene, whit_result made, struct scene_mesh *mesh,
                const double place[3], struct scene_material material)
{
    uint32_t index = scene_add_material(scene, material);
    if (made != WHIT_OK || index == SCENE_NONE) {
        scene_mesh_finish(mesh);
        return false;
    }
    for (uint32_t i = 0; i < 3 * mesh->vertex_count; ++i)
        mesh->positions[i] += (float)place[i % 3];
    for (uint32_t i = 0; i < mesh->triangle_count; ++i)
        mesh->materials[i] = index;
    mesh->name = string_copy("small");
    struct scene_instance instance = {.mesh = scene_add_mesh(scene, *mesh), .node = SCENE_NONE};
    if (instance.mesh == SCENE_NONE)
        return false;
    instance.name = string_copy("small");
    return scene_add_instance(scene, instance) != SCENE_NONE;
}

static struct scene_material material_of(float red, float green, float blue)
{
    struct scene_material material;
    scene_material_init(&material, "small");
    material.diffuse[0] = red;
    material.diffuse[1] = green;
    material.diffuse[2] = blue;
    return material;
}

static bool put_floor(struct scene *scene)
{
    struct scene_mesh mesh = {0};
    whit_result made = shape_plane(8.0, 8.0, 1, 1.0, &mesh);
    return put(scene, made, &mesh, (double[]){0.0, 0.0, 0.0}, material_of(0.7f, 0.7f, 0.7f));
}

static bool put_mirror(struct scene *scene)
{
    struct scene_mesh mesh = {0};
    struct scene_material material = material_of(0.1f, 0.1f, 0.1f);
    whit_result made = shape_box((double[]){1.5, 1.6, 0.4}, &mesh);
    for (int i = 0; i < 3; ++i)
        material.reflection[i] = 0.8f;
    return put(scene, made, &mesh, (double[]){0.3, 0.8, -1.5}, material);
}

static bool put_ball(struct scene *scene, double x, struct scene_material material)
{
    struct scene_mesh mesh = {0};
    whit_result made = shape_icosphere(0.6, 3, &mesh);
    return put(scene, made, &mesh, (double[]){x, 0.61, 0.2}, material);
}

static struct scene_material glass(void)
{
    struct scene_material material = material_of(0.0f, 0.0f, 0.0f);
    material.fresnel = true;
    for (int i = 0; i < 3; ++i)
        material.transmission[i] = 0.95f;
    return material;
}

static bool put_lamp(struct scene *scene)
{
    const struct scene_light light = {.name = string_copy("small"),
                                      .kind = WHIT_LIGHT_POINT,
                                      .node = SCENE_NONE,
                                      .position = {-3.0, 5.0, 3.0},
                                      .color = {1.0f, 1.0f, 1.0f}};
    return scene_add_light(scene, light) != SCENE_NONE;
}

static bool put_camera(struct scene *scene)
{
    const struct scene_camera camera = {.name = string_copy("small"),
                                        .kind = WHIT_CAMERA_PERSPECTIVE,
                                        .node = SCENE_NONE,
                                        .eye = {0.0, 2.0, 4.5},
                                        .target = {0.0, 0.6, 0.0},
                                        .up = {0.0, 1.0, 0.0},
                                        .fov_y = 0.7f};
    return scene_add_camera(scene, camera) != SCENE_NONE;
}

struct scene *scene_small(const whit_log *log)
{
    struct scene *scene = scene_create(log, "whit's small scene");
    bool made = scene && put_floor(scene) && put_mirror(scene) && put_ball(scene, -0.9, glass()) &&
                put_ball(scene, 0.9, material_of(0.8f, 0.3f, 0.2f)) && put_lamp(scene) &&
                put_camera(scene);
    if (!made)
        log_error(log, "out of memory for whit's small scene");
    if (made && scene_freeze(scene) == WHIT_OK)
        return scene;
    scene_destroy(scene);
    return NULL;
}
