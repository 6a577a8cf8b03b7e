/* Materials and the texels that they use. Texels stay as in their files, 8 bits a channel; shaders
   decode sRGB by a table before they filter, since light adds up and sRGB codes do not. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "device/buffer.h"
#include "picture/mipmap.h"
#include "render/renderer.h"
#include "render/textures.h"

/* A texture that some material uses, in its size on the device. If two materials need its levels
   averaged in two ways (mipmap_kind), it is there twice. */
struct texel_image {
    uint32_t texture; /* index in scene->textures */
    enum mipmap_kind kind;
    uint32_t width, height, first;
    uint32_t halvings;
    uint32_t levels; /* without level 0 */
};

struct material_upload {
    struct renderer *renderer;
    struct texel_image *images;
    uint32_t image_count, image_capacity;
    struct gpu_texture *uses;
    uint32_t *use_images; /* by use: index in `images` */
    uint32_t use_count, use_capacity, use_image_capacity;
    struct gpu_material *materials;
    float cutoff_slack; /* of opacities: how far they may be rounded down */
};

static uint32_t find_image(struct material_upload *up, uint32_t texture, enum mipmap_kind kind)
{
    for (uint32_t i = 0; i < up->image_count; ++i) {
        struct texel_image *image = &up->images[i];
        if (image->texture != texture)
            continue;
        if (image->kind == MIPMAP_NONE)
            image->kind = kind;
        if (kind == MIPMAP_NONE || image->kind == kind)
            return i;
    }
    const struct scene_texture *source = &up->renderer->scene->textures[texture];
    struct texel_image image = {
        .texture = texture, .kind = kind, .width = source->width, .height = source->height};
    if (!ARRAY_PUSH(up->images, up->image_count, up->image_capacity, image))
        return SCENE_NONE;
    return up->image_count - 1;
}

static uint32_t wrap_code(enum scene_wrap wrap)
{
    return wrap == SCENE_WRAP_CLAMP    ? WRAP_CLAMP
           : wrap == SCENE_WRAP_MIRROR ? WRAP_MIRROR
                                       : WRAP_REPEAT;
}

/* *out: index of a new use record for the slot of the material; TEXTURE_NONE if it has no
   texture. */
static whit_result add_use(struct material_upload *up, const struct scene_material *m,
                           enum scene_slot slot, uint32_t *out)
{
    const struct scene_texture_use *use = &m->textures[slot];
    *out = TEXTURE_NONE;
    if (use->texture == SCENE_NONE)
        return WHIT_OK;
    bool minified = up->renderer->params.minification == WHIT_MINIFICATION_MIPMAP;
    uint32_t image = find_image(up, use->texture, minified ? mipmap_kind_of(m, slot) : MIPMAP_NONE);
    const float *t = use->transform;
    struct gpu_texture record = {
        .matrix = {t[0], t[1], t[3], t[4]},
        .offset = {scene_texture_offset(use, 0), scene_texture_offset(use, 1)},
        .wrap = wrap_code(use->wrap_u) | wrap_code(use->wrap_v) << 2,
        .nearest = use->nearest,
        .uv_set = use->uv_set != 0,
        .srgb = scene_slot_is_srgb(slot, m->model),
    };
    uint32_t image_slots = up->use_count;
    if (image == SCENE_NONE || !ARRAY_PUSH(up->uses, up->use_count, up->use_capacity, record) ||
        !ARRAY_PUSH(up->use_images, image_slots, up->use_image_capacity, image))
        return render_no_memory(up->renderer, "textures");
    *out = up->use_count - 1;
    return WHIT_OK;
}

static bool has_alpha(const struct scene *scene, uint32_t texture)
{
    if (texture == SCENE_NONE)
        return false;
    const struct scene_texture *t = &scene->textures[texture];
    size_t count = (size_t)t->width * t->height;
    for (size_t i = 0; i < count; ++i) {
        if (t->rgba[4 * i + 3] != 255)
            return true;
    }
    return false;
}

