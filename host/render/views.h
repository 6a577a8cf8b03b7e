/* Draws views of many cameras as one picture. */
#ifndef RENDER_VIEWS_H
#define RENDER_VIEWS_H

#include "render/renderer.h"

/* Rows of the picture in memory, where each view is padded to whole rows of blocks. */
uint32_t views_rows(const struct renderer *renderer);
/* Rows of one view in memory, with padding. */
uint32_t views_stride(const struct renderer *renderer);
/* Rows of all views together, without padding. */
uint32_t views_picture_rows(const struct renderer *renderer);
/* Rows that images of the picture have: of all views, or the rows that params ask for. */
uint32_t views_image_rows(const struct renderer *renderer);
/* Writes to the device where the current sample passes through the lens of each view of the
   chunk. */
WHIT_CHECK whit_result views_take_sample(struct renderer *renderer, const struct gpu_chunk *chunk);
/* Goes back to a picture of one camera, if it is one of many. */
WHIT_CHECK whit_result views_leave(struct renderer *renderer);
void views_finish(struct views *views);

#endif
