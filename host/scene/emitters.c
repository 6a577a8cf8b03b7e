/* Emissive surfaces as lights. A few flat ones become triangle and rectangle lights, which the
   kernel samples at as many points as the settings say. Lamps of many triangles become at most
   SAMPLES_MAX point samples, spread evenly over their emitted power. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/color.h"
#include "base/vec.h"
#include "scene/freeze.h"

#define SAMPLES_MAX   16
/* The most flat lights: each costs a shadow ray per light sample, 16 by default, at every lit
   point. */
#define FLAT_MAX      8
/* Two triangles merge into a parallelogram if their corners are off by at most this share of a
   side's length. */
#define CORNER_SLACK  1e-5
#define TRIANGLES_MAX (4u << 20)
/* Emitted power per area of the great circle of the scene's bounding sphere. Below it emission is
   decoration and makes no lights: the lamps of a car do not replace daylight. */
#define POWER_MIN     0.004

struct emitter {
    uint32_t instance, material, triangle;
    double power; /* world area * luminance */
};

struct emitter_list {
    struct emitter *items;
    uint32_t count, capacity;
    double power;
};

/* The share of its emission that a surface sends, by the material's opacity. Textures and vertex
   colours, which may make it less, do not count. */
static double sent_share(const struct scene_material *material)
{
    double opacity = (double)material->opacity;
    if (material->alpha == SCENE_ALPHA_BLEND)
        return fmin(fmax(opacity, 0.0), 1.0);
    return material->alpha == SCENE_ALPHA_MASK && material->opacity < material->alpha_cutoff ? 0.0
                                                                                             : 1.0;
}

/* Whether a material's surfaces become lights. Textured emission does not: signs and screens glow,
   but are no lamps of the texture's average colour. */
static bool lights_up(const struct scene_material *material)
{
    return material->model != WHIT_MODEL_UNLIT && color_luminance(material->emission) > 0.0 &&
           sent_share(material) > 0.0 &&
           material->textures[SCENE_SLOT_EMISSION].texture == SCENE_NONE;
}

/* Gives twice the triangle's area; *out is its normal, with that as its length. */
static double normal_of(double corners[3][3], double out[3])
{
    double a[3], b[3];
    double3_sub(corners[1], corners[0], a);
    double3_sub(corners[2], corners[0], b);
    double3_cross(a, b, out);
    return double3_length(out);
}

static bool gather_instance(const struct scene *scene, const struct scene_pose *pose,
                            uint32_t instance, struct emitter_list *list)
{
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[instance].mesh];
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        const struct scene_material *material = &scene->materials[mesh->materials[t]];
        if (!lights_up(material))
            continue;
        double corners[3][3], normal[3];
        scene_mesh_placed_corners(mesh, t, &pose->instances[instance], corners);
        double power = 0.5 * normal_of(corners, normal) * color_luminance(material->emission) *
                       sent_share(material);
        if (!(power > 0.0) || !isfinite(power))
            continue;
        struct emitter emitter = {instance, mesh->materials[t], t, power};
        if (list->count == TRIANGLES_MAX ||
            !ARRAY_PUSH(list->items, list->count, list->capacity, emitter))
            return false;
        list->power += power;
    }
    return true;
}

