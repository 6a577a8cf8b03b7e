/* Views of many cameras, in one picture. */
#ifndef RENDER_VIEWS_H
#define RENDER_VIEWS_H

#include "render/renderer.h"

/* Rows that the picture has in memory; views have whole rows of blocks. */
uint32_t views_rows(const struct renderer *renderer);
/* Rows of one view among these. */
uint32_t views_stride(const struct renderer *renderer);
/* Rows of the whole picture, of all views. */
uint32_t views_picture_rows(const struct renderer *renderer);
/* Rows that its images have. */
uint32_t views_image_rows(const struct renderer *renderer);
/* Writes for each view of the chunk where the sample in hand passes through its lens. */
WHIT_CHECK whit_result views_take_sample(struct renderer *renderer, const struct gpu_chunk *chunk);
/* Back to the picture of one camera; nothing where it is that. */
WHIT_CHECK whit_result views_leave(struct renderer *renderer);
void views_finish(struct views *views);

#endif
