/* Objects of a scene file: shapes, models and groups, placed, moved and repeated. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "load/scene_reader.h"
#include "scene/shapes.h"

#define DEPTH_MOST     64u
#define INSTANCES_MOST 4000000u
#define SIZE_MOST      1e15
#define SPHERES_MOST   10000000u

static const char *const object_keys[] = {"name",     "translation", "rotation", "quaternion",
                                          "scale",    "matrix",      "material", "animation",
                                          "children", "repeat",      NULL};
static const char *const group_keys[] = {"shape", "model", NULL};
static const char *const model_keys[] = {"model", "lights", "cameras", NULL};
static const char *const box_keys[] = {"shape", "size", NULL};
static const char *const plane_keys[] = {"shape", "size", "steps", "uv_scale", NULL};
static const char *const sphere_keys[] = {"shape", "radius", "segments", "rings", NULL};
static const char *const icosphere_keys[] = {"shape", "radius", "level", NULL};
static const char *const torus_keys[] = {"shape", "radius", "tube", "segments", "sides", NULL};
static const char *const cylinder_keys[] = {"shape",  "radius",   "radius_top",
                                            "height", "segments", NULL};
static const char *const cone_keys[] = {"shape", "radius", "height", "segments", NULL};
static const char *const terrain_keys[] = {"shape", "size", "height", "steps", "seed", NULL};
static const char *const strands_keys[] = {"shape", "size", "length", "width",
                                           "count", "seed", NULL};
static const char *const atrium_keys[] = {"shape", "bays", "level", NULL};
static const char *const flake_keys[] = {"shape",    "radius", "level", "balls",
                                         "segments", "rings",  NULL};
static const char *const ball_keys[] = {"shape", "radius", "center", NULL};
static const char *const balls_keys[] = {"shape", "spheres", NULL};

enum shape {
    SHAPE_BOX,
    SHAPE_PLANE,
    SHAPE_SPHERE,
    SHAPE_ICOSPHERE,
    SHAPE_TORUS,
    SHAPE_CYLINDER,
    SHAPE_CONE,
    SHAPE_TERRAIN,
    SHAPE_STRANDS,
    SHAPE_ATRIUM,
    SHAPE_SPHEREFLAKE,
    SHAPE_BALL,
    SHAPE_BALLS,
    SHAPE_COUNT
};

static const char *const shape_names[SHAPE_COUNT + 1] = {
    "box",     "plane",   "sphere", "icosphere",   "torus", "cylinder", "cone",
    "terrain", "strands", "atrium", "sphereflake", "ball",  "balls",    NULL};
static const char *const *const shape_keys[SHAPE_COUNT] = {
    box_keys,     plane_keys,   sphere_keys, icosphere_keys, torus_keys, cylinder_keys, cone_keys,
    terrain_keys, strands_keys, atrium_keys, flake_keys,     ball_keys,  balls_keys};

/* "size" as one number for all sides, or as one a side. */
static bool read_size(struct reader *reader, const struct place *place, const json_t *object,
                      size_t count, double *out)
{
    const json_t *value = json_object_get(object, "size");
    struct place here = {place, "size", 0};
    if (!value)
        return true;
    if (json_is_number(value)) {
        if (!reader_number(reader, place, object, "size", 1e-15, SIZE_MOST, &out[0]))
            return false;
        for (size_t i = 1; i < count; ++i)
            out[i] = out[0];
        return true;
    }
    if (!reader_vector(reader, &here, value, count, out))
        return false;
    for (size_t i = 0; i < count; ++i) {
        if (!(out[i] > 0.0 && out[i] <= SIZE_MOST))
            return reader_fail(reader, &here, "every side must be over 0 and at most %g",
                               SIZE_MOST);
    }
    return true;
}

struct shape_sizes {
    double size[3], center[3], radius, radius_top, tube, height, length, width, uv_scale;
    uint32_t segments, rings, sides, steps, level, seed, count, bays;
    bool balls;
};

