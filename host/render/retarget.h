/* Points an existing renderer at another view. */
#ifndef RENDER_RETARGET_H
#define RENDER_RETARGET_H

#include "render/renderer.h"

/* Makes the buffers of pixels anew, for the picture as it is now. */
WHIT_CHECK whit_result retarget_pixels(struct renderer *renderer);

#endif
