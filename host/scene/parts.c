#include "scene/parts.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/path.h"
#include "scene/hash.h"

/* ---- Names ---- */

const char *scene_part_kind_name(whit_part_kind kind)
{
    static const char *const names[WHIT_PART_KINDS] = {
        [WHIT_PART_MESH] = "mesh",
        [WHIT_PART_MATERIAL] = "material",
        [WHIT_PART_TEXTURE] = "texture",
        [WHIT_PART_LIGHT] = "light",
        [WHIT_PART_CAMERA] = "camera",
        [WHIT_PART_ANIMATION] = "animation",
        [WHIT_PART_ENVIRONMENT] = "environment",
        [WHIT_PART_OBJECTS] = "objects",
    };
    return kind < WHIT_PART_KINDS ? names[kind] : "";
}

static uint32_t count_of(const struct scene *scene, unsigned kind)
{
    const uint32_t counts[SCENE_NAMES] = {
        [WHIT_PART_MESH] = scene->mesh_count,       [WHIT_PART_MATERIAL] = scene->material_count,
        [WHIT_PART_TEXTURE] = scene->texture_count, [WHIT_PART_LIGHT] = scene->light_count,
        [WHIT_PART_CAMERA] = scene->camera_count,   [WHIT_PART_ANIMATION] = scene->channel_count,
        [SCENE_NAMES_NODE] = scene->node_count,
    };
    return counts[kind];
}

static const char *own_name(const struct scene *scene, unsigned kind, uint32_t index)
{
    switch (kind) {
    case WHIT_PART_MESH:
        return scene->meshes[index].name;
    case WHIT_PART_MATERIAL:
        return scene->materials[index].name;
    case WHIT_PART_TEXTURE:
        return scene->textures[index].name ? path_name(scene->textures[index].name) : NULL;
    case WHIT_PART_LIGHT:
        return scene->lights[index].name;
    case WHIT_PART_CAMERA:
        return scene->cameras[index].name;
    case SCENE_NAMES_NODE:
        return scene->nodes[index].name;
    default:
        return NULL;
    }
}

/* Gives the name of an animation channel: the node's name, and which part of its transform is
   animated. */
static char *channel_name(const struct scene *scene, const struct scene_names *nodes,
                          uint32_t index)
{
    static const char *const paths[] = {
        [SCENE_PATH_TRANSLATION] = "translation",
        [SCENE_PATH_ROTATION] = "rotation",
        [SCENE_PATH_SCALE] = "scale",
    };
    const struct scene_channel *channel = &scene->channels[index];
    return string_format("%s %s", nodes->names[channel->node], paths[channel->path]);
}

/* Adds the name `own`, made unique by a number where it is empty or taken. numbers[i]: how many
   numbers behind the name of record i were tried, which are not tried again. */
static bool add_name(struct scene_names *names, uint32_t *numbers, const char *own)
{
    uint32_t index = names->count, first = SCENE_NONE, taken;
    char *name = own[0] ? string_copy(own) : string_format("#%u", index);
    while (name && key_table_find(&names->table, name, strlen(name), &taken)) {
        first = first == SCENE_NONE ? taken : first;
        free(name);
        name = string_format("%s#%u", own, 2 + numbers[first]++);
    }
    names->names[index] = name;
    names->count += name != NULL;
    return name && key_table_add(&names->table, name, strlen(name), index);
}

/* For each mesh the name of the first instance that has one: a mesh of a scene file is itself named
   after its shape, which many share. NULL: no memory. */
static const char **object_names(const struct scene *scene)
{
    const char **names = array_alloc_zeroed(scene->mesh_count, sizeof *names);
    for (uint32_t i = 0; names && i < scene->instance_count; ++i) {
        const struct scene_instance *instance = &scene->instances[i];
        if (!names[instance->mesh] && instance->name && instance->name[0])
            names[instance->mesh] = instance->name;
    }
    return names;
}