static bool read_sizes(struct reader *reader, const struct place *place, const json_t *object,
                       enum shape shape, struct shape_sizes *out)
{
    bool ball = shape == SHAPE_SPHERE || shape == SHAPE_SPHEREFLAKE || shape == SHAPE_BALL;
    *out = (struct shape_sizes){
        .size = {shape == SHAPE_TERRAIN   ? 10.0
                 : shape == SHAPE_STRANDS ? 2.0
                                          : 1.0,
                 1.0, 1.0},
        .radius = shape == SHAPE_TORUS || ball || shape == SHAPE_ICOSPHERE ? 1.0 : 0.5,
        .tube = 0.25,
        .height = 1.0,
        .length = 2.0,
        .width = 0.02,
        .uv_scale = 1.0,
        .segments = shape == SHAPE_SPHEREFLAKE ? 24 : 64,
        .rings = shape == SHAPE_SPHEREFLAKE ? 12 : 32,
        .sides = 32,
        .steps = shape == SHAPE_TERRAIN ? 64 : 1,
        .level = shape == SHAPE_SPHEREFLAKE ? 3
                 : shape == SHAPE_ATRIUM    ? 2
                                            : 4,
        .seed = 1,
        .count = 5000,
        .bays = 9,
    };
    size_t size_count = shape == SHAPE_BOX ? 3 : shape == SHAPE_PLANE ? 2 : 1;
    uint32_t steps_most = shape == SHAPE_TERRAIN ? 4096 : 2048;
    uint32_t level_least = shape == SHAPE_ATRIUM ? 1 : 0;
    uint32_t level_most = shape == SHAPE_SPHEREFLAKE ? 6 : 8;
    if (!read_size(reader, place, object, size_count, out->size) ||
        !reader_number(reader, place, object, "radius", 1e-15, SIZE_MOST, &out->radius) ||
        !reader_numbers(reader, place, object, "center", 3, out->center) ||
        !reader_bool(reader, place, object, "balls", &out->balls))
        return false;
    out->radius_top = out->radius;
    return reader_number(reader, place, object, "radius_top", 0.0, SIZE_MOST, &out->radius_top) &&
           reader_number(reader, place, object, "tube", 1e-15, SIZE_MOST, &out->tube) &&
           reader_number(reader, place, object, "height", 1e-15, SIZE_MOST, &out->height) &&
           reader_number(reader, place, object, "length", 1e-15, SIZE_MOST, &out->length) &&
           reader_number(reader, place, object, "width", 1e-15, SIZE_MOST, &out->width) &&
           reader_number(reader, place, object, "uv_scale", -1e6, 1e6, &out->uv_scale) &&
           reader_count(reader, place, object, "segments", 3, 4096, &out->segments) &&
           reader_count(reader, place, object, "rings", 2, 4096, &out->rings) &&
           reader_count(reader, place, object, "sides", 3, 4096, &out->sides) &&
           reader_count(reader, place, object, "steps", 1, steps_most, &out->steps) &&
           reader_count(reader, place, object, "level", level_least, level_most, &out->level) &&
           reader_count(reader, place, object, "count", 1, 1000000, &out->count) &&
           reader_count(reader, place, object, "bays", 1, 64, &out->bays) &&
           reader_count(reader, place, object, "seed", 0, 1000000000, &out->seed);
}

static whit_result make_flake_of_balls(const struct shape_sizes *s, struct scene_mesh *out)
{
    double *spheres;
    uint32_t count;
    whit_result result = shape_sphereflake(s->radius, s->level, &spheres, &count);
    if (result == WHIT_OK)
        result = shape_balls(spheres, count, out);
    free(spheres);
    return result;
}

static whit_result make_mesh(enum shape shape, const struct shape_sizes *s, struct scene_mesh *out)
{
    switch (shape) {
    case SHAPE_BOX:
        return shape_box(s->size, out);
    case SHAPE_PLANE:
        return shape_plane(s->size[0], s->size[1], s->steps, s->uv_scale, out);
    case SHAPE_SPHERE:
        return shape_sphere(s->radius, s->segments, s->rings, out);
    case SHAPE_SPHEREFLAKE:
        return s->balls ? make_flake_of_balls(s, out)
                        : shape_sphere(1.0, s->segments, s->rings, out);
    case SHAPE_BALL:
        return shape_balls((const double[]){s->center[0], s->center[1], s->center[2], s->radius}, 1,
                           out);
    case SHAPE_ICOSPHERE:
        return shape_icosphere(s->radius, s->level, out);
    case SHAPE_TORUS:
        return shape_torus(s->radius, s->tube, s->segments, s->sides, out);
    case SHAPE_CYLINDER:
        return shape_cylinder(s->radius, s->radius_top, s->height, s->segments, out);
    case SHAPE_CONE:
        return shape_cylinder(s->radius, 0.0, s->height, s->segments, out);
    case SHAPE_TERRAIN:
        return shape_terrain(s->size[0], s->height, s->steps, s->seed, out);
    case SHAPE_STRANDS:
        return shape_strands(s->size[0], s->length, s->width, s->count, s->seed, out);
    case SHAPE_ATRIUM:
        return shape_atrium(s->bays, s->level, out);
    case SHAPE_BALLS: /* read_balls */
    case SHAPE_COUNT:
        break;
    }
    return WHIT_ERROR_USAGE;
}

