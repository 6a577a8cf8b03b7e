/* What a new version of the shader makes of the picture. With the lock; note and step are of the
   drawing thread. */
#ifndef VIEW_ENGINE_RELOAD_H
#define VIEW_ENGINE_RELOAD_H

#include "view/engine_change.h"
#include "view/engine_turns.h"

struct thread;

/* FLIP of the first whole picture of a new version of the shader, in a thread of its own. */
struct engine_flip {
    struct engine *engine;
    struct thread *thread;
    uint64_t number;         /* of the reload */
    struct engine_kept kept; /* before it */
    whit_image *after;
    bool known, done; /* done: under the lock */
    double mean;
};

/* What is measured of a reload; of the drawing thread. */
struct engine_reloading {
    struct engine_kept before; /* the picture that FLIP is still missing of; without ids: none */
    struct engine_turns turns; /* of the version before and of the new one */
    bool wanted;               /* engine_measure_reload */
};

/* There is a whole picture of settings `after`, and before it there was *before, which it may take;
   `difference`: between them, NULL where they are not of one place. */
void engine_reload_note(struct engine *engine, struct engine_kept *before,
                        const struct settings *after, const struct difference *difference);
/* Measures, where there is something to measure and nothing else to do; gives the lock back
   meanwhile. False: there was not. */
bool engine_reload_step(struct engine *engine);
/* As engine_stop_reload, which takes the lock. */
void engine_reload_stop(struct engine *engine);
/* Waits for its thread; NULL is fine. */
void engine_flip_destroy(struct engine_flip *flip);

#endif
