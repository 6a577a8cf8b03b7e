/* The scene in device memory. */
#ifndef RENDER_UPLOAD_H
#define RENDER_UPLOAD_H

#include "render/renderer.h"

WHIT_CHECK whit_result upload_scene(struct renderer *renderer);
/* How kernels read the trees, and whether rays walk in packets; upload_scene begins with it. */
void upload_choose(struct renderer *renderer);
/* Chooses packets anew for the number of rays that the picture has now; before the frame is filled.
 */
WHIT_CHECK whit_result upload_choose_packets(struct renderer *renderer);
/* Makes the nodes of eight that packets need on the host, and says what stack they take. */
WHIT_CHECK whit_result upload_widen(struct renderer *renderer);
/* Whether rays can walk in packets here, as far as device, trees and parameters go. */
bool upload_can_widen(const struct renderer *renderer);
/* Nodes of eight children, where there are none yet: renderer->wide. */
WHIT_CHECK whit_result upload_wide(struct renderer *renderer);
void upload_finish(struct scene_buffers *buffers);
WHIT_CHECK whit_result upload_words(struct renderer *renderer, const void *data,
                                    uint64_t size_bytes, uint32_t uses, const char *name,
                                    struct buffer **out);
/* What another pose changes: instances with their tree, lights. Passes bound to buffers that had to
   grow are gone afterwards. */
WHIT_CHECK whit_result upload_pose(struct renderer *renderer);

#endif
