/* Animation of a scene file's objects, lights and cameras. */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/same.h"
#include "base/vec.h"
#include "load/scene_animation.h"

void reader_quaternion(const double degrees[3], double out[4])
{
    double s[3], c[3];
    for (int i = 0; i < 3; ++i) {
        s[i] = same_sin(degrees[i] * PI / 360.0);
        c[i] = same_cos(degrees[i] * PI / 360.0);
    }
    out[0] = s[0] * c[1] * c[2] - c[0] * s[1] * s[2];
    out[1] = c[0] * s[1] * c[2] + s[0] * c[1] * s[2];
    out[2] = c[0] * c[1] * s[2] - s[0] * s[1] * c[2];
    out[3] = c[0] * c[1] * c[2] + s[0] * s[1] * s[2];
}

static bool read_times(struct reader *reader, const struct place *place, const json_t *channel,
                       struct scene_channel *out)
{
    const json_t *times = json_object_get(channel, "times");
    struct place here = {place, "times", 0};
    size_t count = json_array_size(times);
    if (!count || count > 1000000)
        return reader_fail(reader, times ? &here : place,
                           "`times` takes one or more seconds in [ ]");
    out->key_count = (uint32_t)count;
    out->times_s = array_alloc(count, sizeof *out->times_s);
    if (!out->times_s)
        return reader_no_memory(reader);
    for (size_t i = 0; i < count; ++i) {
        struct place at = {&here, NULL, i};
        const json_t *time = json_array_get(times, i);
        if (!json_is_number(time) || fabs(json_number_value(time)) > 1e9)
            return reader_fail(reader, &at, "a number of seconds is expected");
        out->times_s[i] = (float)json_number_value(time);
        if (i && !(out->times_s[i] > out->times_s[i - 1]))
            return reader_fail(reader, &at, "times must increase");
    }
    return true;
}

/* Reads a key's value. A rotation is a quaternion or three angles in degrees, which are converted
   to a quaternion; cubic channels, with their tangents, need quaternions. */
static bool read_value(struct reader *reader, const struct place *place, const json_t *value,
                       const struct scene_channel *channel, float *out)
{
    size_t width = channel->path == SCENE_PATH_ROTATION ? 4 : 3;
    double numbers[4];
    bool degrees = channel->path == SCENE_PATH_ROTATION && json_array_size(value) == 3 &&
                   channel->interpolation != SCENE_CUBIC;
    if (!reader_vector(reader, place, value, degrees ? 3 : width, numbers))
        return false;
    if (degrees)
        reader_quaternion((const double[3]){numbers[0], numbers[1], numbers[2]}, numbers);
    for (size_t i = 0; i < width; ++i)
        out[i] = (float)numbers[i];
    return true;
}

static bool read_values(struct reader *reader, const struct place *place, const json_t *object,
                        struct scene_channel *out)
{
    const json_t *values = json_object_get(object, "values");
    struct place here = {place, "values", 0};
    size_t width = out->path == SCENE_PATH_ROTATION ? 4 : 3;
    size_t count = out->key_count * (out->interpolation == SCENE_CUBIC ? (size_t)3 : 1);
    if (json_array_size(values) != count)
        return reader_fail(
            reader, values ? &here : place, "`values` takes %zu entries for %u times%s", count,
            out->key_count,
            out->interpolation == SCENE_CUBIC ? " (in-tangent, value, out-tangent for each)" : "");
    out->values = array_alloc(count, width * sizeof *out->values);
    if (!out->values)
        return reader_no_memory(reader);
    for (size_t i = 0; i < count; ++i) {
        struct place at = {&here, NULL, i};
        if (!read_value(reader, &at, json_array_get(values, i), out, out->values + i * width))
            return false;
    }
    return true;
}

static bool read_channel(struct reader *reader, const struct place *place, const json_t *object,
                         enum scene_path path, uint32_t node)
{
    static const char *const keys[] = {"times", "values", "interpolation", NULL};
    uint32_t kind = SCENE_LINEAR;
    struct scene_channel channel = {.node = node, .path = path};
    if (!reader_object(reader, place, object, keys) ||
        !reader_choice(reader, place, object, "interpolation", scene_interpolation_names, &kind))
        return false;
    channel.interpolation = (enum scene_interpolation)kind;
    if (!read_times(reader, place, object, &channel) ||
        !read_values(reader, place, object, &channel)) {
        free(channel.times_s);
        free(channel.values);
        return false;
    }
    return scene_add_channel(reader->scene, channel) != SCENE_NONE || reader_no_memory(reader);
}

bool reader_animation(struct reader *reader, const struct place *place, const json_t *object,
                      uint32_t node)
{
    static const char *const paths[] = {"translation", "rotation", "scale", NULL};
    const json_t *animation = json_object_get(object, "animation");
    struct place here = {place, "animation", 0};
    if (!animation)
        return true;
    if (!reader_object(reader, &here, animation, paths))
        return false;
    for (int path = 0; paths[path]; ++path) {
        const json_t *channel = json_object_get(animation, paths[path]);
        struct place at = {&here, paths[path], 0};
        if (channel && !read_channel(reader, &at, channel, (enum scene_path)path, node))
            return false;
    }
    return true;
}

bool reader_moving_node(struct reader *reader, const struct place *place, const json_t *object,
                        const char *name, uint32_t *index)
{
    struct scene_node node;
    *index = SCENE_NONE;
    if (!json_object_get(object, "animation"))
        return true;
    scene_node_init(&node, name, SCENE_NONE);
    *index = scene_add_node(reader->scene, node);
    if (*index == SCENE_NONE)
        return reader_no_memory(reader);
    return reader_animation(reader, place, object, *index);
}
