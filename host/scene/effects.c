#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/color.h"
#include "base/path.h"
#include "base/text.h"
#include "scene/effects.h"

static const char *const names[SCENE_EFFECT_COUNT] = {
    [SCENE_EFFECT_SHADOWS] = "shadows",
    [SCENE_EFFECT_REFLECTION] = "reflection",
    [SCENE_EFFECT_REFRACTION] = "refraction",
    [SCENE_EFFECT_FRESNEL] = "fresnel",
    [SCENE_EFFECT_ABSORPTION] = "absorption",
    [SCENE_EFFECT_CUTOUTS] = "cutouts",
    [SCENE_EFFECT_TEXTURES] = "textures",
    [SCENE_EFFECT_NORMAL_MAPS] = "normal-maps",
    [SCENE_EFFECT_EMISSION] = "emission",
    [SCENE_EFFECT_HIGHLIGHTS] = "highlights",
    [SCENE_EFFECT_POINT_LIGHTS] = "point-lights",
    [SCENE_EFFECT_DIRECTIONAL_LIGHTS] = "directional-lights",
    [SCENE_EFFECT_SPOT_LIGHTS] = "spot-lights",
    [SCENE_EFFECT_AREA_LIGHTS] = "area-lights",
    [SCENE_EFFECT_ENVIRONMENT_MAP] = "environment-map",
    [SCENE_EFFECT_SMOOTH_NORMALS] = "smooth-normals",
    [SCENE_EFFECT_VERTEX_COLORS] = "vertex-colors",
    [SCENE_EFFECT_METAL_ROUGH] = "metal-rough",
    [SCENE_EFFECT_INSTANCES] = "instances",
    [SCENE_EFFECT_ORTHOGRAPHIC] = "orthographic",
    [SCENE_EFFECT_LENS] = "lens",
    [SCENE_EFFECT_PANORAMA] = "panorama",
    [SCENE_EFFECT_MEDIA] = "media",
    [SCENE_EFFECT_SPHERES] = "spheres",
    [SCENE_EFFECT_TINTED_SHADOWS] = "tinted-shadows",
    [SCENE_EFFECT_CULLING] = "culling",
    [SCENE_EFFECT_CATCHERS] = "catchers",
    [SCENE_EFFECT_TERMINATOR] = "terminator",
};

const char *scene_effect_name(enum scene_effect effect)
{
    return (unsigned)effect < SCENE_EFFECT_COUNT ? names[effect] : "unknown";
}

/* Marks an effect as called for; only the first reason is kept. */
WHIT_PRINTF(3, 4)
static void call(struct scene_effects *out, enum scene_effect effect, const char *format, ...)
{
    if (out->called[effect])
        return;
    out->called[effect] = true;
    va_list args;
    va_start(args, format);
    text_print(out->reasons[effect], sizeof out->reasons[effect], format, args);
    va_end(args);
}

static void place_of(const struct scene_origin *origin, char *out, size_t out_bytes)
{
    out[0] = '\0';
    if (origin->file && origin->line)
        snprintf(out, out_bytes, ", %s:%u", path_name(origin->file), origin->line);
    else if (origin->file)
        snprintf(out, out_bytes, ", %s", path_name(origin->file));
}

static void call_by_material(struct scene_effects *out, enum scene_effect effect,
                             const struct scene_material *material, const char *what)
{
    char place[64], illum[24] = "";
    if (out->called[effect])
        return;
    place_of(&material->origin, place, sizeof place);
    if (material->illum >= 0)
        snprintf(illum, sizeof illum, ", illum %d", (int)material->illum);
    call(out, effect, "material `%s`%s%s%s%s", text_token(material->name).text, illum,
         what[0] ? ", " : "", what, place);
}

static bool any(const float rgb[3])
{
    return !color_is_black(rgb);
}

static bool has(const struct scene_material *material, enum scene_slot slot)
{
    return material->textures[slot].texture != SCENE_NONE;
}

static bool is_glossy_metal_rough(const struct scene_material *m)
{
    return m->model == WHIT_MODEL_METAL_ROUGH && (m->specular_level > 0.0f || m->metallic > 0.0f);
}

