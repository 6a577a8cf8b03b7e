#include "scene/freeze.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/text.h"
#include "base/vec.h"
#include "scene/exposure.h"
#include "scene/hash.h"
#include "scene/pose.h"

/* Lights are clamped to this; shaders/bind/light.glsl clamps arriving light to the same limit. */
#define LIGHT_MAX 1e24f

static whit_result refuse(struct scene *scene, const char *what, uint32_t index, const char *why)
{
    return log_failure(&scene->log, WHIT_ERROR_INPUT, "%s: %s %u: %s", scene->name, what, index,
                       why);
}

static whit_result check_nodes(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        struct scene_node *node = &scene->nodes[i];
        if (node->parent != SCENE_NONE && node->parent >= i)
            return refuse(scene, "node", i, "its parent does not come before it");
        bool finite = node->has_matrix ? affine_is_finite(&node->matrix) : true;
        for (int k = 0; !node->has_matrix && k < 4; ++k)
            finite = finite && isfinite(node->rotation[k]) &&
                     (k == 3 || (isfinite(node->translation[k]) && isfinite(node->scale[k])));
        if (!finite) {
            scene_note(scene, SCENE_NOTE_WARNING,
                       "node %u `%s`: its transform is not finite and is ignored", i,
                       text_token(node->name).text);
            *node = (struct scene_node){.name = node->name,
                                        .parent = node->parent,
                                        .matrix = affine_identity(),
                                        .rotation = {0, 0, 0, 1},
                                        .scale = {1, 1, 1}};
        }
    }
    return WHIT_OK;
}

static whit_result check_channels(struct scene *scene)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->channel_count; ++i) {
        struct scene_channel *channel = &scene->channels[i];
        if (scene_can_play(scene, channel)) {
            scene->channels[kept++] = *channel;
            continue;
        }
        free(channel->times_s);
        free(channel->values);
    }
    if (kept < scene->channel_count)
        scene_note(scene, SCENE_NOTE_WARNING,
                   "dropped %u animation channels whose times do not increase or that are not "
                   "finite",
                   scene->channel_count - kept);
    scene->channel_count = kept;
    return WHIT_OK;
}

static bool mend(float *value, float min, float max, float otherwise)
{
    float before = *value;
    *value = !isfinite(before) ? otherwise : fminf(fmaxf(before, min), max);
    return !(*value == before);
}

static uint32_t mend_rgb(float rgb[3], float max, float otherwise)
{
    uint32_t mended = 0;
    for (int i = 0; i < 3; ++i)
        mended += mend(&rgb[i], 0.0f, max, otherwise);
    return mended;
}

static uint32_t mend_material(struct scene_material *m)
{
    const float huge = 1e30f;
    uint32_t count = mend_rgb(m->ambient, huge, 1.0f) + mend_rgb(m->diffuse, huge, 0.7f) +
                     mend_rgb(m->specular, huge, 0.0f) + mend_rgb(m->emission, LIGHT_MAX, 0.0f) +
                     mend_rgb(m->reflection, huge, 0.0f) + mend_rgb(m->transmission, huge, 0.0f) +
                     mend_rgb(m->absorption, huge, 0.0f);
    count += mend(&m->shininess, 0.0f, 1e6f, 32.0f);
    count += mend(&m->metallic, 0.0f, 1.0f, 0.0f);
    count += mend(&m->roughness, 0.0f, 1.0f, 1.0f);
    count += mend(&m->specular_level, 0.0f, 1.0f, 1.0f);
    count += mend(&m->opacity, 0.0f, 1.0f, 1.0f);
    count += mend(&m->alpha_cutoff, 0.0f, huge, 0.5f);
    count += mend(&m->normal_scale, -1e6f, 1e6f, 1.0f);
    if (!isfinite(m->ior) || m->ior <= 0.0f || m->ior > 1e6f) {
        m->ior = 1.5f;
        ++count;
    }
    if (m->priority > 255) {
        m->priority = 255;
        ++count;
    }
    return count;
}

static bool transform_is_finite(const struct scene_texture_use *use)
{
    for (int i = 0; i < 6; ++i) {
        if (!isfinite(use->transform[i]) || fabsf(use->transform[i]) > 1e9f)
            return false;
    }
    return true;
}

