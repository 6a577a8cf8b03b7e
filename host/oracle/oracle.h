/* Hits in double, and how certain they are. */
#ifndef ORACLE_ORACLE_H
#define ORACLE_ORACLE_H

#include "accel/accel.h"

/* The oracle's closest hit, in double. |edge_margin| says how certain it is: the number of error
   bounds of the float test between the ray and another answer, which is to lose the hit at an edge
   or an end of the interval, or to hit another triangle that is narrowly missed or as near. Below 1
   the float test may decide otherwise. It is negative for a miss. When traced through a tree, far
   triangles do not enter it, so that only values below 1 are exact. `second_t` is the t of the next
   hit on another primitive (infinity: none; equal to t: a tie). `t_error` bounds the error of the
   float test's t. */
struct oracle_hit {
    double t, u, v;
    uint32_t primitive, instance;
    double edge_margin, second_t, t_error;
};

/* Searches the tree (boxes widened so that no hit is lost), or all primitives (`brute`). */
void oracle_trace(const struct accel *accel, const struct gpu_ray *ray, bool brute,
                  struct oracle_hit *hit);

#endif
