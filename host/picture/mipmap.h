/* Mipmaps: smaller levels of a texture, each with half the side of the one before, for surfaces
   that show it minified (Williams 1983, Pyramidal Parametrics). Kernels and reference read the same
   bytes. */
#ifndef PICTURE_MIPMAP_H
#define PICTURE_MIPMAP_H

#include "scene/scene.h"

/* The values that are averaged. Alpha is always averaged linearly. */
enum mipmap_kind {
    MIPMAP_NONE,   /* no smaller levels: the texture is read by traversal, which does not know the
                      pixel */
    MIPMAP_LINEAR, /* the bytes as they are: normals as vectors, heights, factors, opacity */
    MIPMAP_SRGB,   /* linear light, from sRGB bytes of red, green and blue */
    MIPMAP_COVER,  /* as MIPMAP_SRGB, weighted by alpha: transparent texels do not tint others */
};
enum { MIPMAP_LEVELS_MAX = 15 }; /* after level 0, as sides are below 2^16 */

/* How the texture in a slot of the material is averaged. */
enum mipmap_kind mipmap_kind_of(const struct scene_material *material, enum scene_slot slot);

/* The side of a level: halves, rounded down, and at least 1. */
static inline uint32_t mipmap_side(uint32_t side, uint32_t level)
{
    return side >> level ? side >> level : 1;
}

/* The number of levels after level 0, down to one texel; 0 for a texture of one texel. */
uint32_t mipmap_levels(uint32_t width, uint32_t height);
/* The number of texels of all levels before `level`: for 1, those of level 0. */
uint64_t mipmap_first(uint32_t width, uint32_t height, uint32_t level);

/* Makes all levels after level 0, one after the other, 8-bit RGBA, by a box filter: each texel is
   the mean of the texels of the level before that it covers, for odd sides also of parts of texels.
   `kind` is not MIPMAP_NONE. free() it; NULL: memory ran out, or level 0 has only one texel. */
uint8_t *mipmap_make(const uint8_t *rgba, uint32_t width, uint32_t height, enum mipmap_kind kind);

/* mipmap_level approximates the logarithm of 1 .. 2 by this many linear pieces. */
enum { MIPMAP_PIECES = 16 };
/* For each piece: half the binary logarithm at its start, and the increase up to its end, as
   kernels read them. */
void mipmap_pieces(float pieces[2 * MIPMAP_PIECES]);
/* The level whose texels are as large as `texels` of level 0: half their binary logarithm, with an
   error of at most 4e-4; 0 up to one texel and for NaN. The twin of mip_level in
   shaders/bind/shading.glsl. */
double mipmap_level(const float pieces[2 * MIPMAP_PIECES], double texels);

/* The area in texels that a filtered texel covers. With linear interpolation a texel of side t
   shows as a box convolved with a tent, of variance t^2 / 12 + t^2 / 6. That is the variance w^2 /
   12 of a box of side w with w^2 = 3 t^2. */
#define MIPMAP_PIXEL_TEXELS 3.0

/* The share of the pixel's area that sample `index` stands for: 1 for the first, 1/4 for the next
   three, 1/16 for the next 12, and so on. The samples of a pixel are one nested sequence of which
   any number makes a picture. So the footprint of a sample is that of the smallest even pattern
   that contains it, and with many samples the mean approaches the unblurred texture. */
double mipmap_sample_share(uint32_t index);

#endif