static whit_result check_materials(struct scene *scene)
{
    if (!scene->material_count) {
        struct scene_material material;
        scene_material_init(&material, "default");
        if (scene_add_material(scene, material) == SCENE_NONE)
            return WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        struct scene_material *material = &scene->materials[i];
        uint32_t count = mend_material(material);
        for (int slot = 0; slot < SCENE_SLOT_COUNT; ++slot) {
            struct scene_texture_use *use = &material->textures[slot];
            if (use->texture != SCENE_NONE && use->texture >= scene->texture_count)
                return refuse(scene, "material", i, "it uses a texture that is not there");
            if (!transform_is_finite(use)) {
                memcpy(use->transform, (float[]){1, 0, 0, 0, 1, 0}, sizeof use->transform);
                ++count;
            }
            use->uv_set = use->uv_set ? 1 : 0;
        }
        if (count)
            scene_note(scene, SCENE_NOTE_WARNING,
                       "material `%s`: %u values not finite or out of range were mended",
                       text_token(material->name).text, count);
    }
    return WHIT_OK;
}

static whit_result check_textures(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->texture_count; ++i) {
        const struct scene_texture *texture = &scene->textures[i];
        if (!texture->width || !texture->height || !texture->rgba)
            return refuse(scene, "texture", i, "it has no pixels");
    }
    return WHIT_OK;
}

static whit_result check_mesh(struct scene *scene, uint32_t index)
{
    struct scene_mesh *mesh = &scene->meshes[index];
    if ((mesh->vertex_count && !mesh->positions) || (mesh->triangle_count && !mesh->indices))
        return refuse(scene, "mesh", index, "it has no positions or no indices");
    if (mesh->sphere_count &&
        (!mesh->spheres || mesh->triangle_count || mesh->vertex_count || mesh->group_count))
        return refuse(scene, "mesh", index, "it has spheres and triangles, or none of its spheres");
    uint32_t primitives = scene_mesh_primitives(mesh);
    if (primitives && !mesh->materials) {
        mesh->materials = array_alloc_zeroed(primitives, sizeof *mesh->materials);
        if (!mesh->materials)
            return WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < primitives; ++i) {
        if (mesh->materials[i] >= scene->material_count)
            return refuse(scene, "mesh", index, "a triangle's material is not there");
    }
    for (uint32_t i = 0; i < mesh->group_count; ++i) {
        const struct scene_group *group = &mesh->groups[i];
        if (group->first_triangle > mesh->triangle_count ||
            group->triangle_count > mesh->triangle_count - group->first_triangle)
            return refuse(scene, "mesh", index, "a group reaches past its triangles");
    }
    return freeze_clean_mesh(scene, index);
}

static whit_result check_meshes(struct scene *scene)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < scene->mesh_count; ++i)
        result = check_mesh(scene, i);
    return result;
}

/* World matrices by what stands still, to find instances that cannot be placed at any time: what
   channels move is left out, scene_pose_init checks it at its time. */
static struct affine *still_nodes(const struct scene *scene)
{
    struct affine *still = array_alloc(scene->node_count, sizeof *still);
    uint8_t *moved = array_alloc_zeroed(scene->node_count, sizeof *moved); /* bits of scene_path */
    for (uint32_t i = 0; moved && i < scene->channel_count; ++i)
        moved[scene->channels[i].node] |= (uint8_t)(1u << scene->channels[i].path);
    for (uint32_t i = 0; still && moved && i < scene->node_count; ++i) {
        const struct scene_node *node = &scene->nodes[i];
        bool scaled = moved[i] >> SCENE_PATH_SCALE & 1;
        bool shifted = moved[i] >> SCENE_PATH_TRANSLATION & 1;
        still[i] = node->has_matrix && !moved[i]
                       ? node->matrix
                       : affine_from_trs(shifted ? (const double[3]){0, 0, 0} : node->translation,
                                         node->rotation,
                                         scaled ? (const double[3]){1, 1, 1} : node->scale);
        if (node->parent != SCENE_NONE)
            still[i] = affine_multiply(&still[node->parent], &still[i]);
    }
    if (!moved) {
        free(still);
        still = NULL;
    }
    free(moved);
    return still;
}

