/* Buffers of pixels, and of the rays of a tile. */
#ifndef RENDER_PIXELS_H
#define RENDER_PIXELS_H

#include "render/renderer.h"

/* The bits of the steps of a ray of a picture of this depth, 8..16: gpu_frame. */
uint32_t pixels_slot_shift(uint32_t depth);

/* target->buffers, for the parameters and effects of the renderer, for bands of up to
   `height` rows and chunks of `tile_size` (0: as large as is fit). */
WHIT_CHECK whit_result pixels_create(struct target *target, uint32_t height, uint32_t tile_size);
void target_finish(struct target *target);
/* Before pictures of another size or depth: its pixels, and what is bound to them. */
void target_drop_pixels(struct target *target);
/* Partial sums that the most samples of a pixel leave at once. */
uint32_t pixels_levels(const whit_renderer_params *params);
/* Blocks of 8 x 8 that cover `pixels` in a row or column. */
uint32_t pixels_blocks_across(uint32_t pixels);

#endif
