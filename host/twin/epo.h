/* How far the nodes of mesh trees overlap. */
#ifndef TWIN_EPO_H
#define TWIN_EPO_H

#include "accel/accel.h"

/* End-point overlap (Aila, Karras and Laine 2013, "On quality metrics of bounding volume
   hierarchies", section 3) of one mesh tree before it is normalised: `overlap` is the area of
   triangles inside a node's box that do not belong to its subtree, summed over nodes, of
   leaves times their triangles. `surface` is the area of the
   triangles. A triangle in several leaves belongs to the subtrees of them all. */
struct bvh_epo {
    double overlap, surface;
};
WHIT_CHECK whit_result accel_mesh_epo(const struct accel *accel, uint32_t mesh,
                                      struct bvh_epo *epo);
/* The area of the part of triangle abc that is inside the closed box. */
double epo_clipped_area(const float a[3], const float b[3], const float c[3],
                        const struct bvh_box *box);

#endif