static uint32_t model_code(whit_material_model model)
{
    return model == WHIT_MODEL_METAL_ROUGH ? MATERIAL_MODEL_METAL_ROUGH
           : model == WHIT_MODEL_UNLIT     ? MATERIAL_MODEL_UNLIT
                                           : MATERIAL_MODEL_PHONG;
}

static uint32_t material_flags(const struct scene_material *m)
{
    return (m->fresnel ? MATERIAL_FRESNEL : 0) | (m->thin_walled ? MATERIAL_THIN : 0) |
           (m->alpha == SCENE_ALPHA_MASK ? MATERIAL_MASK : 0) |
           (m->shadow_catcher ? MATERIAL_CATCHER : 0) |
           (m->alpha == SCENE_ALPHA_BLEND ? MATERIAL_BLEND : 0) |
           m->priority << MATERIAL_PRIORITY_SHIFT;
}

/* Opacity is a texture of its own, or the alpha of the diffuse texture. */
static whit_result add_opacity(struct material_upload *up, const struct scene_material *m,
                               struct gpu_material *out)
{
    out->tex_opacity = TEXTURE_NONE;
    if (m->alpha == SCENE_ALPHA_OPAQUE || !up->renderer->effects.called[SCENE_EFFECT_CUTOUTS])
        return WHIT_OK;
    bool own = m->textures[SCENE_SLOT_OPACITY].texture != SCENE_NONE;
    enum scene_slot slot = own ? SCENE_SLOT_OPACITY : SCENE_SLOT_DIFFUSE;
    bool alpha = has_alpha(up->renderer->scene, m->textures[slot].texture);
    out->flags |= alpha ? MATERIAL_OPACITY_ALPHA : 0;
    return own || alpha ? add_use(up, m, slot, &out->tex_opacity) : WHIT_OK;
}

/* Whether the kernels read the textures of a slot. */
static bool reads_slot(const struct renderer *renderer, enum scene_slot slot)
{
    bool bends = slot == SCENE_SLOT_NORMAL || slot == SCENE_SLOT_BUMP;
    return renderer->effects.called[bends ? SCENE_EFFECT_NORMAL_MAPS : SCENE_EFFECT_TEXTURES];
}

/* Makes glass opaque, for pictures without refraction: it gets the colour that it would let
   through, and reflects as before. `transmission` stays: shadows are still those of glass. */
static void make_solid(struct scene_material *m)
{
    float root = (m->ior - 1.0f) / (m->ior + 1.0f);
    float mirror = m->fresnel ? root * root : 0.0f;
    for (int c = 0; m->model == WHIT_MODEL_PHONG && c < 3; ++c) {
        m->diffuse[c] += (1.0f - mirror) * m->transmission[c];
        m->ambient[c] += (1.0f - mirror) * m->transmission[c];
        m->reflection[c] = m->fresnel ? mirror : m->reflection[c];
    }
}

struct scene_material material_drawn(const struct renderer *renderer, uint32_t index)
{
    struct scene_material m = renderer->scene->materials[index];
    bool glass = m.transmission[0] > 0.0f || m.transmission[1] > 0.0f || m.transmission[2] > 0.0f;
    if (glass && m.model != WHIT_MODEL_UNLIT && !renderer->effects.called[SCENE_EFFECT_REFRACTION])
        make_solid(&m);
    return m;
}

bool textures_minify(const struct renderer *renderer)
{
    const struct scene *scene = renderer->scene;
    if (renderer->params.minification != WHIT_MINIFICATION_MIPMAP)
        return false;
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        const struct scene_material *m = &scene->materials[i];
        for (int slot = 0; slot < SCENE_SLOT_COUNT; ++slot) {
            enum scene_slot s = (enum scene_slot)slot;
            if (m->textures[s].texture != SCENE_NONE && reads_slot(renderer, s) &&
                mipmap_kind_of(m, s) != MIPMAP_NONE)
                return true;
        }
    }
    return false;
}