static bool add_names(const struct scene *scene, unsigned kind, struct scene_parts *parts)
{
    struct scene_names *names = &parts->names[kind];
    uint32_t count = count_of(scene, kind);
    const char **objects = kind == WHIT_PART_MESH ? object_names(scene) : NULL;
    uint32_t *numbers = array_alloc_zeroed(count, sizeof *numbers);
    names->names = array_alloc_zeroed(count, sizeof *names->names);
    bool good = names->names && numbers && (objects || kind != WHIT_PART_MESH);
    for (uint32_t i = 0; good && i < count; ++i) {
        const char *own = objects && objects[i] ? objects[i] : own_name(scene, kind, i);
        char *made = kind == WHIT_PART_ANIMATION
                         ? channel_name(scene, &parts->names[SCENE_NAMES_NODE], i)
                         : NULL;
        own = made ? made : own ? own : "";
        good = (made || kind != WHIT_PART_ANIMATION) && add_name(names, numbers, own);
        free(made);
    }
    free(objects);
    free(numbers);
    return good;
}

const char *scene_parts_name(const struct scene_parts *parts, unsigned kind, uint32_t index)
{
    return index == SCENE_NONE ? "" : parts->names[kind].names[index];
}

uint32_t scene_parts_index(const struct scene_parts *parts, unsigned kind, const char *name)
{
    uint32_t index;
    return key_table_find(&parts->names[kind].table, name, strlen(name), &index) ? index
                                                                                 : SCENE_NONE;
}

/* ---- Hashes ---- */

static uint64_t hash_name(uint64_t value, const char *name)
{
    return hash_bytes(value, name, strlen(name));
}

static uint64_t hash_mesh(const struct scene_parts *parts, const struct scene_mesh *mesh)
{
    struct scene_mesh shape = *mesh;
    uint32_t last = SCENE_NONE, primitives = scene_mesh_primitives(mesh);
    uint64_t name = 0;
    shape.materials = NULL;
    uint64_t value = freeze_hash_record(WHIT_PART_MESH, &shape);
    for (uint32_t i = 0; i < primitives; ++i) {
        if (mesh->materials[i] != last)
            name = hash_name(
                HASH_START, scene_parts_name(parts, WHIT_PART_MATERIAL, last = mesh->materials[i]));
        value = hash_bytes(value, &name, sizeof name);
    }
    return value;
}

static uint64_t hash_material(const struct scene_parts *parts, const struct scene_material *own)
{
    struct scene_material material = *own;
    uint64_t names = HASH_START;
    for (int i = 0; i < SCENE_SLOT_COUNT; ++i) {
        uint32_t *texture = &material.textures[i].texture;
        names = hash_name(names, scene_parts_name(parts, WHIT_PART_TEXTURE, *texture));
        *texture = 0;
    }
    uint64_t value = freeze_hash_record(WHIT_PART_MATERIAL, &material);
    return hash_bytes(value, &names, sizeof names);
}

/* Adds to the hash `value` of a light, camera or channel the name of the node that it belongs
   to. */
static uint64_t hash_below(const struct scene_parts *parts, uint32_t node, uint64_t value)
{
    return hash_name(value, scene_parts_name(parts, SCENE_NAMES_NODE, node));
}

static uint64_t hash_light(const struct scene_parts *parts, const struct scene_light *own)
{
    struct scene_light light = *own;
    memcpy(light.color, light.stated, sizeof light.color);
    light.node = 0;
    return hash_below(parts, own->node, freeze_hash_record(WHIT_PART_LIGHT, &light));
}

static uint64_t hash_camera(const struct scene_parts *parts, const struct scene_camera *own)
{
    struct scene_camera camera = *own;
    camera.node = 0;
    return hash_below(parts, own->node, freeze_hash_record(WHIT_PART_CAMERA, &camera));
}

static uint64_t hash_channel(const struct scene_parts *parts, const struct scene_channel *own)
{
    struct scene_channel channel = *own;
    channel.node = 0;
    return hash_below(parts, own->node, freeze_hash_record(WHIT_PART_ANIMATION, &channel));
}

/* Hashes what a file states of the environment. What whit adds follows from the other parts. */
static uint64_t hash_environment(const struct scene *scene)
{
    static const struct scene_environment none;
    static const float dark[3];
    const uint32_t flags[] = {scene->has_environment, scene->has_ambient};
    uint64_t value = freeze_hash_record(WHIT_PART_ENVIRONMENT,
                                        scene->has_environment ? &scene->environment : &none);
    value = hash_bytes(value, flags, sizeof flags);
    value = hash_bytes(value, scene->has_ambient ? scene->ambient : dark, sizeof dark);
    return hash_bytes(value, &scene->contact, sizeof scene->contact);
}

