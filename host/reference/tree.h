/* Ray trees of samples. */
#ifndef REFERENCE_TREE_H
#define REFERENCE_TREE_H

#include "reference/inside.h"

/* Gives the colour of sample tracer->sample of a pixel, and the hit of its camera ray in *first.
   Records the ray tree if tracer->records. */
struct dvec3 tree_trace(struct tracer *tracer, uint32_t x, uint32_t y, struct hit *first);
/* Adds a ray to the ray tree and gives its index; REFERENCE_NONE where rays are not recorded. */
uint32_t tree_record(struct tracer *tracer, const struct reference_ray *ray);
void tree_finish(struct tracer *tracer);

#endif
