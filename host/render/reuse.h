/* Colours that the device still has, for another post(). */
#ifndef RENDER_REUSE_H
#define RENDER_REUSE_H

#include "render/renderer.h"

/* Whether the colours that are kept are those of the picture that is asked for. */
bool reuse_is_possible(const struct renderer *renderer);
/* The picture, where reuse_is_possible: calls post() for each pixel once more, and the functions
   beside the colour where these are others. Statistics stay. */
WHIT_CHECK whit_result reuse_render(struct renderer *renderer);
/* After a picture was drawn: notes of which view, samples and sliders its colours are. */
void reuse_note(struct renderer *renderer);
/* Whether the picture that is kept stays what it is also where the next one is cancelled. */
bool reuse_outlives(const struct renderer *renderer);

#endif
