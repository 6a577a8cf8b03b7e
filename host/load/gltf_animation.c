#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/gltf_accessor.h"
#include "load/gltf_json.h"
#include "scene/afford.h"

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

/* Reads the sampler's times and values into *out, which owns them, also on failure. *usable: the
   channel can be played; only then its memory is counted. */
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
    *usable = *usable &&
              values == (uint64_t)out->key_count * (out->interpolation == SCENE_CUBIC ? 3 : 1) &&
              scene_can_play(gltf->scene, out);
    return !*usable ||
           scene_afford(gltf->scene,
                        (out->key_count + (uint64_t)values * components) * sizeof(float),
                        "%s of %u keys", at->text, out->key_count);
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
    played->paths[target.node] |= bit;
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
                   "%s: %u animation channels are not played: their interpolation is unknown, "
                   "their times do not increase, or their values are not finite or not as many as "
                   "their times need",
                   name, played->unusable);
}

/* Whether an animation moves a node that one before it moves, which is played. */
static bool is_other_clip(const struct gltf *gltf, const json_t *animation,
                          const struct played *played)
{
    const json_t *channel;
    size_t i;
    json_array_foreach(json_object_get(animation, "channels"), i, channel)
    {
        const json_t *node = json_object_get(json_object_get(channel, "target"), "node");
        json_int_t index = json_is_integer(node) ? json_integer_value(node) : -1;
        if (index >= 0 && index < gltf->node_count && played->paths[index])
            return true;
    }
    return false;
}

static const char *clip_name(const json_t *animations, uint32_t index)
{
    const char *name =
        json_string_value(json_object_get(json_array_get(animations, index), "name"));
    return name ? name : "";
}

/* Finds the animation that is played alone, or first. False: `wanted` is the name or the number of
   none. */
static bool find_clip(const struct gltf *gltf, const char *wanted, uint32_t *index)
{
    const json_t *animations = json_object_get(gltf->root, "animations");
    uint32_t count = (uint32_t)json_array_size(animations);
    char number[16], names[256] = "";
    *index = 0;
    for (uint32_t i = 0; wanted && i < 2 * count; i++) { /* names come before numbers */
        snprintf(number, sizeof number, "%u", *index = i % count);
        if (strcmp(i < count ? clip_name(animations, i) : number, wanted) == 0)
            return true;
        if (i < count)
            text_add(names, sizeof names, "%s%u `%s`", i ? ", " : "", i,
                     text_token(clip_name(animations, i)).text);
    }
    if (wanted && count)
        log_error(&gltf->scene->log, "%s: there is no animation `%s`, only %s", gltf->request->path,
                  text_token(wanted).text, names);
    return !wanted || !count;
}

/* Plays the wanted animation alone; else the first one, and of the others those that move nodes
   which no played one moves. Animations of a file may be clips, of which viewers play one at a
   time, or the parts that objects have in what happens. */
whit_result gltf_add_animations(struct gltf *gltf)
{
    const whit_load_params *params = gltf->request->params;
    const char *wanted = params ? params->clip : NULL;
    const json_t *animations = json_object_get(gltf->root, "animations");
    struct played played = {.paths = array_alloc_zeroed(gltf->node_count, 1)};
    whit_result result = played.paths ? WHIT_OK : WHIT_ERROR_MEMORY;
    uint32_t first, others = 0, before = gltf->scene->channel_count;
    char names[256] = "";
    if (result == WHIT_OK && !find_clip(gltf, wanted, &first))
        result = WHIT_ERROR_INPUT;
    for (uint32_t i = 0; result == WHIT_OK && i < gltf_count(gltf, "animations"); i++) {
        bool other = is_other_clip(gltf, json_array_get(animations, i), &played);
        if (!wanted && gltf->scene->channel_count == before)
            first = i; /* what comes before it has no channel that is played */
        if (wanted ? i == first : !other)
            result = add_animation(gltf, i, &played);
        else
            text_add(names, sizeof names, "%s`%s`", others++ ? ", " : "",
                     text_token(clip_name(animations, i)).text);
    }
    if (result == WHIT_OK)
        note_unplayed(gltf, &played);
    if (result == WHIT_OK && others)
        scene_note(gltf->scene, SCENE_NOTE_INFO, "%s: %sanimation `%s` is played; %s %s not",
                   path_name(gltf->request->path),
                   gltf->scene->channel_count == before ? "nothing of " : "",
                   text_token(clip_name(animations, first)).text, names,
                   others == 1 ? "is" : "are");
    free(played.paths);
    return result;
}
