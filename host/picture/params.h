/* Checks the parameters of a picture, for the renderer and for the reference, which needs no
   device. */
#ifndef PICTURE_PARAMS_H
#define PICTURE_PARAMS_H

#include "base/log.h"
#include "whit/whit_renderer.h"

/* A shadow ray is not traced where it can add at most this times the bailout of the light that its
   light sends. This cuts off highlights, which never fade to 0, far from their middle. */
#define BAILOUT_SHADOW_SHARE 0x1p-14

/* Samples of adaptive pictures, unless params say otherwise: of every pixel, and the most. */
enum { SAMPLING_ADAPTIVE_FIRST = 4, SAMPLING_ADAPTIVE_MAX = 64 };
enum { TILE_MIN = 16, TILE_MAX = 1024 }; /* sides of tiles, pixels */

/* Fills in defaults. WHIT_ERROR_USAGE, logged, for what is out of range. */
WHIT_CHECK whit_result params_check(const whit_log *log, whit_renderer_params *params);

/* How many rows of the picture are drawn. */
uint32_t params_rows(const whit_renderer_params *params);

#endif
