/* Flat arrays of the scene and its trees into device memory. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "render/renderer.h"

static bool fits_storage(const struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    uint64_t limit = device_get_info(renderer->device)->max_storage_range_bytes;
    return (uint64_t)accel->node_count * sizeof(struct gpu_bvh_node) <= limit &&
           (uint64_t)accel->triangle_count * sizeof(struct gpu_triangle) <= limit &&
           (uint64_t)accel->instance_count * sizeof(struct gpu_instance) <= limit;
}

/* Texel buffers are twice as fast on lavapipe, and reach beyond the range of a storage buffer. */
static bool choose_texel_loads(const struct renderer *renderer)
{
    switch (renderer->params.load_path) {
    case RENDER_LOAD_STORAGE:
        return false;
    case RENDER_LOAD_TEXEL:
        return true;
    case RENDER_LOAD_AUTO:
        break;
    }
    return device_get_info(renderer->device)->kind == DEVICE_CPU || !fits_storage(renderer);
}

whit_result upload_words(struct renderer *renderer, const void *data, uint64_t size_bytes,
                         uint32_t uses, const char *name, struct buffer **out)
{
    *out = NULL;
    if (size_bytes == 0)
        return WHIT_OK;
    whit_result result = buffer_create(renderer->device, size_bytes, uses, name, out);
    if (result == WHIT_OK)
        result = buffer_write(*out, 0, data, size_bytes);
    if (result == WHIT_OK)
        renderer->scene_buffers.bytes += buffer_size(*out);
    return result;
}

static whit_result upload_trees(struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    struct scene_buffers *buffers = &renderer->scene_buffers;
    uint32_t uses = buffers->texel_loads ? BUFFER_TEXELS : BUFFER_STORAGE;
    whit_result result =
        upload_words(renderer, accel->nodes, (uint64_t)accel->node_count * sizeof *accel->nodes,
                     uses, "nodes", &buffers->nodes);
    if (result == WHIT_OK)
        result = upload_words(renderer, accel->triangles,
                              (uint64_t)accel->triangle_count * sizeof *accel->triangles, uses,
                              "triangles", &buffers->triangles);
    if (result == WHIT_OK && !accel->single_identity)
        result = upload_words(renderer, accel->instances,
                              (uint64_t)accel->instance_count * sizeof *accel->instances, uses,
                              "instances", &buffers->instances);
    return result;
}

/* Calls `fill` for every triangle of every mesh, each mesh once, into one array of
   `words` 32-bit words a triangle. */
typedef void (*fill_triangle)(const struct scene_mesh *mesh, uint32_t triangle, uint32_t *out);

static whit_result upload_per_triangle(struct renderer *renderer, uint32_t words,
                                       fill_triangle fill, const char *name, struct buffer **out)
{
    const struct scene *scene = renderer->scene;
    uint32_t total = renderer->scene_buffers.triangle_total;
    uint32_t *data = array_alloc_zeroed(total, words * sizeof *data);
    if (!data) {
        log_error(&renderer->log, "out of memory for %s", name);
        return WHIT_ERROR_MEMORY;
    }
    uint32_t *at = data;
    for (uint32_t m = 0; m < scene->mesh_count; ++m) {
        const struct scene_mesh *mesh = &scene->meshes[m];
        for (uint32_t t = 0; t < mesh->triangle_count; ++t, at += words)
            fill(mesh, t, at);
    }
    whit_result result = upload_words(renderer, data, (uint64_t)total * words * sizeof *data,
                                      BUFFER_STORAGE, name, out);
    free(data);
    return result;
}

static void fill_material(const struct scene_mesh *mesh, uint32_t triangle, uint32_t *out)
{
    *out = mesh->materials[triangle];
}

/* Zeros for flat meshes: shading then takes the geometric normal. */
static void fill_normals(const struct scene_mesh *mesh, uint32_t triangle, uint32_t *out)
{
    const uint32_t *corners = &mesh->indices[3 * (size_t)triangle];
    for (size_t k = 0; mesh->normals && k < 3; ++k)
        memcpy(&out[3 * k], &mesh->normals[3 * (size_t)corners[k]], 3 * sizeof(float));
}

static void fill_uvs(const struct scene_mesh *mesh, uint32_t triangle, uint32_t *out, int set)
{
    const float *uvs = mesh->uvs[set] ? mesh->uvs[set] : mesh->uvs[0];
    const uint32_t *corners = &mesh->indices[3 * (size_t)triangle];
    for (size_t k = 0; uvs && k < 3; ++k)
        memcpy(&out[2 * k], &uvs[2 * (size_t)corners[k]], 2 * sizeof(float));
}

static uint32_t pack_unorm2x16(float x, float y)
{
    float cx = x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x, cy = y < 0.0f ? 0.0f : y > 1.0f ? 1.0f : y;
    return (uint32_t)(cx * 65535.0f + 0.5f) | (uint32_t)(cy * 65535.0f + 0.5f) << 16;
}

static void fill_colors(const struct scene_mesh *mesh, uint32_t triangle, uint32_t *out)
{
    static const float white[4] = {1, 1, 1, 1};
    const uint32_t *corners = &mesh->indices[3 * (size_t)triangle];
    for (size_t k = 0; k < 3; ++k) {
        const float *color = mesh->colors ? &mesh->colors[4 * (size_t)corners[k]] : white;
        out[2 * k] = pack_unorm2x16(color[0], color[1]);
        out[2 * k + 1] = pack_unorm2x16(color[2], color[3]);
    }
}

