/* Mipmap levels of textures, and which of them a pixel uses. */
#include "../random.h"
#include "../scenes.h"
#include "base/color.h"
#include "picture/mipmap.h"
#include "unit.h"

static const uint32_t sizes[][2] = {{1, 1},   {2, 2},   {1, 33}, {40, 1}, {3, 3},
                                    {37, 20}, {16, 64}, {7, 5},  {2, 9},  {255, 254}};
enum { SIZES = sizeof sizes / sizeof *sizes };

TEST(levels_go_down_to_one_texel)
{
    for (int i = 0; i < SIZES; ++i) {
        uint32_t width = sizes[i][0], height = sizes[i][1], levels = mipmap_levels(width, height);
        uint64_t texels = 0;
        for (uint32_t k = 0; k <= levels; ++k) {
            uint32_t across = mipmap_side(width, k), down = mipmap_side(height, k);
            assert_int_equal(mipmap_first(width, height, k), texels);
            assert_int_equal(across * down == 1, k == levels);
            texels += (uint64_t)across * down;
        }
    }
    assert_int_equal(mipmap_levels(65535, 1), MIPMAP_LEVELS_MAX);
    assert_null(mipmap_make((const uint8_t[4]){1, 2, 3, 4}, 1, 1, MIPMAP_SRGB));
}

/* ---- A box filter by its definition ---- */

/* On one axis: how much of texel `texel` of a side of `from` texels is covered by texel `at` of the
   next level, whose side has `to` texels. */
static double overlap(uint32_t from, uint32_t to, uint32_t texel, uint32_t at)
{
    double low = (double)at * from / to, high = (at + 1.0) * from / to;
    return fmax(fmin(high, texel + 1.0) - fmax(low, texel), 0.0);
}

static double decode(double code, int channel, enum mipmap_kind kind)
{
    return channel < 3 && kind != MIPMAP_LINEAR ? linear_from_srgb(code / 255.0) : code / 255.0;
}

static double encode(double value, int channel, enum mipmap_kind kind)
{
    return 255.0 * (channel < 3 && kind != MIPMAP_LINEAR ? srgb_from_linear(value) : value);
}

/* Replaces a picture, four doubles per texel, by its next level. */
static void shrink(double *rgba, uint32_t *width, uint32_t *height, enum mipmap_kind kind)
{
    uint32_t across = *width > 1 ? *width / 2 : 1, down = *height > 1 ? *height / 2 : 1;
    double *out = calloc((size_t)across * down, 4 * sizeof *out);
    assert_non_null(out);
    for (uint32_t at = 0; at < across * down; ++at) {
        double sum[4] = {0}, area = 0.0, alpha = 0.0;
        for (uint32_t from = 0; from < *width * *height; ++from) {
            double part = overlap(*width, across, from % *width, at % across) *
                          overlap(*height, down, from / *width, at / across);
            area += part;
            alpha += part * rgba[4 * from + 3];
        }
        for (uint32_t from = 0; from < *width * *height; ++from) {
            double part = overlap(*width, across, from % *width, at % across) *
                          overlap(*height, down, from / *width, at / across) / area;
            bool weighed = kind == MIPMAP_COVER && alpha > 0.0;
            double cover = weighed ? rgba[4 * from + 3] * area / alpha : 1.0;
            for (int c = 0; c < 4; ++c)
                sum[c] += part * rgba[4 * from + (unsigned)c] * (c < 3 ? cover : 1.0);
        }
        memcpy(&out[4 * at], sum, sizeof sum);
    }
    memcpy(rgba, out, 4 * (size_t)across * down * sizeof *out);
    free(out);
    *width = across;
    *height = down;
}

