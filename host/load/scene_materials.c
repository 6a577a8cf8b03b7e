/* Materials and textures of a scene file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/same.h"
#include "base/text.h"
#include "base/vec.h"
#include "image/image.h"
#include "load/scene_materials.h"
#include "load/texture.h"

static const char *const common_keys[] = {"emission",
                                          "texture",
                                          "normal_map",
                                          "bump_map",
                                          "emission_map",
                                          "specular_map",
                                          "metal_rough_map",
                                          "opacity_map",
                                          "transmission_map",
                                          "opacity",
                                          "alpha",
                                          "alpha_cutoff",
                                          "two_sided",
                                          "one_sided",
                                          "shadow_catcher",
                                          "priority",
                                          "normal_scale",
                                          "ior",
                                          "transmission",
                                          "absorption",
                                          "thin_walled",
                                          NULL};
static const char *const phong_keys[] = {"ambient",    "diffuse", "specular", "shininess",
                                         "reflection", "fresnel", NULL};
static const char *const metal_keys[] = {"base_color", "metallic", "roughness", "specular_level",
                                         NULL};
static const char *const unlit_keys[] = {"unlit", "color", NULL};
static const char *const texture_keys[] = {"file",    "checker", "gradient", "brick",
                                           "scale",   "offset",  "rotation", "wrap",
                                           "nearest", "uv_set",  NULL};

static bool has(const json_t *object, const char *key)
{
    return json_object_get(object, key) != NULL;
}

/* Adds a generated texture. Equal textures have equal names, and are added once. */
static bool add_picture(struct reader *reader, char *name, uint32_t width, uint32_t height,
                        uint8_t *rgba, uint32_t *index)
{
    struct scene *scene = reader->scene;
    if (!name || !rgba) {
        free(name);
        free(rgba);
        return reader_no_memory(reader);
    }
    if (scene_find_texture(scene, name, index)) {
        free(name);
        free(rgba);
        return true;
    }
    *index = scene_add_texture(scene, (struct scene_texture){name, width, height, rgba, 0});
    return *index != SCENE_NONE || reader_no_memory(reader);
}

/* The two colours of a pattern. */
struct pattern {
    float colors[2][3];
    bool encodes; /* `colors` are linear, and texels are sRGB; false: texels are `colors` as they
                     are, as maps of numbers have them */
};

static void store_color(const struct pattern *pattern, const float color[3], uint8_t *texel)
{
    for (int i = 0; i < 3; ++i)
        texel[i] = (uint8_t)lrintf(
            255.0f * (pattern->encodes ? image_srgb_from_linear(color[i]) : color[i]));
    texel[3] = 255;
}

static char *picture_name(const char *kind, const struct pattern *pattern)
{
    uint8_t a[4], b[4];
    store_color(pattern, pattern->colors[0], a);
    store_color(pattern, pattern->colors[1], b);
    return string_format("%s%s #%02x%02x%02x #%02x%02x%02x", kind,
                         pattern->encodes ? "" : " of numbers", a[0], a[1], a[2], b[0], b[1], b[2]);
}

static bool add_checker(struct reader *reader, const struct pattern *pattern, uint32_t *index)
{
    uint8_t *rgba = array_alloc(4, 4);
    for (int i = 0; rgba && i < 4; ++i)
        store_color(pattern, pattern->colors[i == 1 || i == 2], rgba + 4 * i);
    return add_picture(reader, picture_name("checker", pattern), 2, 2, rgba, index);
}

static bool add_gradient(struct reader *reader, const struct pattern *pattern, uint32_t *index)
{
    enum { ROWS = 256 };
    uint8_t *rgba = array_alloc(ROWS, 4);
    for (int row = 0; rgba && row < ROWS; ++row) {
        float s = (float)row / (ROWS - 1), color[3];
        for (int i = 0; i < 3; ++i)
            color[i] = (1.0f - s) * pattern->colors[0][i] + s * pattern->colors[1][i];
        store_color(pattern, color, rgba + 4 * (size_t)row);
    }
    return add_picture(reader, picture_name("gradient", pattern), 1, ROWS, rgba, index);
}