static bool any_mesh(const struct scene *scene, bool (*has)(const struct scene_mesh *mesh))
{
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        if (has(&scene->meshes[i]))
            return true;
    }
    return false;
}

static bool has_normals(const struct scene_mesh *mesh)
{
    return mesh->normals != NULL;
}

static bool has_uvs(const struct scene_mesh *mesh)
{
    return mesh->uvs[0] != NULL;
}

static bool has_second_uvs(const struct scene_mesh *mesh)
{
    return mesh->uvs[1] != NULL;
}

static bool has_colors(const struct scene_mesh *mesh)
{
    return mesh->colors != NULL;
}

/* Set 0 for every triangle, then set 1 where any mesh has one. */
static whit_result upload_uvs(struct renderer *renderer)
{
    const struct scene *scene = renderer->scene;
    uint64_t total = renderer->scene_buffers.triangle_total;
    int sets = any_mesh(scene, has_second_uvs) ? 2 : 1;
    uint32_t *data = array_alloc_zeroed((size_t)total * (size_t)sets, 6 * sizeof *data);
    if (!data)
        return WHIT_ERROR_MEMORY;
    uint32_t *at = data;
    for (int set = 0; set < sets; ++set) {
        for (uint32_t m = 0; m < scene->mesh_count; ++m) {
            for (uint32_t t = 0; t < scene->meshes[m].triangle_count; ++t, at += 6)
                fill_uvs(&scene->meshes[m], t, at, set);
        }
    }
    whit_result result = upload_words(renderer, data, total * (uint64_t)sets * 6 * sizeof *data,
                                      BUFFER_STORAGE, "triangle uvs", &renderer->scene_buffers.uvs);
    free(data);
    return result;
}

static whit_result upload_attributes(struct renderer *renderer)
{
    const struct scene *scene = renderer->scene;
    struct scene_buffers *buffers = &renderer->scene_buffers;
    bool all = renderer->params.all_effects; /* then kernels read every array */
    uint64_t total = 0;
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        total += scene->meshes[i].triangle_count;
    buffers->triangle_total = (uint32_t)total;
    if (total == 0)
        return WHIT_OK;
    whit_result result = upload_per_triangle(renderer, 1, fill_material, "triangle materials",
                                             &buffers->triangle_materials);
    if (result == WHIT_OK && (all || any_mesh(scene, has_normals)))
        result =
            upload_per_triangle(renderer, 9, fill_normals, "triangle normals", &buffers->normals);
    if (result == WHIT_OK && (all || any_mesh(scene, has_colors)))
        result = upload_per_triangle(renderer, 6, fill_colors, "triangle colors", &buffers->colors);
    if (result == WHIT_OK && (all || any_mesh(scene, has_uvs)))
        result = upload_uvs(renderer);
    return result;
}

static uint32_t light_code(enum scene_light_kind kind)
{
    switch (kind) {
    case SCENE_LIGHT_POINT:
        return LIGHT_POINT;
    case SCENE_LIGHT_DIRECTIONAL:
        return LIGHT_DIRECTIONAL;
    case SCENE_LIGHT_SPOT:
        return LIGHT_SPOT;
    case SCENE_LIGHT_AREA_SAMPLE:
        return LIGHT_AREA_SAMPLE;
    }
    return LIGHT_POINT;
}

static struct gpu_light make_light(const struct scene_light *light)
{
    struct gpu_light out = {
        .kind = light_code(light->kind),
        .range = light->range > 0.0f ? light->range : INFINITY,
        .falloff = light->falloff || light->kind == SCENE_LIGHT_AREA_SAMPLE,
        .cos_inner = light->cos_inner,
        .cos_outer = light->cos_outer,
        .two_sided = light->two_sided,
    };
    for (int i = 0; i < 3; ++i) {
        out.position[i] = (float)light->position[i];
        out.direction[i] = (float)light->direction[i];
        out.color[i] = light->color[i];
    }
    return out;
}

static whit_result upload_lights(struct renderer *renderer)
{
    const struct scene_pose *pose = &renderer->pose;
    struct gpu_light *lights = array_alloc(pose->light_count, sizeof *lights);
    if (!lights)
        return WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < pose->light_count; ++i)
        lights[i] = make_light(&pose->lights[i]);
    whit_result result =
        upload_words(renderer, lights, (uint64_t)pose->light_count * sizeof *lights, BUFFER_STORAGE,
                     "lights", &renderer->scene_buffers.lights);
    free(lights);
    return result;
}

whit_result upload_scene(struct renderer *renderer)
{
    struct scene_buffers *buffers = &renderer->scene_buffers;
    buffers->texel_loads = choose_texel_loads(renderer);
    whit_result result = buffer_create(renderer->device, 16, BUFFER_STORAGE | BUFFER_TEXELS,
                                       "nothing", &buffers->none);
    if (result == WHIT_OK)
        result = upload_trees(renderer);
    if (result == WHIT_OK)
        result = upload_attributes(renderer);
    if (result == WHIT_OK)
        result = upload_materials(renderer);
    if (result == WHIT_OK)
        result = upload_environment(renderer);
    if (result == WHIT_OK)
        result = upload_lights(renderer);
    return result;
}

void upload_finish(struct scene_buffers *buffers)
{
    struct buffer *all[] = {
        buffers->nodes,     buffers->triangles,
        buffers->instances, buffers->materials,
        buffers->textures,  buffers->texels,
        buffers->uvs,       buffers->frame,
        buffers->normals,   buffers->triangle_materials,
        buffers->colors,    buffers->lights,
        buffers->none,      buffers->environment,
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
        buffer_destroy(all[i]);
    *buffers = (struct scene_buffers){0};
}
