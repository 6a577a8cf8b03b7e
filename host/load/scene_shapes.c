/* Objects of a scene file that are shapes, which are made by formula from a few sizes. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "load/scene_materials.h"
#include "load/scene_objects.h"
#include "scene/afford.h"
#include "scene/shapes.h"

#define SHAPE_SIZE_MAX 1e15
#define SPHERES_MAX    10000000u

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

const char *const shape_names[SHAPE_COUNT + 1] = {
    "box",     "plane",   "sphere", "icosphere",   "torus", "cylinder", "cone",
    "terrain", "strands", "atrium", "sphereflake", "ball",  "balls",    NULL};
const char *const *const shape_keys[SHAPE_COUNT] = {
    box_keys,     plane_keys,   sphere_keys, icosphere_keys, torus_keys, cylinder_keys, cone_keys,
    terrain_keys, strands_keys, atrium_keys, flake_keys,     ball_keys,  balls_keys};

/* Reads "size": one number for all sides, or one for each. */
static bool read_size(struct reader *reader, const struct place *place, const json_t *object,
                      size_t count, double *out)
{
    struct place here = {place, "size", 0};
    if (!reader_extent(reader, place, object, "size", 1e-15, SHAPE_SIZE_MAX, count, out))
        return false;
    for (size_t i = 0; i < count; ++i) {
        if (!(out[i] > 0.0 && out[i] <= SHAPE_SIZE_MAX))
            return reader_fail(reader, &here, "every side must be over 0 and at most %g",
                               SHAPE_SIZE_MAX);
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
    uint32_t steps_max = shape == SHAPE_TERRAIN ? 4096 : 2048;
    uint32_t level_min = shape == SHAPE_ATRIUM ? 1 : 0;
    uint32_t level_max = shape == SHAPE_SPHEREFLAKE ? 6 : 8;
    if (!read_size(reader, place, object, size_count, out->size) ||
        !reader_number(reader, place, object, "radius", 1e-15, SHAPE_SIZE_MAX, &out->radius) ||
        !reader_numbers(reader, place, object, "center", 3, out->center) ||
        !reader_bool(reader, place, object, "balls", &out->balls))
        return false;
    out->radius_top = out->radius;
    return reader_number(reader, place, object, "radius_top", 0.0, SHAPE_SIZE_MAX,
                         &out->radius_top) &&
           reader_number(reader, place, object, "tube", 1e-15, SHAPE_SIZE_MAX, &out->tube) &&
           reader_number(reader, place, object, "height", 1e-15, SHAPE_SIZE_MAX, &out->height) &&
           reader_number(reader, place, object, "length", 1e-15, SHAPE_SIZE_MAX, &out->length) &&
           reader_number(reader, place, object, "width", 1e-15, SHAPE_SIZE_MAX, &out->width) &&
           reader_number(reader, place, object, "uv_scale", -1e6, 1e6, &out->uv_scale) &&
           reader_count(reader, place, object, "segments", 3, 4096, &out->segments) &&
           reader_count(reader, place, object, "rings", 2, 4096, &out->rings) &&
           reader_count(reader, place, object, "sides", 3, 4096, &out->sides) &&
           reader_count(reader, place, object, "steps", 1, steps_max, &out->steps) &&
           reader_count(reader, place, object, "level", level_min, level_max, &out->level) &&
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
    case SHAPE_BALLS: /* made by read_balls */
    case SHAPE_COUNT:
        break;
    }
    return WHIT_ERROR_USAGE;
}

static uint64_t balls_of(const struct shape_sizes *s)
{
    uint64_t count = 1;
    for (uint32_t i = 0; i < s->level; ++i)
        count = 9 * count + 1;
    return count;
}

/* An upper bound of a shape's triangles; for an atrium an estimate. */
static uint64_t triangles_of(enum shape shape, const struct shape_sizes *s)
{
    uint64_t level = s->level, segments = s->segments;
    switch (shape) {
    case SHAPE_PLANE:
    case SHAPE_TERRAIN:
        return 2 * (uint64_t)s->steps * s->steps;
    case SHAPE_SPHERE:
    case SHAPE_SPHEREFLAKE:
        return 2 * segments * s->rings;
    case SHAPE_ICOSPHERE:
        return UINT64_C(20) << 2 * level;
    case SHAPE_TORUS:
        return 2 * segments * s->sides;
    case SHAPE_STRANDS:
        return 4 * (uint64_t)s->count;
    case SHAPE_ATRIUM:
        return (s->bays + UINT64_C(1)) * level * (2200 + 420 * level);
    default:
        return 4 * segments;
    }
}

static uint64_t mesh_cost(enum shape shape, const struct shape_sizes *s)
{
    uint64_t count = triangles_of(shape, s);
    bool flake = shape == SHAPE_SPHEREFLAKE && s->balls;
    return flake || shape == SHAPE_BALL ? scene_sphere_cost(flake ? balls_of(s) : 1)
                                        : scene_triangle_cost(count, count, 8 * sizeof(float));
}

/* A key that is equal for shapes that give equal meshes. */
static char *shape_key(enum shape shape, const struct shape_sizes *s, uint32_t material)
{
    return string_format("%d %u %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g "
                         "%u %u %u %u %u %u %u %u %d %.17g %.17g %.17g",
                         (int)shape, material, s->size[0], s->size[1], s->size[2], s->radius,
                         s->radius_top, s->tube, s->height, s->length, s->width, s->uv_scale,
                         s->segments, s->rings, s->sides, s->steps, s->level, s->seed, s->count,
                         s->bays, s->balls, s->center[0], s->center[1], s->center[2]);
}

