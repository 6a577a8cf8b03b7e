#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/array.h"
#include "base/vec.h"
#include "load/scene_cameras.h"
#include "picture/camera.h"
#include "scene/effects.h"
#include "scene/pose.h"
#include "scene/small.h"
#include "scene/viewpoint.h"

static const double DEGREES = 180.0 / PI;

whit_result whit_scene_load(const char *path, const whit_load_params *params, const whit_log *log,
                            whit_scene **out)
{
    const whit_log own = log_or_silence(log);
    struct scene *scene = NULL;
    whit_result result = load_scene(&own, path, params, &scene);
    return api_hand_out_scene(&own, scene, result, out);
}

whit_result whit_scene_small(const whit_log *log, whit_scene **out)
{
    const whit_log own = log_or_silence(log);
    struct scene *scene = scene_small(&own);
    return api_hand_out_scene(&own, scene, scene ? WHIT_OK : WHIT_ERROR_MEMORY, out);
}

void whit_scene_drop_pictures(whit_scene *scene)
{
    scene_drop_pictures(scene->scene);
}

void whit_scene_destroy(whit_scene *scene)
{
    if (!scene)
        return;
    scene_pose_finish(&scene->pose);
    scene_destroy(scene->scene);
    free(scene);
}

static const char *or_empty(const char *text)
{
    return text ? text : "";
}

void whit_scene_get_info(const whit_scene *handle, whit_scene_info *info)
{
    const struct scene *scene = handle->scene;
    *info = (whit_scene_info){
        .mesh_count = scene->mesh_count,
        .instance_count = scene->instance_count,
        .node_count = scene->node_count,
        .material_count = scene->material_count,
        .texture_count = scene->texture_count,
        .light_count = scene->light_count,
        .camera_count = scene->camera_count,
        .note_count = scene->note_count,
        .effect_count = SCENE_EFFECT_COUNT,
        .textures_missing = scene->textures_missing,
        .triangle_count = scene->triangle_total,
        .sphere_count = scene->sphere_total,
        .file_bytes = scene->file_bytes,
        .hash = scene->hash,
        .channel_count = scene->channel_count,
        .time_begin_s = (double)scene->time_begin_s,
        .time_end_s = (double)scene->time_end_s,
        .one_tree = handle->one_tree,
        .environment = scene->environment.kind,
        .environment_made_by_whit = scene->environment.made_by_whit,
        .exposure_ev = scene->exposure_ev,
    };
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        info->mesh_triangle_count += scene->meshes[i].triangle_count;
    memcpy(info->lo, handle->pose.lo, sizeof info->lo);
    memcpy(info->hi, handle->pose.hi, sizeof info->hi);
    scene_pose_objects(scene, &handle->pose, info->objects_lo, info->objects_hi);
    bool part = scene->shown_lo[0] <= scene->shown_hi[0];
    memcpy(info->home_lo, part ? scene->shown_lo : info->objects_lo, sizeof info->home_lo);
    memcpy(info->home_hi, part ? scene->shown_hi : info->objects_hi, sizeof info->home_hi);
}

void whit_scene_get_mesh(const whit_scene *handle, uint32_t index, whit_mesh_info *info)
{
    *info = (whit_mesh_info){.name = ""};
    if (index >= handle->scene->mesh_count)
        return;
    const struct scene_mesh *mesh = &handle->scene->meshes[index];
    *info = (whit_mesh_info){
        .name = or_empty(mesh->name),
        .vertex_count = mesh->vertex_count,
        .triangle_count = mesh->triangle_count,
        .group_count = mesh->group_count,
        .sphere_count = mesh->sphere_count,
        .has_normals = mesh->normals != NULL,
        .has_uvs = mesh->uvs[0] || mesh->uvs[1],
        .has_colors = mesh->colors != NULL,
    };
    memcpy(info->lo, mesh->lo, sizeof info->lo);
    memcpy(info->hi, mesh->hi, sizeof info->hi);
}

static uint32_t count_textures(const struct scene_material *material)
{
    uint32_t count = 0;
    for (int i = 0; i < SCENE_SLOT_COUNT; ++i)
        count += material->textures[i].texture != SCENE_NONE;
    return count;
}

