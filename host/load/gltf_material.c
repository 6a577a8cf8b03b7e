#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/same.h"
#include "base/text.h"
#include "load/gltf.h"
#include "load/gltf_json.h"
#include "load/texture_ahead.h"

/* One material while it is read. */
struct reading {
    struct gltf *gltf;
    const json_t *object;
    struct gltf_place at;
    struct scene_material *out;
};

static whit_result read_texture(struct reading *r, const json_t *in, const char *key,
                                enum scene_slot slot)
{
    bool visible = slot == SCENE_SLOT_DIFFUSE;
    return gltf_texture_use(r->gltf, in, &r->at, key, visible, &r->out->textures[slot]);
}

/* The extension's object, or NULL. */
static whit_result extension(struct reading *r, const char *name, json_t **out)
{
    return gltf_extension(r->gltf, r->object, &r->at, name, out) ? WHIT_OK : WHIT_ERROR_INPUT;
}

static bool number(struct reading *r, const json_t *in, const char *key, double min, double max,
                   float *out)
{
    double value = (double)*out;
    if (!gltf_number(r->gltf, in, &r->at, key, &value))
        return false;
    *out = (float)fmin(fmax(value, min), max);
    return true;
}

static whit_result read_metal_rough(struct reading *r)
{
    struct scene_material *out = r->out;
    float base[4] = {1, 1, 1, 1};
    json_t *pbr;
    out->metallic = 1;
    out->roughness = 1;
    if (!gltf_object(r->gltf, r->object, &r->at, "pbrMetallicRoughness", &pbr) ||
        !gltf_floats(r->gltf, pbr, &r->at, "baseColorFactor", 4, base) ||
        !number(r, pbr, "metallicFactor", 0, 1, &out->metallic) ||
        !number(r, pbr, "roughnessFactor", 0, 1, &out->roughness))
        return WHIT_ERROR_INPUT;
    for (int i = 0; i < 3; i++)
        out->diffuse[i] = fmaxf(base[i], 0);
    out->opacity = fminf(fmaxf(base[3], 0), 1);
    whit_result result = read_texture(r, pbr, "baseColorTexture", SCENE_SLOT_DIFFUSE);
    if (result == WHIT_OK)
        result = read_texture(r, pbr, "metallicRoughnessTexture", SCENE_SLOT_METAL_ROUGH);
    return result;
}

static whit_result read_emission(struct reading *r)
{
    json_t *object;
    float strength = 1;
    if (!gltf_floats(r->gltf, r->object, &r->at, "emissiveFactor", 3, r->out->emission))
        return WHIT_ERROR_INPUT;
    whit_result result = extension(r, "KHR_materials_emissive_strength", &object);
    if (result != WHIT_OK || !number(r, object, "emissiveStrength", 0, 1e30, &strength))
        return WHIT_ERROR_INPUT;
    for (int i = 0; i < 3; i++)
        r->out->emission[i] = fmaxf(r->out->emission[i], 0) * strength;
    return read_texture(r, r->object, "emissiveTexture", SCENE_SLOT_EMISSION);
}

static whit_result read_normal_map(struct reading *r)
{
    json_t *info;
    if (!gltf_object(r->gltf, r->object, &r->at, "normalTexture", &info) ||
        !number(r, info, "scale", -1e6, 1e6, &r->out->normal_scale))
        return WHIT_ERROR_INPUT;
    return read_texture(r, r->object, "normalTexture", SCENE_SLOT_NORMAL);
}

static whit_result read_alpha(struct reading *r)
{
    const char *mode;
    if (!gltf_string(r->gltf, r->object, &r->at, "alphaMode", &mode) ||
        !number(r, r->object, "alphaCutoff", 0, 1e30, &r->out->alpha_cutoff) ||
        !gltf_bool(r->gltf, r->object, &r->at, "doubleSided", &r->out->two_sided))
        return WHIT_ERROR_INPUT;
    if (mode && strcmp(mode, "MASK") == 0)
        r->out->alpha = SCENE_ALPHA_MASK;
    else if (mode && strcmp(mode, "BLEND") == 0)
        r->out->alpha = SCENE_ALPHA_BLEND;
    else if (mode && strcmp(mode, "OPAQUE") != 0) {
        gltf_fail(r->gltf, &r->at, "the alphaMode `%s` is unknown", text_token(mode).text);
        return WHIT_ERROR_INPUT;
    }
    return WHIT_OK;
}

static whit_result read_specular(struct reading *r)
{
    json_t *object;
    whit_result result = extension(r, "KHR_materials_specular", &object);
    if (result != WHIT_OK || !number(r, object, "specularFactor", 0, 1, &r->out->specular_level) ||
        !gltf_floats(r->gltf, object, &r->at, "specularColorFactor", 3, r->out->specular))
        return WHIT_ERROR_INPUT;
    result = read_texture(r, object, "specularTexture", SCENE_SLOT_SPECULAR_LEVEL);
    return result == WHIT_OK ? read_texture(r, object, "specularColorTexture", SCENE_SLOT_SPECULAR)
                             : result;
}

