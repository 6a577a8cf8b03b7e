/* Draws pictures tile by tile; parts of submissions. */
#ifndef RENDER_TILES_H
#define RENDER_TILES_H

#include "render/renderer.h"

/* Takes `samples` samples of all pixels of progress->lattice, or (progress->listed) of those whose
   level in progress->levels asks for that many. */
WHIT_CHECK whit_result render_pass(struct renderer *renderer, uint32_t samples,
                                   struct progress *progress);
/* Sets up `chunk`, whose blocks are set, for sample `index` of the `samples` of a pass. */
void render_take_sample(const struct target *target, uint32_t index, uint32_t samples,
                        struct gpu_chunk *chunk);

/* WHIT_ERROR_USAGE, logged, if there are no trees and the rays that an invocation traces take more
   loop iterations together than the driver allows; else WHIT_OK. */
WHIT_CHECK whit_result params_check_loops(const struct renderer *renderer);

/* The side of the next tile, in pixels, after one of `tile` that took spent_ms. Tiles that take too
   long are halved. Others grow to at most twice their size, up to `largest`, for which the buffers
   have room, unless they would take too long then. */
uint32_t tiles_adapt(uint32_t tile, uint32_t largest, double spent_ms);
/* Gives the progress of a pass over all pixels, which begins now. */
struct progress render_progress(const struct renderer *renderer);
/* Draws the picture, of one camera or of many. */
WHIT_CHECK whit_result render_all(struct renderer *renderer);

/* WHIT_ERROR_CANCELLED or WHIT_ERROR_TIME_LIMIT if the picture is to stop; else WHIT_OK.
   render_stop_asked logs that the time limit passed. */
WHIT_CHECK whit_result render_stop_due(const struct renderer *renderer);
WHIT_CHECK whit_result render_stop_asked(const struct renderer *renderer,
                                         const struct progress *progress);
/* Empties a list of deferred rays; NULL: nothing to do. The caller adds barriers. */
void render_clear_deferred(struct renderer *renderer, struct buffer *deferred);
/* Records a kernel over the rays that the dispatch before has put on the list `deferred`, with a
   barrier in between. `push`: its push constants, with `deferred` set. */
void render_take_deferred(struct commands *commands, struct pipeline *pipeline,
                          struct binding_set *set, struct buffer *deferred, const void *push,
                          uint32_t push_bytes);
/* Records the push constants of the bound kernel, a stage. chunk->blocks_x must not be 0. */
void render_push_chunk(struct renderer *renderer, struct gpu_chunk *chunk);
/* Number of pixels that a chunk may have; some may be outside of the picture. */
uint32_t render_slots(const struct gpu_chunk *chunk);
/* Number of workgroups for the camera rays of a chunk, at one ray an invocation. */
uint32_t render_groups(const struct gpu_chunk *chunk);
/* The pixel at place `i` of block `block`, as slot_pixel() of the kernels. False if it is outside
   of the picture. */
bool render_slot_pixel(const struct renderer *renderer, uint32_t block, uint32_t i, uint32_t *x,
                       uint32_t *y);
WHIT_CHECK whit_result render_finish_submission(struct target *target);

/* The number of items that kernels have put on lists of deferred rays since `deferred_clear`. */
WHIT_CHECK whit_result deferred_clear(struct target *target);
WHIT_CHECK whit_result deferred_read(const struct target *target, uint32_t *count);

/* Reads the status word, and logs what its bits mean. WHIT_OK if none is set, or STATUS_QUEUE_FULL
   alone, which goes into target->stages.full. `traces`: rays of a caller, which the CPU traces too.
 */
WHIT_CHECK whit_result status_check(struct target *target, bool traces);

#endif