/* One tile of a running bond: two courses, one brick wide, the second shifted by half a brick. */
static bool add_brick(struct reader *reader, const struct pattern *pattern, uint32_t *index)
{
    enum { SIDE = 128, COURSE = SIDE / 2, JOINT = 6 };
    uint8_t *rgba = array_alloc((size_t)SIDE * SIDE, 4);
    for (int y = 0; rgba && y < SIDE; ++y) {
        for (int x = 0; x < SIDE; ++x) {
            int along = (x + (y / COURSE ? SIDE / 2 : 0)) % SIDE;
            bool mortar = y % COURSE < JOINT || along < JOINT;
            store_color(pattern, pattern->colors[mortar],
                        rgba + 4 * ((size_t)y * SIDE + (size_t)x));
        }
    }
    return add_picture(reader, picture_name("brick", pattern), SIDE, SIDE, rgba, index);
}

/* Reads a colour of a pattern. In a map of numbers, which `pattern` does not encode, the bytes of
   "#rrggbb" are the numbers. */
static bool pattern_color(struct reader *reader, const struct place *place, const json_t *value,
                          const struct pattern *pattern, float out[3])
{
    if (!reader_color_value(reader, place, value, out))
        return false;
    for (int i = 0; i < 3; ++i) {
        if (out[i] > 1.0f)
            return reader_fail(
                reader, place,
                "patterns are at most 1; brighter ones need a factor, as `emission`");
        if (json_is_string(value) && !pattern->encodes)
            out[i] = image_srgb_from_linear(out[i]);
    }
    return true;
}

static bool made_texture(struct reader *reader, const struct place *place, const json_t *value,
                         const char *kind, bool srgb, struct scene_texture_use *use)
{
    static const char *const keys[] = {"colors", "size", NULL};
    struct pattern pattern = {.encodes = srgb};
    double size = 1.0;
    if (!reader_object(reader, place, value, keys) ||
        !reader_number(reader, place, value, "size", 1e-6, 1e6, &size))
        return false;
    const json_t *list = json_object_get(value, "colors");
    struct place at_colors = {place, list ? "colors" : kind, 0};
    if (!json_is_array(list) || json_array_size(list) != 2)
        return reader_fail(reader, list ? &at_colors : place, "`colors` takes two colours in [ ]");
    for (size_t i = 0; i < 2; ++i) {
        struct place here = {&at_colors, NULL, i};
        if (!pattern_color(reader, &here, json_array_get(list, i), &pattern, pattern.colors[i]))
            return false;
    }
    /* `size`: how many squares, bricks, or heights of the gradient there are per unit of uv. */
    bool checker = strcmp(kind, "checker") == 0, gradient = strcmp(kind, "gradient") == 0;
    use->transform[0] = use->transform[4] = (float)(checker ? 0.5 * size : size);
    use->nearest = checker;
    if (gradient && size <= 1.0) /* its ends do not blend */
        use->wrap_v = SCENE_WRAP_CLAMP;
    return checker    ? add_checker(reader, &pattern, &use->texture)
           : gradient ? add_gradient(reader, &pattern, &use->texture)
                      : add_brick(reader, &pattern, &use->texture);
}

static bool file_texture(struct reader *reader, const struct place *place, const char *name,
                         struct scene_texture_use *use)
{
    const char *reason = NULL;
    char *path = roots_join(reader->path, name);
    if (!path)
        return reader_no_memory(reader);
    whit_result result =
        load_texture(reader->scene, path, NULL, 0, reader->params, &use->texture, &reason);
    if (result == WHIT_ERROR_INPUT && reason)
        reader_fail(reader, place, "texture `%s`: %s", text_token(name).text, reason);
    else if (result != WHIT_OK)
        reader->result = result;
    free(path);
    return result == WHIT_OK;
}

/* Combines the texture's transform with the pattern's: A * (u, v) + b with A = rotation * scale. */
static bool texture_transform(struct reader *reader, const struct place *place, const json_t *value,
                              struct scene_texture_use *use)
{
    double scale[2] = {1, 1}, offset[2] = {0, 0}, degrees = 0.0;
    if (!reader_numbers(reader, place, value, "scale", 2, scale) ||
        !reader_numbers(reader, place, value, "offset", 2, offset) ||
        !reader_number(reader, place, value, "rotation", -36000.0, 36000.0, &degrees))
        return false;
    double c = same_cos(degrees * PI / 180.0);
    double s = same_sin(degrees * PI / 180.0), size = (double)use->transform[0];
    const double rows[6] = {c * scale[0] * size, -s * scale[1] * size, offset[0],
                            s * scale[0] * size, c * scale[1] * size,  offset[1]};
    for (int i = 0; i < 6; ++i)
        use->transform[i] = (float)rows[i];
    return true;
}