/* Effects of a transmissive material. Total internal reflection calls for reflection, even where
   the material states none. */
static void scan_glass(struct scene_effects *out, const struct scene_material *m)
{
    call_by_material(out, SCENE_EFFECT_REFRACTION, m, "");
    if (m->thin_walled)
        return;
    call_by_material(out, SCENE_EFFECT_MEDIA, m, "");
    call_by_material(out, SCENE_EFFECT_REFLECTION, m, "total reflection");
    if (any(m->absorption))
        call_by_material(out, SCENE_EFFECT_ABSORPTION, m, "");
}

static void scan_optics(struct scene_effects *out, const struct scene_material *m)
{
    bool metal_rough = is_glossy_metal_rough(m);
    /* Roughness 1 leaves nothing of a mirror image, unless a texture lowers the roughness. */
    bool mirrors = metal_rough && (m->roughness < 1.0f || has(m, SCENE_SLOT_METAL_ROUGH));
    if (any(m->emission))
        call_by_material(out, SCENE_EFFECT_EMISSION, m, "");
    if (m->shadow_catcher)
        call_by_material(out, SCENE_EFFECT_CATCHERS, m, "");
    if (m->one_sided)
        call_by_material(out, SCENE_EFFECT_CULLING, m, "one-sided");
    out->lit |= m->model == WHIT_MODEL_METAL_ROUGH || m->shadow_catcher ||
                (m->model == WHIT_MODEL_PHONG && (any(m->diffuse) || any(m->specular)));
    if (m->model == WHIT_MODEL_UNLIT)
        return;
    if (any(m->reflection) || mirrors || (any(m->transmission) && m->fresnel))
        call_by_material(out, SCENE_EFFECT_REFLECTION, m,
                         any(m->reflection) ? ""
                         : mirrors          ? "metal-rough"
                                            : "glass");
    if (any(m->transmission))
        scan_glass(out, m);
    if (mirrors || (m->fresnel && (any(m->reflection) || any(m->transmission))))
        call_by_material(out, SCENE_EFFECT_FRESNEL, m, mirrors ? "metal-rough" : "");
    if (metal_rough || (m->model == WHIT_MODEL_PHONG && any(m->specular)))
        call_by_material(out, SCENE_EFFECT_HIGHLIGHTS, m, "");
    if (m->model == WHIT_MODEL_METAL_ROUGH)
        call_by_material(out, SCENE_EFFECT_METAL_ROUGH, m, "");
}

/* Whether alpha may let light pass: a mask or blend that is opaque everywhere needs no test of
   opacity at each hit. */
static bool lets_through(const struct scene *scene, const struct scene_material *m)
{
    if (m->alpha == SCENE_ALPHA_OPAQUE)
        return false;
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        if (scene->meshes[i].colors)
            return true;
    }
    return m->opacity < 1.0f || (m->alpha == SCENE_ALPHA_MASK && m->alpha_cutoff > 1.0f) ||
           has(m, SCENE_SLOT_DIFFUSE) || has(m, SCENE_SLOT_OPACITY);
}

static uint32_t sampling_of(const struct scene_texture_use *use)
{
    static const uint32_t wraps[] = {
        [SCENE_WRAP_REPEAT] = SCENE_SAMPLING_REPEAT,
        [SCENE_WRAP_CLAMP] = SCENE_SAMPLING_CLAMP,
        [SCENE_WRAP_MIRROR] = SCENE_SAMPLING_MIRROR,
    };
    return wraps[use->wrap_u] | wraps[use->wrap_v] | (use->nearest ? 0 : SCENE_SAMPLING_FILTERED);
}

