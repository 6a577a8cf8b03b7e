/* Objects of a scene file: shapes, models and groups, and their repetition by `repeat`. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "load/scene_animation.h"
#include "load/scene_objects.h"
#include "load/scene_range.h"

#define DEPTH_MAX 64u

static const char *const object_keys[] = {"name",     "translation", "rotation", "quaternion",
                                          "scale",    "matrix",      "material", "animation",
                                          "children", "repeat",      NULL};
static const char *const group_keys[] = {"shape", "model", NULL};
static const char *const model_keys[] = {"model", "lights", "cameras", NULL};

struct repeat {
    uint32_t count[3];
    double step[3];
    bool centered;
};

static bool read_repeat(struct reader *reader, const struct place *place, const json_t *object,
                        struct repeat *out)
{
    static const char *const keys[] = {"count", "step", "centered", NULL};
    const json_t *value = json_object_get(object, "repeat");
    struct place here = {place, "repeat", 0}, at_count = {&here, "count", 0};
    double count[3] = {1, 1, 1};
    *out = (struct repeat){.step = {1, 1, 1}, .centered = true};
    if (value && (!reader_object(reader, &here, value, keys) ||
                  !reader_numbers(reader, &here, value, "count", 3, count) ||
                  !reader_numbers(reader, &here, value, "step", 3, out->step) ||
                  !reader_bool(reader, &here, value, "centered", &out->centered)))
        return false;
    for (int i = 0; i < 3; ++i) {
        if (!(count[i] >= 1.0 && count[i] <= 1e6 && count[i] == floor(count[i])))
            return reader_fail(reader, &at_count, "three whole numbers from 1 are expected");
        out->count[i] = (uint32_t)count[i];
    }
    if (count[0] * count[1] * count[2] > INSTANCES_MAX)
        return reader_fail(reader, &at_count, "more than %u copies", INSTANCES_MAX);
    return true;
}

static bool add_cell(struct reader *reader, const struct repeat *repeat, uint32_t cell,
                     uint32_t parent, uint32_t *index)
{
    struct scene_node node;
    const uint32_t at[3] = {cell % repeat->count[0], cell / repeat->count[0] % repeat->count[1],
                            cell / repeat->count[0] / repeat->count[1]};
    scene_node_init(&node, "copy", parent);
    for (int i = 0; i < 3; ++i) {
        double middle = repeat->centered ? 0.5 * (repeat->count[i] - 1.0) : 0.0;
        node.translation[i] = (at[i] - middle) * repeat->step[i];
    }
    *index = scene_add_node(reader->scene, node);
    return *index != SCENE_NONE || reader_no_memory(reader);
}

static bool add_node(struct reader *reader, const struct place *place, const json_t *object,
                     const char *name, uint32_t parent, uint32_t *index)
{
    struct scene_node node;
    scene_node_init(&node, name, parent);
    if (!reader_transform(reader, place, object, &node)) {
        free(node.name);
        return false;
    }
    *index = scene_add_node(reader->scene, node);
    if (*index == SCENE_NONE)
        return reader_no_memory(reader);
    return reader_animation(reader, place, object, *index);
}

static bool read_content(struct reader *reader, const struct place *place, const json_t *object,
                         uint32_t parent, uint32_t depth)
{
    const char *name = NULL, *model = NULL;
    uint32_t shape = SHAPE_COUNT, node;
    const json_t *children = json_object_get(object, "children");
    struct place at_children = {place, "children", 0};
    if (!reader_string(reader, place, object, "model", &model) ||
        !reader_choice(reader, place, object, "shape", shape_names, &shape))
        return false;
    name = model ? path_name(model) : shape < SHAPE_COUNT ? shape_names[shape] : "group";
    if (!reader_string(reader, place, object, "name", &name) ||
        !add_node(reader, place, object, name, parent, &node))
        return false;
    if (shape < SHAPE_COUNT && !reader_shape(reader, place, object, (enum shape)shape, name, node))
        return false;
    if (model && !reader_model(reader, place, object, node))
        return false;
    return !children || reader_objects(reader, &at_children, children, node, depth + 1);
}

/* Refuses a key of another kind of object: for example, a sphere has no `tube`. */
static bool refuse_foreign_key(struct reader *reader, const struct place *place, const char *key,
                               const char *kind)
{
    struct place here = {place, key, 0};
    const char *article = kind[0] == 'i' ? "an" : "a";
    return reader_fail(reader, &here, "%s %s has no `%s`", article, kind, key);
}

