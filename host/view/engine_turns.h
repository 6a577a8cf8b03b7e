/* Draws two pictures with the same camera, time and size in turns, while there is nothing else to
   do. Its functions are called with engine->lock held. */
#ifndef VIEW_ENGINE_TURNS_H
#define VIEW_ENGINE_TURNS_H

#include "view/engine.h"

/* Two pictures that are drawn in turns, before and after a change; used by the drawing thread. */
struct engine_turns {
    struct engine *engine; /* set by engine_turns_measure */
    struct settings settings[2];
    struct sample_runs ms[2]; /* times of drawing */
    double start_ms;
    bool stopped; /* something else came first */
};
enum { ENGINE_PAIRS_MIN = 6 };

/* Whether all pictures are drawn as asked for, and nothing else has to be done. */
bool engine_is_idle(const struct engine *engine);
/* Measures turns->ms, and *difference: how much longer the second picture takes, in ms. Releases
   the lock meanwhile. Returns "", or why there were too few pairs; *difference is then
   unchanged. */
const char *engine_turns_measure(struct engine *engine, struct engine_turns *turns,
                                 struct sample_median *difference);
extern const char ENGINE_TURNS_STOPPED[]; /* the reason if something else came first */

#endif
