/* whit's own scene files: docs/scenes.md, docs/scene.schema.json. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/same.h"
#include "base/text.h"
#include "base/vec.h"
#include "load/scene_animation.h"
#include "load/scene_cameras.h"
#include "load/scene_materials.h"
#include "load/scene_reader.h"

#define FILE_BYTES_MAX ((uint64_t)64 << 20)
#define RADIANS        (PI / 180.0)

/* In the file `position` is the centre of the rectangle, and `u` and `v` are its sides. */
static bool read_rectangle(struct reader *reader, const struct place *place, const json_t *object,
                           struct scene_light *out)
{
    static const char *const needed[] = {"position", "u", "v"};
    double *const values[] = {out->position, out->edge_u, out->edge_v};
    for (int i = 0; i < 3; ++i) {
        if (!json_object_get(object, needed[i]))
            return reader_fail(reader, place, "a rectangle light needs a `%s`", needed[i]);
        if (!reader_numbers(reader, place, object, needed[i], 3, values[i]))
            return false;
    }
    for (int i = 0; i < 3; ++i)
        out->position[i] -= 0.5 * (out->edge_u[i] + out->edge_v[i]);
    return true;
}

static bool read_triangle(struct reader *reader, const struct place *place, const json_t *object,
                          struct scene_light *out)
{
    const json_t *points = json_object_get(object, "points");
    double corners[3][3];
    struct place at_points = {place, "points", 0};
    if (!json_is_array(points) || json_array_size(points) != 3)
        return reader_fail(reader, place, "a triangle light needs three `points`");
    for (size_t i = 0; i < 3; ++i) {
        struct place here = {&at_points, NULL, i};
        if (!reader_vector(reader, &here, json_array_get(points, i), 3, corners[i]))
            return false;
    }
    for (int i = 0; i < 3; ++i) {
        out->position[i] = corners[0][i];
        out->edge_u[i] = corners[1][i] - corners[0][i];
        out->edge_v[i] = corners[2][i] - corners[0][i];
    }
    return true;
}

static bool read_emitter(struct reader *reader, const struct place *place, const json_t *object,
                         struct scene_light *out)
{
    bool rectangle = out->kind == WHIT_LIGHT_RECTANGLE;
    if (!(rectangle ? read_rectangle : read_triangle)(reader, place, object, out) ||
        !reader_bool(reader, place, object, "two_sided", &out->two_sided))
        return false;
    if (!(double3_area(out->edge_u, out->edge_v) > 0.0))
        return reader_fail(reader, place, "the light has no area");
    return true;
}

static bool read_light_place(struct reader *reader, const struct place *place, const json_t *object,
                             struct scene_light *out)
{
    if (scene_light_is_flat(out))
        return read_emitter(reader, place, object, out);
    double target[3];
    struct place here = {place, "target", 0};
    bool points = out->kind == WHIT_LIGHT_POINT;
    if (out->kind != WHIT_LIGHT_DIRECTIONAL && !json_object_get(object, "position"))
        return reader_fail(reader, place, "a point or spot light needs a `position`");
    if (!points && !json_object_get(object, "direction") && !json_object_get(object, "target"))
        return reader_fail(reader, place, "this light needs a `direction` or a `target`");
    if (!reader_numbers(reader, place, object, "position", 3, out->position) ||
        !reader_numbers(reader, place, object, "direction", 3, out->direction))
        return false;
    if (json_object_get(object, "target")) {
        if (json_object_get(object, "direction"))
            return reader_fail(reader, &here, "`target` and `direction` exclude each other");
        if (!reader_numbers(reader, place, object, "target", 3, target))
            return false;
        for (int i = 0; i < 3; ++i)
            out->direction[i] = target[i] - out->position[i];
    }
    double length = double3_distance(out->direction, (const double[3]){0, 0, 0});
    if (!(length > 0.0))
        return reader_fail(reader, place, "the light's direction has no length");
    for (int i = 0; i < 3; ++i)
        out->direction[i] /= length;
    return true;
}

