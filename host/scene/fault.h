/* Faults that are put into a copy of a scene on purpose, to see whether a check catches them. */
#ifndef SCENE_FAULT_H
#define SCENE_FAULT_H

#include "scene/mix.h"

/* Makes a frozen copy of `side` with these faults in it. WHIT_ERROR_USAGE, not logged, where the
   scene has nothing that one of them could change; other errors as scene_mix. */
WHIT_CHECK whit_result scene_fault(const whit_log *log, const struct scene_side *side,
                                   const whit_fault *faults, uint32_t count, struct scene **out);

#endif