static bool made_by_whit(const struct scene *scene, unsigned kind, uint32_t index)
{
    return (kind == WHIT_PART_LIGHT && scene->lights[index].made_by_whit) ||
           (kind == WHIT_PART_CAMERA && scene->cameras[index].made_by_whit);
}

/* Hashes nodes and instances, and the names of all parts in their order. Materials and textures are
   left out: parts that refer to them hash their names. */
static uint64_t hash_objects(const struct scene *scene, const struct scene_parts *parts)
{
    const uint32_t flags[] = {scene->is_model, (uint32_t)scene->lights_wanted};
    uint64_t value = hash_bytes(freeze_hash_objects(scene), flags, sizeof flags);
    for (unsigned kind = 0; kind < SCENE_NAMES; ++kind) {
        bool listed = kind != WHIT_PART_MATERIAL && kind != WHIT_PART_TEXTURE;
        for (uint32_t i = 0; listed && i < parts->names[kind].count; ++i) {
            if (!made_by_whit(scene, kind, i))
                value = hash_name(value, parts->names[kind].names[i]);
        }
    }
    return value;
}

static uint64_t hash_of(const struct scene *scene, const struct scene_parts *parts,
                        whit_part_kind kind, uint32_t index)
{
    switch (kind) {
    case WHIT_PART_MESH:
        return hash_mesh(parts, &scene->meshes[index]);
    case WHIT_PART_MATERIAL:
        return hash_material(parts, &scene->materials[index]);
    case WHIT_PART_TEXTURE:
        return freeze_hash_record(kind, &scene->textures[index]);
    case WHIT_PART_LIGHT:
        return hash_light(parts, &scene->lights[index]);
    case WHIT_PART_CAMERA:
        return hash_camera(parts, &scene->cameras[index]);
    case WHIT_PART_ANIMATION:
        return hash_channel(parts, &scene->channels[index]);
    case WHIT_PART_ENVIRONMENT:
        return hash_environment(scene);
    case WHIT_PART_OBJECTS:
    case WHIT_PART_KINDS:
        break;
    }
    return hash_objects(scene, parts);
}

/* ---- Parts ---- */

whit_result scene_parts_init(const struct scene *scene, struct scene_parts *out)
{
    *out = (struct scene_parts){0};
    bool good = add_names(scene, SCENE_NAMES_NODE, out); /* first: channels are named by them */
    for (unsigned kind = 0; good && kind < SCENE_NAMES_NODE; ++kind)
        good = add_names(scene, kind, out);
    for (whit_part_kind kind = 0; good && kind < WHIT_PART_KINDS; ++kind) {
        bool listed = kind < WHIT_PART_ENVIRONMENT;
        uint32_t count = listed ? count_of(scene, kind) : 1;
        out->first[kind] = out->count;
        for (uint32_t i = 0; good && i < count; ++i) {
            if (made_by_whit(scene, kind, i))
                continue;
            struct scene_part part = {kind, i, listed ? out->names[kind].names[i] : "",
                                      hash_of(scene, out, kind, i)};
            good = ARRAY_PUSH(out->items, out->count, out->capacity, part);
        }
    }
    return good ? WHIT_OK : WHIT_ERROR_MEMORY;
}

void scene_parts_finish(struct scene_parts *parts)
{
    for (unsigned kind = 0; kind < SCENE_NAMES; ++kind) {
        struct scene_names *names = &parts->names[kind];
        for (uint32_t i = 0; i < names->count; ++i)
            free(names->names[i]);
        free(names->names);
        key_table_finish(&names->table);
    }
    free(parts->items);
    *parts = (struct scene_parts){0};
}

const struct scene_part *scene_parts_find(const struct scene_parts *parts, whit_part_kind kind,
                                          const char *name)
{
    uint32_t index = kind < WHIT_PART_ENVIRONMENT ? scene_parts_index(parts, kind, name) : 0;
    if (index == SCENE_NONE || index >= parts->count - parts->first[kind])
        return NULL;
    const struct scene_part *part = &parts->items[parts->first[kind] + index];
    return part->kind == kind && part->index == index ? part : NULL;
}
