/* The effect of a change of settings on the picture, measured on whole pictures. */
#ifndef VIEW_ENGINE_CHANGE_H
#define VIEW_ENGINE_CHANGE_H

#include "view/engine.h"

/* Measures the last change, which takes a while, unless something else comes first. `late`: there
   is nothing left to refine. False: there was nothing to do. Called with engine->lock held, which
   is released while it draws. */
bool engine_change_step(struct engine *engine, bool late);
void engine_change_stop(struct engine *engine);
bool engine_change_waits(const struct engine *engine); /* the last change is still to be measured */
/* Compares two whole pictures with the same camera, time and size. *change stays as it is if they
   are not, or differ in nothing that has a name. */
void engine_compare(const struct engine_frame *before, const struct engine_frame *after,
                    struct engine_change *change);
/* Whether both have the same camera, time and size, and the same ids and colours. */
bool engine_is_same(const struct engine_frame *before, const struct engine_frame *after);
/* Replaces *kept by what comparing and refining need of the frame: settings, statistics, size, and
   the images, which both then own. Its `color` is NULL if costs were painted. */
void engine_keep(struct engine_frame *kept, const struct engine_frame *frame);

#endif
