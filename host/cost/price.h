/* Renderers timed in turns. */
#ifndef COST_PRICE_H
#define COST_PRICE_H

#include "base/sample.h"
#include "whit/whit_compare.h"
#include "whit/whit_reference.h"
#include "whit/whit_renderer.h"

enum cost_clock { COST_WALL, COST_CPU, COST_DEVICE, COST_CLOCKS };
const char *cost_clock_name(enum cost_clock clock); /* "wall" */

/* Times of two renderers that were measured in turns. */
enum { COST_ROUNDS_MAX = 41, COST_ROUNDS_MIN = 7 };
struct cost_price {
    uint32_t rounds, width, height;
    struct sample_median usual_ms[COST_CLOCKS]; /* device: 0 rounds where it is not measured */
    struct sample_median setting_ms[COST_CLOCKS];
    struct sample_median ratio[COST_CLOCKS];      /* setting / usual, over pairs */
    struct sample_median difference[COST_CLOCKS]; /* setting - usual, over pairs */
    int verdict; /* by the report's clock: 1 dearer, -1 cheaper, 0 not distinguishable */
};
/* Renders both `rounds` times in turns, after one picture each that is not timed. `first`,
   `second`: views that the renderers are set to; NULL: they stay as they are. If both are the same
   renderer, both views must be given. `reference`: draws in place of `setting`, by `second`, and
   its device time is its wall clock; or NULL. Stops at the renderers' cancel flag, as for the
   viewer's price list. */
WHIT_CHECK whit_result cost_price(whit_renderer *usual, const whit_renderer_params *first,
                                  whit_renderer *setting, const whit_renderer_params *second,
                                  whit_reference *reference, enum cost_clock clock, uint32_t rounds,
                                  struct cost_price *out);
/* Times one renderer, set to `view`, `rounds` times after one picture that is not timed. */
struct cost_times {
    struct sample_median ms[COST_CLOCKS]; /* device: 0 rounds where it is not measured */
    double wall_max_ms;                   /* 90 % quantile of the wall clock */
};
WHIT_CHECK whit_result cost_time(whit_renderer *renderer, const whit_renderer_params *view,
                                 uint32_t rounds, struct cost_times *out);
/* Compares the colours of two renderers' pictures, without FLIP. */
WHIT_CHECK whit_result cost_colors(whit_renderer *a, whit_renderer *b, const whit_log *log,
                                   whit_difference *out);
/* The clock that verdicts go by: processor time for a CPU device; else the device's clock if it has
   one, else the wall clock. */
enum cost_clock cost_clock_of(const whit_device *device, const whit_renderer *renderer);

#endif
