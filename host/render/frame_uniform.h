/* The frame record: camera, sky, media around the eye, and what else a whole picture shares. */
#ifndef RENDER_FRAME_UNIFORM_H
#define RENDER_FRAME_UNIFORM_H

#include "render/renderer.h"

/* All of renderer->frame but the rows. */
WHIT_CHECK whit_result frame_fill(struct renderer *renderer);
/* The buffer that holds it, and the values of sliders behind it. */
WHIT_CHECK whit_result frame_create(struct renderer *renderer);
/* Writes both to the device, as they are. */
WHIT_CHECK whit_result frame_write(const struct renderer *renderer);
/* Fills the record and writes both to the device. */
WHIT_CHECK whit_result frame_upload(struct renderer *renderer);

#endif