static bool read_light_values(struct reader *reader, const struct place *place,
                              const json_t *object, struct scene_light *out)
{
    double intensity = 1.0, inner = 0.0, outer = 45.0;
    struct place here = {place, "inner", 0};
    if (!reader_color(reader, place, object, "color", out->color) ||
        !reader_number(reader, place, object, "intensity", 0.0, 1e12, &intensity) ||
        !reader_bool(reader, place, object, "falloff", &out->falloff) ||
        !reader_float(reader, place, object, "range", 0.0, 1e18, &out->range) ||
        !reader_number(reader, place, object, "outer", 0.1, 180.0, &outer))
        return false;
    inner = 0.8 * outer;
    if (!reader_number(reader, place, object, "inner", 0.0, 180.0, &inner))
        return false;
    if (inner > outer)
        return reader_fail(reader, &here, "the inner angle is over the outer one");
    scene_light_cones(out, inner * RADIANS, outer * RADIANS);
    for (int i = 0; i < 3; ++i)
        out->color[i] = (float)((double)out->color[i] * intensity);
    return true;
}

/* The kinds of lights that files have, the default first, and the keys of each in addition to those
   of all lights. */
enum { LIGHT_KINDS = 5 };
static const whit_light_kind light_kinds[LIGHT_KINDS] = {WHIT_LIGHT_POINT, WHIT_LIGHT_DIRECTIONAL,
                                                         WHIT_LIGHT_SPOT, WHIT_LIGHT_RECTANGLE,
                                                         WHIT_LIGHT_TRIANGLE};
static const char *const point_keys[] = {"position", "falloff", "range", NULL};
static const char *const directional_keys[] = {"direction", "target", NULL};
static const char *const spot_keys[] = {"position", "direction", "target", "falloff",
                                        "range",    "inner",     "outer",  NULL};
static const char *const rectangle_keys[] = {"position", "u", "v", "two_sided", NULL};
static const char *const triangle_keys[] = {"points", "two_sided", NULL};
static const char *const *const light_keys[LIGHT_KINDS] = {point_keys, directional_keys, spot_keys,
                                                           rectangle_keys, triangle_keys};

static bool read_light(struct reader *reader, const struct place *place, const json_t *object)
{
    static const char *const common[] = {"name", "kind", "color", "intensity", "animation", NULL};
    const char *names[LIGHT_KINDS + 1] = {NULL};
    uint32_t kind = 0;
    const char *name = "light";
    struct scene_light light = {.direction = {0, -1, 0}, .color = {1, 1, 1}, .node = SCENE_NONE};
    if (!json_is_object(object))
        return reader_fail(reader, place, "a light in { } is expected");
    for (int i = 0; i < LIGHT_KINDS; ++i)
        names[i] = scene_light_kind_names[light_kinds[i]];
    if (!reader_choice(reader, place, object, "kind", names, &kind))
        return false;
    const char *const *lists[] = {common, light_keys[kind]};
    const char *foreign = reader_foreign_key(object, lists, 2, light_keys, LIGHT_KINDS);
    struct place at_foreign = {place, foreign, 0};
    if (foreign)
        return reader_fail(reader, &at_foreign, "a %s light has no `%s`", names[kind], foreign);
    light.kind = light_kinds[kind];
    light.falloff = light.kind != WHIT_LIGHT_DIRECTIONAL;
    if (!reader_object_lists(reader, place, object, lists, 2) ||
        !reader_string(reader, place, object, "name", &name) ||
        !read_light_place(reader, place, object, &light) ||
        !read_light_values(reader, place, object, &light) ||
        !reader_moving_node(reader, place, object, name, &light.node))
        return false;
    light.name = scene_text(reader->scene, name);
    light.origin.file = scene_text(reader->scene, reader->path);
    light.origin.line = reader_line(reader, place);
    return scene_add_light(reader->scene, light) != SCENE_NONE || reader_no_memory(reader);
}

static bool read_lights(struct reader *reader, const struct place *place, const json_t *value)
{
    if (!json_is_array(value))
        return reader_fail(reader, place, "lights in [ ] are expected");
    if (json_array_size(value) > 4096)
        return reader_fail(reader, place, "more than 4096 lights");
    for (size_t i = 0; i < json_array_size(value); ++i) {
        struct place here = {place, NULL, i};
        if (!read_light(reader, &here, json_array_get(value, i)))
            return false;
    }
    return true;
}