/* Everything that makes two meshes the same one. */
static char *shape_key(enum shape shape, const struct shape_sizes *s, uint32_t material)
{
    return string_format("%d %u %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g "
                         "%u %u %u %u %u %u %u %u %d %.17g %.17g %.17g",
                         (int)shape, material, s->size[0], s->size[1], s->size[2], s->radius,
                         s->radius_top, s->tube, s->height, s->length, s->width, s->uv_scale,
                         s->segments, s->rings, s->sides, s->steps, s->level, s->seed, s->count,
                         s->bays, s->balls, s->center[0], s->center[1], s->center[2]);
}

/* Takes over what `mesh` owns. */
static bool add_dressed(struct reader *reader, enum shape shape, struct scene_mesh mesh,
                        uint32_t material, uint32_t *index)
{
    mesh.name = string_copy(shape_names[shape]);
    for (uint32_t i = 0; i < scene_mesh_primitives(&mesh); ++i)
        mesh.materials[i] = material;
    *index = scene_add_mesh(reader->scene, mesh);
    return *index != SCENE_NONE || reader_no_memory(reader);
}

static bool add_mesh(struct reader *reader, const struct place *place, enum shape shape,
                     const struct shape_sizes *sizes, uint32_t material, uint32_t *index)
{
    struct scene_mesh mesh = {0};
    whit_result result = make_mesh(shape, sizes, &mesh);
    if (result == WHIT_ERROR_MEMORY)
        return reader_no_memory(reader);
    if (result != WHIT_OK)
        return reader_fail(reader, place, "these sizes make no %s", shape_names[shape]);
    return add_dressed(reader, shape, mesh, material, index);
}

/* "spheres": [[x, y, z, radius], ...] as one mesh of their own. */
static bool read_balls(struct reader *reader, const struct place *place, const json_t *object,
                       uint32_t material, uint32_t *index)
{
    const json_t *value = json_object_get(object, "spheres");
    struct place here = {place, "spheres", 0};
    size_t count = json_is_array(value) ? json_array_size(value) : 0;
    if (count == 0 || count > SPHERES_MOST)
        return reader_fail(reader, &here, "1 to %u spheres [x, y, z, radius] are expected",
                           SPHERES_MOST);
    double *spheres = array_alloc(count, 4 * sizeof *spheres);
    bool good = spheres || reader_no_memory(reader);
    for (size_t i = 0; good && i < count; ++i) {
        struct place at = {&here, NULL, i};
        double *sphere = spheres + 4 * i;
        good = reader_vector(reader, &at, json_array_get(value, i), 4, sphere);
        if (good && !(sphere[3] >= 1e-15 && sphere[3] <= SIZE_MOST))
            good = reader_fail(reader, &at, "the radius must be from 1e-15 to %g", SIZE_MOST);
    }
    struct scene_mesh mesh = {0};
    if (good && shape_balls(spheres, (uint32_t)count, &mesh) != WHIT_OK)
        good = reader_no_memory(reader);
    free(spheres);
    return good && add_dressed(reader, SHAPE_BALLS, mesh, material, index);
}

