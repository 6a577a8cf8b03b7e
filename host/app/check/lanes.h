/* Lanes: threads with further devices that draw cases of a suite in parallel with the first device.
   Lanes take cases from the end of the suite, the first device from its start, so that neighbouring
   cases, which often share a scene, are drawn by one device. A lane prints nothing: a case with
   messages is left to the first device, which prints them in the order of the suite. So the output
   does not depend on lanes. */
#ifndef APP_CHECK_LANES_H
#define APP_CHECK_LANES_H

#include "app/check/check.h"
#include "app/check/draw.h"

struct lanes;

/* Draws case `index` by the studio, and finds its verdict: a result of `check`. */
typedef whit_result lanes_draw(struct check *check, struct studio *studio, uint32_t index);

/* Starts the lanes. NULL: they would not pay, as for few cases or on a GPU, or cannot be
   started. */
struct lanes *lanes_begin(struct check *check, const struct studio *first, lanes_draw *draw);
/* Whether a lane has drawn case `index`; waits for a lane that is drawing it. False: the caller
   draws it, and no lane will. */
bool lanes_have(struct lanes *lanes, uint32_t index);
/* Lets each lane finish the case in hand. NULL is fine. */
void lanes_end(struct lanes *lanes);

#endif