static int compare_emitters(const void *a, const void *b)
{
    const struct emitter *x = a, *y = b;
    if (x->instance != y->instance)
        return x->instance < y->instance ? -1 : 1;
    if (x->material != y->material)
        return x->material < y->material ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static double radical_inverse(uint32_t i)
{
    double result = 0.0, digit = 0.5;
    for (; i; i >>= 1, digit *= 0.5)
        result += (i & 1) * digit;
    return result;
}

/* Uniform over the triangle from two numbers in [0, 1). */
static void point_in(double corners[3][3], double u, double v, double out[3])
{
    double root = sqrt(u);
    for (int i = 0; i < 3; ++i)
        out[i] = corners[0][i] * (1.0 - root) + corners[1][i] * root * (1.0 - v) +
                 corners[2][i] * root * v;
}

/* A light with the fields that all lights of this emitter's material share. */
static struct scene_light light_of(struct scene *scene, const struct emitter *emitter)
{
    const struct scene_material *material = &scene->materials[emitter->material];
    char *name = string_format("emission of `%s`", material->name ? material->name : "");
    scene->lacks_memory |= !name;
    return (struct scene_light){
        .name = name,
        .origin = {.file = scene_text(scene, material->origin.file), .line = material->origin.line},
        .node = scene->instances[emitter->instance].node,
        .falloff = true,
        .versine_outer = 1.0f,
        /* Winding gives the lit side only in glTF: OBJ files wind their lamps either way. */
        .two_sided = material->two_sided || material->model != WHIT_MODEL_METAL_ROUGH,
        .made_by_whit = true,
    };
}

static struct affine local_of(const struct scene_instance *instance)
{
    return instance->has_local ? instance->local : affine_identity();
}

static bool add_sample(struct scene *scene, const struct emitter *emitter, double u, double v,
                       double power)
{
    const struct scene_instance *instance = &scene->instances[emitter->instance];
    const struct scene_material *material = &scene->materials[emitter->material];
    struct affine local = local_of(instance);
    struct scene_light light = light_of(scene, emitter);
    light.kind = WHIT_LIGHT_AREA_SAMPLE;
    double corners[3][3], normal[3];
    scene_mesh_placed_corners(&scene->meshes[instance->mesh], emitter->triangle, &local, corners);
    double twice_area = normal_of(corners, normal);
    double side = affine_determinant(&local) < 0.0 ? -1.0 : 1.0;
    /* A one-sided sample lies a little above its surface, which would otherwise shadow it. */
    double lift = light.two_sided ? 0.0 : 1e-4 * sqrt(twice_area);
    point_in(corners, u, v, light.position);
    for (int i = 0; i < 3; ++i) {
        light.direction[i] = twice_area > 0.0 ? side * normal[i] / twice_area : -(double)(i == 1);
        light.position[i] += lift * light.direction[i];
        light.color[i] = (float)((double)material->emission[i] /
                                 color_luminance(material->emission) * power / PI);
    }
    return scene_add_light(scene, light) != SCENE_NONE;
}

/* Adds `samples` lights at even steps of accumulated power over `count` emitters. */
static bool sample_run(struct scene *scene, const struct emitter *run, uint32_t count,
                       uint32_t samples)
{
    double total = 0.0;
    for (uint32_t i = 0; i < count; ++i)
        total += run[i].power;
    double before = 0.0;
    uint32_t at = 0;
    for (uint32_t i = 0; i < samples; ++i) {
        double target = ((double)i + 0.5) / samples * total;
        while (at + 1 < count && before + run[at].power <= target)
            before += run[at++].power;
        double u = fmin((target - before) / run[at].power, 1.0);
        double v = fmod(radical_inverse(i) + 0.5 / samples, 1.0);
        if (!add_sample(scene, &run[at], u, v, total / samples))
            return false;
    }
    return true;
}

static uint32_t run_length(const struct emitter_list *list, uint32_t first)
{
    uint32_t end = first + 1;
    while (end < list->count && list->items[end].instance == list->items[first].instance &&
           list->items[end].material == list->items[first].material)
        ++end;
    return end - first;
}

static uint32_t count_runs(const struct emitter_list *list)
{
    uint32_t runs = 0;
    for (uint32_t i = 0; i < list->count; i += run_length(list, i))
        ++runs;
    return runs;
}

/* Every run of emitters (run_length) gets one sample and, by its power, a share of the rest. More
   than SAMPLES_MAX runs are sampled as one. */
static bool sample_all(struct scene *scene, const struct emitter_list *list)
{
    uint32_t runs = count_runs(list);
    if (runs > SAMPLES_MAX)
        return sample_run(scene, list->items, list->count, SAMPLES_MAX);
    for (uint32_t i = 0, length; i < list->count; i += length) {
        length = run_length(list, i);
        double power = 0.0;
        for (uint32_t k = 0; k < length; ++k)
            power += list->items[i + k].power;
        uint32_t samples = 1 + (uint32_t)((SAMPLES_MAX - runs) * power / list->power + 1e-9);
        if (!sample_run(scene, list->items + i, length, samples))
            return false;
    }
    return true;
}

/* ---- Flat lights ---- */

/* A triangle, or the parallelogram of a corner and two sides. */
struct flat {
    const struct emitter *emitter;
    double corner[3], sides[2][3];
    bool rectangle;
};

static void make_flat(const struct scene *scene, const struct emitter *emitter, struct flat *out)
{
    const struct scene_instance *instance = &scene->instances[emitter->instance];
    struct affine local = local_of(instance);
    double corners[3][3];
    scene_mesh_placed_corners(&scene->meshes[instance->mesh], emitter->triangle, &local, corners);
    bool mirrored = affine_determinant(&local) < 0.0;
    *out = (struct flat){.emitter = emitter};
    memcpy(out->corner, corners[0], sizeof out->corner);
    double3_sub(corners[1], corners[0], out->sides[mirrored]);
    double3_sub(corners[2], corners[0], out->sides[!mirrored]);
}

/* Corner `k`, 0 to 2, of a flat that is a triangle. */
static void flat_corner(const struct flat *flat, int k, double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = flat->corner[i] + (k ? flat->sides[k - 1][i] : 0.0);
}

/* Whether triangle `b`, with its corners counted from `turn` on, is `a` rotated by 180 degrees
   about the middle of the side opposite corner `k`: together they are a parallelogram whose
   `corner` is corner k. */
static bool is_other_half(const struct flat *a, int k, const struct flat *b, int turn)
{
    double at[3][3], other[3][3], far[3];
    for (int i = 0; i < 3; ++i) {
        flat_corner(a, (k + i) % 3, at[i]);
        flat_corner(b, (turn + i) % 3, other[i]);
    }
    for (int i = 0; i < 3; ++i)
        far[i] = at[1][i] + at[2][i] - at[0][i];
    double slack = CORNER_SLACK * double3_distance(at[1], at[2]);
    return double3_distance(other[0], far) <= slack && double3_distance(other[1], at[2]) <= slack &&
           double3_distance(other[2], at[1]) <= slack;
}

/* Makes `a` the parallelogram of both, where they form one; else gives false. */
static bool merge_flats(struct flat *a, const struct flat *b)
{
    if (a->rectangle || a->emitter->instance != b->emitter->instance ||
        a->emitter->material != b->emitter->material)
        return false;
    for (int k = 0; k < 9; ++k) {
        double corners[3][3];
        if (!is_other_half(a, k / 3, b, k % 3))
            continue;
        for (int i = 0; i < 3; ++i)
            flat_corner(a, (k / 3 + i) % 3, corners[i]);
        memcpy(a->corner, corners[0], sizeof a->corner);
        double3_sub(corners[1], corners[0], a->sides[0]);
        double3_sub(corners[2], corners[0], a->sides[1]);
        a->rectangle = true;
        return true;
    }
    return false;
}

/* Collects triangles and parallelograms of all emitters; false: there are more than FLAT_MAX. */
static bool gather_flats(const struct scene *scene, const struct emitter_list *list,
                         struct flat *flats, uint32_t *count)
{
    *count = 0;
    for (uint32_t i = 0; i < list->count; ++i) {
        struct flat flat;
        make_flat(scene, &list->items[i], &flat);
        bool merged = false;
        for (uint32_t k = 0; !merged && k < *count; ++k)
            merged = merge_flats(&flats[k], &flat);
        /* Up to 2 * FLAT_MAX meanwhile: triangles that follow may merge with these. */
        if (!merged && *count == 2 * FLAT_MAX)
            return false;
        if (!merged)
            flats[(*count)++] = flat;
    }
    return *count <= FLAT_MAX;
}

static bool add_flats(struct scene *scene, const struct flat *flats, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        struct scene_light light = light_of(scene, flats[i].emitter);
        light.kind = flats[i].rectangle ? WHIT_LIGHT_RECTANGLE : WHIT_LIGHT_TRIANGLE;
        double corners[3][3] = {{0}}, normal[3];
        memcpy(light.position, flats[i].corner, sizeof light.position);
        memcpy(light.edge_u, flats[i].sides[0], sizeof light.edge_u);
        memcpy(light.edge_v, flats[i].sides[1], sizeof light.edge_v);
        memcpy(corners[1], light.edge_u, sizeof corners[1]);
        memcpy(corners[2], light.edge_v, sizeof corners[2]);
        double length = normal_of(corners, normal);
        for (int k = 0; k < 3; ++k)
            light.direction[k] = length > 0.0 ? normal[k] / length : -(double)(k == 1);
        const struct scene_material *material = &scene->materials[flats[i].emitter->material];
        for (int k = 0; k < 3; ++k)
            light.color[k] = (float)((double)material->emission[k] * sent_share(material));
        if (scene_add_light(scene, light) == SCENE_NONE)
            return false;
    }
    return true;
}

