/* Another view for a renderer. */
#ifndef RENDER_RETARGET_H
#define RENDER_RETARGET_H

#include "render/renderer.h"

/* Buffers of pixels for the picture as it is now, in place of those that there are. */
WHIT_CHECK whit_result retarget_pixels(struct renderer *renderer);

#endif
