/* Part of whit.h: images, their files, heat maps. */
#ifndef WHIT_IMAGE_H
#define WHIT_IMAGE_H

#include "whit_scene.h"

WHIT_C_BEGIN

typedef struct whit_image_info {
    uint32_t width, height, channels;
    bool integers;
} whit_image_info;
void whit_image_get_info(const whit_image *image, whit_image_info *info);
/* width * height * channels values, row 0 at the top. NULL where the image has the other type. */
const float *whit_image_floats(const whit_image *image);
const uint32_t *whit_image_words(const whit_image *image);

/* Writes the RGBA bytes (width * height * 4) that a .png of this image of floats has; nothing for
   an image of integers. */
void whit_image_display_bytes(const whit_image *image, uint8_t *rgba);

typedef struct whit_text {
    const char *key, *value;
} whit_text;
/* .png (8-bit sRGB), .exr and .pfm (float); integers only .exr. Atomic. `texts` (the recipe) is
   stored in .png and .exr. Their keys differ, and have 1 to 79 printable characters, and no spaces
   at their ends or side by side; in an .exr they are none of channels, chunkCount, compression,
   dataWindow, displayWindow, lineOrder, name, pixelAspectRatio, screenWindowCenter,
   screenWindowWidth, tiles, type and version, which the format needs itself. WHIT_ERROR_USAGE for a
   format that cannot hold the image and for other keys, WHIT_ERROR_OUTPUT where the file cannot be
   written. */
WHIT_CHECK whit_result whit_image_save(const whit_image *image, const char *path,
                                       const whit_text *texts, uint32_t text_count,
                                       const whit_log *log);
typedef struct whit_image_layer {
    const char *name;
    const whit_image *image;
} whit_image_layer;
/* As whit_image_save, for an .exr, with further images of 4 floats and the same size as channels
   NAME.R, .G, .B and .A. Their names differ, and have 1 to 200 bytes and no dots. WHIT_ERROR_USAGE
   too for other formats, other names, and for more than WHIT_LAYERS_MAX layers. */
WHIT_CHECK whit_result whit_image_save_layers(const whit_image *image,
                                              const whit_image_layer *layers, uint32_t layer_count,
                                              const char *path, const whit_text *texts,
                                              uint32_t text_count, const whit_log *log);
/* Loads a picture. `params` (may be NULL): only its fields about foreign files are used, though all
   are checked.
   WHIT_ERROR_INPUT for a file that is missing, damaged or no picture; WHIT_ERROR_USAGE as of
   whit_scene_load. */
WHIT_CHECK whit_result whit_image_load(const char *path, const whit_load_params *params,
                                       const whit_log *log, whit_image **out);
/* The recipe in a .png or .exr; other formats have none. *texts with its strings is one block, to
   be released by whit_memory_destroy. `params` as above. WHIT_ERROR_INPUT for a file that is
   missing, damaged or no picture, WHIT_ERROR_MEMORY, WHIT_ERROR_CANCELLED; WHIT_ERROR_USAGE where a
   sandbox is required and there is none. */
WHIT_CHECK whit_result whit_image_load_texts(const char *path, const whit_load_params *params,
                                             const whit_log *log, whit_text **texts,
                                             uint32_t *text_count);
/* `pixels`: width * height * channels linear floats, row 0 at the top, copied; channels: 1, 3, 4.
   WHIT_ERROR_USAGE for other channels or sizes. */
WHIT_CHECK whit_result whit_image_create(uint32_t width, uint32_t height, uint32_t channels,
                                         const float *pixels, whit_image **out);
/* Makes the picture whose .png has these RGBA bytes; alpha is ignored. WHIT_ERROR_USAGE for a size
   of 0. */
WHIT_CHECK whit_result whit_image_create_display(uint32_t width, uint32_t height,
                                                 const uint8_t *rgba, whit_image **out);
/* A copy of `count` rows from `first` on, which is displayed with the same exposure.
   WHIT_ERROR_USAGE for rows outside of the image, or a count of 0; WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_image_rows(const whit_image *image, uint32_t first, uint32_t count,
                                       whit_image **out);
void whit_image_destroy(whit_image *image);

/* True where whit_image_save can write an image to `path`, by its extension; `integers`: an image
   of hit identities. */
bool whit_image_format_known(const char *path, bool integers);

/* Draws an image of one channel as a heat map with a legend below, in colours that the colour-blind
   can tell apart (viridis): dark is 0, bright is `scale` and above. The result is linear RGB and
   wide enough for a readable legend; narrower images are centred in it. */
typedef struct whit_heat_params {
    double scale;      /* finite, not below 0; 0: whit_image_heat_scale */
    const char *title; /* of the legend, or NULL; ASCII, shortened when it does not fit */
    const char *unit;  /* of the numbers, at the legend's right end, or NULL */
    bool is_signed;    /* colours from -scale (blue) over 0 (white) to scale (brown); an image of
                          three channels shows the one farthest from 0 */
} whit_heat_params;
/* The 99.5th percentile of the values, rounded up to a round number. Where it is 0, the largest
   value is rounded up instead; 1 where all values are 0. */
double whit_image_heat_scale(const whit_image *values);
/* WHIT_ERROR_USAGE unless the image has one channel of floats, or three with `is_signed`, and for
   a scale out of range. */
WHIT_CHECK whit_result whit_image_heat(const whit_image *values, const whit_heat_params *params,
                                       whit_image **out);

/* The bytes of the PNG that whit_image_save writes, to be released by whit_memory_destroy.
   WHIT_ERROR_USAGE for integers. */
WHIT_CHECK whit_result whit_image_encode_png(const whit_image *image, const whit_text *texts,
                                             uint32_t text_count, const whit_log *log,
                                             uint8_t **data, size_t *size_bytes);

WHIT_C_END

#endif
