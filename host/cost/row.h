/* One setting beside the usual ones. */
#ifndef COST_ROW_H
#define COST_ROW_H

#include "cost/measure.h"

/* The target's picture at another size, in what is left of the time limit. */
whit_renderer_params measure_sized(const struct measure *measure, const struct settings *target,
                                   uint32_t width, uint32_t height);
/* One row: renderer, errors, price, hits, within about `seconds`. What a device or a scene
   refuses is a note in the row, and WHIT_OK. */
WHIT_CHECK whit_result measure_row(struct measure *measure, const struct settings *target,
                                   enum knob_level level, double seconds, struct cost_row *row);
/* The usual settings' row, from measure->renderer, within about `seconds`. */
WHIT_CHECK whit_result measure_usual(struct measure *measure, double seconds, struct cost_row *row);

#endif
