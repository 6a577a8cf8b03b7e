/* Draws an extra picture of an input that is no case of the suite: another scene or other
   settings. */
#ifndef APP_CHECK_TRIAL_H
#define APP_CHECK_TRIAL_H

#include "app/check/draw.h"

/* Draws the picture of `input`: settings, a loaded scene, a shader or NULL, and a device, NULL for
   the reference, all borrowed. The drawing owns the trees and the renderer that it needs. Call
   trial_finish() in any case. */
WHIT_CHECK whit_result trial_draw(struct drawing *drawing, const struct job *input);
void trial_finish(struct drawing *drawing);
/* Whether, after such an error, no other picture can be drawn either. */
bool trial_ends_all(whit_result result);

#endif
