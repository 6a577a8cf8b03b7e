/* The reference pictures of a report. */
#ifndef COST_REFERENCE_H
#define COST_REFERENCE_H

#include "cost/measure.h"

/* Makes both references, at the largest size that `seconds` allow. */
WHIT_CHECK whit_result measure_references(struct measure *measure, double seconds);

#endif