static bool keep_instance(struct scene *scene, uint32_t index, const struct affine *still,
                          uint32_t *empty)
{
    const struct scene_instance *instance = &scene->instances[index];
    if (!scene_mesh_primitives(&scene->meshes[instance->mesh])) {
        ++*empty;
        return false;
    }
    struct affine matrix = instance->has_local ? instance->local : affine_identity();
    if (instance->node != SCENE_NONE)
        matrix = affine_multiply(&still[instance->node], &matrix);
    if (scene_can_place(&matrix))
        return true;
    scene_note(scene, SCENE_NOTE_WARNING, "instance %u `%s` dropped: its transform has no inverse",
               index, text_token(instance->name).text);
    return false;
}

static whit_result check_instances(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_instance *instance = &scene->instances[i];
        if (instance->mesh >= scene->mesh_count)
            return refuse(scene, "instance", i, "its mesh is not there");
        if (instance->node != SCENE_NONE && instance->node >= scene->node_count)
            return refuse(scene, "instance", i, "its node is not there");
    }
    struct affine *still = still_nodes(scene);
    if (!still)
        return WHIT_ERROR_MEMORY;
    uint32_t kept = 0, empty = 0;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        if (keep_instance(scene, i, still, &empty))
            scene->instances[kept++] = scene->instances[i];
        else
            free(scene->instances[i].name);
    }
    scene->instance_count = kept;
    free(still);
    if (empty)
        scene_note(scene, SCENE_NOTE_WARNING, "dropped %u instances of meshes without triangles",
                   empty);
    return WHIT_OK;
}

/* Drops meshes without an instance: their trees would be built and uploaded for nothing. */
static whit_result drop_unused_meshes(struct scene *scene)
{
    uint32_t *moved_to = array_alloc(scene->mesh_count, sizeof *moved_to);
    if (!moved_to)
        return WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        moved_to[i] = SCENE_NONE;
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        moved_to[scene->instances[i].mesh] = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        if (moved_to[i] == SCENE_NONE) {
            scene_mesh_finish(&scene->meshes[i]);
            continue;
        }
        moved_to[i] = kept;
        scene->meshes[kept++] = scene->meshes[i];
    }
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        scene->instances[i].mesh = moved_to[scene->instances[i].mesh];
    if (kept < scene->mesh_count)
        scene_note(scene, SCENE_NOTE_INFO, "dropped %u meshes that nothing places",
                   scene->mesh_count - kept);
    scene->mesh_count = kept;
    free(moved_to);
    return WHIT_OK;
}

/* Whether the material has a texture whose texels a mesh with these coordinates cannot tell
   apart. */
static bool shows_one_texel(const struct scene *scene, const struct scene_mesh *mesh,
                            const struct scene_material *material)
{
    for (int slot = 0; slot < SCENE_SLOT_COUNT; ++slot) {
        const struct scene_texture_use *use = &material->textures[slot];
        if (use->texture == SCENE_NONE || mesh->uvs[0] || mesh->uvs[use->uv_set])
            continue;
        const struct scene_texture *texture = &scene->textures[use->texture];
        if (texture->width > 1 || texture->height > 1)
            return true;
    }
    return false;
}

static whit_result check_uvs(struct scene *scene)
{
    const struct scene_mesh *first = NULL;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[i];
        const uint32_t *materials = mesh->materials;
        bool lacks = false;
        for (uint32_t t = 0; !lacks && t < mesh->triangle_count; ++t)
            lacks = (!t || materials[t] != materials[t - 1]) &&
                    shows_one_texel(scene, mesh, &scene->materials[materials[t]]);
        count += lacks;
        first = lacks && !first ? mesh : first;
    }
    if (first)
        scene_note(scene, SCENE_NOTE_WARNING,
                   "mesh `%s` has textures and no texture coordinates: they show one texel (meshes "
                   "of this kind: %u)",
                   text_token(first->name).text, count);
    return WHIT_OK;
}

