/* What materials mean to traversal, and triangle records that say it. */
#include <math.h>
#include <string.h>

#include "accel/accel_inside.h"

static uint32_t optical_depth(double transmittance)
{
    double depth = transmittance > 0.0 ? -log2(transmittance) * SHADOW_DEPTH_SCALE : 1023.0;
    return depth >= 1023.0 ? 1023u : depth > 0.0 ? (uint32_t)(depth + 0.5) : 0u;
}

/* What a straight shadow ray keeps: 1 - opacity passes beside the surface, the rest through it. */
static struct material_bits material_bits(const struct scene_material *m, bool area_lights)
{
    struct material_bits bits = {.masked = m->alpha == SCENE_ALPHA_MASK};
    if (bits.masked &&
        (m->opacity < m->alpha_cutoff || m->textures[SCENE_SLOT_OPACITY].texture != SCENE_NONE ||
         m->textures[SCENE_SLOT_DIFFUSE].texture != SCENE_NONE))
        bits.flags |= TRIANGLE_CUTOUT;
    /* Surfaces that scene_freeze puts light samples on; others that glow are ordinary ones. */
    bool glows = m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0;
    if (area_lights && glows && m->model != SCENE_MODEL_UNLIT &&
        m->textures[SCENE_SLOT_EMISSION].texture == SCENE_NONE)
        bits.flags |= TRIANGLE_NO_SHADOW;
    double cover = m->alpha == SCENE_ALPHA_BLEND ? fmin(fmax((double)m->opacity, 0.0), 1.0) : 1.0;
    bool filters = false;
    for (int c = 0; c < 3; ++c) {
        double kept = 1.0 - cover + cover * (double)m->transmission[c];
        filters |= kept > 0.0;
        bits.shadow |= optical_depth(kept) << (10 * c);
    }
    bool glassy = m->transmission[0] > 0 || m->transmission[1] > 0 || m->transmission[2] > 0;
    if (m->one_sided && !glassy)
        bits.flags |= TRIANGLE_ONE_SIDED;
    if (filters)
        bits.flags |= TRIANGLE_FILTER;
    else
        bits.shadow = 0;
    return bits;
}

void material_bits_scan(const struct scene *scene, struct material_bits *out)
{
    bool area_lights = false;
    for (uint32_t i = 0; i < scene->light_count; ++i)
        area_lights |= scene->lights[i].kind == SCENE_LIGHT_AREA_SAMPLE ||
                       (scene->lights[i].made_by_whit && scene_light_is_flat(&scene->lights[i]));
    for (uint32_t i = 0; i < scene->material_count; ++i)
        out[i] = material_bits(&scene->materials[i], area_lights);
}

void material_bits_whole(const struct scene *scene, const struct material_bits *materials,
                         const struct scene_mesh *mesh, uint8_t *whole)
{
    for (uint32_t i = 0; i < scene_mesh_primitives(mesh); ++i) {
        uint32_t material = mesh->materials ? mesh->materials[i] : 0;
        bool filters =
            material < scene->material_count && (materials[material].flags & TRIANGLE_FILTER) != 0;
        whole[i] = mesh->sphere_count || filters;
    }
}

struct gpu_triangle material_bits_record(const struct scene *scene,
                                         const struct material_bits *materials,
                                         const struct scene_mesh *mesh, uint32_t primitive)
{
    struct gpu_triangle out = {.primitive = primitive};
    if (mesh->sphere_count) {
        const float *sphere = &mesh->spheres[4 * (size_t)primitive];
        memcpy(out.v0, sphere, sizeof out.v0);
        out.v1[0] = out.v2[0] = sphere[3];
        out.flags = TRIANGLE_SPHERE;
    } else {
        const uint32_t *corner = &mesh->indices[3 * (size_t)primitive];
        memcpy(out.v0, &mesh->positions[3 * (size_t)corner[0]], sizeof out.v0);
        memcpy(out.v1, &mesh->positions[3 * (size_t)corner[1]], sizeof out.v1);
        memcpy(out.v2, &mesh->positions[3 * (size_t)corner[2]], sizeof out.v2);
    }
    uint32_t material = mesh->materials ? mesh->materials[primitive] : 0;
    if (material < scene->material_count) {
        const struct material_bits *bits = &materials[material];
        out.flags |= bits->flags | (bits->masked && mesh->colors ? TRIANGLE_CUTOUT : 0);
        out.shadow = bits->shadow;
    }
    return out;
}
