/* What the mesh trees of a scene are like, and what rays are to expect of them. */
#ifndef TWIN_REPORT_H
#define TWIN_REPORT_H

#include "accel/accel.h"

enum { REPORT_DEPTH_BINS = BVH_DEPTH_MAX + 2, REPORT_LEAF_BINS = BVH_LEAF_MAX + 1 };

/* Figures of all mesh trees together; a mesh with several instances counts once. Means over meshes
   are weighted by the area of their boxes, for that is how often a random line meets them. */
struct accel_report {
    uint64_t leaves_at_depth[REPORT_DEPTH_BINS]; /* the root is depth 0; the last: and below */
    uint64_t leaves_of_size[REPORT_LEAF_BINS];
    double sah_cost; /* predicted_inner_nodes times the traversal cost, and predicted_triangles */
    double epo;      /* end-point overlap, relative to the area of all triangles */
    double overlap;  /* area shared by siblings, relative to that of all parents */
    /* Counts for a random line that meets a root box: predicted by ratios of areas, as if nothing
       stopped it; measured by closest-hit traversal, which does not look behind a hit. */
    double predicted_inner_nodes, predicted_triangles;
    double measured_inner_nodes, measured_triangles;
    uint64_t measured_rays;
};

/* `ray_count` lines are measured, 0: none. Deterministic for any number of threads. */
WHIT_CHECK whit_result accel_report(const struct accel *accel, uint32_t ray_count,
                                    struct accel_report *report);

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
