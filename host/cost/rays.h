/* The two sets of rays, and what hits of theirs are worth. */
#ifndef COST_RAYS_H
#define COST_RAYS_H

#include "cost/measure.h"

/* The sets of rays for the usual trees, and the hits of a renderer of `target`. */
WHIT_CHECK whit_result measure_judges(struct measure *measure);
WHIT_CHECK whit_result measure_hits(struct measure *measure, whit_renderer *renderer,
                                    const struct settings *target, struct cost_row *row);

#endif
