/* Foreign picture files into pixels, through libjpeg and stb_image; and finding files whose names
   were written on a system with other ideas about case and slashes. */
#ifndef LOAD_PICTURE_H
#define LOAD_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/foreign.h"
#include "base/log.h"
#include "base/roots.h"

/* picture_finish() it. Row 0 is the top. */
struct picture {
    uint32_t width, height;
    uint8_t *rgba;       /* 4 a pixel as stored, or NULL */
    size_t mapped_bytes; /* `rgba` is the reply of a child, so long; 0: from malloc() */
    float *rgb;          /* 3 a pixel, linear, from malloc(), or NULL */
};

/* Runs picture_decode() in a child process, whose reply becomes `rgba`. On failure `reason` is
   filled and nothing is logged, as by foreign_ask(). Where the header tells of more than
   `pixels_max` nothing is decoded: the result is WHIT_ERROR_INPUT, and `out` has the width and the
   height. */
WHIT_CHECK whit_result picture_read(const whit_log *log, const struct foreign_params *params,
                                    uint64_t pixels_max, const uint8_t *data, size_t size_bytes,
                                    struct picture *out, char reason[FOREIGN_REASON_BYTES]);

/* `rgba` from the bytes of a PNG, JPEG, BMP, TGA or GIF (its first frame). A file whose header
   tells of more pixels than its bytes could hold in any of these formats is refused before memory
   is asked for. WHIT_ERROR_INPUT fills `reason` and logs nothing. */
WHIT_CHECK whit_result picture_decode(const uint8_t *data, size_t size_bytes, struct picture *out,
                                      const char **reason);
/* Why a file of so many bytes, whose header tells of these sides, is refused; NULL: it is not. */
const char *picture_why_refused(uint32_t width, uint32_t height, size_t size_bytes);
/* Halves with a box filter until neither side is over `side_max`. False: memory ran out. */
bool picture_shrink(struct picture *picture, uint32_t side_max);
void picture_finish(struct picture *picture);
/* The first bytes of what deflate has packed, as many as fit: zeros where it is damaged. Only for a
   child, since foreign code does it. */
void picture_inflate(const uint8_t *data, size_t size_bytes, char *out, int out_bytes);

/* `path`, or the one file that differs from it by case and by \ for /. Release with free(); NULL
   when memory runs out. A path that leads nowhere is given back with its slashes turned; one that
   leads out of the roots is not looked for. */
char *picture_find(const struct roots *roots, const char *path);

#endif