static bool check_keys(struct reader *reader, const struct place *place, const json_t *object,
                       uint32_t shape, bool model)
{
    const char *kind = shape < SHAPE_COUNT ? shape_names[shape] : model ? "model" : "group";
    const char *const *lists[] = {object_keys, shape < SHAPE_COUNT ? shape_keys[shape]
                                               : model             ? model_keys
                                                                   : group_keys};
    const char *const *others[SHAPE_COUNT + 1] = {[SHAPE_COUNT] = model_keys};
    struct place at_model = {place, "model", 0};
    if (model && shape < SHAPE_COUNT)
        return reader_fail(reader, &at_model, "`shape` and `model` exclude each other");
    memcpy(others, shape_keys, sizeof shape_keys);
    const char *foreign = reader_foreign_key(object, lists, 2, others, SHAPE_COUNT + 1);
    if (foreign && (shape < SHAPE_COUNT || model || json_object_get(object, "children")))
        return refuse_foreign_key(reader, place, foreign, kind);
    if (foreign)
        return reader_fail(reader, place, "an object needs a `shape`, a `model` or `children`");
    return reader_object_lists(reader, place, object, lists, 2);
}

static bool check_object(struct reader *reader, const struct place *place, const json_t *object)
{
    uint32_t shape = SHAPE_COUNT;
    const json_t *model = json_object_get(object, "model");
    struct place here = {place, "material", 0};
    if (!json_is_object(object))
        return reader_fail(reader, place, "an object { } is expected");
    if (!reader_choice(reader, place, object, "shape", shape_names, &shape))
        return false;
    if (!check_keys(reader, place, object, shape, model != NULL))
        return false;
    if (model || shape < SHAPE_COUNT)
        return true;
    if (!json_object_get(object, "children"))
        return reader_fail(reader, place, "an object needs a `shape`, a `model` or `children`");
    if (json_object_get(object, "material"))
        return reader_fail(reader, &here, "a group has no material; give it to its children");
    return true;
}

static bool read_object(struct reader *reader, const struct place *place, const json_t *object,
                        uint32_t parent, uint32_t depth)
{
    struct repeat repeat;
    if (!check_object(reader, place, object) || !read_repeat(reader, place, object, &repeat))
        return false;
    uint32_t cells = repeat.count[0] * repeat.count[1] * repeat.count[2], cell = parent;
    if (cells > 1 && !add_cell(reader, &repeat, 0, parent, &cell))
        return false;
    struct scene_range range = range_begin(reader->scene, cell);
    if (!read_content(reader, place, object, cell, depth))
        return false;
    range_end(reader->scene, &range);
    /* `repeat` copies no lights and no cameras. */
    range.light_end = range.first_light;
    range.camera_end = range.first_camera;
    if (!range_afford(reader, place, &range, cells - 1))
        return false;
    for (uint32_t i = 1; i < cells; ++i) {
        if (!add_cell(reader, &repeat, i, parent, &cell) ||
            !range_copy(reader, place, &range, cell))
            return false;
    }
    return true;
}

bool reader_objects(struct reader *reader, const struct place *place, const json_t *value,
                    uint32_t parent, uint32_t depth)
{
    if (depth > DEPTH_MAX)
        return reader_fail(reader, place, "children more than %u deep", DEPTH_MAX);
    if (!json_is_array(value))
        return reader_fail(reader, place, "objects in [ ] are expected");
    for (size_t i = 0; i < json_array_size(value); ++i) {
        struct place here = {place, NULL, i};
        if (reader->params && reader->params->cancel && *reader->params->cancel) {
            reader->result = WHIT_ERROR_CANCELLED;
            return false;
        }
        if (!read_object(reader, &here, json_array_get(value, i), parent, depth))
            return false;
    }
    return true;
}