static void scan_material(const struct scene *scene, struct scene_effects *out,
                          const struct scene_material *m)
{
    static const char *const slots[SCENE_SLOT_COUNT] = {
        "diffuse map",     "specular map", "emission map",     "normal map",        "bump map",
        "metal-rough map", "opacity map",  "transmission map", "specular level map"};
    scan_optics(out, m);
    for (int slot = 0; slot < SCENE_SLOT_COUNT; ++slot) {
        if (!has(m, (enum scene_slot)slot))
            continue;
        call_by_material(out, SCENE_EFFECT_TEXTURES, m, slots[slot]);
        out->texture_slots |= 1u << slot;
        out->sampling |=
            sampling_of(&m->textures[slot]) |
            (scene_slot_is_srgb((enum scene_slot)slot, m->model) ? SCENE_SAMPLING_SRGB : 0u);
    }
    if (has(m, SCENE_SLOT_DIFFUSE) && m->alpha != SCENE_ALPHA_OPAQUE)
        out->texture_slots |= 1u << SCENE_SLOT_OPACITY;
    if (m->model != WHIT_MODEL_UNLIT && (has(m, SCENE_SLOT_NORMAL) || has(m, SCENE_SLOT_BUMP)))
        call_by_material(out, SCENE_EFFECT_NORMAL_MAPS, m,
                         has(m, SCENE_SLOT_NORMAL) ? "normal map" : "bump map");
    if (lets_through(scene, m))
        call_by_material(out, SCENE_EFFECT_CUTOUTS, m,
                         m->alpha == SCENE_ALPHA_MASK ? "alpha mask" : "alpha blend");
    bool blends = m->alpha == SCENE_ALPHA_BLEND && lets_through(scene, m);
    if (out->called[SCENE_EFFECT_SHADOWS] && (blends || any(m->transmission)))
        call_by_material(out, SCENE_EFFECT_TINTED_SHADOWS, m, blends ? "alpha blend" : "");
}

/* A switch without a default, so that the compiler warns of a kind that is missing here. */
static enum scene_effect effect_of_light(whit_light_kind kind)
{
    switch (kind) {
    case WHIT_LIGHT_POINT:
        return SCENE_EFFECT_POINT_LIGHTS;
    case WHIT_LIGHT_DIRECTIONAL:
        return SCENE_EFFECT_DIRECTIONAL_LIGHTS;
    case WHIT_LIGHT_SPOT:
        return SCENE_EFFECT_SPOT_LIGHTS;
    case WHIT_LIGHT_AREA_SAMPLE:
    case WHIT_LIGHT_RECTANGLE:
    case WHIT_LIGHT_TRIANGLE:
    case WHIT_LIGHT_KINDS:
        return SCENE_EFFECT_AREA_LIGHTS;
    }
    return SCENE_EFFECT_AREA_LIGHTS;
}

/* Without `functions`, which may read all lights, a light that sends no light is left out. */
static void scan_light(struct scene_effects *out, bool functions, const struct scene_light *light)
{
    char place[64];
    if (!functions && !any(light->color))
        return;
    place_of(&light->origin, place, sizeof place);
    const char *by = light->made_by_whit ? ", added by whit" : "";
    const struct text_token name = text_token(light->name);
    call(out, effect_of_light(light->kind), "light `%s`%s%s", name.text, by, place);
    if (any(light->color))
        call(out, SCENE_EFFECT_SHADOWS, "light `%s`%s%s", name.text, by, place);
}

static void scan_geometry(const struct scene *scene, struct scene_effects *out)
{
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[i];
        const struct text_token name = text_token(mesh->name);
        if (mesh->normals)
            call(out, SCENE_EFFECT_SMOOTH_NORMALS, "mesh `%s`", name.text);
        if (mesh->normals && out->called[SCENE_EFFECT_SHADOWS])
            call(out, SCENE_EFFECT_TERMINATOR, "mesh `%s` in shadows", name.text);
        if (mesh->sphere_count)
            call(out, SCENE_EFFECT_SPHERES, "%u sphere%s of mesh `%s`", mesh->sphere_count,
                 mesh->sphere_count == 1 ? "" : "s", name.text);
        if (mesh->colors)
            call(out, SCENE_EFFECT_VERTEX_COLORS, "mesh `%s`", name.text);
    }
    if (scene->instance_count > 1)
        call(out, SCENE_EFFECT_INSTANCES, "%u instances of %u meshes", scene->instance_count,
             scene->mesh_count);
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_instance *instance = &scene->instances[i];
        if (instance->node != SCENE_NONE || instance->has_local)
            call(out, SCENE_EFFECT_INSTANCES, "instance `%s` has a transform",
                 text_token(instance->name).text);
    }
}

