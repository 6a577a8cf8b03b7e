#include "scene/scene.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/child.h"
#include "base/same.h"
#include "base/text.h"
#include "base/vec.h"

struct scene *scene_create(const whit_log *log, const char *name)
{
    struct scene *scene = calloc(1, sizeof *scene);
    if (!scene)
        return NULL;
    scene->log = log_or_silence(log);
    scene->name = string_copy(name ? name : "");
    if (!scene->name) {
        free(scene);
        return NULL;
    }
    return scene;
}

void scene_mesh_finish(struct scene_mesh *mesh)
{
    if (!mesh)
        return;
    for (uint32_t i = 0; mesh->groups && i < mesh->group_count; ++i)
        free(mesh->groups[i].name);
    free(mesh->groups);
    free(mesh->name);
    free(mesh->spheres);
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs[0]);
    free(mesh->uvs[1]);
    free(mesh->colors);
    free(mesh->tangents);
    free(mesh->indices);
    free(mesh->materials);
    *mesh = (struct scene_mesh){0};
}

/* array_copy; without memory sets *good to false. */
static void *copy_of(const void *data, size_t count, size_t bytes, bool *good)
{
    void *copy = array_copy(data, count, bytes);
    *good = *good && (copy || !data);
    return copy;
}

bool scene_mesh_copy(const struct scene_mesh *mesh, struct scene_mesh *out)
{
    size_t vertices = mesh->vertex_count, triangles = mesh->triangle_count;
    bool good = true;
    *out = *mesh;
    out->name = string_copy(mesh->name);
    out->spheres = copy_of(mesh->spheres, mesh->sphere_count, 4 * sizeof(float), &good);
    out->positions = copy_of(mesh->positions, vertices, 3 * sizeof(float), &good);
    out->normals = copy_of(mesh->normals, vertices, 3 * sizeof(float), &good);
    for (int i = 0; i < 2; ++i)
        out->uvs[i] = copy_of(mesh->uvs[i], vertices, 2 * sizeof(float), &good);
    out->colors = copy_of(mesh->colors, vertices, 4 * sizeof(float), &good);
    out->tangents = copy_of(mesh->tangents, vertices, 4 * sizeof(float), &good);
    out->indices = copy_of(mesh->indices, triangles, 3 * sizeof(uint32_t), &good);
    out->materials = copy_of(mesh->materials, scene_mesh_primitives(mesh), sizeof(uint32_t), &good);
    out->groups = copy_of(mesh->groups, mesh->group_count, sizeof *mesh->groups, &good);
    for (uint32_t i = 0; out->groups && i < out->group_count; ++i) {
        out->groups[i].name = string_copy(mesh->groups[i].name);
        good = good && (out->groups[i].name || !mesh->groups[i].name);
    }
    if (good && (out->name || !mesh->name))
        return true;
    scene_mesh_finish(out);
    return false;
}

void scene_material_finish(struct scene_material *material)
{
    if (!material)
        return;
    free(material->name);
    free(material->origin.file);
    *material = (struct scene_material){0};
}

static void finish_light(struct scene_light *light)
{
    free(light->name);
    free(light->origin.file);
}

static void finish_channel(struct scene_channel *channel)
{
    free(channel->times_s);
    free(channel->values);
}

static void drop_texels(struct scene_texture *texture)
{
    struct child_reply held = {.data = texture->rgba, .size_bytes = texture->mapped_bytes};
    if (texture->mapped_bytes)
        child_reply_free(&held);
    else
        free(texture->rgba);
    texture->rgba = NULL;
}

static void finish_texture(struct scene_texture *texture)
{
    free(texture->name);
    drop_texels(texture);
}

void scene_drop_pictures(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->texture_count; ++i)
        drop_texels(&scene->textures[i]);
    free(scene->environment.rgb);
    scene->environment.rgb = NULL;
    scene->pictures_dropped = true;
}

