/* Decodes foreign picture files, with libjpeg and stb_image; and finds files whose names were
   written on a system that ignores case or has backslashes. */
#ifndef LOAD_PICTURE_H
#define LOAD_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/foreign.h"
#include "base/log.h"
#include "base/roots.h"

/* A decoded picture, to be released with picture_finish(). Row 0 is the top. */
struct picture {
    uint32_t width, height;
    uint8_t *rgba;       /* 4 per pixel as stored, or NULL */
    size_t mapped_bytes; /* length of `rgba` if it is a mapped reply of a child; 0: from malloc() */
    float *rgb;          /* 3 per pixel, linear, from malloc(), or NULL */
};

/* Runs picture_decode() in a child process, whose reply becomes `rgba`. On failure `reason` is
   filled and nothing is logged, as by foreign_ask(). */
WHIT_CHECK whit_result picture_read(const whit_log *log, const struct foreign_params *params,
                                    uint64_t pixels_max, const uint8_t *data, size_t size_bytes,
                                    struct picture *out, char reason[FOREIGN_REASON_BYTES]);

/* Decodes a PNG, JPEG, BMP, TGA or GIF (its first frame) into `rgba`. A file whose header states
   more pixels than its bytes can hold in any of these formats is refused before memory is
   allocated. WHIT_ERROR_INPUT fills `reason`; nothing is logged. If the header states more than
   `pixels_max` pixels, nothing is decoded either, and `out` has width and height. */
WHIT_CHECK whit_result picture_decode(const uint8_t *data, size_t size_bytes, uint64_t pixels_max,
                                      struct picture *out, const char **reason);
/* Why a file of `size_bytes` whose header states this size is refused; NULL: it is not refused.
   `sides` gets the size if only the limit is exceeded. */
const char *picture_why_refused(uint32_t width, uint32_t height, size_t size_bytes,
                                uint64_t pixels_max, struct picture *sides);
/* Halves the picture with a box filter until no side exceeds `side_max`. False: memory ran out. */
bool picture_shrink(struct picture *picture, uint32_t side_max);
void picture_finish(struct picture *picture);
/* Inflates raw deflate data up to `out_bytes`; zeros where data are damaged. Only for child
   processes, since foreign code does it. */
void picture_inflate(const uint8_t *data, size_t size_bytes, char *out, int out_bytes);

/* Finds a file whose path may differ from `path` by case, and by / in place of \. Gives that path,
   or `path` with its slashes turned if there is no such file; to free(). NULL when memory runs out.
   A path that leads out of the roots is not searched. */
char *picture_find(const struct roots *roots, const char *path);
/* The path of a texture that the model `from` names: as written if that file exists; else its bare
   name beside the model, also in another case, since many paths are of the exporter's machine; else
   as written, for picture_find. To free(); NULL when memory runs out. */
char *picture_find_named(const struct roots *roots, const char *from, const char *name);

#endif