/* Equal shapes share a mesh, and so one tree. */
static bool shared_mesh(struct reader *reader, const struct place *place, enum shape shape,
                        const struct shape_sizes *sizes, uint32_t material, uint32_t *index)
{
    char *key = shape_key(shape, sizes, material);
    if (!key)
        return reader_no_memory(reader);
    for (uint32_t i = 0; i < reader->shape_count; ++i) {
        if (strcmp(reader->shapes[i].key, key) == 0) {
            free(key);
            *index = reader->shapes[i].mesh;
            return true;
        }
    }
    if (!add_mesh(reader, place, shape, sizes, material, index)) {
        free(key);
        return false;
    }
    if (ARRAY_PUSH(reader->shapes, reader->shape_count, reader->shape_capacity,
                   (struct shape_cache){key, *index}))
        return true;
    free(key);
    return reader_no_memory(reader);
}

static bool add_instance(struct reader *reader, const char *name, uint32_t mesh, uint32_t node,
                         const struct affine *local)
{
    struct scene_instance instance = {.name = string_copy(name), .mesh = mesh, .node = node};
    if (local) {
        instance.has_local = true;
        instance.local = *local;
    }
    return scene_add_instance(reader->scene, instance) != SCENE_NONE || reader_no_memory(reader);
}

static bool add_sphereflake(struct reader *reader, const char *name, uint32_t mesh, uint32_t node,
                            const struct shape_sizes *sizes)
{
    double *spheres;
    uint32_t count;
    if (shape_sphereflake(sizes->radius, sizes->level, &spheres, &count) != WHIT_OK)
        return reader_no_memory(reader);
    bool added = true;
    for (uint32_t i = 0; added && i < count; ++i) {
        const double *s = spheres + 4 * (size_t)i, turn[4] = {0, 0, 0, 1};
        struct affine local = affine_from_trs(s, turn, (const double[3]){s[3], s[3], s[3]});
        added = add_instance(reader, name, mesh, node, &local);
    }
    free(spheres);
    return added;
}

static bool plain_material(struct reader *reader, uint32_t *index)
{
    if (reader->plain_material == SCENE_NONE) {
        struct scene_material material;
        scene_material_init(&material, "default");
        reader->plain_material = scene_add_material(reader->scene, material);
    }
    *index = reader->plain_material;
    return *index != SCENE_NONE || reader_no_memory(reader);
}

/* *index keeps SCENE_NONE when the object names no material. */
static bool read_material(struct reader *reader, const struct place *place, const json_t *object,
                          uint32_t *index)
{
    const json_t *value = json_object_get(object, "material");
    struct place here = {place, "material", 0};
    *index = SCENE_NONE;
    return !value || reader_material_use(reader, &here, value, index);
}

static bool read_shape(struct reader *reader, const struct place *place, const json_t *object,
                       enum shape shape, const char *name, uint32_t node)
{
    struct shape_sizes sizes;
    uint32_t material, mesh = SCENE_NONE;
    if (!read_sizes(reader, place, object, shape, &sizes) ||
        !read_material(reader, place, object, &material) ||
        (material == SCENE_NONE && !plain_material(reader, &material)))
        return false;
    if (shape == SHAPE_BALLS) {
        if (!read_balls(reader, place, object, material, &mesh))
            return false;
    } else if (!shared_mesh(reader, place, shape, &sizes, material, &mesh)) {
        return false;
    }
    if (shape == SHAPE_SPHEREFLAKE && !sizes.balls)
        return add_sphereflake(reader, name, mesh, node, &sizes);
    return add_instance(reader, name, mesh, node, NULL);
}

static uint32_t moved_node(const struct model_cache *range, uint32_t node, uint32_t parent,
                           uint32_t first)
{
    if (node == range->parent)
        return parent;
    return node == SCENE_NONE ? node : node - range->first_node + first;
}

static bool copy_channel(struct reader *reader, struct scene_channel channel, uint32_t node)
{
    size_t values = channel.key_count * (channel.path == SCENE_PATH_ROTATION ? 4u : 3u) *
                    (channel.interpolation == SCENE_CUBIC ? (size_t)3 : 1);
    float *times = array_alloc(channel.key_count, sizeof *times);
    float *copies = array_alloc(values, sizeof *copies);
    if (!times || !copies) {
        free(times);
        free(copies);
        return reader_no_memory(reader);
    }
    memcpy(times, channel.times_s, channel.key_count * sizeof *times);
    memcpy(copies, channel.values, values * sizeof *copies);
    channel.node = node;
    channel.times_s = times;
    channel.values = copies;
    return scene_add_channel(reader->scene, channel) != SCENE_NONE || reader_no_memory(reader);
}

