/* Translates kernels to machine code on two cores. */
#ifndef RENDER_TRANSLATION_H
#define RENDER_TRANSLATION_H

#include "render/stage_set.h"

/* Translates the kernels of a set that was just made and bound to machine code on two cores, if the
   driver would use one core and its cache has none of this code. Errors are the device's. After a
   request to stop, the remaining kernels are translated when they are dispatched. */
WHIT_CHECK whit_result translation_share(struct target *target, const struct stages_job *job);

#endif
