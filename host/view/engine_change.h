/* The effect of a change of settings on the picture, measured on whole pictures. */
#ifndef VIEW_ENGINE_CHANGE_H
#define VIEW_ENGINE_CHANGE_H

#include "view/engine.h"

/* A whole picture, kept for comparisons. */
struct engine_kept {
    struct settings settings;
    whit_stats stats;
    uint32_t width, height;
    /* The images of the frame, shared with it. `color`: NULL if costs were painted. `plain` and
       `cuts`: NULL where the frame has none. `ids`: NULL if nothing is kept. */
    whit_image *color, *plain, *cuts, *ids;
};

/* Measures the last change, which takes a while, unless something else comes first. `late`: there
   is nothing left to refine. False: there was nothing to do. Called with engine->lock held, which
   is released while it draws. */
bool engine_change_step(struct engine *engine, bool late);
void engine_change_stop(struct engine *engine);
bool engine_change_waits(const struct engine *engine); /* the last change is still to be measured */
/* Compares two whole pictures with the same camera, time and size. *change stays as it is if they
   are not, or differ in nothing that has a name. */
void engine_compare(const struct engine_kept *before, const struct engine_frame *after,
                    struct engine_change *change);
/* Whether both have the same camera, time and size, and the same ids and colours. */
bool engine_is_same(const struct engine_kept *before, const struct engine_frame *after);
/* Replaces *kept by the frame, whose images both then own. */
void engine_keep(struct engine_kept *kept, const struct engine_frame *frame);
void engine_kept_finish(struct engine_kept *kept);

#endif