/* Adds a mesh with one material. Takes ownership of the mesh's arrays. */
static bool add_dressed(struct reader *reader, enum shape shape, struct scene_mesh mesh,
                        uint32_t material, uint32_t *index)
{
    mesh.name = scene_text(reader->scene, shape_names[shape]);
    for (uint32_t i = 0; i < scene_mesh_primitives(&mesh); ++i)
        mesh.materials[i] = material;
    *index = scene_add_mesh(reader->scene, mesh);
    return *index != SCENE_NONE || reader_no_memory(reader);
}

static bool add_mesh(struct reader *reader, const struct place *place, enum shape shape,
                     const struct shape_sizes *sizes, uint32_t material, uint32_t *index)
{
    struct scene_mesh mesh = {0};
    if (!reader_afford(reader, place, mesh_cost(shape, sizes), "its %s", shape_names[shape]))
        return false;
    whit_result result = make_mesh(shape, sizes, &mesh);
    if (result == WHIT_ERROR_MEMORY)
        return reader_no_memory(reader);
    if (result != WHIT_OK)
        return reader_fail(reader, place, "these sizes make no %s", shape_names[shape]);
    return add_dressed(reader, shape, mesh, material, index);
}

/* Reads "spheres": [[x, y, z, radius], ...] into one mesh. */
static bool read_balls(struct reader *reader, const struct place *place, const json_t *object,
                       uint32_t material, uint32_t *index)
{
    const json_t *value = json_object_get(object, "spheres");
    struct place here = {place, "spheres", 0};
    size_t count = json_is_array(value) ? json_array_size(value) : 0;
    if (count == 0 || count > SPHERES_MAX)
        return reader_fail(reader, &here, "1 to %u spheres [x, y, z, radius] are expected",
                           SPHERES_MAX);
    double *spheres = array_alloc(count, 4 * sizeof *spheres);
    bool good = spheres || reader_no_memory(reader);
    for (size_t i = 0; good && i < count; ++i) {
        struct place at = {&here, NULL, i};
        double *sphere = spheres + 4 * i;
        good = reader_vector(reader, &at, json_array_get(value, i), 4, sphere);
        if (good && !(sphere[3] >= 1e-15 && sphere[3] <= SHAPE_SIZE_MAX))
            good = reader_fail(reader, &at, "the radius must be from 1e-15 to %g", SHAPE_SIZE_MAX);
    }
    struct scene_mesh mesh = {0};
    if (good && shape_balls(spheres, (uint32_t)count, &mesh) != WHIT_OK)
        good = reader_no_memory(reader);
    free(spheres);
    return good && add_dressed(reader, SHAPE_BALLS, mesh, material, index);
}

/* Gives the shape's mesh, which equal shapes share, and with it a tree. */
static bool shared_mesh(struct reader *reader, const struct place *place, enum shape shape,
                        const struct shape_sizes *sizes, uint32_t material, uint32_t *index)
{
    char *key = shape_key(shape, sizes, material);
    if (!key)
        return reader_no_memory(reader);
    size_t key_bytes = strlen(key);
    bool good =
        key_table_find(&reader->shapes, key, key_bytes, index) ||
        (add_mesh(reader, place, shape, sizes, material, index) &&
         (key_table_add(&reader->shapes, key, key_bytes, *index) || reader_no_memory(reader)));
    free(key);
    return good;
}

static bool add_instance(struct reader *reader, const char *name, uint32_t mesh, uint32_t node,
                         const struct affine *local)
{
    struct scene_instance instance = {
        .name = scene_text(reader->scene, name), .mesh = mesh, .node = node};
    if (local) {
        instance.has_local = true;
        instance.local = *local;
    }
    return scene_add_instance(reader->scene, instance) != SCENE_NONE || reader_no_memory(reader);
}

static bool add_sphereflake(struct reader *reader, const struct place *place, const char *name,
                            uint32_t mesh, uint32_t node, const struct shape_sizes *sizes)
{
    double *spheres;
    uint32_t count;
    uint64_t balls = balls_of(sizes);
    if (!reader_afford(reader, place, scene_instance_cost(balls), "its sphereflake of %llu spheres",
                       (unsigned long long)balls))
        return false;
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

bool reader_shape(struct reader *reader, const struct place *place, const json_t *object,
                  enum shape shape, const char *name, uint32_t node)
{
    struct shape_sizes sizes;
    uint32_t material, mesh = SCENE_NONE;
    if (!read_sizes(reader, place, object, shape, &sizes) ||
        !reader_object_material(reader, place, object, &material) ||
        (material == SCENE_NONE && !plain_material(reader, &material)))
        return false;
    if (shape == SHAPE_BALLS) {
        if (!read_balls(reader, place, object, material, &mesh))
            return false;
    } else if (!shared_mesh(reader, place, shape, &sizes, material, &mesh)) {
        return false;
    }
    if (shape == SHAPE_SPHEREFLAKE && !sizes.balls)
        return add_sphereflake(reader, place, name, mesh, node, &sizes);
    return add_instance(reader, name, mesh, node, NULL);
}