static void scan_camera(struct scene_effects *out, const struct scene_camera *camera)
{
    const struct text_token name = text_token(camera->name);
    if (camera->kind == WHIT_CAMERA_ORTHOGRAPHIC)
        call(out, SCENE_EFFECT_ORTHOGRAPHIC, "camera `%s`", name.text);
    else if (camera->kind == WHIT_CAMERA_PANORAMA)
        call(out, SCENE_EFFECT_PANORAMA, "camera `%s`", name.text);
    else if (camera->lens_radius > 0.0f)
        call(out, SCENE_EFFECT_LENS, "camera `%s`, radius %g", name.text,
             (double)camera->lens_radius);
}

uint8_t *scene_worn_materials(const struct scene *scene)
{
    uint8_t *worn = array_alloc_zeroed(scene->material_count, sizeof *worn);
    for (uint32_t i = 0; worn && i < scene->mesh_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[i];
        for (uint32_t t = 0; t < mesh->triangle_count + mesh->sphere_count; ++t)
            worn[mesh->materials[t]] |= mesh->sphere_count ? WORN_BY_SPHERES : WORN_BY_TRIANGLES;
    }
    return worn;
}

uint32_t scene_find_worn(const struct scene *scene, const char *name)
{
    uint8_t *worn = scene_worn_materials(scene);
    uint32_t found = SCENE_NONE;
    for (uint32_t i = 0; i < scene->material_count && found == SCENE_NONE; ++i) {
        const char *own = scene->materials[i].name;
        if ((!worn || worn[i]) && (!name[0] || (own && strcmp(own, name) == 0)))
            found = i;
    }
    free(worn);
    return found;
}

uint32_t scene_effects_scan_materials(const struct scene *scene, enum scene_materials which,
                                      struct scene_effects *out)
{
    uint8_t *worn = scene_worn_materials(scene);
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        bool glass = any(scene->materials[i].transmission);
        if ((worn && !worn[i]) ||
            (which != SCENE_MATERIALS_ALL && glass != (which == SCENE_MATERIALS_GLASS)))
            continue;
        scan_material(scene, out, &scene->materials[i]);
        out->on_triangles |= !worn || (worn[i] & WORN_BY_TRIANGLES);
        out->on_spheres |= !worn || (worn[i] & WORN_BY_SPHERES);
        ++count;
    }
    free(worn);
    return count;
}

/* For a scene of which nothing is lit. */
static void drop_lights(struct scene_effects *out)
{
    static const enum scene_effect lights[] = {
        SCENE_EFFECT_SHADOWS,      SCENE_EFFECT_TINTED_SHADOWS, SCENE_EFFECT_TERMINATOR,
        SCENE_EFFECT_POINT_LIGHTS, SCENE_EFFECT_SPOT_LIGHTS,    SCENE_EFFECT_DIRECTIONAL_LIGHTS,
        SCENE_EFFECT_AREA_LIGHTS,
    };
    for (size_t i = 0; i < sizeof lights / sizeof *lights; ++i) {
        out->called[lights[i]] = false;
        out->reasons[lights[i]][0] = '\0';
    }
}

void scene_effects_scan(const struct scene *scene, bool functions, struct scene_effects *out)
{
    memset(out, 0, sizeof *out);
    for (uint32_t i = 0; i < scene->light_count; ++i) /* first: tinted shadows need shadows */
        scan_light(out, functions, &scene->lights[i]);
    scene_effects_scan_materials(scene, SCENE_MATERIALS_ALL, out);
    scan_geometry(scene, out);
    /* Glass is lit where --effects leaves refraction out. */
    if (!functions && !out->lit && !out->called[SCENE_EFFECT_REFRACTION])
        drop_lights(out);
    const struct scene_environment *sky = &scene->environment;
    if (sky->kind == WHIT_ENVIRONMENT_MAP && sky->rgb)
        call(out, SCENE_EFFECT_ENVIRONMENT_MAP, "map `%s`",
             text_token(sky->name ? path_name(sky->name) : "").text);
    for (uint32_t i = 0; i < scene->camera_count; ++i)
        scan_camera(out, &scene->cameras[i]);
}