static bool texture_source(struct reader *reader, const struct place *place, const json_t *value,
                           bool srgb, struct scene_texture_use *use)
{
    static const char *const kinds[] = {"file", "checker", "gradient", "brick"};
    const char *kind = NULL;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        if (!has(value, kinds[i]))
            continue;
        if (kind)
            return reader_fail(reader, place, "`%s` and `%s` exclude each other", kind, kinds[i]);
        kind = kinds[i];
    }
    if (!kind)
        return reader_fail(reader, place,
                           "a texture needs a `file`, `checker`, `gradient` or "
                           "`brick`");
    struct place here = {place, kind, 0};
    if (strcmp(kind, "file") != 0)
        return made_texture(reader, &here, json_object_get(value, kind), kind, srgb, use);
    const char *name = NULL;
    return reader_string(reader, place, value, "file", &name) &&
           file_texture(reader, &here, name, use);
}

static bool read_texture(struct reader *reader, const struct place *place, const json_t *object,
                         const char *key, bool srgb, struct scene_texture_use *use)
{
    const json_t *value = json_object_get(object, key);
    struct place here = {place, key, 0};
    uint32_t wrap = SCENE_WRAP_REPEAT;
    if (!value)
        return true;
    if (json_is_string(value))
        return file_texture(reader, &here, json_string_value(value), use);
    if (!reader_object(reader, &here, value, texture_keys) ||
        !texture_source(reader, &here, value, srgb, use) ||
        !texture_transform(reader, &here, value, use) ||
        !reader_choice(reader, &here, value, "wrap", scene_wrap_names, &wrap) ||
        !reader_bool(reader, &here, value, "nearest", &use->nearest) ||
        !reader_count(reader, &here, value, "uv_set", 0, 1, &use->uv_set))
        return false;
    if (has(value, "wrap"))
        use->wrap_u = use->wrap_v = (enum scene_wrap)wrap;
    return true;
}

static bool read_textures(struct reader *reader, const struct place *place, const json_t *value,
                          struct scene_material *out)
{
    static const char *const keys[SCENE_SLOT_COUNT] = {
        [SCENE_SLOT_DIFFUSE] = "texture",       [SCENE_SLOT_SPECULAR] = "specular_map",
        [SCENE_SLOT_EMISSION] = "emission_map", [SCENE_SLOT_NORMAL] = "normal_map",
        [SCENE_SLOT_BUMP] = "bump_map",         [SCENE_SLOT_METAL_ROUGH] = "metal_rough_map",
        [SCENE_SLOT_OPACITY] = "opacity_map",   [SCENE_SLOT_TRANSMISSION] = "transmission_map",
        [SCENE_SLOT_SPECULAR_LEVEL] = NULL, /* only in glTF */
    };
    for (int slot = 0; slot < SCENE_SLOT_COUNT; ++slot) {
        bool srgb = scene_slot_is_srgb((enum scene_slot)slot, out->model);
        if (keys[slot] &&
            !read_texture(reader, place, value, keys[slot], srgb, &out->textures[slot]))
            return false;
    }
    return true;
}

static float largest(const float rgb[3])
{
    return fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
}

static void set_grey(float out[3], float level)
{
    out[0] = out[1] = out[2] = level;
}

/* Defaults depend on the keys given: the diffuse default is what `reflection` leaves, and 0 for
   glass. */
static bool read_phong(struct reader *reader, const struct place *place, const json_t *value,
                       struct scene_material *out)
{
    if (!reader_color(reader, place, value, "reflection", out->reflection))
        return false;
    bool glass = largest(out->transmission) > 0.0f;
    float left = glass ? 0.0f : fmaxf(0.0f, 1.0f - largest(out->reflection));
    set_grey(out->diffuse, has(value, "texture") ? left : 0.7f * left);
    out->fresnel = glass;
    if (!reader_color(reader, place, value, "diffuse", out->diffuse))
        return false;
    memcpy(out->ambient, out->diffuse, sizeof out->ambient);
    return reader_color(reader, place, value, "ambient", out->ambient) &&
           reader_color(reader, place, value, "specular", out->specular) &&
           reader_float(reader, place, value, "shininess", 0.0, 1e6, &out->shininess) &&
           reader_bool(reader, place, value, "fresnel", &out->fresnel);
}