static void check_levels(uint32_t width, uint32_t height, enum mipmap_kind kind)
{
    size_t texels = (size_t)width * height;
    uint64_t random = texels + kind;
    own_memory uint8_t *bytes = malloc(4 * texels);
    own_memory double *rgba = malloc(4 * texels * sizeof *rgba);
    assert_non_null(bytes);
    assert_non_null(rgba);
    for (size_t i = 0; i < 4 * texels; ++i) {
        bool empty = i % 4 == 3 && random_below(&random, 3) == 0;
        bytes[i] = empty ? 0 : (uint8_t)random_below(&random, 256);
        rgba[i] = decode(bytes[i], i % 4, kind);
    }
    uint8_t *levels = mipmap_make(bytes, width, height, kind), *at = levels;
    while (width * height > 1) {
        shrink(rgba, &width, &height, kind);
        for (size_t i = 0; i < 4 * (size_t)width * height; ++i, ++at) {
            /* A code is off by at most half a step, and by the rounding of floats. */
            double low = decode(fmax(*at - 0.5, 0.0), i % 4, kind) - 1e-6,
                   high = decode(fmin(*at + 0.5, 255.0), i % 4, kind) + 1e-6;
            if (!(rgba[i] >= low && rgba[i] <= high))
                fail_msg("%ux%u, kind %u, value %zu: %u in place of %g", width, height, kind, i,
                         *at, encode(rgba[i], i % 4, kind));
        }
    }
    free(levels);
}

TEST(texels_are_means_of_what_they_cover)
{
    for (int i = 0; i < SIZES - 1; ++i) {
        check_levels(sizes[i][0], sizes[i][1], MIPMAP_LINEAR);
        check_levels(sizes[i][0], sizes[i][1], MIPMAP_SRGB);
        check_levels(sizes[i][0], sizes[i][1], MIPMAP_COVER);
    }
}

TEST(one_colour_stays)
{
    uint8_t rgba[4 * 15];
    for (int code = 0; code < 256; ++code) {
        for (enum mipmap_kind kind = MIPMAP_LINEAR; kind <= MIPMAP_COVER; ++kind) {
            memset(rgba, code, sizeof rgba);
            own_memory uint8_t *levels = mipmap_make(rgba, 3, 5, kind);
            assert_non_null(levels);
            for (int i = 0; i < 4 * 3; ++i) /* of 1 x 2 and 1 x 1 texels */
                assert_int_equal(levels[i], code);
        }
    }
}

TEST(slots_are_averaged_as_what_they_are)
{
    struct scene_material m = material_plain("m");
    for (int slot = 0; slot < SCENE_SLOT_COUNT; ++slot)
        m.textures[slot].texture = SCENE_NONE;
    m.alpha = SCENE_ALPHA_OPAQUE;
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_DIFFUSE), MIPMAP_SRGB);
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_EMISSION), MIPMAP_SRGB);
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_SPECULAR), MIPMAP_LINEAR);
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_NORMAL), MIPMAP_LINEAR);
    m.model = WHIT_MODEL_METAL_ROUGH;
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_SPECULAR), MIPMAP_SRGB);
    m.alpha = SCENE_ALPHA_BLEND;
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_DIFFUSE), MIPMAP_COVER);
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_OPACITY), MIPMAP_LINEAR);
    m.textures[SCENE_SLOT_OPACITY].texture = 0;
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_DIFFUSE), MIPMAP_SRGB);
    m.alpha = SCENE_ALPHA_MASK;
    assert_int_equal(mipmap_kind_of(&m, SCENE_SLOT_OPACITY), MIPMAP_NONE);
}

/* ---- The level for a pixel ---- */

TEST(level_is_half_the_logarithm)
{
    float pieces[2 * MIPMAP_PIECES];
    double before = 0.0;
    mipmap_pieces(pieces);
    for (double texels = 1e-3; texels < 1e12; texels *= 1.0007) {
        double level = mipmap_level(pieces, texels), right = fmax(0.5 * log2(texels), 0.0);
        if (!(fabs(level - right) <= 4e-4))
            fail_msg("%.9g texels: level %.9g in place of %.9g", texels, level, right);
        assert_true(level >= before);
        before = level;
    }
    for (int k = 0; k <= 20; ++k)
        assert_true(mipmap_level(pieces, ldexp(1.0, 2 * k)) == k);
    assert_true(mipmap_level(pieces, (double)NAN) == 0.0);
    assert_true(mipmap_level(pieces, -4.0) == 0.0);
    assert_true(mipmap_level(pieces, 0.0) == 0.0);
    assert_true(mipmap_level(pieces, (double)INFINITY) == MIPMAP_LEVELS_MAX);
}

TEST(samples_stand_for_parts_of_even_patterns)
{
    for (uint32_t i = 0; i < 4096; ++i) {
        uint32_t pattern = 1; /* the smallest power of 4 that holds it */
        while (pattern <= i)
            pattern *= 4;
        assert_true(mipmap_sample_share(i) == 1.0 / pattern);
    }
}
