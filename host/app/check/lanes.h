/* Further devices that draw cases of a suite beside the first: these go from its end, the first one
   from its start, until they meet, so that neighbours, which often share a scene, are drawn by one
   device. A lane says nothing: what it cannot draw without a word is left to the first, which says
   it when its turn comes. So what is printed does not depend on lanes. */
#ifndef APP_CHECK_LANES_H
#define APP_CHECK_LANES_H

#include "app/check/check.h"
#include "app/check/draw.h"

struct lanes;

/* Draws case `index` by the studio, and finds its verdict: a result of `check`. */
typedef whit_result lanes_draw(struct check *check, struct studio *studio, uint32_t index);

/* NULL: no lane pays, as in a suite of few cases or on a GPU, or none can be had. */
struct lanes *lanes_begin(struct check *check, const struct studio *first, lanes_draw *draw);
/* Whether a lane has drawn case `index`; waits for a lane that is drawing it. False: the caller
   draws it, and no lane will. */
bool lanes_have(struct lanes *lanes, uint32_t index);
/* Lets each lane finish the case in hand. NULL is fine. */
void lanes_end(struct lanes *lanes);

#endif
