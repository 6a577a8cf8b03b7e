#include "scene/fault.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/vec.h"
#include "scene/freeze.h"

/* A random number below `count`, which is above 0. */
static uint32_t draw(uint64_t *random, uint32_t count)
{
    return (uint32_t)(splitmix64(random) % count);
}

/* Moves a vertex of some triangle, or a sphere, in a random direction by `amount` times the longest
   side of the mesh's box. */
static bool move_vertex(struct scene *scene, uint64_t *random, double amount)
{
    if (!scene->mesh_count)
        return false;
    uint32_t index = draw(random, scene->mesh_count);
    struct scene_mesh *mesh = &scene->meshes[index];
    uint32_t primitive = draw(random, scene_mesh_primitives(mesh));
    float *place =
        mesh->sphere_count
            ? mesh->spheres + 4 * (size_t)primitive
            : mesh->positions + 3 * (size_t)mesh->indices[3 * (size_t)primitive + draw(random, 3)];
    double way[3], side = 0.0;
    for (int i = 0; i < 3; ++i) {
        way[i] = 2.0 * splitmix64_unit(random) - 1.0;
        side = fmax(side, (double)mesh->hi[i] - (double)mesh->lo[i]);
    }
    double3_unit(way);
    for (int i = 0; i < 3; ++i)
        place[i] = (float)((double)place[i] + amount * side * way[i]);
    scene->lacks_memory |= freeze_clean_mesh(scene, index) != WHIT_OK; /* its only error */
    return true;
}

/* Changes the index of refraction of a material that lets light through or has Fresnel reflection.
   False: the scene has none. */
static bool change_ior(struct scene *scene, uint64_t *random, double amount)
{
    uint32_t start = scene->material_count ? draw(random, scene->material_count) : 0;
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        struct scene_material *material = &scene->materials[(start + i) % scene->material_count];
        const float *through = material->transmission;
        if (!material->fresnel && !(through[0] + through[1] + through[2] > 0.0f))
            continue;
        material->ior = (float)((double)material->ior + amount);
        return true;
    }
    return false;
}

static bool brighten(float rgb[3], double amount)
{
    for (int i = 0; i < 3; ++i)
        rgb[i] = (float)((double)rgb[i] * (1.0 + amount));
    return rgb[0] + rgb[1] + rgb[2] > 0.0f;
}

/* Brightens a light by the share `amount`, or an emissive material where there is no light: one
   that is not black. */
static bool change_light(struct scene *scene, uint64_t *random, double amount)
{
    uint32_t count = scene->light_count ? scene->light_count : scene->material_count;
    uint32_t start = count ? draw(random, count) : 0;
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t k = (start + i) % count;
        float *rgb = scene->light_count ? scene->lights[k].color : scene->materials[k].emission;
        if (brighten(rgb, amount))
            return true;
    }
    return false;
}

/* Changes R, G and B of one row of texels by `amount` times 255: values below 128 up, others
   down. */
static bool change_texels(struct scene *scene, uint64_t *random, double amount)
{
    if (!scene->texture_count)
        return false;
    struct scene_texture *texture = &scene->textures[draw(random, scene->texture_count)];
    uint8_t *row = texture->rgba + 4 * (size_t)draw(random, texture->height) * texture->width;
    int by = (int)fmax(1.0, fmin(amount, 1.0) * 255.0);
    for (size_t i = 0; i < 4 * (size_t)texture->width; ++i) {
        if (i % 4 != 3)
            row[i] = (uint8_t)(row[i] < 128 ? fmin(row[i] + by, 255.0) : fmax(row[i] - by, 0.0));
    }
    return true;
}

/* Swaps the values of two materials, which keep their names, and adds `glow` to the emission of
   both. */
static bool swap_materials(struct scene *scene, uint64_t *random, double glow)
{
    if (scene->material_count < 2)
        return false;
    uint32_t i = draw(random, scene->material_count);
    uint32_t k = (i + 1 + draw(random, scene->material_count - 1)) % scene->material_count;
    struct scene_material *a = &scene->materials[i], *b = &scene->materials[k];
    const struct scene_material was_a = *a, was_b = *b;
    *a = was_b;
    *b = was_a;
    a->name = was_a.name;
    b->name = was_b.name;
    for (int c = 0; c < 3; ++c) {
        a->emission[c] += (float)glow;
        b->emission[c] += (float)glow;
    }
    return true;
}

/* Swaps two instances in the list, whose indices are the ids of hits. */
static bool swap_objects(struct scene *scene, uint64_t *random)
{
    if (scene->instance_count < 2)
        return false;
    uint32_t i = draw(random, scene->instance_count);
    uint32_t k = (i + 1 + draw(random, scene->instance_count - 1)) % scene->instance_count;
    struct scene_instance swapped = scene->instances[i];
    scene->instances[i] = scene->instances[k];
    scene->instances[k] = swapped;
    return true;
}

static bool put_fault(struct scene *scene, const whit_fault *fault)
{
    uint64_t random = fault->seed;
    switch (fault->kind) {
    case WHIT_FAULT_VERTEX:
        return move_vertex(scene, &random, fault->amount);
    case WHIT_FAULT_IOR:
        return change_ior(scene, &random, fault->amount);
    case WHIT_FAULT_LIGHT:
        return change_light(scene, &random, fault->amount);
    case WHIT_FAULT_TEXELS:
        return change_texels(scene, &random, fault->amount);
    case WHIT_FAULT_MATERIALS:
        return swap_materials(scene, &random, fault->amount);
    case WHIT_FAULT_ORDER:
        return swap_objects(scene, &random);
    case WHIT_FAULT_KINDS:
        break;
    }
    return false;
}

whit_result scene_fault(const whit_log *log, const struct scene_side *side,
                        const whit_fault *faults, uint32_t count, struct scene **out)
{
    *out = NULL;
    bool *back = calloc(side->parts->count, sizeof *back);
    whit_result result = back ? scene_mix_begin(log, side, side, back, out) : WHIT_ERROR_MEMORY;
    free(back);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        if (!put_fault(*out, &faults[i]))
            result = WHIT_ERROR_USAGE;
    }
    return scene_mix_end(result, out);
}