static whit_result add_material(struct material_upload *up, uint32_t index)
{
    const struct scene_material drawn = material_drawn(up->renderer, index), *m = &drawn;
    struct gpu_material *out = &up->materials[index];
    memcpy(out->diffuse, m->diffuse, sizeof out->diffuse);
    memcpy(out->ambient, m->ambient, sizeof out->ambient);
    memcpy(out->specular, m->specular, sizeof out->specular);
    memcpy(out->emission, m->emission, sizeof out->emission);
    memcpy(out->reflection, m->reflection, sizeof out->reflection);
    memcpy(out->transmission, m->transmission, sizeof out->transmission);
    memcpy(out->absorption, m->absorption, sizeof out->absorption);
    out->model = model_code(m->model);
    out->flags = material_flags(m);
    out->shininess = m->shininess;
    out->ior = m->ior;
    out->roughness = m->roughness;
    out->metallic = m->metallic;
    out->opacity = m->opacity;
    out->normal_scale = m->normal_scale;
    out->alpha_cutoff = m->alpha_cutoff - up->cutoff_slack;
    out->specular_level = m->specular_level;
    const struct {
        enum scene_slot slot;
        uint32_t *use;
    } slots[] = {
        {SCENE_SLOT_DIFFUSE, &out->tex_diffuse},
        {SCENE_SLOT_SPECULAR, &out->tex_specular},
        {SCENE_SLOT_EMISSION, &out->tex_emission},
        {SCENE_SLOT_NORMAL, &out->tex_normal},
        {SCENE_SLOT_BUMP, &out->tex_bump},
        {SCENE_SLOT_METAL_ROUGH, &out->tex_metal_rough},
        {SCENE_SLOT_TRANSMISSION, &out->tex_transmission},
        {SCENE_SLOT_SPECULAR_LEVEL, &out->tex_specular_level},
    };
    for (size_t i = 0; i < sizeof slots / sizeof *slots; ++i) {
        *slots[i].use = TEXTURE_NONE;
        if (!reads_slot(up->renderer, slots[i].slot))
            continue;
        whit_result result = add_use(up, m, slots[i].slot, slots[i].use);
        if (result != WHIT_OK)
            return result;
    }
    return add_opacity(up, m, out);
}

static uint64_t texel_total(const struct material_upload *up)
{
    uint64_t total = 0;
    for (uint32_t i = 0; i < up->image_count; ++i)
        total += (uint64_t)up->images[i].width * up->images[i].height;
    return total;
}

/* The words that an image takes: level 0, a word for each further level, their texels. */
static uint64_t image_words(const struct texel_image *image)
{
    uint64_t words = mipmap_first(image->width, image->height, image->levels + 1);
    return words + image->levels;
}

/* Adds mipmap levels where there is room for them. A texture without levels is sampled as without
   minification. */
static void add_levels(struct material_upload *up, uint64_t limit)
{
    uint64_t room = limit - texel_total(up);
    uint32_t left_out = 0;
    for (uint32_t i = 0; i < up->image_count; ++i) {
        struct texel_image *image = &up->images[i];
        if (image->kind == MIPMAP_NONE)
            continue;
        image->levels = mipmap_levels(image->width, image->height);
        uint64_t more = image_words(image) - (uint64_t)image->width * image->height;
        if (more > room) {
            image->levels = 0;
            ++left_out;
            continue;
        }
        room -= more;
    }
    if (left_out)
        log_warning(&up->renderer->log,
                    "textures: %u without smaller levels, to fit the device's buffers", left_out);
}