void whit_scene_get_material(const whit_scene *handle, uint32_t index, whit_material_info *info)
{
    *info = (whit_material_info){.name = ""};
    if (index >= handle->scene->material_count)
        return;
    const struct scene_material *material = &handle->scene->materials[index];
    *info = (whit_material_info){
        .name = or_empty(material->name),
        .file = material->origin.file,
        .line = material->origin.line,
        .model = material->model,
        .illum = material->illum,
        .shininess = material->shininess,
        .ior = material->ior,
        .opacity = material->opacity,
        .metallic = material->metallic,
        .roughness = material->roughness,
        .texture_count = count_textures(material),
    };
    memcpy(info->diffuse, material->diffuse, sizeof info->diffuse);
    memcpy(info->specular, material->specular, sizeof info->specular);
    memcpy(info->emission, material->emission, sizeof info->emission);
    memcpy(info->reflection, material->reflection, sizeof info->reflection);
    memcpy(info->transmission, material->transmission, sizeof info->transmission);
}

void whit_scene_get_light(const whit_scene *handle, uint32_t index, whit_light_info *info)
{
    *info = (whit_light_info){.name = ""};
    if (index >= handle->pose.light_count)
        return;
    const struct scene_light *light = &handle->pose.lights[index];
    *info = (whit_light_info){
        .name = or_empty(light->name),
        .kind = light->kind,
        .made_by_whit = light->made_by_whit,
    };
    memcpy(info->position, light->position, sizeof info->position);
    /* light->position is a corner of a rectangle; scene files and this info have its centre. */
    for (int i = 0; i < 3 && light->kind == WHIT_LIGHT_RECTANGLE; ++i)
        info->position[i] += 0.5 * (light->edge_u[i] + light->edge_v[i]);
    memcpy(info->direction, light->direction, sizeof info->direction);
    memcpy(info->color, light->color, sizeof info->color);
}

static void describe_camera(const struct scene_camera *camera, whit_camera_info *info)
{
    bool perspective = camera->kind == WHIT_CAMERA_PERSPECTIVE;
    bool orthographic = camera->kind == WHIT_CAMERA_ORTHOGRAPHIC;
    *info = (whit_camera_info){
        .name = or_empty(camera->name),
        .kind = camera->kind,
        .fov_y_degrees = perspective ? (double)camera->fov_y * DEGREES : 0.0,
        .height = orthographic ? (double)camera->height : 0.0,
        .lens_radius = (double)camera->lens_radius,
        .focus_distance = (double)camera->focus_distance,
        .target_is_direction = camera->target_is_direction,
        .made_by_whit = camera->made_by_whit,
    };
    memcpy(info->eye, camera->eye, sizeof info->eye);
    memcpy(info->target, camera->target, sizeof info->target);
    memcpy(info->up, camera->up, sizeof info->up);
}

void whit_scene_get_camera(const whit_scene *handle, uint32_t index, whit_camera_info *info)
{
    *info = (whit_camera_info){.name = ""};
    if (index < handle->pose.camera_count)
        describe_camera(&handle->pose.cameras[index], info);
}

whit_result whit_scene_pose_camera(const whit_scene *handle, uint32_t index, double time_s,
                                   whit_camera_info *info)
{
    struct scene_camera camera;
    whit_scene_get_camera(handle, index, info);
    if (index >= handle->pose.camera_count)
        return WHIT_OK;
    whit_result result = scene_pose_camera(handle->scene, index, time_s, &camera);
    if (result == WHIT_OK)
        describe_camera(&camera, info);
    return result;
}

void whit_scene_get_instance(const whit_scene *handle, uint32_t index, whit_instance_info *info)
{
    const char *name = index == WHIT_INSTANCE_SHAPE ? "shape of intersect()" : "";
    *info = (whit_instance_info){.name = name, .mesh = WHIT_NONE};
    if (index >= handle->pose.instance_count)
        return;
    const struct scene_instance *instance = &handle->scene->instances[index];
    info->name = or_empty(instance->name);
    info->mesh = instance->mesh;
    for (int i = 0; i < 12; ++i)
        info->object_to_world[i] = handle->pose.instances[index].m[i];
}

void whit_scene_get_effect(const whit_scene *handle, uint32_t index, whit_effect_info *info)
{
    *info = (whit_effect_info){.name = "", .reason = ""};
    if (index >= SCENE_EFFECT_COUNT)
        return;
    info->name = scene_effect_name((enum scene_effect)index);
    info->called = handle->effects.called[index];
    info->reason = info->called ? handle->effects.reasons[index] : "";
}