static bool usable_light(const struct scene_light *light)
{
    bool finite = true;
    for (int i = 0; i < 3; ++i)
        finite = finite && isfinite(light->position[i]) && isfinite(light->direction[i]) &&
                 isfinite(light->color[i]);
    double area = double3_length(light->direction);
    return finite && (!scene_light_is_flat(light) || (area > 0.0 && isfinite(area)));
}

/* Brings the light's values into their ranges; gives how many values of its colour had to
   change. */
static uint32_t mend_light(struct scene_light *light)
{
    uint32_t count = 0;
    double *d = light->direction;
    double length = double3_length(d);
    for (int i = 0; i < 3; ++i) {
        d[i] = length > 0.0 && isfinite(length) ? d[i] / length : -(double)(i == 1);
        count += mend(&light->color[i], 0.0f, LIGHT_MAX, 0.0f);
    }
    if (!(light->range > 0.0f) || !isfinite(light->range))
        light->range = 0.0f;
    mend(&light->versine_outer, 0.0f, 2.0f, 0.29289322f);
    mend(&light->versine_inner, 0.0f, light->versine_outer, 0.0f);
    return count;
}

static whit_result check_lights(struct scene *scene)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        struct scene_light *light = &scene->lights[i];
        if (light->node != SCENE_NONE && light->node >= scene->node_count)
            return refuse(scene, "light", i, "its node is not there");
    }
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        struct scene_light *light = &scene->lights[i];
        if (scene_light_is_flat(light)) /* mend_light makes it unit */
            double3_cross(light->edge_u, light->edge_v, light->direction);
        if (usable_light(light)) {
            uint32_t count = mend_light(light);
            if (count)
                scene_note(scene, SCENE_NOTE_WARNING,
                           "light %u `%s`: %u values of its colour out of range were mended", i,
                           text_token(light->name).text, count);
            scene->lights[kept++] = *light;
            continue;
        }
        scene_note(scene, SCENE_NOTE_WARNING,
                   "light %u `%s` dropped: its values are not finite, or it has no area", i,
                   text_token(light->name).text);
        free(light->name);
        free(light->origin.file);
    }
    scene->light_count = kept;
    return WHIT_OK;
}

static bool usable_camera(const struct scene_camera *camera)
{
    double distance = double3_distance(camera->target, camera->eye);
    for (int i = 0; i < 3; ++i) {
        if (!isfinite(camera->up[i]))
            return false;
    }
    if (camera->kind == WHIT_CAMERA_ORTHOGRAPHIC &&
        !(camera->height > 0.0f && isfinite(camera->height)))
        return false;
    return isfinite(distance) && distance > 0.0;
}

/* Brings a camera's values into their ranges. An `up` parallel to the view is replaced by the y
   axis, or by z where the view is close to y. */
static void mend_camera(struct scene_camera *camera)
{
    double view[3], across[3];
    double3_sub(camera->target, camera->eye, view);
    double3_cross(view, camera->up, across);
    double length2 = double3_dot(view, view), up2 = double3_dot(camera->up, camera->up);
    if (!(double3_dot(across, across) > 1e-16 * length2 * up2)) {
        int axis = fabs(view[1]) < 0.9 * sqrt(length2) ? 1 : 2;
        for (int i = 0; i < 3; ++i)
            camera->up[i] = i == axis ? 1.0 : 0.0;
    }
    if (!(camera->fov_y > 0.0f && camera->fov_y < 3.1415f))
        camera->fov_y = 0.6981317f;
    if (camera->kind != WHIT_CAMERA_PERSPECTIVE ||
        !(camera->lens_radius > 0.0f && isfinite(camera->lens_radius)))
        camera->lens_radius = 0.0f;
    if (!(camera->focus_distance > 0.0f && isfinite(camera->focus_distance)))
        camera->focus_distance = 0.0f;
    if (!(camera->aspect > 0.0f && isfinite(camera->aspect)))
        camera->aspect = 0.0f;
}

static whit_result check_cameras(struct scene *scene)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->camera_count; ++i) {
        if (scene->cameras[i].node != SCENE_NONE && scene->cameras[i].node >= scene->node_count)
            return refuse(scene, "camera", i, "its node is not there");
    }
    for (uint32_t i = 0; i < scene->camera_count; ++i) {
        struct scene_camera *camera = &scene->cameras[i];
        if (usable_camera(camera)) {
            mend_camera(camera);
            scene->cameras[kept++] = *camera;
            continue;
        }
        scene_note(scene, SCENE_NOTE_WARNING, "camera %u `%s` dropped: it looks nowhere", i,
                   text_token(camera->name).text);
        free(camera->name);
    }
    scene->camera_count = kept;
    return WHIT_OK;
}

