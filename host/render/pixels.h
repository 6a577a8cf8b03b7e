/* Buffers of the pixels of a band and of the rays of a tile. */
#ifndef RENDER_PIXELS_H
#define RENDER_PIXELS_H

#include "render/renderer.h"

/* How many low bits of a ray's state count its steps in a picture of this depth, 8..16:
   gpu_frame.slot_shift. */
uint32_t pixels_slot_shift(uint32_t depth);

/* Creates target->buffers for the renderer's parameters and effects: bands of up to `height` rows,
   chunks of up to tile_size x tile_size pixels (0: as large as is useful). */
WHIT_CHECK whit_result pixels_create(struct target *target, uint32_t height, uint32_t tile_size);
void target_finish(struct target *target);
/* Drops the buffers of pixels and what is bound to them: call it before pictures of another size or
   depth. */
void target_drop_pixels(struct target *target);
/* Partial sums that a pixel needs while its samples are added up pairwise: log2 of its most
   samples, rounded up. */
uint32_t pixels_levels(const whit_renderer_params *params);
/* Whether pixels get ids and weights of cut rays, beside colours. */
bool pixels_have_data(const struct target *target);
/* Number of blocks of 8 pixels that cover a row or column of `pixels`. */
uint32_t pixels_blocks_across(uint32_t pixels);

#endif