void scene_destroy(struct scene *scene)
{
    if (!scene)
        return;
    roots_finish(&scene->roots);
    key_table_finish(&scene->texture_keys);
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        scene_mesh_finish(&scene->meshes[i]);
    for (uint32_t i = 0; i < scene->node_count; ++i)
        free(scene->nodes[i].name);
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        free(scene->instances[i].name);
    for (uint32_t i = 0; i < scene->material_count; ++i)
        scene_material_finish(&scene->materials[i]);
    for (uint32_t i = 0; i < scene->texture_count; ++i)
        finish_texture(&scene->textures[i]);
    for (uint32_t i = 0; i < scene->light_count; ++i)
        finish_light(&scene->lights[i]);
    for (uint32_t i = 0; i < scene->camera_count; ++i)
        free(scene->cameras[i].name);
    for (uint32_t i = 0; i < scene->channel_count; ++i)
        finish_channel(&scene->channels[i]);
    for (uint32_t i = 0; i < scene->note_count; ++i)
        free(scene->notes[i].text);
    free(scene->meshes);
    free(scene->nodes);
    free(scene->instances);
    free(scene->materials);
    free(scene->textures);
    free(scene->lights);
    free(scene->cameras);
    free(scene->channels);
    free(scene->notes);
    free(scene->environment.rgb);
    free(scene->environment.name);
    free(scene->name);
    free(scene);
}

void scene_texture_use_init(struct scene_texture_use *out)
{
    *out = (struct scene_texture_use){.texture = SCENE_NONE, .transform = {1, 0, 0, 0, 1, 0}};
}

bool scene_slot_is_srgb(enum scene_slot slot, whit_material_model model)
{
    return slot == SCENE_SLOT_DIFFUSE || slot == SCENE_SLOT_EMISSION ||
           (slot == SCENE_SLOT_SPECULAR && model == WHIT_MODEL_METAL_ROUGH);
}

float scene_texture_offset(const struct scene_texture_use *use, int axis)
{
    float offset = use->transform[3 * axis + 2];
    enum scene_wrap wrap = axis ? use->wrap_v : use->wrap_u;
    return wrap == SCENE_WRAP_CLAMP ? offset : fmodf(offset, 2.0f);
}

void scene_material_init(struct scene_material *out, const char *name)
{
    *out = (struct scene_material){
        .name = string_copy(name ? name : ""),
        .model = WHIT_MODEL_PHONG,
        .illum = -1,
        .ambient = {0.7f, 0.7f, 0.7f},
        .diffuse = {0.7f, 0.7f, 0.7f},
        .shininess = 32.0f,
        .ior = 1.5f,
        .roughness = 1.0f,
        .specular_level = 1.0f,
        .alpha = SCENE_ALPHA_OPAQUE,
        .opacity = 1.0f,
        .alpha_cutoff = 0.5f,
        .normal_scale = 1.0f,
    };
    for (int i = 0; i < SCENE_SLOT_COUNT; ++i)
        scene_texture_use_init(&out->textures[i]);
}

static float versine(double angle)
{
    double sine = same_sin(0.5 * angle);
    return (float)(2.0 * sine * sine);
}

void scene_light_cones(struct scene_light *light, double inner, double outer)
{
    light->versine_inner = versine(inner);
    light->versine_outer = versine(outer);
}

double scene_light_fade(const struct scene_light *light, double distance)
{
    double far = light->range > 0.0f ? distance / (double)light->range : 0.0;
    return fmax(1.0 - far * far * far * far, 0.0);
}

double scene_light_cone_width(const struct scene_light *light)
{
    double outer = (double)light->versine_outer, width = outer - (double)light->versine_inner;
    return fmax(width, fmax(outer * 1e-6, 1e-30));
}

void scene_camera_axes(const struct scene_camera *camera, double forward[3], double right[3],
                       double up[3])
{
    double3_sub(camera->target, camera->eye, forward);
    double3_unit(forward);
    double3_cross(forward, camera->up, right);
    double3_unit(right);
    double3_cross(right, forward, up);
}

void scene_node_init(struct scene_node *out, const char *name, uint32_t parent)
{
    *out = (struct scene_node){
        .name = string_copy(name ? name : ""),
        .parent = parent,
        .matrix = affine_identity(),
        .rotation = {0, 0, 0, 1},
        .scale = {1, 1, 1},
    };
}

