#include "scene/mix.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "scene/freeze.h"

struct mix {
    struct scene_side before, after;
    const struct scene_side *frame; /* the side that gives `out` its objects and lists of parts */
    const bool *back;               /* by the parts of `before`: take it from `before` */
    struct scene *out;
    struct key_table added[SCENE_NAMES]; /* name to index in `out`, for records not in `frame` */
    bool failed;                         /* memory ran out */
};

/* The side from which the part of this kind and name is taken. */
static const struct scene_side *side_of(const struct mix *mix, whit_part_kind kind,
                                        const char *name)
{
    const struct scene_part *old = scene_parts_find(mix->before.parts, kind, name);
    if (!old)
        return &mix->after;
    bool back = mix->back[old - mix->before.parts->items];
    return back || !scene_parts_find(mix->after.parts, kind, name) ? &mix->before : &mix->after;
}

static void *copy_of(struct mix *mix, const void *data, size_t count, size_t bytes)
{
    void *copy = array_copy(data, count, bytes);
    mix->failed |= data && !copy;
    return copy;
}

/* ---- Records that others refer to: each function gives the new index ---- */

static uint32_t place_of(struct mix *mix, const struct scene_side *side, unsigned kind,
                         uint32_t index);

static uint32_t add_node(struct mix *mix, const struct scene_side *side, uint32_t index)
{
    struct scene_node node = side->scene->nodes[index];
    node.parent = place_of(mix, side, SCENE_NAMES_NODE, node.parent);
    node.name = scene_text(mix->out, node.name);
    return scene_add_node(mix->out, node);
}

static uint32_t add_texture(struct mix *mix, const struct scene_side *side, uint32_t index)
{
    struct scene_texture texture = side->scene->textures[index];
    texture.name = scene_text(mix->out, texture.name);
    texture.mapped_bytes = 0;
    texture.rgba =
        copy_of(mix, texture.rgba, (size_t)texture.width * texture.height, 4 * sizeof(uint8_t));
    return scene_add_texture(mix->out, texture);
}

static uint32_t add_material(struct mix *mix, const struct scene_side *side, uint32_t index)
{
    struct scene_material material = side->scene->materials[index];
    for (int i = 0; i < SCENE_SLOT_COUNT; ++i)
        material.textures[i].texture =
            place_of(mix, side, WHIT_PART_TEXTURE, material.textures[i].texture);
    material.name = scene_text(mix->out, material.name);
    material.origin.file = scene_text(mix->out, material.origin.file);
    return scene_add_material(mix->out, material);
}

/* Translates an index of `side` to one of the new scene; a record whose name the new scene lacks is
   added. */
static uint32_t place_of(struct mix *mix, const struct scene_side *side, unsigned kind,
                         uint32_t index)
{
    if (index == SCENE_NONE || side == mix->frame)
        return index;
    const char *name = scene_parts_name(side->parts, kind, index);
    uint32_t place = scene_parts_index(mix->frame->parts, kind, name);
    if (place != SCENE_NONE || key_table_find(&mix->added[kind], name, strlen(name), &place))
        return place;
    place = kind == WHIT_PART_TEXTURE    ? add_texture(mix, side, index)
            : kind == WHIT_PART_MATERIAL ? add_material(mix, side, index)
                                         : add_node(mix, side, index);
    mix->failed |=
        place == SCENE_NONE || !key_table_add(&mix->added[kind], name, strlen(name), place);
    return place;
}

/* ---- Parts, in the order of the lists of `frame` ---- */

static bool add_mesh(struct mix *mix, const struct scene_side *side, uint32_t index)
{
    struct scene_mesh mesh;
    uint32_t last = SCENE_NONE, place = SCENE_NONE;
    if (!scene_mesh_copy(&side->scene->meshes[index], &mesh))
        return false;
    for (uint32_t i = 0; i < scene_mesh_primitives(&mesh); ++i) {
        if (mesh.materials[i] != last)
            place = place_of(mix, side, WHIT_PART_MATERIAL, last = mesh.materials[i]);
        mesh.materials[i] = place;
    }
    return scene_add_mesh(mix->out, mesh) != SCENE_NONE;
}

static bool add_light(struct mix *mix, const struct scene_side *side, uint32_t index)
{
    struct scene_light light = side->scene->lights[index];
    memcpy(light.color, light.stated, sizeof light.color);
    light.name = scene_text(mix->out, light.name);
    light.origin.file = scene_text(mix->out, light.origin.file);
    light.node = place_of(mix, side, SCENE_NAMES_NODE, light.node);
    return scene_add_light(mix->out, light) != SCENE_NONE;
}

static bool add_camera(struct mix *mix, const struct scene_side *side, uint32_t index)
{
    struct scene_camera camera = side->scene->cameras[index];
    camera.name = scene_text(mix->out, camera.name);
    camera.node = place_of(mix, side, SCENE_NAMES_NODE, camera.node);
    return scene_add_camera(mix->out, camera) != SCENE_NONE;
}