static bool read_metal_rough(struct reader *reader, const struct place *place, const json_t *value,
                             struct scene_material *out)
{
    out->fresnel = true;
    out->roughness = 0.5f;
    set_grey(out->diffuse, has(value, "texture") ? 1.0f : 0.8f);
    set_grey(out->specular, 1.0f);
    return reader_color(reader, place, value, "base_color", out->diffuse) &&
           reader_float(reader, place, value, "metallic", 0.0, 1.0, &out->metallic) &&
           reader_float(reader, place, value, "roughness", 0.0, 1.0, &out->roughness) &&
           reader_float(reader, place, value, "specular_level", 0.0, 1.0, &out->specular_level);
}

static bool read_unlit(struct reader *reader, const struct place *place, const json_t *value,
                       struct scene_material *out)
{
    bool unlit = true;
    struct place here = {place, "unlit", 0};
    if (!reader_bool(reader, place, value, "unlit", &unlit))
        return false;
    if (!unlit)
        return reader_fail(reader, &here, "leave `unlit` out for a material that is lit");
    set_grey(out->diffuse, 1.0f);
    return reader_color(reader, place, value, "color", out->diffuse);
}

static bool read_alpha(struct reader *reader, const struct place *place, const json_t *value,
                       struct scene_material *out)
{
    uint32_t alpha = SCENE_ALPHA_OPAQUE;
    if (!reader_float(reader, place, value, "opacity", 0.0, 1.0, &out->opacity) ||
        !reader_float(reader, place, value, "alpha_cutoff", 0.0, 1.0, &out->alpha_cutoff))
        return false;
    if (out->opacity < 1.0f || has(value, "opacity_map"))
        alpha = SCENE_ALPHA_BLEND;
    if (has(value, "alpha_cutoff"))
        alpha = SCENE_ALPHA_MASK;
    if (!reader_choice(reader, place, value, "alpha", scene_alpha_names, &alpha))
        return false;
    out->alpha = (enum scene_alpha)alpha;
    return true;
}

static bool read_common(struct reader *reader, const struct place *place, const json_t *value,
                        struct scene_material *out)
{
    double ior = (double)out->ior;
    if (!reader_number(reader, place, value, "ior", 0.01, 100.0, &ior))
        return false;
    out->ior = (float)ior;
    return reader_color(reader, place, value, "emission", out->emission) &&
           reader_color(reader, place, value, "transmission", out->transmission) &&
           reader_color(reader, place, value, "absorption", out->absorption) &&
           reader_bool(reader, place, value, "thin_walled", &out->thin_walled) &&
           reader_bool(reader, place, value, "two_sided", &out->two_sided) &&
           reader_bool(reader, place, value, "one_sided", &out->one_sided) &&
           reader_bool(reader, place, value, "shadow_catcher", &out->shadow_catcher) &&
           reader_count(reader, place, value, "priority", 0, 255, &out->priority) &&
           reader_float(reader, place, value, "normal_scale", -1000.0, 1000.0,
                        &out->normal_scale) &&
           read_alpha(reader, place, value, out) && read_textures(reader, place, value, out);
}

/* Refuses keys of other kinds of materials; for their colour keys, the error names this kind's. */
static bool check_keys(struct reader *reader, const struct place *place, const json_t *value,
                       const char *kind_key, const char *const *own)
{
    static const char *const *const kinds[] = {phong_keys, metal_keys, unlit_keys};
    const char *const *lists[] = {common_keys, own};
    const char *color = own == unlit_keys ? "color" : own == metal_keys ? "base_color" : "diffuse";
    const char *foreign = reader_foreign_key(value, lists, 2, kinds, sizeof kinds / sizeof *kinds);
    struct place here = {place, foreign, 0};
    if (!foreign)
        return reader_object_lists(reader, place, value, lists, 2);
    bool colors = strcmp(foreign, "diffuse") == 0 || strcmp(foreign, "base_color") == 0 ||
                  strcmp(foreign, "color") == 0;
    const char *hint[] = {colors ? "; use `" : "", colors ? color : "", colors ? "`" : ""};
    if (!kind_key)
        return reader_fail(reader, &here, "`%s` goes with `unlit` only%s%s%s", foreign, hint[0],
                           hint[1], hint[2]);
    return reader_fail(reader, &here, "`%s` does not go with `%s`%s%s%s", foreign, kind_key,
                       hint[0], hint[1], hint[2]);
}

