/* Converts MTL entries to materials. The classes of `illum`:

     0  colour only: unlit            5  mirror, its weight rising to 1 by Fresnel from Ks
     1  diffuse                       6  refraction
     2  diffuse and highlight         7  refraction and Fresnel
     3  mirror reflection by Ks       8  as 3 without ray tracing: taken as 2
     4  glass: light passes straight  9  as 4 without ray tracing: blends by d
        through, and Ks reflects     10  catches shadows, is invisible itself
   Class 6 refracts (1 - Ks) Tf of the light, as the format says. Class 7 splits light by Fresnel
   with Ni; the format gives no formula for it.

   How much a refracting class (4, 6, 7) transmits:
     d < 1      1 - d; in classes 6 and 7 tinted by Tf where Tf has a hue
     else Tf    Tf as the format says, where 1 transmits everything; but 1 - Tf where Tf can only
                be the share held back, see filter_is_inverted()
     neither    everything
   In other classes d is the opacity; Tf, which exporters write as 1 even for opaque surfaces, is
   ignored. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/mtl_material.h"
#include "load/texture_ahead.h"
#include "scene/afford.h"

enum { ALPHA_HALF = 128 };

/* --- textures ------------------------------------------------------------------------------- */

/* MTL samples at scale * uv + offset with v upwards; whit's v grows downwards: v = 1 - v_up. */
static void set_transform(const struct mtl_texture *map, struct scene_texture_use *use)
{
    const float transform[6] = {
        map->scale[0], 0, map->offset[0], 0, map->scale[1], 1 - map->scale[1] - map->offset[1]};
    memcpy(use->transform, transform, sizeof transform);
    use->wrap_u = use->wrap_v = map->clamp ? SCENE_WRAP_CLAMP : SCENE_WRAP_REPEAT;
}

/* Applies -imfchan and -mm to texels, on the stored 8-bit codes. */
static void derive_texels(const struct mtl_texture *map, size_t count, const uint8_t *from,
                          uint8_t *to)
{
    for (size_t i = 0; i < count; i++, from += 4, to += 4) {
        /* Rec. 709 weights on the codes, without sRGB decoding: the texels are scalars. */
        float luminance = 0.2126f * from[0] + 0.7152f * from[1] + 0.0722f * from[2];
        memcpy(to, from, 4);
        for (int k = 0; k < 3; k++) {
            float code = map->channel == 0     ? (float)from[k]
                         : map->channel == 'l' ? luminance
                         : map->channel == 'm' ? (float)from[3]
                         : map->channel == 'b' ? (float)from[2]
                                               : (float)from[map->channel == 'g'];
            code = 255.0f * map->base + map->gain * code;
            to[k] = (uint8_t)lrintf(fminf(fmaxf(code, 0.0f), 255.0f));
        }
        if (map->channel)
            to[3] = 255;
    }
}

