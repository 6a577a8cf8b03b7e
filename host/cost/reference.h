/* Pictures that others are held against. */
#ifndef COST_REFERENCE_H
#define COST_REFERENCE_H

#include "cost/measure.h"

/* Both references, at the largest size that `seconds` allow. */
WHIT_CHECK whit_result measure_references(struct measure *measure, double seconds);

#endif