/* glTF states the colour that is left of white light after a distance; absorption is the
   coefficient of Beer's law for it. */
static bool read_volume(struct reading *r, const json_t *volume)
{
    float thickness = 0, distance = 0, color[3] = {1, 1, 1};
    if (!number(r, volume, "thicknessFactor", 0, 1e30, &thickness) ||
        !number(r, volume, "attenuationDistance", 0, 1e30, &distance) ||
        !gltf_floats(r->gltf, volume, &r->at, "attenuationColor", 3, color))
        return false;
    r->out->thin_walled = !(thickness > 0);
    for (int i = 0; i < 3; i++) {
        float left = fminf(fmaxf(color[i], 1e-6f), 1.0f);
        r->out->absorption[i] =
            thickness > 0 && distance > 0 ? (float)-same_log((double)left) / distance : 0;
    }
    return true;
}

/* glTF forbids KHR_materials_ior beside pbrSpecularGlossiness, whose F0 does not depend on it. */
static whit_result read_ior(struct reading *r)
{
    json_t *ior, *glossy;
    float value = r->out->ior;
    if (extension(r, "KHR_materials_ior", &ior) != WHIT_OK ||
        extension(r, "KHR_materials_pbrSpecularGlossiness", &glossy) != WHIT_OK ||
        !number(r, ior, "ior", 0, 1e6, &value))
        return WHIT_ERROR_INPUT;
    if (value < 1) /* KHR_materials_ior: 0 means a mirror at every angle */
        value = value > 0 ? 1.0f : 1e3f;
    if (!glossy)
        r->out->ior = value;
    return WHIT_OK;
}

/* Sets transmission to the factor alone: for METAL_ROUGH the renderer itself tints transmitted
   light by the base colour. */
static whit_result read_transmission(struct reading *r)
{
    json_t *object, *volume;
    float factor = 0;
    struct scene_material *out = r->out;
    if (extension(r, "KHR_materials_transmission", &object) != WHIT_OK ||
        extension(r, "KHR_materials_volume", &volume) != WHIT_OK ||
        !number(r, object, "transmissionFactor", 0, 1, &factor))
        return WHIT_ERROR_INPUT;
    if (!object || factor <= 0 || out->model == WHIT_MODEL_UNLIT)
        return WHIT_OK;
    for (int i = 0; i < 3; i++)
        out->transmission[i] = factor;
    out->fresnel = true;
    out->thin_walled = true;
    if (volume && !read_volume(r, volume))
        return WHIT_ERROR_INPUT;
    return read_texture(r, object, "transmissionTexture", SCENE_SLOT_TRANSMISSION);
}

/* Reads KHR_materials_pbrSpecularGlossiness. Its specular colour is F0, which METAL_ROUGH has as a
   tint of the F0 of its index of refraction; what the specular colour reflects is missing from the
   diffuse light. A texture of the specular colour changes F0 alone: as its factor is most often 1,
   the factor does not say how much is missing. assimp states opacity in baseColorFactor alone. */
static whit_result read_specular_glossiness(struct reading *r, const json_t *object)
{
    struct scene_material *out = r->out;
    float diffuse[4] = {1, 1, 1, 1}, specular[3] = {1, 1, 1}, glossiness = 1;
    float root = (out->ior - 1) / (out->ior + 1);
    scene_texture_use_init(&out->textures[SCENE_SLOT_METAL_ROUGH]);
    scene_texture_use_init(&out->textures[SCENE_SLOT_DIFFUSE]);
    scene_texture_use_init(&out->textures[SCENE_SLOT_SPECULAR_LEVEL]);
    whit_result result = read_texture(r, object, "diffuseTexture", SCENE_SLOT_DIFFUSE);
    if (result == WHIT_OK)
        result = read_texture(r, object, "specularGlossinessTexture", SCENE_SLOT_SPECULAR);
    if (result != WHIT_OK)
        return result;
    if (!gltf_floats(r->gltf, object, &r->at, "diffuseFactor", 4, diffuse) ||
        !gltf_floats(r->gltf, object, &r->at, "specularFactor", 3, specular) ||
        !number(r, object, "glossinessFactor", 0, 1, &glossiness))
        return WHIT_ERROR_INPUT;
    float max = fminf(fmaxf(fmaxf(specular[0], specular[1]), fmaxf(specular[2], 0)), 1);
    bool textured = out->textures[SCENE_SLOT_SPECULAR].texture != SCENE_NONE;
    for (int i = 0; i < 3; i++) {
        out->diffuse[i] = fmaxf(diffuse[i], 0) * (textured ? 1 : 1 - max);
        out->specular[i] = fmaxf(specular[i], 0) / (root * root);
    }
    out->metallic = 0;
    out->roughness = 1 - glossiness;
    out->specular_level = max > 0; /* 0: no reflection at grazing angles either */
    out->opacity = fminf(out->opacity, fminf(fmaxf(diffuse[3], 0), 1));
    return WHIT_OK;
}

