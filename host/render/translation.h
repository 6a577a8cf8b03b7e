/* Machine code by two cores. */
#ifndef RENDER_TRANSLATION_H
#define RENDER_TRANSLATION_H

#include "render/stage_set.h"

/* Has the kernels of a set that was just made and bound translated to machine code by two cores,
   where the driver's cache has none of it and the driver would use one core. Errors are the
   device's; where a stop is asked for, what is left is translated when it is dispatched. */
WHIT_CHECK whit_result translation_share(struct target *target, const struct stages_job *job);

#endif