static bool add_channel(struct mix *mix, const struct scene_side *side, uint32_t index)
{
    struct scene_channel channel = side->scene->channels[index];
    size_t values = (size_t)channel.key_count * scene_channel_width(&channel);
    channel.node = place_of(mix, side, SCENE_NAMES_NODE, channel.node);
    channel.times_s = copy_of(mix, channel.times_s, channel.key_count, sizeof(float));
    channel.values = copy_of(mix, channel.values, values, sizeof(float));
    return scene_add_channel(mix->out, channel) != SCENE_NONE;
}

static bool add_part(struct mix *mix, whit_part_kind kind, const char *name)
{
    const struct scene_side *side = side_of(mix, kind, name);
    uint32_t index = scene_parts_find(side->parts, kind, name)->index;
    switch (kind) {
    case WHIT_PART_MESH:
        return add_mesh(mix, side, index);
    case WHIT_PART_MATERIAL:
        return add_material(mix, side, index) != SCENE_NONE;
    case WHIT_PART_TEXTURE:
        return add_texture(mix, side, index) != SCENE_NONE;
    case WHIT_PART_LIGHT:
        return add_light(mix, side, index);
    case WHIT_PART_CAMERA:
        return add_camera(mix, side, index);
    default:
        return add_channel(mix, side, index);
    }
}

static bool add_parts(struct mix *mix)
{
    /* Kinds that others refer to come first: records that those add then follow behind all of
       `frame`, whose indices stay. */
    static const whit_part_kind order[] = {WHIT_PART_TEXTURE, WHIT_PART_MATERIAL,
                                           WHIT_PART_MESH,    WHIT_PART_LIGHT,
                                           WHIT_PART_CAMERA,  WHIT_PART_ANIMATION};
    const struct scene_parts *parts = mix->frame->parts;
    bool good = true;
    for (size_t k = 0; good && k < sizeof order / sizeof *order; ++k) {
        for (uint32_t i = parts->first[order[k]]; good && parts->items[i].kind == order[k]; ++i)
            good = add_part(mix, order[k], parts->items[i].name);
    }
    return good;
}

/* ---- The rest ---- */

static bool add_objects(struct mix *mix)
{
    const struct scene *from = mix->frame->scene;
    bool good = true;
    for (uint32_t i = 0; good && i < from->node_count; ++i)
        good = add_node(mix, mix->frame, i) != SCENE_NONE;
    for (uint32_t i = 0; good && i < from->instance_count; ++i) {
        struct scene_instance instance = from->instances[i];
        instance.name = scene_text(mix->out, instance.name);
        good = scene_add_instance(mix->out, instance) != SCENE_NONE;
    }
    mix->out->is_model = from->is_model;
    mix->out->lights_wanted = from->lights_wanted;
    mix->out->file_bytes = from->file_bytes;
    mix->out->memory_limit = from->memory_limit;
    mix->out->memory_taken = from->memory_taken;
    return good;
}

static void add_environment(struct mix *mix)
{
    const struct scene *from = side_of(mix, WHIT_PART_ENVIRONMENT, "")->scene;
    struct scene *out = mix->out;
    struct scene_environment *sky = &out->environment;
    out->has_environment = from->has_environment;
    out->has_ambient = from->has_ambient;
    out->contact = from->contact;
    if (from->has_ambient)
        memcpy(out->ambient, from->ambient, sizeof out->ambient);
    if (!from->has_environment)
        return;
    *sky = from->environment;
    sky->name = scene_text(out, sky->name);
    sky->rgb = copy_of(mix, sky->rgb, (size_t)sky->width * sky->height, 3 * sizeof *sky->rgb);
}

whit_result scene_mix_begin(const whit_log *log, const struct scene_side *before,
                            const struct scene_side *after, const bool *back, struct scene **out)
{
    struct mix mix = {.before = *before, .after = *after, .back = back};
    mix.frame = side_of(&mix, WHIT_PART_OBJECTS, "");
    mix.out = *out = scene_create(log, after->scene->name);
    if (!mix.out)
        return WHIT_ERROR_MEMORY;
    bool good = add_objects(&mix) && add_parts(&mix);
    add_environment(&mix);
    for (unsigned kind = 0; kind < SCENE_NAMES; ++kind)
        key_table_finish(&mix.added[kind]);
    return good && !mix.failed && !mix.out->lacks_memory ? WHIT_OK : WHIT_ERROR_MEMORY;
}

whit_result scene_mix_end(whit_result result, struct scene **out)
{
    if (result == WHIT_OK)
        result = freeze_complete(*out);
    if (result != WHIT_OK) {
        scene_destroy(*out);
        *out = NULL;
    }
    return result;
}

whit_result scene_mix(const whit_log *log, const struct scene_side *before,
                      const struct scene_side *after, const bool *back, struct scene **out)
{
    return scene_mix_end(scene_mix_begin(log, before, after, back, out), out);
}