/* Halves the largest textures until all fit into one buffer, and logs a warning. */
static void fit_images(struct material_upload *up, uint64_t limit)
{
    uint32_t halvings = 0;
    while (texel_total(up) > limit) {
        struct texel_image *largest = &up->images[0];
        for (uint32_t i = 1; i < up->image_count; ++i) {
            if ((uint64_t)up->images[i].width * up->images[i].height >
                (uint64_t)largest->width * largest->height)
                largest = &up->images[i];
        }
        largest->width = (largest->width + 1) / 2;
        largest->height = (largest->height + 1) / 2;
        ++largest->halvings;
        ++halvings;
    }
    if (halvings)
        log_warning(&up->renderer->log,
                    "textures: halved %u times, largest first, to fit the device's buffers",
                    halvings);
}

/* Halves the size, by averaging up to 2x2 texels; updates *width and *height. */
static void halve_texels(const uint8_t *from, uint32_t *width, uint32_t *height, uint8_t *to)
{
    uint32_t w = (*width + 1) / 2, h = (*height + 1) / 2;
    for (uint32_t y = 0; y < h; ++y) {
        for (uint32_t x = 0; x < w; ++x) {
            size_t x0 = 2 * x, y0 = 2 * y;
            size_t x1 = x0 + 1 < *width ? x0 + 1 : x0, y1 = y0 + 1 < *height ? y0 + 1 : y0;
            for (size_t c = 0; c < 4; ++c) {
                unsigned sum = 0u + from[4 * (y0 * *width + x0) + c] +
                               from[4 * (y0 * *width + x1) + c] + from[4 * (y1 * *width + x0) + c] +
                               from[4 * (y1 * *width + x1) + c];
                to[4 * ((size_t)y * w + x) + c] = (uint8_t)((sum + 2) / 4);
            }
        }
    }
    *width = w;
    *height = h;
}

/* Writes the levels behind level 0 of an image, which is `rgba`. */
static whit_result write_levels(struct material_upload *up, const struct texel_image *image,
                                const uint8_t *rgba)
{
    struct buffer *buffer = up->renderer->scene_buffers.texels;
    uint64_t texels = (uint64_t)image->width * image->height;
    uint64_t more = mipmap_first(image->width, image->height, image->levels + 1) - texels;
    uint32_t firsts[MIPMAP_LEVELS_MAX];
    if (image->levels == 0)
        return WHIT_OK;
    for (uint32_t i = 0; i < image->levels; ++i)
        firsts[i] = image->first + image->levels +
                    (uint32_t)mipmap_first(image->width, image->height, i + 1);
    uint8_t *levels = mipmap_make(rgba, image->width, image->height, image->kind);
    if (!levels)
        return render_no_memory(up->renderer, "the levels of a texture");
    uint64_t at = (image->first + texels) * 4;
    whit_result result = buffer_write(buffer, at, firsts, (uint64_t)image->levels * 4);
    if (result == WHIT_OK)
        result = buffer_write(buffer, at + (uint64_t)image->levels * 4, levels, more * 4);
    free(levels);
    return result;
}

static whit_result write_image(struct material_upload *up, const struct texel_image *image)
{
    const struct scene_texture *source = &up->renderer->scene->textures[image->texture];
    uint32_t width = source->width, height = source->height;
    const uint8_t *rgba = source->rgba;
    uint8_t *half = NULL;
    if (image->halvings) {
        rgba = half = array_alloc(((size_t)width + 1) / 2 * (((size_t)height + 1) / 2), 4);
        if (!half)
            return render_no_memory(up->renderer, "a texture");
        halve_texels(source->rgba, &width, &height, half);
    }
    for (uint32_t i = 1; i < image->halvings; ++i)
        halve_texels(half, &width, &height, half); /* in place: reads ahead of its writes */
    whit_result result =
        buffer_write(up->renderer->scene_buffers.texels, (uint64_t)image->first * 4, rgba,
                     (uint64_t)width * height * 4);
    if (result == WHIT_OK)
        result = write_levels(up, image, rgba);
    free(half);
    return result;
}

