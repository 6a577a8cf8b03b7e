/* Pictures tile by tile, and what submissions are made of. */
#ifndef RENDER_TILES_H
#define RENDER_TILES_H

#include "render/renderer.h"

/* Takes `samples` samples of all pixels of progress->lattice, or of those of them to which
   progress->levels gives so many. */
WHIT_CHECK whit_result render_pass(struct renderer *renderer, uint32_t samples,
                                   struct progress *progress);
/* Sample `index` of the `samples` of a pass, into a chunk whose blocks are set. */
void render_take_sample(const struct target *target, uint32_t index, uint32_t samples,
                        struct gpu_chunk *chunk);

/* Without trees, whose price is known, WHIT_ERROR_USAGE where the rays that an invocation
   traces take more iterations of loops together than the driver grants it; else WHIT_OK. */
WHIT_CHECK whit_result params_check_loops(const struct renderer *renderer);

/* Gives the progress of a pass over all pixels that begins now. */
struct progress render_progress(const struct renderer *renderer);
/* The picture, of one camera or of many. */
WHIT_CHECK whit_result render_all(struct renderer *renderer);

/* What submissions are made of. */
WHIT_CHECK whit_result render_stop_asked(const struct renderer *renderer,
                                         const struct progress *progress);
/* Empties a list of deferred rays, if there is one. Barriers are the caller's. */
void render_clear_deferred(struct renderer *renderer, struct buffer *deferred);
/* Runs the second kernel of `pass`, which has exact integers, on the rays that the dispatch before
   has listed in `deferred`; a barrier goes between. `push`: its push constants, with `waiting`
   set. */
void render_take_deferred(struct target *target, const struct pass *pass, struct buffer *deferred,
                          const void *push, uint32_t push_bytes);
/* Workgroups of the camera rays of a chunk. */
uint32_t render_groups(const struct gpu_chunk *chunk);
/* Pixel `i` of block `block`, as slot_pixel() of the kernel. False when outside of the picture. */
bool render_slot_pixel(const struct renderer *renderer, uint32_t block, uint32_t i, uint32_t *x,
                       uint32_t *y);
WHIT_CHECK whit_result render_finish_submission(struct target *target);

/* What kernels have listed as waiting since `deferred_clear`. */
WHIT_CHECK whit_result deferred_clear(struct target *target);
WHIT_CHECK whit_result deferred_read(const struct target *target, uint32_t *count);

/* Logs what the bits say. WHIT_OK when there are none. */
WHIT_CHECK whit_result status_check(struct target *target);

#endif
