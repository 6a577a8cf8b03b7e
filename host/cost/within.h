/* The best picture within a time. */
#ifndef COST_WITHIN_H
#define COST_WITHIN_H

#include "cost/choose.h"

/* Fills search->best. `search` has what is known, and the
   usual settings but for knobs that change nothing, of which it has the fastest. */
void choose_within(struct search *search);

/* How many things are given up for time, one after the other, and which one in that
   order is that setting of that knob; WHIT_NONE: none, it is the usual one or better. */
uint32_t cost_steps(void);
uint32_t cost_step_of(const char *knob, const char *setting);

#endif
