/* Two pictures of one place, drawn in turns while nothing else is to be done. With the lock. */
#ifndef VIEW_ENGINE_TURNS_H
#define VIEW_ENGINE_TURNS_H

#include "view/engine.h"

/* Two pictures that are drawn in turns, before and after something changed; of the drawing thread.
 */
struct engine_turns {
    struct settings settings[2];
    struct sample_runs ms[2]; /* of drawing */
    double start_ms;
    bool stopped; /* something else came first */
};
enum { ENGINE_PAIRS_MIN = 6 };

/* Whether pictures are there as they were asked for, and nothing else is to be done. */
bool engine_is_idle(const struct engine *engine);
/* Fills in turns->ms, and *difference by how much the second picture takes longer in ms. Gives the
   lock back meanwhile. "" or why there were too few pairs; *difference is then untouched. */
const char *engine_turns_measure(struct engine *engine, struct engine_turns *turns,
                                 struct sample_median *difference);
extern const char ENGINE_TURNS_STOPPED[]; /* one of these reasons */

#endif
