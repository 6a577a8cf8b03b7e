/* Compares pictures of a new version of the shader and the version before. The functions are called
   with engine->lock held; note and step on the drawing thread. */
#ifndef VIEW_ENGINE_RELOAD_H
#define VIEW_ENGINE_RELOAD_H

#include "view/engine_change.h"
#include "view/engine_turns.h"

struct thread;

/* Computes FLIP for the first whole picture of a new version of the shader, in a thread of its
   own. */
struct engine_flip {
    struct engine *engine;
    struct thread *thread;
    uint64_t number;            /* number of the reload */
    whit_image *before, *after; /* its pictures */
    bool known, done;           /* done: under the lock */
    double mean;
};

/* State of measuring a reload; used by the drawing thread. */
struct engine_reloading {
    struct engine_frame
        before;                /* the picture before, if FLIP is still missing; without ids: none */
    struct engine_turns turns; /* draws the version before, and the new one */
    bool wanted;               /* set by engine_measure_reload */
};

/* Call it after each whole picture. `after`: its settings; *before: the whole picture before, which
   may be taken; `difference` between both, NULL if camera, time or size differ. */
void engine_reload_note(struct engine *engine, struct engine_frame *before,
                        const struct settings *after, const struct difference *difference);
/* Measures a reload if there is something to measure and nothing else to do; releases the lock
   meanwhile. False: nothing was done. */
bool engine_reload_step(struct engine *engine);
/* As engine_stop_reload, but called with engine->lock held. */
void engine_reload_stop(struct engine *engine);
/* Waits for the thread, and frees; NULL is fine. */
void engine_flip_destroy(struct engine_flip *flip);

#endif
