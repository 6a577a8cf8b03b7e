/* The scene in device memory. */
#ifndef RENDER_UPLOAD_H
#define RENDER_UPLOAD_H

#include "render/renderer.h"

WHIT_CHECK whit_result upload_scene(struct renderer *renderer);
/* Chooses how kernels read the trees, and whether rays are traced in packets; part of
   upload_scene. */
void upload_choose(struct renderer *renderer);
/* Chooses again whether rays are traced in packets, for the number of rays that the picture has
   now. Call it before frame_fill. */
WHIT_CHECK whit_result upload_choose_packets(struct renderer *renderer);
/* Makes the nodes of eight children that packets need on the host, and sets
   renderer->packet_stack_size. */
WHIT_CHECK whit_result upload_widen(struct renderer *renderer);
/* Whether device, trees and parameters allow packets. */
bool upload_can_widen(const struct renderer *renderer);
/* Whether kernels read nodes of 16 bytes: see renderer->quantized. */
bool upload_chooses_quantized(struct renderer *renderer);
/* Makes and uploads nodes of eight children, if there are none yet, and sets renderer->wide. */
WHIT_CHECK whit_result upload_wide(struct renderer *renderer);
void upload_finish(struct scene_buffers *buffers);
/* Writes to *buffer. A buffer that is missing or too small is made anew, a larger one with room to
   grow; passes, which are bound to the old one, are then unbound. Without bytes nothing is done. */
WHIT_CHECK whit_result upload_words(struct renderer *renderer, const void *data,
                                    uint64_t size_bytes, uint32_t uses, const char *name,
                                    struct buffer **buffer);
/* Uploads what another pose changes: instances with their tree, lights. */
WHIT_CHECK whit_result upload_pose(struct renderer *renderer);

#endif