/* The nodes, instances and channels of `range` once more, below `parent`. */
static bool copy_range(struct reader *reader, const struct place *place,
                       const struct model_cache *range, uint32_t parent)
{
    struct scene *scene = reader->scene;
    uint32_t first = scene->node_count;
    if (scene->instance_count + (uint64_t)(range->instance_end - range->first_instance) >
            INSTANCES_MOST ||
        first + (uint64_t)(range->node_end - range->first_node) > INSTANCES_MOST)
        return reader_fail(reader, place, "more than %u instances", INSTANCES_MOST);
    for (uint32_t i = range->first_node; i < range->node_end; ++i) {
        struct scene_node node = scene->nodes[i];
        node.name = string_copy(node.name);
        node.parent = moved_node(range, node.parent, parent, first);
        if (scene_add_node(scene, node) == SCENE_NONE)
            return reader_no_memory(reader);
    }
    for (uint32_t i = range->first_instance; i < range->instance_end; ++i) {
        struct scene_instance instance = scene->instances[i];
        instance.name = string_copy(instance.name);
        instance.node = moved_node(range, instance.node, parent, first);
        if (scene_add_instance(scene, instance) == SCENE_NONE)
            return reader_no_memory(reader);
    }
    for (uint32_t i = range->first_channel; i < range->channel_end; ++i) {
        uint32_t node = moved_node(range, scene->channels[i].node, parent, first);
        if (!copy_channel(reader, scene->channels[i], node))
            return false;
    }
    return true;
}

static struct model_cache begin_range(const struct scene *scene, uint32_t parent)
{
    return (struct model_cache){
        .parent = parent,
        .first_node = scene->node_count,
        .first_instance = scene->instance_count,
        .first_channel = scene->channel_count,
    };
}

static void end_range(const struct scene *scene, struct model_cache *range)
{
    range->node_end = scene->node_count;
    range->instance_end = scene->instance_count;
    range->channel_end = scene->channel_count;
}

static bool load_new_model(struct reader *reader, const struct place *place, const char *path,
                           uint32_t node, uint32_t material, bool lights, bool cameras)
{
    struct scene *scene = reader->scene;
    uint32_t first_mesh = scene->mesh_count;
    struct place here = {place, "model", 0};
    if (!file_exists(path))
        return reader_fail(reader, &here, "there is no file `%s`", path);
    whit_result result = load_model(scene, path, node, lights, cameras, reader->params);
    if (result != WHIT_OK) {
        reader->result = result;
        return false;
    }
    for (uint32_t i = first_mesh; material != SCENE_NONE && i < scene->mesh_count; ++i) {
        struct scene_mesh *mesh = &scene->meshes[i];
        for (uint32_t t = 0; t < mesh->triangle_count; ++t)
            mesh->materials[t] = material;
    }
    return true;
}

/* A model that was placed before is not read again: its meshes get more instances. */
static bool place_model(struct reader *reader, const struct place *place, const char *path,
                        uint32_t node, uint32_t material, bool lights, bool cameras)
{
    char *key = string_format("%u %d %d %s", material, lights, cameras, path);
    if (!key)
        return reader_no_memory(reader);
    for (uint32_t i = 0; !lights && !cameras && i < reader->model_count; ++i) {
        if (strcmp(reader->models[i].key, key) == 0) {
            free(key);
            return copy_range(reader, place, &reader->models[i], node);
        }
    }
    struct model_cache range = begin_range(reader->scene, node);
    if (!load_new_model(reader, place, path, node, material, lights, cameras)) {
        free(key);
        return false;
    }
    end_range(reader->scene, &range);
    range.key = key;
    if (ARRAY_PUSH(reader->models, reader->model_count, reader->model_capacity, range))
        return true;
    free(key);
    return reader_no_memory(reader);
}

static bool has_extension_of_model(const char *path)
{
    static const char *const known[] = {"obj", "gltf", "glb", "ply", "stl"};
    char extension[16];
    path_extension(path, extension, sizeof extension);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
        if (strcmp(extension, known[i]) == 0)
            return true;
    }
    return false;
}