static bool power_suffices(const struct emitter_list *list, const struct scene_pose *pose)
{
    double diagonal2 = 0.0;
    for (int i = 0; i < 3; ++i)
        diagonal2 += (pose->hi[i] - pose->lo[i]) * (pose->hi[i] - pose->lo[i]);
    return list->power >= POWER_MIN * PI * diagonal2 / 4.0;
}

whit_result freeze_sample_emitters(struct scene *scene, const struct scene_pose *pose,
                                   uint32_t *added)
{
    struct emitter_list list = {0};
    uint32_t before = scene->light_count;
    whit_result result = WHIT_OK;
    *added = 0;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        if (gather_instance(scene, pose, i, &list))
            continue;
        if (list.count == TRIANGLES_MAX) {
            scene_note(scene, SCENE_NOTE_WARNING,
                       "more than %u emissive triangles: they are not sampled as lights",
                       TRIANGLES_MAX);
            goto done;
        }
        result = WHIT_ERROR_MEMORY;
        goto done;
    }
    if (!list.count || !power_suffices(&list, pose))
        goto done;
    qsort(list.items, list.count, sizeof *list.items, compare_emitters);
    struct flat flats[2 * FLAT_MAX];
    uint32_t flat_count;
    bool flat = gather_flats(scene, &list, flats, &flat_count);
    if (flat ? !add_flats(scene, flats, flat_count) : !sample_all(scene, &list))
        result = WHIT_ERROR_MEMORY;
    *added = scene->light_count - before;
done:
    free(list.items);
    return result;
}