static whit_result write_table(struct material_upload *up)
{
    _Static_assert(MIPMAP_PIECES == LEVEL_PIECES &&
                       TEXEL_TABLE_WORDS == TEXEL_CODES + 2 * LEVEL_PIECES,
                   "as kernels read it");
    float table[TEXEL_TABLE_WORDS];
    for (uint32_t i = 0; i < TEXEL_CODES; ++i)
        table[i] = image_linear_from_srgb((float)i / 255.0f);
    mipmap_pieces(&table[TEXEL_CODES]);
    return buffer_write(up->renderer->scene_buffers.texels, 0, table, sizeof table);
}

static whit_result upload_texels(struct material_upload *up)
{
    struct renderer *renderer = up->renderer;
    struct scene_buffers *buffers = &renderer->scene_buffers;
    if (up->image_count == 0)
        return WHIT_OK;
    uint64_t limit = buffers->texel_loads
                         ? device_get_limits(renderer->device)->max_texel_elements * 4
                         : device_get_info(renderer->device)->max_storage_range_bytes / 4;
    if (limit > UINT32_MAX) /* offsets of words have 32 bits */
        limit = UINT32_MAX;
    fit_images(up, limit - TEXEL_TABLE_WORDS);
    add_levels(up, limit - TEXEL_TABLE_WORDS);
    uint64_t words = TEXEL_TABLE_WORDS;
    for (uint32_t i = 0; i < up->image_count; ++i)
        words += image_words(&up->images[i]);
    uint32_t uses = buffers->texel_loads ? BUFFER_TEXELS : BUFFER_STORAGE;
    whit_result result =
        buffer_create(renderer->device, words * 4, uses, "texels", &buffers->texels);
    if (result == WHIT_OK)
        result = write_table(up);
    uint32_t first = TEXEL_TABLE_WORDS;
    for (uint32_t i = 0; result == WHIT_OK && i < up->image_count; ++i) {
        struct texel_image *image = &up->images[i];
        image->first = first;
        first += (uint32_t)image_words(image);
        result = write_image(up, image);
    }
    if (result == WHIT_OK)
        buffers->bytes += buffer_size(buffers->texels);
    return result;
}

static void place_uses(struct material_upload *up)
{
    for (uint32_t i = 0; i < up->use_count; ++i) {
        const struct texel_image *image = &up->images[up->use_images[i]];
        up->uses[i].first = image->first;
        up->uses[i].size = image->width | image->height << 16;
        up->uses[i].wrap |= image->levels << TEXTURE_LEVELS_SHIFT;
    }
}

/* A bit more than half a step of vertex colours, which upload.c packs to 16 bits: their alpha may
   be meant to equal the cutoff. */
static float find_cutoff_slack(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        if (scene->meshes[i].colors)
            return 0x1.1p-17f;
    }
    return 0.0f;
}

whit_result material_records_init(struct renderer *renderer, struct material_records *records)
{
    const struct scene *scene = renderer->scene;
    struct material_upload up = {.renderer = renderer, .cutoff_slack = find_cutoff_slack(scene)};
    *records = (struct material_records){0};
    up.materials = array_alloc_zeroed(scene->material_count, sizeof *up.materials);
    whit_result result = up.materials ? WHIT_OK : render_no_memory(renderer, "materials");
    for (uint32_t i = 0; result == WHIT_OK && i < scene->material_count; ++i)
        result = add_material(&up, i);
    if (result == WHIT_OK)
        result = upload_texels(&up);
    if (result == WHIT_OK)
        place_uses(&up);
    free(up.images);
    free(up.use_images);
    *records = (struct material_records){up.materials, up.uses, up.use_count};
    if (result != WHIT_OK)
        material_records_finish(records);
    return result;
}

void material_records_finish(struct material_records *records)
{
    free(records->materials);
    free(records->uses);
    *records = (struct material_records){0};
}