static bool read_material(struct reader *reader, const struct place *place, const json_t *value,
                          struct scene_material *out)
{
    const char *metal = NULL;
    for (size_t i = 0; metal_keys[i]; ++i)
        metal = !metal && has(value, metal_keys[i]) ? metal_keys[i] : metal;
    bool unlit = has(value, "unlit");
    out->model = unlit ? WHIT_MODEL_UNLIT : metal ? WHIT_MODEL_METAL_ROUGH : WHIT_MODEL_PHONG;
    return check_keys(reader, place, value, unlit ? "unlit" : metal,
                      unlit   ? unlit_keys
                      : metal ? metal_keys
                              : phong_keys) &&
           read_common(reader, place, value, out) &&
           (unlit   ? read_unlit(reader, place, value, out)
            : metal ? read_metal_rough(reader, place, value, out)
                    : read_phong(reader, place, value, out));
}

/* A map times 0 is 0, and these factors are 0 unless they are given. */
static void note_idle_maps(const struct reader *reader, const struct place *place,
                           const struct scene_material *m)
{
    const struct {
        enum scene_slot slot;
        bool idle;
        const char *map, *factor;
    } maps[] = {
        {SCENE_SLOT_EMISSION, largest(m->emission) == 0.0f, "emission_map", "`emission` is"},
        {SCENE_SLOT_TRANSMISSION, largest(m->transmission) == 0.0f, "transmission_map",
         "`transmission` is"},
        {SCENE_SLOT_SPECULAR, largest(m->specular) == 0.0f && largest(m->reflection) == 0.0f,
         "specular_map", "`specular` and `reflection` are"},
    };
    for (size_t i = 0; i < sizeof maps / sizeof *maps; ++i) {
        if (maps[i].idle && m->textures[maps[i].slot].texture != SCENE_NONE)
            scene_note(reader->scene, SCENE_NOTE_WARNING, "%s:%u: `%s` shows nothing, as %s 0",
                       reader->path, reader_line(reader, place), maps[i].map, maps[i].factor);
    }
}

static bool add_material(struct reader *reader, const struct place *place, const json_t *value,
                         const char *name, uint32_t *index)
{
    struct scene_material material;
    scene_material_init(&material, name);
    material.origin.file = string_copy(reader->path);
    material.origin.line = reader_line(reader, place);
    if (!material.name || !material.origin.file) {
        scene_material_finish(&material);
        return reader_no_memory(reader);
    }
    if (!read_material(reader, place, value, &material)) {
        scene_material_finish(&material);
        return false;
    }
    note_idle_maps(reader, place, &material);
    *index = scene_add_material(reader->scene, material);
    return *index != SCENE_NONE || reader_no_memory(reader);
}

bool reader_materials(struct reader *reader, const struct place *place, const json_t *value)
{
    const char *name;
    json_t *material;
    if (!json_is_object(value))
        return reader_fail(reader, place, "an object { } of named materials is expected");
    json_object_foreach((json_t *)(uintptr_t)value, name, material)
    {
        struct place here = {place, name, 0};
        uint32_t index;
        if (strcmp(name, "comment") == 0)
            continue;
        if (!add_material(reader, &here, material, name, &index))
            return false;
        if (!key_table_add(&reader->material_names, name, strlen(name), index))
            return reader_no_memory(reader);
    }
    reader->material_end = reader->scene->material_count;
    return true;
}

static bool named_material(struct reader *reader, const struct place *place, const char *name,
                           uint32_t *index)
{
    const struct scene *scene = reader->scene;
    if (key_table_find(&reader->material_names, name, strlen(name), index))
        return true;
    const char **names = array_alloc_zeroed((size_t)reader->material_end + 1, sizeof *names);
    if (!names)
        return reader_no_memory(reader);
    for (uint32_t i = 0; i < reader->material_end; ++i)
        names[i] = scene->materials[i].name;
    const char *nearest = reader_nearest(name, names);
    reader_fail(reader, place, "there is no material `%s`%s%s%s", text_token(name).text,
                nearest ? "; did you mean `" : "", text_token(nearest).text, nearest ? "`?" : "");
    free(names);
    return false;
}

/* Reads a reference to a material: its name, or a material object written in place. */
static bool material_use(struct reader *reader, const struct place *place, const json_t *value,
                         uint32_t *index)
{
    if (json_is_string(value))
        return named_material(reader, place, json_string_value(value), index);
    if (json_is_object(value))
        return add_material(reader, place, value, "", index);
    return reader_fail(reader, place, "the name of a material, or a material in { }, is expected");
}

bool reader_object_material(struct reader *reader, const struct place *place, const json_t *object,
                            uint32_t *index)
{
    const json_t *value = json_object_get(object, "material");
    struct place here = {place, "material", 0};
    *index = SCENE_NONE;
    return !value || material_use(reader, &here, value, index);
}