uint32_t scene_add_mesh(struct scene *scene, struct scene_mesh mesh)
{
    if (ARRAY_PUSH(scene->meshes, scene->mesh_count, scene->mesh_capacity, mesh))
        return scene->mesh_count - 1;
    scene_mesh_finish(&mesh);
    return SCENE_NONE;
}

uint32_t scene_add_node(struct scene *scene, struct scene_node node)
{
    scene->lacks_memory |= !node.name;
    if (ARRAY_PUSH(scene->nodes, scene->node_count, scene->node_capacity, node))
        return scene->node_count - 1;
    free(node.name);
    return SCENE_NONE;
}

uint32_t scene_add_instance(struct scene *scene, struct scene_instance instance)
{
    if (ARRAY_PUSH(scene->instances, scene->instance_count, scene->instance_capacity, instance))
        return scene->instance_count - 1;
    free(instance.name);
    return SCENE_NONE;
}

uint32_t scene_add_material(struct scene *scene, struct scene_material material)
{
    scene->lacks_memory |= !material.name;
    if (ARRAY_PUSH(scene->materials, scene->material_count, scene->material_capacity, material))
        return scene->material_count - 1;
    scene_material_finish(&material);
    return SCENE_NONE;
}

uint32_t scene_add_texture(struct scene *scene, struct scene_texture texture)
{
    uint32_t index = scene->texture_count;
    if (!ARRAY_PUSH(scene->textures, scene->texture_count, scene->texture_capacity, texture)) {
        finish_texture(&texture);
        return SCENE_NONE;
    }
    uint32_t first;
    if (texture.name && !scene_find_texture(scene, texture.name, &first))
        scene->lacks_memory |=
            !key_table_add(&scene->texture_keys, texture.name, strlen(texture.name), index);
    return index;
}

bool scene_find_texture(const struct scene *scene, const char *name, uint32_t *index)
{
    return key_table_find(&scene->texture_keys, name, strlen(name), index);
}

void scene_drop_lights(struct scene *scene)
{
    while (scene->light_count)
        finish_light(&scene->lights[--scene->light_count]);
}

uint32_t scene_add_light(struct scene *scene, struct scene_light light)
{
    if (ARRAY_PUSH(scene->lights, scene->light_count, scene->light_capacity, light))
        return scene->light_count - 1;
    finish_light(&light);
    return SCENE_NONE;
}

uint32_t scene_add_camera(struct scene *scene, struct scene_camera camera)
{
    if (ARRAY_PUSH(scene->cameras, scene->camera_count, scene->camera_capacity, camera))
        return scene->camera_count - 1;
    free(camera.name);
    return SCENE_NONE;
}

uint32_t scene_add_channel(struct scene *scene, struct scene_channel channel)
{
    if (ARRAY_PUSH(scene->channels, scene->channel_count, scene->channel_capacity, channel))
        return scene->channel_count - 1;
    finish_channel(&channel);
    return SCENE_NONE;
}

bool scene_can_play(const struct scene *scene, const struct scene_channel *channel)
{
    if (channel->node >= scene->node_count || !channel->key_count || !channel->times_s ||
        !channel->values)
        return false;
    size_t values = (size_t)channel->key_count * scene_channel_width(channel);
    for (uint32_t i = 0; i < channel->key_count; ++i) {
        if (!isfinite(channel->times_s[i]) ||
            (i && !(channel->times_s[i] > channel->times_s[i - 1])))
            return false;
    }
    for (size_t i = 0; i < values; ++i) {
        if (!isfinite(channel->values[i]))
            return false;
    }
    return true;
}

char *scene_text(struct scene *scene, const char *text)
{
    char *copy = string_copy(text);
    scene->lacks_memory |= text && !copy;
    return copy;
}

void scene_note(struct scene *scene, enum scene_note_level level, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    text_print(text, sizeof text, format, args);
    va_end(args);
    if (level == SCENE_NOTE_WARNING)
        log_warning(&scene->log, "%s", text);
    else
        log_info(&scene->log, "%s", text);
    struct scene_note note = {level, scene_text(scene, text)};
    if (!note.text)
        return;
    if (ARRAY_PUSH(scene->notes, scene->note_count, scene->note_capacity, note))
        return;
    free(note.text);
    scene->lacks_memory = true;
}