static bool read_model(struct reader *reader, const struct place *place, const json_t *object,
                       uint32_t node)
{
    const char *name = NULL;
    bool lights = false, cameras = false;
    uint32_t material;
    struct place here = {place, "model", 0};
    if (!reader_string(reader, place, object, "model", &name) ||
        !reader_bool(reader, place, object, "lights", &lights) ||
        !reader_bool(reader, place, object, "cameras", &cameras) ||
        !read_material(reader, place, object, &material))
        return false;
    if (!has_extension_of_model(name))
        return reader_fail(reader, &here, "`%s` is no model; whit reads .obj .gltf .glb .ply .stl",
                           name);
    char *path = path_beside(reader->path, name);
    if (!path)
        return reader_no_memory(reader);
    bool placed = place_model(reader, place, path, node, material, lights, cameras);
    free(path);
    return placed;
}

static bool read_matrix(struct reader *reader, const struct place *place, const json_t *object,
                        struct scene_node *node)
{
    static const char *const others[] = {"translation", "rotation", "quaternion", "scale",
                                         "animation"};
    struct place here = {place, "matrix", 0};
    if (!json_object_get(object, "matrix"))
        return true;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        if (json_object_get(object, others[i]))
            return reader_fail(reader, &here, "`matrix` and `%s` exclude each other", others[i]);
    }
    node->has_matrix = true;
    return reader_numbers(reader, place, object, "matrix", 12, node->matrix.m);
}

static bool read_scale(struct reader *reader, const struct place *place, const json_t *object,
                       double out[3])
{
    const json_t *value = json_object_get(object, "scale");
    struct place here = {place, "scale", 0};
    if (!json_is_number(value)) {
        if (!reader_numbers(reader, place, object, "scale", 3, out))
            return false;
    } else {
        if (!reader_number(reader, place, object, "scale", -1e15, 1e15, &out[0]))
            return false;
        out[1] = out[2] = out[0];
    }
    if (out[0] == 0.0 || out[1] == 0.0 || out[2] == 0.0)
        return reader_fail(reader, &here, "a scale of 0 leaves nothing");
    return true;
}

static bool read_transform(struct reader *reader, const struct place *place, const json_t *object,
                           struct scene_node *node)
{
    double degrees[3] = {0, 0, 0};
    struct place at_turn = {place, "quaternion", 0};
    if (!read_matrix(reader, place, object, node) ||
        !reader_numbers(reader, place, object, "translation", 3, node->translation) ||
        !reader_numbers(reader, place, object, "rotation", 3, degrees) ||
        !read_scale(reader, place, object, node->scale))
        return false;
    reader_quaternion(degrees, node->rotation);
    if (!json_object_get(object, "quaternion"))
        return true;
    if (json_object_get(object, "rotation"))
        return reader_fail(reader, &at_turn, "`quaternion` and `rotation` exclude each other");
    if (!reader_numbers(reader, place, object, "quaternion", 4, node->rotation))
        return false;
    double length = 0.0;
    for (int i = 0; i < 4; ++i)
        length += node->rotation[i] * node->rotation[i];
    return length > 0.0 || reader_fail(reader, &at_turn, "all zero is no rotation");
}

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
    if (count[0] * count[1] * count[2] > INSTANCES_MOST)
        return reader_fail(reader, &at_count, "more than %u copies", INSTANCES_MOST);
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
    if (!read_transform(reader, place, object, &node)) {
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
    if (shape < SHAPE_COUNT && !read_shape(reader, place, object, (enum shape)shape, name, node))
        return false;
    if (model && !read_model(reader, place, object, node))
        return false;
    return !children || reader_objects(reader, &at_children, children, node, depth + 1);
}

/* Keys of other kinds of objects: a sphere has no tube. */
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
    struct model_cache range = begin_range(reader->scene, cell);
    if (!read_content(reader, place, object, cell, depth))
        return false;
    end_range(reader->scene, &range);
    for (uint32_t i = 1; i < cells; ++i) {
        if (!add_cell(reader, &repeat, i, parent, &cell) ||
            !copy_range(reader, place, &range, cell))
            return false;
    }
    return true;
}

bool reader_objects(struct reader *reader, const struct place *place, const json_t *value,
                    uint32_t parent, uint32_t depth)
{
    if (depth > DEPTH_MOST)
        return reader_fail(reader, place, "children more than %u deep", DEPTH_MOST);
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
