#include "picture/mipmap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/color.h"
#include "base/same.h"
#include "base/threads.h"

/* ---- Sizes ---- */

uint32_t mipmap_levels(uint32_t width, uint32_t height)
{
    uint32_t levels = 0;
    for (uint32_t side = width > height ? width : height; side > 1; side /= 2)
        ++levels;
    return levels;
}

uint64_t mipmap_first(uint32_t width, uint32_t height, uint32_t level)
{
    uint64_t texels = 0;
    for (uint32_t i = 0; i < level; ++i)
        texels += (uint64_t)mipmap_side(width, i) * mipmap_side(height, i);
    return texels;
}

enum mipmap_kind mipmap_kind_of(const struct scene_material *m, enum scene_slot slot)
{
    if (slot == SCENE_SLOT_OPACITY && m->alpha == SCENE_ALPHA_MASK)
        return MIPMAP_NONE;
    /* Without an opacity map the alpha of the diffuse texture is the opacity. */
    if (slot == SCENE_SLOT_DIFFUSE && m->alpha != SCENE_ALPHA_OPAQUE &&
        m->textures[SCENE_SLOT_OPACITY].texture == SCENE_NONE)
        return MIPMAP_COVER;
    return scene_slot_is_srgb(slot, m->model) ? MIPMAP_SRGB : MIPMAP_LINEAR;
}

/* ---- Averages ---- */

/* Conversion between 8-bit codes and linear values 0..1. */
struct curve {
    float linear[256];
    float upper[256]; /* largest linear value that has this code */
    uint8_t guess[4097];
};

static void curve_init(struct curve *curve, bool srgb)
{
    for (int i = 0; i < 256; ++i) {
        curve->linear[i] = (float)(srgb ? linear_from_srgb(i / 255.0) : i / 255.0);
        double middle = fmin((i + 0.5) / 255.0, 1.0);
        curve->upper[i] = (float)(srgb ? linear_from_srgb(middle) : middle);
    }
    uint32_t code = 0;
    for (uint32_t i = 0; i <= 4096; ++i) {
        while (code < 255 && curve->upper[code] < (float)i / 4096.0f)
            ++code;
        curve->guess[i] = (uint8_t)code;
    }
}

/* The code nearest to a linear value; the limit is halfway between two codes. */
static uint8_t encode(const struct curve *curve, float linear)
{
    uint32_t code = curve->guess[(uint32_t)(linear * 4096.0f)];
    while (code < 255 && curve->upper[code] < linear)
        ++code;
    return (uint8_t)code;
}

/* The texels, in one dimension of `from` texels, that texel `at` of the next smaller level covers,
   and their weights. Where 2n + 1 texels become n, each covers one texel and parts of its two
   neighbours. */
struct cover {
    uint32_t first, count;
    float weights[3];
};

static struct cover cover_of(uint32_t from, uint32_t at)
{
    uint32_t half = mipmap_side(from, 1);
    struct cover cover = {.first = 2 * at, .count = 2, .weights = {0.5f, 0.5f}};
    if (from == 1)
        return (struct cover){.count = 1, .weights = {1.0f}};
    if (from % 2 == 0)
        return cover;
    cover.count = 3;
    cover.weights[0] = (float)(half - at) / (float)from;
    cover.weights[1] = (float)half / (float)from;
    cover.weights[2] = (float)(at + 1) / (float)from;
    return cover;
}

/* A level as source of the next one: level 0 as bytes, later ones as unrounded floats. */
struct level {
    const uint8_t *bytes;
    const float *values; /* or NULL: `bytes` */
    uint32_t width, height;
    const struct curve *light, *plain; /* light: curve of red, green and blue; plain: of alpha */
};

static void read_texel(const struct level *level, size_t at, float rgba[4])
{
    for (size_t c = 0; c < 4; ++c) {
        const struct curve *curve = c < 3 ? level->light : level->plain;
        rgba[c] =
            level->values ? level->values[4 * at + c] : curve->linear[level->bytes[4 * at + c]];
    }
}

/* Computes a texel of the next level as a mean; `covering`: colours are weighted by alpha, unless
   all alpha is 0. */
static void average(const struct level *level, uint32_t x, uint32_t y, bool covering, float out[4])
{
    const struct cover across = cover_of(level->width, x), down = cover_of(level->height, y);
    float plain[4] = {0}, covered[3] = {0};
    for (uint32_t j = 0; j < down.count; ++j) {
        for (uint32_t i = 0; i < across.count; ++i) {
            float rgba[4], weight = across.weights[i] * down.weights[j];
            read_texel(level, (size_t)(down.first + j) * level->width + across.first + i, rgba);
            for (int c = 0; c < 4; ++c)
                plain[c] += weight * rgba[c];
            for (int c = 0; c < 3; ++c)
                covered[c] += weight * rgba[3] * rgba[c];
        }
    }
    for (int c = 0; covering && plain[3] > 0.0f && c < 3; ++c)
        plain[c] = covered[c] / plain[3];
    for (int c = 0; c < 4; ++c)
        out[c] = plain[c] < 1.0f ? plain[c] : 1.0f; /* weights add up to 1 within rounding */
}

