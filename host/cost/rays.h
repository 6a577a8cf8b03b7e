/* The two sets of rays, and judging a renderer's hits of them. */
#ifndef COST_RAYS_H
#define COST_RAYS_H

#include "cost/measure.h"

/* measure_judges makes the sets of rays for the usual trees. measure_hits traces and judges them
   with a renderer that has the settings `target`. */
WHIT_CHECK whit_result measure_judges(struct measure *measure);
WHIT_CHECK whit_result measure_hits(struct measure *measure, whit_renderer *renderer,
                                    const struct settings *target, struct cost_row *row);

#endif
