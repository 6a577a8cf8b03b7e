/* What the mesh trees of a scene are like, and what rays are to expect of them. */
#ifndef TWIN_REPORT_H
#define TWIN_REPORT_H

#include "accel/accel.h"
#include "whit/whit_accel.h"

_Static_assert((int)WHIT_DEPTH_BINS == BVH_DEPTH_MAX + 2 && (int)WHIT_LEAF_BINS == BVH_LEAF_MAX + 1,
               "a bin for each depth and one for all below, and one for each size of a leaf");

/* `ray_count` lines are measured, 0: none. Deterministic for any number of threads. */
WHIT_CHECK whit_result accel_report(const struct accel *accel, uint32_t ray_count,
                                    whit_accel_report *report);

/* End-point overlap (Aila, Karras and Laine 2013, "On quality metrics of bounding volume
   hierarchies", section 3) of one mesh tree before it is normalised: `overlap` is the area of
   triangles inside a node's box that do not belong to its subtree, summed over nodes: times the
   traversal cost for inner ones, times their triangles for leaves. `surface` is the area of the
   triangles. A triangle in several leaves belongs to the subtrees of them all. (bvh_epo.c) */
struct bvh_epo {
    double overlap, surface;
};
WHIT_CHECK whit_result accel_mesh_epo(const struct accel *accel, uint32_t mesh,
                                      struct bvh_epo *epo);
/* The area of the part of triangle abc that is inside the closed box. */
double epo_clipped_area(const float a[3], const float b[3], const float c[3],
                        const struct bvh_box *box);

#endif
