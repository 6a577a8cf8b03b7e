#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "load/gltf_json.h"

struct gltf_place gltf_place(const char *format, ...)
{
    struct gltf_place place;
    va_list args;
    va_start(args, format);
    text_print(place.text, sizeof place.text, format, args);
    va_end(args);
    return place;
}

bool gltf_fail(const struct gltf *gltf, const struct gltf_place *at, const char *format, ...)
{
    char text[256];
    va_list args;
    va_start(args, format);
    text_print(text, sizeof text, format, args);
    va_end(args);
    log_error(&gltf->scene->log, "%s: %s: %s", gltf->request->path, at->text, text);
    return false;
}

static const char *type_name(const json_t *value)
{
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        return "an object";
    case JSON_ARRAY:
        return "an array";
    case JSON_STRING:
        return "a string";
    case JSON_INTEGER:
    case JSON_REAL:
        return "a number";
    case JSON_NULL:
        return "null";
    default:
        return "a truth value";
    }
}

static bool wrong_type(const struct gltf *gltf, const struct gltf_place *at, const char *key,
                       const char *wanted, const json_t *value)
{
    return gltf_fail(gltf, at, "`%.40s` should be %s and is %s", key, wanted, type_name(value));
}

bool gltf_object(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, json_t **out)
{
    *out = json_object_get(in, key);
    return !*out || json_is_object(*out) || wrong_type(gltf, at, key, "an object", *out);
}

bool gltf_array(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                const char *key, json_t **out)
{
    *out = json_object_get(in, key);
    return !*out || json_is_array(*out) || wrong_type(gltf, at, key, "an array", *out);
}

bool gltf_string(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, const char **out)
{
    const json_t *value = json_object_get(in, key);
    *out = json_string_value(value);
    return !value || *out || wrong_type(gltf, at, key, "a string", value);
}

bool gltf_bool(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
               const char *key, bool *out)
{
    const json_t *value = json_object_get(in, key);
    if (!value)
        return true;
    *out = json_is_true(value);
    return json_is_boolean(value) || wrong_type(gltf, at, key, "true or false", value);
}

bool gltf_number(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, double *out)
{
    const json_t *value = json_object_get(in, key);
    if (!value)
        return true;
    if (!json_is_number(value))
        return wrong_type(gltf, at, key, "a number", value);
    *out = json_number_value(value);
    return isfinite(*out) || gltf_fail(gltf, at, "`%s` is not finite", key);
}

bool gltf_numbers(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                  const char *key, uint32_t count, double *out)
{
    json_t *array;
    if (!gltf_array(gltf, in, at, key, &array))
        return false;
    if (!array)
        return true;
    if (json_array_size(array) != count)
        return gltf_fail(gltf, at, "`%s` should have %u numbers and has %zu", key, count,
                         json_array_size(array));
    for (uint32_t i = 0; i < count; i++) {
        const json_t *value = json_array_get(array, i);
        if (!json_is_number(value) || !isfinite(json_number_value(value)))
            return gltf_fail(gltf, at, "`%s[%u]` should be a number and is %s", key, i,
                             type_name(value));
        out[i] = json_number_value(value);
    }
    return true;
}

bool gltf_floats(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, uint32_t count, float *out)
{
    double values[16];
    for (uint32_t i = 0; i < count; i++)
        values[i] = (double)out[i];
    if (!gltf_numbers(gltf, in, at, key, count, values))
        return false;
    for (uint32_t i = 0; i < count; i++)
        out[i] = (float)fmin(fmax(values[i], -3e38), 3e38);
    return true;
}

static bool whole_value(const json_t *value, double *out)
{
    *out = json_number_value(value);
    return json_is_number(value) && *out >= 0 && *out <= 9007199254740992.0 && *out == floor(*out);
}

bool gltf_whole(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                const char *key, uint64_t max, uint64_t *out)
{
    const json_t *value = json_object_get(in, key);
    double number;
    if (!value)
        return true;
    if (!whole_value(value, &number))
        return gltf_fail(gltf, at, "`%s` should be a whole number of at least 0", key);
    if (number > (double)max)
        return gltf_fail(gltf, at, "`%s` is %.0f, at most %llu is possible", key, number,
                         (unsigned long long)max);
    *out = (uint64_t)number;
    return true;
}

bool gltf_index_value(const struct gltf *gltf, const json_t *value, const struct gltf_place *at,
                      uint32_t count, uint32_t *out)
{
    double number;
    if (!value || !whole_value(value, &number))
        return gltf_fail(gltf, at, "should be an index");
    if (number >= count)
        return gltf_fail(gltf, at, "index %.0f is out of range, there are %u", number, count);
    *out = (uint32_t)number;
    return true;
}

bool gltf_index(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                const char *key, uint32_t count, uint32_t *out)
{
    const json_t *value = json_object_get(in, key);
    struct gltf_place place = gltf_place("%.60s.%.30s", at->text, key);
    *out = SCENE_NONE;
    return !value || gltf_index_value(gltf, value, &place, count, out);
}

bool gltf_extension(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                    const char *name, json_t **out)
{
    json_t *extensions;
    *out = NULL;
    if (!gltf_object(gltf, in, at, "extensions", &extensions))
        return false;
    return !extensions || gltf_object(gltf, extensions, at, name, out);
}

bool gltf_item(const struct gltf *gltf, const char *key, uint32_t index, struct gltf_place *at,
               json_t **out)
{
    *at = gltf_place("%.40s[%u]", key, index);
    *out = json_array_get(json_object_get(gltf->root, key), index);
    return json_is_object(*out) || gltf_fail(gltf, at, "should be an object");
}

uint32_t gltf_count(const struct gltf *gltf, const char *key)
{
    size_t count = json_array_size(json_object_get(gltf->root, key));
    return count < UINT32_MAX ? (uint32_t)count : UINT32_MAX - 1;
}
