/* Measuring one row of a report: a setting compared with the usual ones. */
#ifndef COST_ROW_H
#define COST_ROW_H

#include "cost/measure.h"

/* Params for the target's picture at another size, limited to what is left of the time limit. */
whit_renderer_params measure_sized(const struct measure *measure, const struct settings *target,
                                   uint32_t width, uint32_t height);
/* Makes a renderer with the kernels and packets that the full-size picture has. It keeps them when
   it draws views of smaller sizes, so that these take as long per pixel. Errors as of
   whit_renderer_create and measure_still_wanted; after these *out is there. */
WHIT_CHECK whit_result measure_renderer(const struct measure *measure,
                                        const struct settings *target, whit_accel *accel,
                                        whit_renderer **out);
/* Measures one row (errors, price, hits) in about `seconds`. A setting that the device or the scene
   refuses gets a note in its row, and the result is WHIT_OK. */
WHIT_CHECK whit_result measure_row(struct measure *measure, const struct settings *target,
                                   enum knob_level level, double seconds, struct cost_row *row);
/* Measures the row of the usual settings with measure->renderer, in about `seconds`. */
WHIT_CHECK whit_result measure_usual(struct measure *measure, double seconds, struct cost_row *row);

#endif
