/* The tree of rays of a pixel. */
#ifndef REFERENCE_TREE_H
#define REFERENCE_TREE_H

#include "reference/inside.h"

/* The colour of a pixel's sample tracer->sample; the ray tree too, if tracer->records. `first`: hit
   of the camera ray. */
struct dvec3 tree_trace(struct tracer *tracer, uint32_t x, uint32_t y, struct hit *first);
/* Adds a ray to the ray tree and gives its number; REFERENCE_NONE where none is recorded. */
uint32_t tree_record(struct tracer *tracer, const struct reference_ray *ray);
void tree_finish(struct tracer *tracer);

#endif