void whit_scene_get_note(const whit_scene *handle, uint32_t index, whit_note_info *info)
{
    *info = (whit_note_info){.text = ""};
    if (index >= handle->scene->note_count)
        return;
    info->warning = handle->scene->notes[index].level == SCENE_NOTE_WARNING;
    info->text = or_empty(handle->scene->notes[index].text);
}

whit_result whit_scene_choose_camera(const whit_scene *handle, whit_camera *camera)
{
    struct viewpoint viewpoint;
    *camera = (whit_camera){.own = true, .up = {0.0, 1.0, 0.0}};
    whit_result result = viewpoint_choose(handle->scene, &handle->pose, &viewpoint);
    if (result != WHIT_OK) {
        log_error(&handle->log, "out of memory");
        return result;
    }
    memcpy(camera->eye, viewpoint.eye, sizeof camera->eye);
    memcpy(camera->target, viewpoint.target, sizeof camera->target);
    camera->fov_y_degrees = viewpoint.fov_y * DEGREES;
    return WHIT_OK;
}

/* Converts an angle to degrees. If a number of at most seven digits gives the same float of
   radians, it is taken, since a file most likely had it. */
static double degrees_of(float radians)
{
    char text[32];
    snprintf(text, sizeof text, "%.7g", (double)radians * DEGREES);
    double said = strtod(text, NULL);
    return (float)(said * PI / 180.0) == radians ? said : (double)radians * DEGREES;
}

static whit_camera camera_of(const struct scene_camera *from)
{
    whit_camera camera = {
        .own = true,
        .kind = from->kind,
        .fov_y_degrees = degrees_of(from->fov_y),
        .height = (double)from->height,
        .lens_radius = (double)from->lens_radius,
        .focus_distance = (double)from->focus_distance,
    };
    memcpy(camera.eye, from->eye, sizeof camera.eye);
    memcpy(camera.target, from->target, sizeof camera.target);
    memcpy(camera.up, from->up, sizeof camera.up);
    return camera;
}

whit_result whit_cameras_load(const char *path, const whit_log *log, whit_camera **cameras,
                              uint32_t *count)
{
    whit_log own = log_or_silence(log);
    *cameras = NULL;
    *count = 0;
    whit_result result = load_check(log, path, NULL);
    if (result != WHIT_OK)
        return result;
    struct scene *scene = scene_create(&own, path);
    result = scene ? load_cameras(scene, path) : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK)
        *cameras = array_alloc(scene->camera_count, sizeof **cameras);
    if (result == WHIT_OK && !*cameras)
        result = WHIT_ERROR_MEMORY;
    if (result == WHIT_ERROR_MEMORY)
        log_error(&own, "%s: out of memory", path);
    for (uint32_t i = 0; result == WHIT_OK && i < scene->camera_count; ++i)
        (*cameras)[i] = camera_of(&scene->cameras[i]);
    *count = result == WHIT_OK ? scene->camera_count : 0;
    scene_destroy(scene);
    return result;
}

static void world_triangle(const struct scene_mesh *mesh, const struct affine *to_world,
                           uint32_t primitive, whit_triangle *out)
{
    double world[3][3];
    scene_mesh_placed_corners(mesh, primitive, to_world, world);
    for (int i = 0; i < 9; ++i)
        out->vertices[i] = (float)world[i / 3][i % 3];
    out->primitive = primitive;
}

whit_result whit_scene_triangles(const whit_scene *handle, double time_s,
                                 bool (*fn)(void *user, const whit_triangle *triangle), void *user)
{
    struct scene_pose pose = {0};
    whit_result result = scene_pose_init(handle->scene, time_s, &pose);
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; i < pose.instance_count && result == WHIT_OK; ++i) {
        const struct scene_mesh *mesh = &handle->scene->meshes[handle->scene->instances[i].mesh];
        whit_triangle triangle = {.instance = i};
        for (uint32_t k = 0; k < mesh->triangle_count && result == WHIT_OK; ++k) {
            world_triangle(mesh, &pose.instances[i], k, &triangle);
            if (!fn(user, &triangle))
                result = WHIT_ERROR_CANCELLED;
        }
    }
    scene_pose_finish(&pose);
    return result;
}

whit_result whit_camera_rays(const whit_scene *scene, const whit_camera *camera, uint32_t width,
                             uint32_t height, const whit_log *log, whit_ray *rays)
{
    return camera_all_rays(log, &scene->pose, camera, width, height, (struct gpu_ray *)rays);
}
