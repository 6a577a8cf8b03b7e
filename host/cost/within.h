/* The best picture within a time. */
#ifndef COST_WITHIN_H
#define COST_WITHIN_H

#include "cost/choose.h"

/* Fills search->best. On entry `search` has all measured effects, and in `settings` the usual ones,
   or the fastest ones for knobs that change nothing. */
void choose_within(struct search *search);

/* The effect of any number of samples per pixel, by the measured rows of knob `aa`; `known` false:
   these do not tell. */
struct effect choose_samples(const struct search *search, uint32_t samples);

/* cost_steps: number of steps in the order in which settings are given up for time. cost_step_of:
   index of the step that is this setting of this knob; WHIT_NONE: none, nothing is given up. */
uint32_t cost_steps(void);
uint32_t cost_step_of(const char *knob, const char *setting);

#endif
