/* Smaller pictures of a texture, each of half the side, for surfaces that show it smaller than it
   is (Williams 1983, Pyramidal Parametrics). Kernels and reference read the same bytes. */
#ifndef PICTURE_MIPMAP_H
#define PICTURE_MIPMAP_H

#include "scene/scene.h"

/* What is averaged. Alpha always is as it stands. */
enum mipmap_kind {
    MIPMAP_NONE,   /* there are no smaller ones: what traversal asks, which knows no pixel */
    MIPMAP_LINEAR, /* bytes: normals as vectors, heights, factors, opacity */
    MIPMAP_SRGB,   /* light, which the bytes of red, green and blue stand for */
    MIPMAP_COVER, /* the same, each texel weighed by its alpha: what covers nothing tints nothing */
};
enum { MIPMAP_LEVELS_MAX = 15 }; /* behind level 0: sides are below 2^16 */

/* What the texture in a slot of the material is averaged as. */
enum mipmap_kind mipmap_kind_of(const struct scene_material *material, enum scene_slot slot);

/* The side of a level: halves, rounded down, and at least 1. */
static inline uint32_t mipmap_side(uint32_t side, uint32_t level)
{
    return side >> level ? side >> level : 1;
}

/* How many levels there are behind level 0, down to one texel; 0 for a texture of one texel. */
uint32_t mipmap_levels(uint32_t width, uint32_t height);
/* The texels of all levels before `level`: of level 0 for 1, and so on. */
uint64_t mipmap_first(uint32_t width, uint32_t height, uint32_t level);

/* All levels behind level 0 one after the other, RGBA of 8 bits as in level 0, by a box filter:
   each texel is the mean of what it covers of the level before, of odd sides parts of texels too.
   `kind` is not MIPMAP_NONE. free() it; NULL: memory ran out, or there is no such level. */
uint8_t *mipmap_make(const uint8_t *rgba, uint32_t width, uint32_t height, enum mipmap_kind kind);

/* mipmap_level reads the logarithm of 1 .. 2 in so many straight pieces. */
enum { MIPMAP_PIECES = 16 };
/* Half the binary logarithm where a piece begins, and by how much it grows up to its end: as
   kernels read them. */
void mipmap_pieces(float pieces[2 * MIPMAP_PIECES]);
/* The level whose texels are as large as `texels` of level 0: half their binary logarithm, within
   4e-4; 0 up to one texel and for NaN. mip_level of shaders/bind/shading.glsl. */
double mipmap_level(const float pieces[2 * MIPMAP_PIECES], double texels);

/* How many texels make up what a sample stands for. Between texels of side t colours go in a
   straight line, so that a texel shows as a box and a tent on end, of variance t^2 / 12 + t^2 / 6:
   that of a box of side w, w^2 / 12, where w^2 is three times t^2. */
#define MIPMAP_PIXEL_TEXELS 3.0

/* Samples of a pixel are one nested sequence, and any number of them is a picture. Of the pixel's
   area, sample `index` stands for this share: 1 for the first, 1/4 for the next three, 1/16 for 12
   more. So a sample blurs as little as the smallest even pattern that it is part of, and what many
   of them come to is the texture as it is. */
double mipmap_sample_share(uint32_t index);

#endif
