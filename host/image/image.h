/* Pixels in host memory, and files of them. */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/foreign.h"
#include "base/roots.h"
#include "whit/whit_image.h"

/* Row 0 is the top. `channels`: 1, 3 or 4 linear floats; or, for ids of hits, 1 to 4 uint32 (1:
   `id`; 2: `instance`, `primitive`), up to 8 for images that are not saved. */
struct image {
    uint32_t width, height, channels;
    float *pixels;   /* width * height * channels, or NULL */
    uint32_t *words; /* the same for integers, or NULL; exactly one of the two is set */
    bool borrowed;   /* the memory belongs to something else */
    /* Factor on the floats when a picture of light is displayed (PNG, window, FLIP, over_1_255);
       0: 1. Files of floats keep unscaled values. */
    float display_scale;
    bool display_soft; /* display also applies color_shoulder, after the factor */
};

/* Makes an image with zeroed pixels. WHIT_ERROR_MEMORY, also for sizes whose product overflows. */
WHIT_CHECK whit_result image_init(struct image *image, uint32_t width, uint32_t height,
                                  uint32_t channels, bool integers);
/* image_init, which logs where there is no memory. */
WHIT_CHECK whit_result image_init_logged(const whit_log *log, struct image *image, uint32_t width,
                                         uint32_t height, uint32_t channels, bool integers);
void image_finish(struct image *image);

/* An additional image of 4 floats for an .exr, of the size of the main image, stored as channels
   NAME.R, .G, .B and .A. The name is borrowed. */
struct image_layer {
    const char *name;
    const struct image *image;
};

/* Saves an image by the path's extension. .png: 8-bit sRGB, clamped, with alpha if there are 4
   channels; non-finite pixels are magenta and counted in a warning. .exr: 32-bit float, or integers
   as UINT channels. .pfm: 32-bit float RGB or grey. Atomic. Errors are logged with the path.
   `texts`: the recipe, as PNG text chunks or EXR string attributes; PFM cannot have any.
   WHIT_ERROR_USAGE for layers in another format than .exr, and for more than WHIT_LAYERS_MAX. */
WHIT_CHECK whit_result image_save(const whit_log *log, const struct image *image,
                                  const struct image_layer *layers, uint32_t layer_count,
                                  const char *path, const whit_text *texts, uint32_t text_count);
/* Whether image_save knows the path's extension; `integers`: whether it stores uint32 (.exr). */
bool image_format_known(const char *path, bool integers);

/* Encodes a PNG in memory; free() *data. `texts` as for image_save. */
WHIT_CHECK whit_result image_encode_png(const whit_log *log, const struct image *image,
                                        const whit_text *texts, uint32_t text_count, uint8_t **data,
                                        size_t *size_bytes);

float image_srgb_from_linear(float linear); /* [0,1] to [0,1], clamps */
float image_linear_from_srgb(float srgb);

#endif
