#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/gltf_accessor.h"
#include "load/gltf_json.h"

struct target {
    uint32_t node; /* file's index, or SCENE_NONE */
    enum scene_path path;
    uint32_t components; /* per value; 0: whit does not play this path, as morph weights */
};

static bool read_target(const struct gltf *gltf, const json_t *channel, const struct gltf_place *at,
                        struct target *out)
{
    json_t *target;
    const char *path;
    if (!gltf_object(gltf, channel, at, "target", &target) ||
        !gltf_index(gltf, target, at, "node", gltf->node_count, &out->node) ||
        !gltf_string(gltf, target, at, "path", &path))
        return false;
    out->components = 0;
    if (path && strcmp(path, "rotation") == 0) {
        out->path = SCENE_PATH_ROTATION;
        out->components = 4;
    } else if (path && (strcmp(path, "translation") == 0 || strcmp(path, "scale") == 0)) {
        out->path = path[0] == 't' ? SCENE_PATH_TRANSLATION : SCENE_PATH_SCALE;
        out->components = 3;
    }
    return true;
}

/* *known: whether there is an interpolation of that name. */
static bool read_interpolation(const struct gltf *gltf, const json_t *sampler,
                               const struct gltf_place *at, enum scene_interpolation *out,
                               bool *known)
{
    const char *name;
    if (!gltf_string(gltf, sampler, at, "interpolation", &name))
        return false;
    *out = !name || strcmp(name, "LINEAR") == 0 ? SCENE_LINEAR
           : strcmp(name, "STEP") == 0          ? SCENE_STEP
                                                : SCENE_CUBIC;
    *known = *out != SCENE_CUBIC || strcmp(name, "CUBICSPLINE") == 0;
    return true;
}

/* Reads the sampler's times and values into *out, which owns them, also on failure. scene_freeze
   checks the times. *usable: the channel can be played as far as it is not about them. */
static bool read_sampler(const struct gltf *gltf, const json_t *sampler,
                         const struct gltf_place *at, uint32_t components,
                         struct scene_channel *out, bool *usable)
{
    uint32_t accessors = gltf_count(gltf, "accessors"), input, output, values;
    if (!read_interpolation(gltf, sampler, at, &out->interpolation, usable) ||
        !gltf_index(gltf, sampler, at, "input", accessors, &input) ||
        !gltf_index(gltf, sampler, at, "output", accessors, &output))
        return false;
    if (input == SCENE_NONE || output == SCENE_NONE)
        return gltf_fail(gltf, at, "has no input or no output");
    if (!gltf_read_floats(gltf, input, 1, &out->times_s, &out->key_count) ||
        !gltf_read_floats(gltf, output, components, &out->values, &values))
        return false;
    *usable &= values == (uint64_t)out->key_count * (out->interpolation == SCENE_CUBIC ? 3 : 1);
    return true;
}

struct played {
    uint8_t *paths; /* of each node of the file: bits of enum scene_path */
    uint32_t doubled, unplayable, unusable;
};

static whit_result add_channel(struct gltf *gltf, const json_t *object, const json_t *samplers,
                               const struct gltf_place *at, struct played *played)
{
    struct target target = {.node = SCENE_NONE};
    uint32_t index;
    if (!json_is_object(object)) {
        gltf_fail(gltf, at, "should be an object");
        return WHIT_ERROR_INPUT;
    }
    if (!read_target(gltf, object, at, &target) ||
        !gltf_index(gltf, object, at, "sampler", (uint32_t)json_array_size(samplers), &index))
        return WHIT_ERROR_INPUT;
    played->unplayable += target.components == 0;
    if (target.components == 0 || target.node == SCENE_NONE || index == SCENE_NONE ||
        gltf->nodes[target.node] == SCENE_NONE)
        return WHIT_OK;
    struct scene_channel channel = {.node = gltf->nodes[target.node], .path = target.path};
    uint8_t bit = (uint8_t)(1u << target.path);
    bool doubled = played->paths[target.node] & bit;
    bool fixed = gltf->scene->nodes[channel.node].has_matrix;
    played->paths[target.node] |= bit;
    played->doubled += doubled;
    played->unplayable += fixed;
    if (doubled || fixed)
        return WHIT_OK;
    bool usable = false;
    bool read = read_sampler(gltf, json_array_get(samplers, index), at, target.components, &channel,
                             &usable);
    played->unusable += read && !usable;
    if (!read || !usable) {
        free(channel.times_s);
        free(channel.values);
        return read ? WHIT_OK : WHIT_ERROR_INPUT;
    }
    return scene_add_channel(gltf->scene, channel) == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

static whit_result add_animation(struct gltf *gltf, uint32_t index, struct played *played)
{
    struct gltf_place at;
    json_t *animation, *channels, *samplers, *channel;
    size_t i;
    if (!gltf_item(gltf, "animations", index, &at, &animation) ||
        !gltf_array(gltf, animation, &at, "channels", &channels) ||
        !gltf_array(gltf, animation, &at, "samplers", &samplers))
        return WHIT_ERROR_INPUT;
    json_array_foreach(channels, i, channel)
    {
        struct gltf_place place = gltf_place("%.60s.channels[%zu]", at.text, i);
        whit_result result = add_channel(gltf, channel, samplers, &place, played);
        if (result != WHIT_OK)
            return result;
    }
    return WHIT_OK;
}

static void note_unplayed(const struct gltf *gltf, const struct played *played)
{
    const char *name = path_name(gltf->request->path);
    if (played->unplayable)
        scene_note(gltf->scene, SCENE_NOTE_WARNING,
                   "%s: %u animation channels are not played (only translation, rotation and scale "
                   "of nodes without a matrix are)",
                   name, played->unplayable);
    if (played->doubled)
        scene_note(gltf->scene, SCENE_NOTE_WARNING,
                   "%s: %u animation channels move what an earlier one moves, they are not played",
                   name, played->doubled);
    if (played->unusable)
        scene_note(gltf->scene, SCENE_NOTE_WARNING,
                   "%s: %u animation channels are not played: their interpolation is unknown, or "
                   "their values are not as many as their times need",
                   name, played->unusable);
}

whit_result gltf_add_animations(struct gltf *gltf)
{
    struct played played = {.paths = array_alloc_zeroed(gltf->node_count, 1)};
    whit_result result = played.paths ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; result == WHIT_OK && i < gltf_count(gltf, "animations"); i++)
        result = add_animation(gltf, i, &played);
    if (result == WHIT_OK)
        note_unplayed(gltf, &played);
    free(played.paths);
    return result;
}
