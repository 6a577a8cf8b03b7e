/* Pixels in host memory, and files of them. */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/foreign.h"
#include "base/roots.h"
#include "whit/whit_image.h"

/* Row 0 is the top. `channels` is 1, 3 or 4 floats, linear; or, for hit identities, 1 to 4 uint32
   (1: `id`, 2: `instance`, `primitive`); up to 8 of them in memory. */
struct image {
    uint32_t width, height, channels;
    float *pixels;   /* width * height * channels, or NULL */
    uint32_t *words; /* the same for integers, or NULL; exactly one of the two is set */
    /* For pictures of light: what is displayed (PNG, window, FLIP, over_1_255) is the floats times
       this; 0: the floats as they are. Files of floats keep them unscaled. */
    float display_scale;
    bool display_soft; /* and then by color_shoulder */
};

/* Zeroed pixels. WHIT_ERROR_MEMORY, also for sizes whose product overflows. */
WHIT_CHECK whit_result image_init(struct image *image, uint32_t width, uint32_t height,
                                  uint32_t channels, bool integers);
void image_finish(struct image *image);

/* By extension: .png 8-bit sRGB (clamped, alpha kept with 4 channels, non-finite as magenta and
   counted in a warning), .exr 32-bit float (integers as UINT channels `instance`, `primitive`),
   .pfm 32-bit float RGB or grey. Atomic. Logs the path and the reason. `texts` are the recipe: PNG
   text chunks, EXR string attributes; of PFM, which has no place for them, they are left out. */
WHIT_CHECK whit_result image_save(const whit_log *log, const struct image *image, const char *path,
                                  const whit_text *texts, uint32_t text_count);
/* An image of 4 floats in the size of another one, beside which an .exr holds it as channels
   NAME.R, .G, .B and .A. The name is borrowed. */
struct image_layer {
    const char *name;
    const struct image *image;
};
enum { IMAGE_LAYERS_MAX = 16 };
/* The same with such images, which no other format keeps: WHIT_ERROR_USAGE, also for more than
   IMAGE_LAYERS_MAX. */
WHIT_CHECK whit_result image_save_layers(const whit_log *log, const struct image *image,
                                         const struct image_layer *layers, uint32_t layer_count,
                                         const char *path, const whit_text *texts,
                                         uint32_t text_count);
/* True for extensions that image_save writes; `integers`: that keep uint32 exactly (.exr). */
bool image_format_known(const char *path, bool integers);

/* A PNG in memory; free() it. `texts` as for image_save. */
WHIT_CHECK whit_result image_encode_png(const whit_log *log, const struct image *image,
                                        const whit_text *texts, uint32_t text_count, uint8_t **data,
                                        size_t *size_bytes);

float image_srgb_from_linear(float linear); /* [0,1] to [0,1], clamps */
float image_linear_from_srgb(float srgb);

#endif