static bool read_map(struct reader *reader, const struct place *place, const json_t *value)
{
    static const char *const keys[] = {"map", "scale", NULL};
    static const char *const others[] = {"zenith", "horizon", "ground"};
    const char *name = NULL;
    float scale[3] = {1, 1, 1};
    struct place here = {place, "map", 0};
    for (size_t i = 0; i < sizeof others / sizeof *others; ++i) {
        if (json_object_get(value, others[i]))
            return reader_fail(reader, &here, "`map` and `%s` exclude each other", others[i]);
    }
    if (!reader_object(reader, place, value, keys) ||
        !reader_string(reader, place, value, "map", &name) ||
        !reader_color(reader, place, value, "scale", scale))
        return false;
    char *path = roots_join(reader->path, name);
    if (!path)
        return reader_no_memory(reader);
    const char *why_not = roots_why_not(&reader->scene->roots, path);
    if (why_not) {
        reader_fail(reader, &here, "`%s`: %s", text_token(name).text, why_not);
        free(path);
        return false;
    }
    whit_result result = load_environment(reader->scene, path, reader->params);
    free(path);
    if (result != WHIT_OK) {
        reader->result = result;
        return false;
    }
    memcpy(reader->scene->environment.scale, scale, sizeof scale);
    return true;
}

static bool read_environment(struct reader *reader, const struct place *place, const json_t *value)
{
    static const char *const keys[] = {"zenith", "horizon", "ground", "scale", NULL};
    struct scene_environment sky = scene_sky;
    if (json_is_object(value) && json_object_get(value, "map"))
        return read_map(reader, place, value);
    if (json_is_object(value)) {
        if (!reader_object(reader, place, value, keys) ||
            !reader_color(reader, place, value, "zenith", sky.zenith) ||
            !reader_color(reader, place, value, "horizon", sky.horizon) ||
            !reader_color(reader, place, value, "ground", sky.ground) ||
            !reader_color(reader, place, value, "scale", sky.scale))
            return false;
    } else {
        if (!reader_color_value(reader, place, value, sky.zenith))
            return false;
        memcpy(sky.horizon, sky.zenith, sizeof sky.horizon);
        memcpy(sky.ground, sky.zenith, sizeof sky.ground);
    }
    reader->scene->environment = sky;
    reader->scene->has_environment = true;
    return true;
}

/* Materials come first, whatever their place in the file, since objects refer to them. */
static bool read_root(struct reader *reader, const json_t *root)
{
    static const char *const keys[] = {"$schema", "description", "materials", "objects",
                                       "lights",  "camera",      "cameras",   "environment",
                                       "ambient", "contact",     NULL};
    static const struct {
        const char *key;
        bool (*read)(struct reader *reader, const struct place *place, const json_t *value);
    } parts[] = {
        {"environment", read_environment}, {"materials", reader_materials}, {"lights", read_lights},
        {"camera", reader_camera},         {"cameras", reader_cameras},
    };
    const struct place place = {0};
    const char *ignored = NULL;
    const json_t *objects = json_object_get(root, "objects");
    struct place at_objects = {&place, "objects", 0}, at_cameras = {&place, "cameras", 0};
    if (!reader_object(reader, &place, root, keys) ||
        !reader_string(reader, &place, root, "description", &ignored) ||
        !reader_color(reader, &place, root, "ambient", reader->scene->ambient) ||
        !reader_float(reader, &place, root, "contact", 0.0, 1e15, &reader->scene->contact))
        return false;
    if (json_object_get(root, "camera") && json_object_get(root, "cameras"))
        return reader_fail(reader, &at_cameras, "`camera` and `cameras` exclude each other");
    reader->scene->has_ambient = json_object_get(root, "ambient") != NULL;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; ++i) {
        const json_t *value = json_object_get(root, parts[i].key);
        struct place here = {&place, parts[i].key, 0};
        if (value && !parts[i].read(reader, &here, value))
            return false;
    }
    return !objects || reader_objects(reader, &at_objects, objects, SCENE_NONE, 0);
}

static void reader_finish(struct reader *reader)
{
    key_table_finish(&reader->material_names);
    key_table_finish(&reader->shapes);
    key_table_finish(&reader->model_keys);
    free(reader->models);
}

whit_result load_scene_file(struct scene *scene, const char *path, const whit_load_params *params)
{
    uint8_t *text = NULL;
    size_t size_bytes = 0;
    whit_result result =
        file_read(&scene->log, &scene->roots, path, FILE_BYTES_MAX, &text, &size_bytes);
    if (result != WHIT_OK)
        return result;
    scene->file_bytes += size_bytes;
    struct reader reader = {
        .scene = scene,
        .params = params,
        .path = path,
        .text = (const char *)text,
        .text_bytes = size_bytes,
        .plain_material = SCENE_NONE,
    };
    json_t *root = reader_parse(&reader);
    bool read = root && read_root(&reader, root);
    result = read ? WHIT_OK : reader.result;
    reader_finish(&reader);
    json_decref(root);
    free(text);
    return result;
}