static whit_result check_environment(struct scene *scene)
{
    struct scene_environment *sky = &scene->environment;
    const float huge = 1e30f;
    uint32_t count = mend_rgb(sky->zenith, huge, 0.0f) + mend_rgb(sky->horizon, huge, 0.0f) +
                     mend_rgb(sky->ground, huge, 0.0f) + mend_rgb(sky->scale, huge, 1.0f) +
                     mend_rgb(scene->ambient, huge, 0.0f);
    if (sky->kind == WHIT_ENVIRONMENT_MAP && (!sky->rgb || !sky->width || !sky->height))
        sky->kind = WHIT_ENVIRONMENT_GRADIENT;
    if (!(scene->contact >= 0.0f && isfinite(scene->contact)))
        scene->contact = 0.0f;
    size_t floats = sky->rgb ? (size_t)sky->width * sky->height * 3 : 0;
    sky->rgb_max = 0.0f;
    for (size_t i = 0; i < floats; ++i) {
        count += mend(&sky->rgb[i], 0.0f, huge, 0.0f);
        sky->rgb_max = fmaxf(sky->rgb_max, sky->rgb[i]);
    }
    if (count)
        scene_note(scene, SCENE_NOTE_WARNING,
                   "environment: %u values not finite or negative were mended", count);
    return WHIT_OK;
}

/* In this order: each relies on those before it. */
static whit_result (*const checks[])(struct scene *scene) = {
    check_nodes,  check_channels,  check_textures,     check_materials,
    check_meshes, check_instances, drop_unused_meshes, check_uvs,
    check_lights, check_cameras,   check_environment,
};

/* Logs the lack of memory once, whichever step ran out of it; passes `result` on. */
static whit_result no_memory(const struct scene *scene, whit_result result)
{
    if (result == WHIT_ERROR_MEMORY)
        log_error(&scene->log, "%s: out of memory for the scene", scene->name);
    return result;
}

whit_result scene_freeze(struct scene *scene)
{
    if (scene->frozen)
        return WHIT_OK;
    whit_result result = WHIT_OK;
    for (size_t i = 0; result == WHIT_OK && i < sizeof checks / sizeof *checks; ++i)
        result = checks[i](scene);
    return result == WHIT_OK ? freeze_complete(scene) : no_memory(scene, result);
}

static void find_times(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->channel_count; ++i) {
        const struct scene_channel *channel = &scene->channels[i];
        float begin_s = channel->times_s[0], end_s = channel->times_s[channel->key_count - 1];
        scene->time_begin_s = i ? fminf(scene->time_begin_s, begin_s) : begin_s;
        scene->time_end_s = i ? fmaxf(scene->time_end_s, end_s) : end_s;
    }
}

whit_result freeze_complete(struct scene *scene)
{
    find_times(scene);
    for (uint32_t i = 0; i < scene->light_count; ++i)
        memcpy(scene->lights[i].stated, scene->lights[i].color, sizeof scene->lights[i].stated);
    whit_result result = freeze_add_defaults(scene);
    if (result == WHIT_OK)
        result = freeze_choose_exposure(scene);
    if (result != WHIT_OK)
        return no_memory(scene, result);
    scene->triangle_total = scene->sphere_total = 0;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        scene->triangle_total += scene->meshes[scene->instances[i].mesh].triangle_count;
        scene->sphere_total += scene->meshes[scene->instances[i].mesh].sphere_count;
    }
    if (!scene->triangle_total && !scene->sphere_total)
        scene_note(scene, SCENE_NOTE_WARNING,
                   "nothing to draw: no triangle is left, the picture shows the background");
    if (scene->lacks_memory)
        return no_memory(scene, WHIT_ERROR_MEMORY);
    scene->hash = freeze_hash(scene);
    scene->frozen = true;
    return WHIT_OK;
}
