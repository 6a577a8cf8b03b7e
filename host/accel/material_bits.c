/* Derives from materials the flags that traversal needs, and writes them into triangle records. */
#include <math.h>
#include <string.h>

#include "base/same.h"

#include "accel/material_bits.h"

static uint32_t optical_depth(double transmittance)
{
    double depth = transmittance > 0.0 ? -same_log2(transmittance) * SHADOW_DEPTH_SCALE : 1023.0;
    return depth >= 1023.0 ? 1023u : depth > 0.0 ? (uint32_t)(depth + 0.5) : 0u;
}

static bool any_channel(const float rgb[3])
{
    return rgb[0] > 0.0f || rgb[1] > 0.0f || rgb[2] > 0.0f;
}

static bool has_texture(const struct scene_material *m, enum scene_slot slot)
{
    return m->textures[slot].texture != SCENE_NONE;
}

/* Sets how much light a straight shadow ray keeps: 1 - opacity passes beside the surface, the rest
   through the material. Where it depends on textures, vertex colours or absorption, the kernel
   computes it at each hit (see bind/filter.glsl); `shadow` is then the value for white textures and
   colours and no absorption. */
static void filter_bits(const struct scene_material *m, bool colors, struct material_bits *bits)
{
    bool metal_rough = m->model == WHIT_MODEL_METAL_ROUGH, filters = false;
    bool glassy = any_channel(m->transmission), blends = m->alpha == SCENE_ALPHA_BLEND;
    bool tints = metal_rough && (colors || has_texture(m, SCENE_SLOT_DIFFUSE) ||
                                 has_texture(m, SCENE_SLOT_METAL_ROUGH));
    bool absorbs = any_channel(m->absorption) && !m->thin_walled;
    bool varies = blends && (colors || has_texture(m, SCENE_SLOT_OPACITY) ||
                             has_texture(m, SCENE_SLOT_DIFFUSE));
    bool patterned = varies || (glassy && (tints || has_texture(m, SCENE_SLOT_TRANSMISSION)));
    bool detail = patterned || (glassy && absorbs);
    double cover = blends ? fmin(fmax((double)m->opacity, 0.0), 1.0) : 1.0;
    uint32_t shadow = 0;
    for (int c = 0; c < 3; ++c) {
        double passes = (double)m->transmission[c];
        if (metal_rough)
            passes *= (double)m->diffuse[c] * (1.0 - (double)m->metallic);
        double kept = 1.0 - cover + cover * passes;
        filters |= kept > 0.0;
        shadow |= optical_depth(kept) << (10 * c);
    }
    if (filters || varies) {
        bits->flags |= TRIANGLE_FILTER | (detail ? TRIANGLE_FILTER_DETAIL : 0);
        bits->shadow = shadow;
        bits->patterned = patterned;
    }
}

static struct material_bits material_bits(const struct scene_material *m, bool area_lights,
                                          bool colors)
{
    struct material_bits bits = {.masked = m->alpha == SCENE_ALPHA_MASK};
    if (bits.masked && (m->opacity < m->alpha_cutoff || colors ||
                        has_texture(m, SCENE_SLOT_OPACITY) || has_texture(m, SCENE_SLOT_DIFFUSE)))
        bits.flags |= TRIANGLE_CUTOUT;
    /* scene_freeze makes area lights of these surfaces; other surfaces that emit cast shadows. */
    if (area_lights && any_channel(m->emission) && m->model != WHIT_MODEL_UNLIT &&
        !has_texture(m, SCENE_SLOT_EMISSION))
        bits.flags |= TRIANGLE_NO_SHADOW;
    if (m->shadow_catcher) /* a shadow catcher only shows the shadows of others */
        bits.flags |= TRIANGLE_NO_SHADOW;
    if (m->one_sided && !any_channel(m->transmission))
        bits.flags |= TRIANGLE_ONE_SIDED;
    if (any_channel(m->transmission))
        bits.flags |= TRIANGLE_GLASS;
    filter_bits(m, colors, &bits);
    return bits;
}

static bool has_area_lights(const struct scene *scene)
{
    bool area_lights = false;
    for (uint32_t i = 0; i < scene->light_count; ++i)
        area_lights |= scene->lights[i].kind == WHIT_LIGHT_AREA_SAMPLE ||
                       (scene->lights[i].made_by_whit && scene_light_is_flat(&scene->lights[i]));
    return area_lights;
}

static bool has_colors(const struct scene *scene)
{
    bool colors = false;
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        colors |= scene->meshes[i].colors != NULL;
    return colors;
}

void material_bits_scan(const struct scene *scene, struct material_bits *out)
{
    bool area_lights = has_area_lights(scene), colors = has_colors(scene);
    for (uint32_t i = 0; i < scene->material_count; ++i)
        out[i] = material_bits(&scene->materials[i], area_lights, colors);
}

void material_bits_whole(const struct material_bits *materials, const struct scene_mesh *mesh,
                         uint8_t *whole)
{
    for (uint32_t i = 0; i < scene_mesh_primitives(mesh); ++i)
        whole[i] = mesh->sphere_count || (materials[mesh->materials[i]].flags & TRIANGLE_FILTER);
}

static uint32_t mesh_flags(const struct material_bits *bits, const struct scene_mesh *mesh)
{
    return bits->flags | (bits->masked && mesh->colors ? TRIANGLE_CUTOUT : 0) |
           (mesh->sphere_count ? TRIANGLE_SPHERE : 0);
}

struct gpu_triangle material_bits_record(const struct material_bits *materials,
                                         const struct scene_mesh *mesh, uint32_t primitive)
{
    const struct material_bits *bits = &materials[mesh->materials[primitive]];
    struct gpu_triangle out = {
        .primitive = primitive, .flags = mesh_flags(bits, mesh), .shadow = bits->shadow};
    if (mesh->sphere_count) {
        const float *sphere = &mesh->spheres[4 * (size_t)primitive];
        memcpy(out.v0, sphere, sizeof out.v0);
        out.v1[0] = out.v2[0] = sphere[3];
    } else {
        const uint32_t *corner = &mesh->indices[3 * (size_t)primitive];
        memcpy(out.v0, &mesh->positions[3 * (size_t)corner[0]], sizeof out.v0);
        memcpy(out.v1, &mesh->positions[3 * (size_t)corner[1]], sizeof out.v1);
        memcpy(out.v2, &mesh->positions[3 * (size_t)corner[2]], sizeof out.v2);
    }
    return out;
}

uint32_t accel_primitive_flags(const struct accel *accel, uint32_t instance, uint32_t primitive)
{
    const struct scene *scene = accel->scene;
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[instance].mesh];
    struct material_bits bits = material_bits(&scene->materials[mesh->materials[primitive]],
                                              has_area_lights(scene), has_colors(scene));
    return mesh_flags(&bits, mesh);
}

bool accel_filters_patterned(const struct accel *accel)
{
    const struct scene *scene = accel->scene;
    bool area_lights = has_area_lights(scene), colors = has_colors(scene), some = false;
    for (uint32_t i = 0; i < scene->material_count; ++i)
        some |= material_bits(&scene->materials[i], area_lights, colors).patterned;
    return some;
}

bool accel_filters_vary(const struct accel *accel)
{
    for (uint32_t i = 0; i < accel->record_count; ++i) {
        if (accel->triangles[i].flags & TRIANGLE_FILTER_DETAIL)
            return true;
    }
    return false;
}
