/* Hits in double, with how sure they are. */
#ifndef ORACLE_ORACLE_H
#define ORACLE_ORACLE_H

#include "accel/accel.h"

/* The double-precision oracle's closest hit, with how sure it is: |edge_margin| is by how many
   error bounds of the float test the ray keeps away from another answer: losing the hit at an edge
   or an end of the interval, or a hit on another triangle that is narrowly missed, or as near.
   Below 1 the float test may decide otherwise. Negative for a miss. Triangles far off do not enter
   it when traced by tree: then only what is below 1 is exact. `second_t` is the next hit behind on
   another primitive (infinity: none; equal: a tie). `t_error` bounds the error of the float test's
   t. */
struct oracle_hit {
    double t, u, v;
    uint32_t primitive, instance;
    double edge_margin, second_t, t_error;
};

/* Searches the tree (boxes widened so that no hit is lost), or all primitives (`brute`). */
void oracle_trace(const struct accel *accel, const struct gpu_ray *ray, bool brute,
                  struct oracle_hit *hit);

#endif