static whit_result read_other_models(struct reading *r)
{
    json_t *glossy, *unlit;
    if (extension(r, "KHR_materials_pbrSpecularGlossiness", &glossy) != WHIT_OK ||
        extension(r, "KHR_materials_unlit", &unlit) != WHIT_OK)
        return WHIT_ERROR_INPUT;
    whit_result result = glossy ? read_specular_glossiness(r, glossy) : WHIT_OK;
    if (unlit) { /* only the base colour counts */
        r->out->model = WHIT_MODEL_UNLIT;
        memset(r->out->emission, 0, sizeof r->out->emission);
        scene_texture_use_init(&r->out->textures[SCENE_SLOT_EMISSION]);
    }
    return result;
}

static bool is_read(const char *extension)
{
    static const char *const read[] = {"KHR_materials_emissive_strength",
                                       "KHR_materials_ior",
                                       "KHR_materials_pbrSpecularGlossiness",
                                       "KHR_materials_specular",
                                       "KHR_materials_transmission",
                                       "KHR_materials_unlit",
                                       "KHR_materials_volume"};
    for (size_t i = 0; i < sizeof read / sizeof *read; i++)
        if (strcmp(extension, read[i]) == 0)
            return true;
    return false;
}

/* Counts the materials that have each of the extensions that whit does not draw. */
static bool count_ignored(struct reading *r, uint32_t index)
{
    struct gltf *gltf = r->gltf;
    const char *name;
    json_t *value;
    json_object_foreach(json_object_get(r->object, "extensions"), name, value)
    {
        uint32_t at = gltf->ignored_count;
        if (is_read(name))
            continue;
        if (!key_table_find(&gltf->ignored_names, name, strlen(name), &at) &&
            !(key_table_add(&gltf->ignored_names, name, strlen(name), at) &&
              ARRAY_PUSH(gltf->ignored, gltf->ignored_count, gltf->ignored_capacity,
                         (struct gltf_ignored){name, index, 0})))
            return false;
        gltf->ignored[at].materials++;
    }
    return true;
}

static void note_ignored(const struct gltf *gltf)
{
    for (uint32_t i = 0; i < gltf->ignored_count; i++) {
        const struct gltf_ignored *ignored = &gltf->ignored[i];
        scene_note(
            gltf->scene, SCENE_NOTE_INFO, "%s: %s is not drawn: %u materials, the first is `%s`",
            path_name(gltf->request->path), text_token(ignored->extension).text, ignored->materials,
            text_token(gltf->scene->materials[gltf->materials[ignored->first_material]].name).text);
    }
}

static whit_result read_material(struct gltf *gltf, uint32_t index, struct scene_material *out)
{
    static whit_result (*const steps[])(struct reading *) = {
        read_metal_rough, read_emission, read_normal_map,   read_alpha,
        read_specular,    read_ior,      read_other_models, read_transmission,
    };
    struct reading reading = {.gltf = gltf, .out = out};
    json_t *object;
    const char *name;
    if (!gltf_item(gltf, "materials", index, &reading.at, &object) ||
        !gltf_string(gltf, object, &reading.at, "name", &name))
        return WHIT_ERROR_INPUT;
    reading.object = object;
    scene_material_init(out, name && *name ? name : reading.at.text);
    out->origin.file = string_copy(gltf->request->path);
    if (!out->name || !out->origin.file)
        return WHIT_ERROR_MEMORY;
    out->model = WHIT_MODEL_METAL_ROUGH;
    for (int i = 0; i < 3; i++)
        out->specular[i] = 1;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        whit_result result = steps[i](&reading);
        if (result != WHIT_OK)
            return result;
    }
    /* A refracting surface needs both sides: rays leave it through the faces that they enter by. */
    out->one_sided = !out->two_sided && !(out->transmission[0] > 0);
    return gltf->only_names || count_ignored(&reading, index) ? WHIT_OK : WHIT_ERROR_MEMORY;
}

/* Decodes the pictures of all materials at once. */
static whit_result decode_pictures(struct gltf *gltf)
{
    whit_result result = WHIT_OK;
    gltf->only_names = true;
    for (uint32_t i = 0; result == WHIT_OK && i < gltf->material_count; i++) {
        struct scene_material material = {0};
        result = read_material(gltf, i, &material);
        scene_material_finish(&material);
    }
    gltf->only_names = false;
    for (uint32_t i = 0; i < gltf->image_count; i++)
        gltf->textures[i] = SCENE_NONE;
    if (result == WHIT_OK)
        load_textures_ahead(gltf->scene, gltf->request->params);
    return result;
}

whit_result gltf_load_materials(struct gltf *gltf)
{
    whit_result decoded = decode_pictures(gltf);
    if (decoded != WHIT_OK)
        return decoded;
    for (uint32_t i = 0; i < gltf->material_count; i++) {
        struct scene_material material = {0};
        whit_result result = read_material(gltf, i, &material);
        if (result != WHIT_OK) {
            scene_material_finish(&material);
            return result;
        }
        gltf->materials[i] = scene_add_material(gltf->scene, material);
        if (gltf->materials[i] == SCENE_NONE)
            return WHIT_ERROR_MEMORY;
    }
    note_ignored(gltf);
    return WHIT_OK;
}
