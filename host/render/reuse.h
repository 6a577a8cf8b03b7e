/* Draws with the colours of the last picture, which the device still has, and another post(). */
#ifndef RENDER_REUSE_H
#define RENDER_REUSE_H

#include "render/renderer.h"

/* Whether the kept colours are those of the picture that is asked for. */
bool reuse_is_possible(const struct renderer *renderer);
/* Draws the picture if reuse_is_possible: calls post() for each pixel once more, and the aovs where
   they have changed. Statistics stay. */
WHIT_CHECK whit_result reuse_render(struct renderer *renderer);
/* Call it after a picture was drawn: notes which view, samples and sliders its colours have. */
void reuse_note(struct renderer *renderer);
/* Whether the kept picture stays valid even if the next one is cancelled. */
bool reuse_outlives(const struct renderer *renderer);

#endif