/* As average(), for even sides, where four texels have weights of a quarter each. The bits are the
   same, as products with a power of 2 are not rounded. */
static void average_even(const struct level *level, uint32_t x, uint32_t y, float out[4])
{
    size_t at = (size_t)(2 * y) * level->width + 2 * x;
    float a[4], b[4], c[4], d[4];
    read_texel(level, at, a);
    read_texel(level, at + 1, b);
    read_texel(level, at + level->width, c);
    read_texel(level, at + level->width + 1, d);
    for (int i = 0; i < 4; ++i)
        out[i] = 0.25f * (((a[i] + b[i]) + c[i]) + d[i]);
}

/* A level that several threads make, in bands of rows. */
enum { BAND_ROWS = 64 };
struct making {
    const struct level *from;
    bool covering;
    uint32_t width, height;
    float *values;
    uint8_t *bytes;
};

static void make_band(void *context, uint32_t band)
{
    const struct making *making = context;
    const struct level *from = making->from;
    bool even = from->width % 2 == 0 && from->height % 2 == 0 && !making->covering;
    uint32_t first = band * BAND_ROWS, left = making->height - first;
    uint32_t end = first + (left < BAND_ROWS ? left : BAND_ROWS);
    float *values = making->values + (size_t)first * making->width * 4;
    uint8_t *bytes = making->bytes + (size_t)first * making->width * 4;
    for (uint32_t y = first; y < end; ++y) {
        for (uint32_t x = 0; x < making->width; ++x, values += 4, bytes += 4) {
            if (even)
                average_even(from, x, y, values);
            else
                average(from, x, y, making->covering, values);
            for (int c = 0; c < 3; ++c)
                bytes[c] = encode(from->light, values[c]);
            bytes[3] = encode(from->plain, values[3]);
        }
    }
}

static void make_level(const struct level *from, bool covering, float *values, uint8_t *bytes)
{
    struct making making = {.from = from,
                            .covering = covering,
                            .width = mipmap_side(from->width, 1),
                            .height = mipmap_side(from->height, 1),
                            .values = values,
                            .bytes = bytes};
    uint32_t bands = (making.height + BAND_ROWS - 1) / BAND_ROWS;
    threads_for(0, bands, make_band, &making);
}

uint8_t *mipmap_make(const uint8_t *rgba, uint32_t width, uint32_t height, enum mipmap_kind kind)
{
    uint32_t levels = mipmap_levels(width, height);
    uint64_t texels = mipmap_first(width, height, levels + 1) - (uint64_t)width * height;
    struct curve *curves = malloc(2 * sizeof *curves);
    uint8_t *bytes = levels ? array_alloc(texels, 4) : NULL;
    float *values = array_alloc(texels, 4 * sizeof *values);
    struct level level = {.bytes = rgba, .width = width, .height = height};
    if (curves && bytes && values) {
        curve_init(&curves[0], kind != MIPMAP_LINEAR);
        curve_init(&curves[1], false);
        level.light = &curves[0];
        level.plain = &curves[1];
    } else {
        free(bytes);
        bytes = NULL;
    }
    size_t at = 0;
    for (uint32_t i = 1; bytes && i <= levels; ++i) {
        make_level(&level, kind == MIPMAP_COVER, values + 4 * at, bytes + 4 * at);
        level.values = values + 4 * at;
        level.width = mipmap_side(width, i);
        level.height = mipmap_side(height, i);
        at += (size_t)level.width * level.height;
    }
    free(curves);
    free(values);
    return bytes;
}

/* ---- Which level ---- */

void mipmap_pieces(float pieces[2 * MIPMAP_PIECES])
{
    for (int i = 0; i < MIPMAP_PIECES; ++i) {
        double here = 0.5 * same_log2(1.0 + (double)i / MIPMAP_PIECES);
        double next = 0.5 * same_log2(1.0 + (i + 1.0) / MIPMAP_PIECES);
        pieces[2 * i] = (float)here;
        pieces[2 * i + 1] = (float)(next - here);
    }
}

double mipmap_level(const float pieces[2 * MIPMAP_PIECES], double texels)
{
    int exponent;
    if (!(texels > 1.0))
        return 0.0;
    if (isinf(texels))
        return MIPMAP_LEVELS_MAX;
    double along = (2.0 * frexp(texels, &exponent) - 1.0) * MIPMAP_PIECES, piece = floor(along);
    const float *line = &pieces[2 * (int)piece];
    return 0.5 * (exponent - 1) + (double)line[0] + (double)line[1] * (along - piece);
}

double mipmap_sample_share(uint32_t index)
{
    double share = 1.0;
    for (; index > 0; index /= 4)
        share *= 0.25;
    return share;
}
