/* What a switch changed, and the whole pictures that say so. */
#ifndef VIEW_ENGINE_CHANGE_H
#define VIEW_ENGINE_CHANGE_H

#include "view/engine.h"

/* A whole picture, for comparing. */
struct engine_kept {
    struct settings settings;
    whit_stats stats;
    whit_accel_info accel;
    uint32_t width, height;
    float *color;  /* RGBA; NULL where costs were painted */
    float *plain;  /* as engine_frame.plain, or NULL */
    float *cuts;   /* as engine_frame.cuts, or NULL */
    uint32_t *ids; /* instance, primitive; NULL: nothing is kept */
};

/* With the lock, which it gives back meanwhile: measures the last change, which takes a while,
   unless something else comes first. `late`: there is nothing left to refine. False: there was
   nothing to do. */
bool engine_change_step(struct engine *engine, bool late);
void engine_change_stop(struct engine *engine);
bool engine_change_waits(const struct engine *engine); /* whether it is to be measured as yet */
/* What differs between two whole pictures of one place; *change stays where they
   are none, or differ in nothing that has a name. */
void engine_compare(const struct engine_kept *before, const struct engine_frame *after,
                    struct engine_change *change);
/* Whether both are of one place, with the same ids and colours. */
bool engine_is_same(const struct engine_kept *before, const struct engine_frame *after);
/* In place of what was kept. Keeps nothing where memory runs out. */
void engine_keep(struct engine_kept *kept, const struct engine_frame *frame);
void engine_kept_finish(struct engine_kept *kept);

#endif