/* Where the map has -imfchan or -mm, sets *index to a new texture made from texture *index. */
static whit_result derive_texture(struct scene *scene, const struct mtl_texture *map,
                                  uint32_t *index)
{
    if (map->channel == 0 && map->base == 0 && map->gain == 1)
        return WHIT_OK;
    const struct scene_texture *from = &scene->textures[*index];
    size_t count = (size_t)from->width * from->height;
    struct scene_texture made = {.width = from->width, .height = from->height};
    made.name =
        string_format("%s -imfchan %c -mm %g %g", from->name, map->channel ? map->channel : '-',
                      (double)map->base, (double)map->gain);
    if (made.name && scene_find_texture(scene, made.name, index)) {
        free(made.name);
        return WHIT_OK;
    }
    if (!made.name)
        return WHIT_ERROR_MEMORY;
    if (!scene_afford(scene, scene_texture_cost(from->width, from->height), "texture `%s`",
                      text_token(path_name(made.name)).text)) {
        free(made.name);
        return WHIT_ERROR_INPUT;
    }
    made.rgba = array_alloc(count, 4);
    if (!made.rgba) {
        free(made.name);
        return WHIT_ERROR_MEMORY;
    }
    derive_texels(map, count, from->rgba, made.rgba);
    *index = scene_add_texture(scene, made);
    return *index == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

static whit_result add_map(struct scene *scene, const struct mtl_entry *entry, enum mtl_map kind,
                           enum scene_slot slot, const whit_load_params *params,
                           struct scene_material *out)
{
    const struct mtl_texture *map = &entry->maps[kind];
    if (!map->file)
        return WHIT_OK;
    char *path = picture_find_named(&scene->roots, entry->file, map->file);
    if (!path)
        return WHIT_ERROR_MEMORY;
    whit_result result = WHIT_OK;
    /* A missing picture becomes magenta for the diffuse colour; other slots go without a
       texture. */
    const char *why_not = slot == SCENE_SLOT_DIFFUSE ? NULL : roots_why_not(&scene->roots, path);
    if (why_not) {
        scene_note(scene, SCENE_NOTE_WARNING, "%s:%u: texture `%s`: %s", path_name(entry->file),
                   map->line, text_token(map->file).text, why_not);
    } else {
        struct scene_texture_use *use = &out->textures[slot];
        set_transform(map, use);
        result = load_texture(scene, path, NULL, 0, params, &use->texture, NULL);
        if (result == WHIT_OK)
            result = derive_texture(scene, map, &use->texture);
    }
    free(path);
    return result;
}

/* --- cut-outs ------------------------------------------------------------------------------- */

static const struct scene_texture *
texture_of(const struct scene *scene, const struct scene_material *material, enum scene_slot slot)
{
    uint32_t index = material->textures[slot].texture;
    return index < scene->texture_count ? &scene->textures[index] : NULL;
}

/* Step between texels that are tested: large pictures are judged by about 2^16 texels. The step is
   odd, so that these fall into different columns. */
static size_t texel_step(size_t count)
{
    return count >> 16 | 1;
}

/* Whether the alpha channel cuts out shapes: some texels are transparent, and some are not. */
static bool has_cutouts(const struct scene_texture *texture)
{
    size_t count = (size_t)texture->width * texture->height, step = texel_step(count);
    size_t clear = 0, seen = 0;
    for (size_t i = 0; i < count; i += step, seen++)
        clear += texture->rgba[i * 4 + 3] < ALPHA_HALF;
    return clear * 200 > seen && (seen - clear) * 200 > seen;
}

/* Whether the alpha of `color` equals the red of `opacity`: both together would apply the same
   opacity twice. */
static bool same_opacity(const struct scene_texture *color, const struct scene_texture *opacity)
{
    if (color->width != opacity->width || color->height != opacity->height)
        return false;
    size_t count = (size_t)color->width * color->height, step = texel_step(count);
    size_t by_alpha = 0, by_red = 0, seen = 0;
    bool has_alpha = false;
    for (size_t i = 0; i < count; i += step, seen++) {
        const uint8_t *texel = opacity->rgba + i * 4;
        int alpha = color->rgba[i * 4 + 3];
        has_alpha |= texel[3] < 255;
        by_alpha += abs(alpha - texel[3]) > 8;
        by_red += abs(alpha - texel[0]) > 8;
    }
    return (has_alpha ? by_alpha : by_red) * 100 <= seen;
}

static void set_cutouts(struct scene *scene, const struct mtl_entry *entry,
                        struct scene_material *out)
{
    const struct scene_texture *color = texture_of(scene, out, SCENE_SLOT_DIFFUSE);
    const struct scene_texture *opacity = texture_of(scene, out, SCENE_SLOT_OPACITY);
    if (opacity) {
        out->alpha = SCENE_ALPHA_MASK;
        if (color && (color == opacity || same_opacity(color, opacity)))
            scene_texture_use_init(&out->textures[SCENE_SLOT_OPACITY]);
    } else if (color && has_cutouts(color)) {
        out->alpha = SCENE_ALPHA_MASK;
        scene_note(scene, SCENE_NOTE_INFO, "%s: material `%s` is cut out by the alpha of `%s`",
                   path_name(entry->file), text_token(entry->name).text,
                   text_token(path_name(color->name)).text);
    }
}

/* --- glass ---------------------------------------------------------------------------------- */

static float largest(const float *rgb)
{
    return fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
}
static float smallest(const float *rgb)
{
    return fminf(rgb[0], fminf(rgb[1], rgb[2]));
}

/* Whether Tf is the share that is held back, as in well-known files: McGuire's archive has 0.1 for
   clear glass, Mineways writes 1 minus the surface's colour. It is taken so where Tf would pass
   nearly nothing, or where 1 - Tf has the hue of Kd. */
static bool filter_is_inverted(const struct mtl_entry *entry)
{
    const float *tf = entry->colors[MTL_TF], *kd = entry->colors[MTL_KD];
    if (largest(tf) <= 0.2f)
        return true;
    bool hue = largest(kd) - smallest(kd) > 0.2f && entry->has_color[MTL_KD];
    if (!hue || largest(tf) > 1.0f)
        return false;
    double dot = 0, tt = 0, kk = 0;
    for (int i = 0; i < 3; i++) {
        double held = 1.0 - tf[i];
        dot += held * kd[i];
        tt += held * held;
        kk += (double)kd[i] * kd[i];
    }
    return tt > 0 && dot / sqrt(tt * kk) > 0.99;
}

static void set_transmission(struct scene *scene, const struct mtl_entry *entry,
                             struct scene_material *out)
{
    const float *tf = entry->colors[MTL_TF];
    float d = entry->has_number[MTL_D] ? entry->numbers[MTL_D] : 1.0f;
    bool filtered = entry->has_color[MTL_TF];
    bool inverted = d >= 1 && filtered && filter_is_inverted(entry);
    for (int i = 0; i < 3; i++) {
        float pass = filtered ? fminf(inverted ? 1 - tf[i] : tf[i], 1.0f) : 1.0f;
        bool tinted = filtered && largest(tf) > 0 && out->illum != 4;
        if (d < 1)
            pass = tinted ? (1 - d) * tf[i] / largest(tf) : 1 - d;
        /* Class 6 refracts what Ks does not reflect; in class 7 Fresnel splits light by angle. */
        out->transmission[i] = out->illum == 6 ? pass * fmaxf(1 - out->specular[i], 0) : pass;
        /* d < 1 dissolves the surface, and with it the diffuse and ambient colour. */
        out->diffuse[i] *= fminf(fmaxf(d, 0.0f), 1.0f);
        out->ambient[i] *= fminf(fmaxf(d, 0.0f), 1.0f);
    }
    if (inverted)
        scene_note(scene, SCENE_NOTE_INFO,
                   "%s:%u: material `%s`: Tf %g %g %g is read as the share held back",
                   path_name(entry->file), entry->line, text_token(entry->name).text, (double)tf[0],
                   (double)tf[1], (double)tf[2]);
}

/* --- the rest ------------------------------------------------------------------------------- */

static void set_color(const struct mtl_entry *entry, enum mtl_color color, float otherwise,
                      float *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = entry->has_color[color] ? entry->colors[color][i] : otherwise;
}

static void set_colors(struct scene *scene, const struct mtl_entry *entry,
                       struct scene_material *out)
{
    const struct mtl_texture *maps = entry->maps;
    set_color(entry, MTL_KD, maps[MTL_MAP_KD].file ? 1.0f : 0.7f, out->diffuse);
    set_color(entry, MTL_KS, maps[MTL_MAP_KS].file ? 1.0f : 0.0f, out->specular);
    set_color(entry, MTL_KE, maps[MTL_MAP_KE].file ? 1.0f : 0.0f, out->emission);
    if (maps[MTL_MAP_KD].file && !(largest(out->diffuse) > 0)) {
        scene_note(scene, SCENE_NOTE_INFO,
                   "%s:%u: material `%s`: map_Kd is drawn as with a Kd of 1, which is 0",
                   path_name(entry->file), entry->line, text_token(entry->name).text);
        out->diffuse[0] = out->diffuse[1] = out->diffuse[2] = 1;
    }
    /* The format has no ambient light, so Ka 0 only says that the writing program has none
       either. */
    if (largest(entry->colors[MTL_KA]) > 0)
        memcpy(out->ambient, entry->colors[MTL_KA], sizeof out->ambient);
    else
        memcpy(out->ambient, out->diffuse, sizeof out->ambient);
    if (entry->has_number[MTL_NS])
        out->shininess = fmaxf(entry->numbers[MTL_NS], 0.0f);
    if (entry->has_number[MTL_NI] && entry->numbers[MTL_NI] > 0)
        out->ior = entry->numbers[MTL_NI];
}

static int32_t class_of(struct scene *scene, const struct mtl_entry *entry)
{
    if (!entry->has_number[MTL_ILLUM])
        return 2;
    float illum = entry->numbers[MTL_ILLUM];
    if (illum >= 0 && illum <= 10 && illum == floorf(illum))
        return (int32_t)illum;
    scene_note(scene, SCENE_NOTE_WARNING, "%s:%u: material `%s`: illum %g is taken as 2",
               path_name(entry->file), entry->line, text_token(entry->name).text, (double)illum);
    return 2;
}

static void set_opacity(struct scene *scene, const struct mtl_entry *entry,
                        struct scene_material *out)
{
    float d = entry->has_number[MTL_D] ? entry->numbers[MTL_D] : 1.0f;
    /* MeshLab writes the opacity as Tr, and other programs the transparency as d. */
    if ((entry->d_by_tr || entry->d_of_all) && d <= 0) {
        scene_note(scene, SCENE_NOTE_INFO,
                   "%s:%u: material `%s`: %s is drawn as opaque: nothing would be seen of it",
                   path_name(entry->file), entry->line, text_token(entry->name).text,
                   entry->d_by_tr ? "Tr 1" : "d 0, as all materials have,");
        d = 1;
    }
    out->opacity = fminf(fmaxf(d, 0.0f), 1.0f);
    if (out->opacity < 1)
        out->alpha = SCENE_ALPHA_BLEND;
}

/* Drops Ks where Ns is 0: with that exponent the highlight would cover the whole surface. */
static void drop_flat_highlight(struct scene *scene, const struct mtl_entry *entry,
                                struct scene_material *out)
{
    if (out->model != WHIT_MODEL_PHONG || out->shininess > 0 || !(largest(out->specular) > 0))
        return;
    scene_note(scene, SCENE_NOTE_INFO, "%s:%u: material `%s`: Ns 0 makes no highlight of Ks",
               path_name(entry->file), entry->line, text_token(entry->name).text);
    memset(out->specular, 0, sizeof out->specular);
}

static void set_class(struct scene *scene, const struct mtl_entry *entry,
                      struct scene_material *out)
{
    bool glass = out->illum == 4 || out->illum == 6 || out->illum == 7;
    bool mirror = glass || out->illum == 3 || out->illum == 5;
    if (out->illum == 0)
        out->model = WHIT_MODEL_UNLIT;
    if (out->illum < 2)
        memset(out->specular, 0, sizeof out->specular);
    if (mirror)
        memcpy(out->reflection, out->specular, sizeof out->reflection);
    out->fresnel = out->illum == 5 || out->illum == 7;
    out->thin_walled = out->illum == 4;
    out->shadow_catcher = out->illum == 10;
    if (glass)
        set_transmission(scene, entry, out);
    else
        set_opacity(scene, entry, out);
    if (out->illum == 8)
        scene_note(scene, SCENE_NOTE_INFO,
                   "%s:%u: material `%s`: illum 8 reflects without rays, drawn as illum 2",
                   path_name(entry->file), entry->line, text_token(entry->name).text);
}

/* Pr and Pm are the metallic-roughness extension. They are used for plain classes alone: mirrors
   and glass state their reflection by `illum`. */
static void set_metal_rough(const struct mtl_entry *entry, struct scene_material *out)
{
    bool plain = out->illum == 1 || out->illum == 2 || out->illum == 8;
    if (!plain || (!entry->has_number[MTL_PR] && !entry->has_number[MTL_PM]))
        return;
    out->model = WHIT_MODEL_METAL_ROUGH;
    out->metallic = entry->has_number[MTL_PM] ? fminf(fmaxf(entry->numbers[MTL_PM], 0), 1) : 0;
    out->roughness = entry->has_number[MTL_PR] ? fminf(fmaxf(entry->numbers[MTL_PR], 0), 1) : 1;
    for (int i = 0; i < 3; i++)
        out->specular[i] = 1;
}

/* Notes a map_Ka that differs from map_Kd: whit tints ambient light by map_Kd. */
static void note_ambient_map(struct scene *scene, const struct mtl_entry *entry)
{
    const struct mtl_texture *ambient = &entry->maps[MTL_MAP_KA];
    const char *diffuse = entry->maps[MTL_MAP_KD].file;
    if (ambient->file && (!diffuse || strcmp(ambient->file, diffuse) != 0))
        scene_note(scene, SCENE_NOTE_WARNING,
                   "%s:%u: `%s` of map_Ka was ignored: ambient light takes map_Kd",
                   path_name(entry->file), ambient->line, text_token(ambient->file).text);
}

void mtl_name_pictures(struct scene *scene, const struct mtl_entry *entry,
                       const whit_load_params *params)
{
    for (int i = MTL_MAP_KD; i < MTL_MAP_COUNT; ++i) {
        /* map_Ns is read for some kinds of materials alone. */
        const char *file = i == MTL_MAP_NS ? NULL : entry->maps[i].file;
        char *path = file ? picture_find_named(&scene->roots, entry->file, file) : NULL;
        if (path)
            load_texture_soon(scene, path, NULL, 0, params);
        free(path);
    }
}

whit_result mtl_material(struct scene *scene, const struct mtl_entry *entry,
                         const whit_load_params *params, struct scene_material *out)
{
    static const struct {
        enum mtl_map map;
        enum scene_slot slot;
    } slots[] = {
        {MTL_MAP_KD, SCENE_SLOT_DIFFUSE},     {MTL_MAP_KS, SCENE_SLOT_SPECULAR},
        {MTL_MAP_KE, SCENE_SLOT_EMISSION},    {MTL_MAP_D, SCENE_SLOT_OPACITY},
        {MTL_MAP_BUMP, SCENE_SLOT_BUMP},      {MTL_MAP_NORMAL, SCENE_SLOT_NORMAL},
        {MTL_MAP_NS, SCENE_SLOT_METAL_ROUGH},
    };
    scene_material_init(out, entry->name);
    out->origin.file = string_copy(entry->file);
    out->origin.line = entry->line;
    if (!out->name || !out->origin.file)
        return WHIT_ERROR_MEMORY;
    out->illum = class_of(scene, entry);
    set_colors(scene, entry, out);
    set_class(scene, entry, out);
    set_metal_rough(entry, out);
    drop_flat_highlight(scene, entry, out);
    for (size_t i = 0; i < sizeof slots / sizeof *slots; i++) {
        if (slots[i].map == MTL_MAP_NS && out->model != WHIT_MODEL_PHONG)
            continue; /* only PHONG has an exponent that map_Ns could scale */
        whit_result result = add_map(scene, entry, slots[i].map, slots[i].slot, params, out);
        if (result != WHIT_OK)
            return result;
    }
    if (entry->maps[MTL_MAP_NORMAL].file)
        out->normal_scale = entry->maps[MTL_MAP_NORMAL].bump;
    else if (entry->maps[MTL_MAP_BUMP].file)
        out->normal_scale = entry->maps[MTL_MAP_BUMP].bump;
    note_ambient_map(scene, entry);
    set_cutouts(scene, entry, out);
    return WHIT_OK;
}
