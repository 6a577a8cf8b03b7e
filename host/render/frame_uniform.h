/* The frame record (struct gpu_frame): camera, sky, media around the eye, and whatever else a whole
   picture shares. */
#ifndef RENDER_FRAME_UNIFORM_H
#define RENDER_FRAME_UNIFORM_H

#include "render/renderer.h"

/* Fills in renderer->frame, but for the row numbers, which upload.c sets. */
WHIT_CHECK whit_result frame_fill(struct renderer *renderer);
/* Writes record and slider values to the device, as they are, to a buffer that the first call
   makes. */
WHIT_CHECK whit_result frame_write(struct renderer *renderer);
/* frame_fill, then frame_write. */
WHIT_CHECK whit_result frame_upload(struct renderer *renderer);

#endif
