/* Part of whit.h: trees over scenes. */
#ifndef WHIT_ACCEL_H
#define WHIT_ACCEL_H

#include "whit_types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum whit_build {
    WHIT_BUILD_BINNED = 0, /* surface area heuristic over equal bins */
    WHIT_BUILD_MEDIAN,     /* halves */
    WHIT_BUILD_SWEEP,      /* surface area heuristic over every position */
    WHIT_BUILD_SPATIAL,    /* splits space too, which may put a triangle in several leaves */
    WHIT_BUILD_NONE, /* no choice: every box is that of everything, so rays test every triangle.
                        WHIT_ERROR_USAGE above 40,000 over all instances, or some 10,000
                        instances; renderers draw fewer of them under many lights */
} whit_build;

typedef struct whit_accel_params {
    whit_build build;
    bool optimize;       /* improve the finished trees by reinsertion */
    uint32_t bins;       /* of WHIT_BUILD_BINNED, 2..256; 0: the measured default */
    uint32_t leaf_limit; /* triangles in a leaf, 1..15; 0: 4 */
    /* WHIT_BUILD_SPATIAL alone. Alpha: the overlap of siblings, relative to the root's area, from
       which on space is split; 0: 1e-5. Budget: references beyond one a triangle, relative to
       triangles; 0: 0.5; < 0: none beyond. */
    float spatial_alpha, spatial_budget;
    uint32_t threads;          /* 0: one a core; never changes the tree */
    whit_build instance_build; /* of the tree over instances: WHIT_BUILD_BINNED or _MEDIAN */
    bool instance_refit;       /* moving instances keep their tree, with new boxes */
    whit_instances instances;
    bool validate; /* check the tree after the build (always in debug builds) */
} whit_accel_params;

/* WHIT_ERROR_USAGE for params out of range, or WHIT_BUILD_NONE of too much; WHIT_ERROR_INPUT for
   more than trees can hold; WHIT_ERROR_STATUS where `validate` finds a violation. */
WHIT_CHECK whit_result whit_accel_create(const whit_scene *scene, const whit_accel_params *params,
                                         whit_accel **out);
void whit_accel_destroy(whit_accel *accel);

typedef struct whit_accel_info {
    uint32_t node_count, leaf_count, triangle_count, sphere_count, depth, instance_depth;
    uint32_t reference_count; /* in leaves: more than both where triangles are split */
    uint64_t bytes;
    double build_ms, instance_build_ms, sah_cost; /* sah_cost: of the largest mesh */
    bool one_tree;                                /* in world space, see whit_instances */
    whit_accel_params params;                     /* that it was made with */
} whit_accel_info;
void whit_accel_get_info(const whit_accel *accel, whit_accel_info *info);

/* Checks every tree: each triangle in a leaf, children inside parents, indices in range, no cycle,
   leaf sizes, depth. WHIT_ERROR_STATUS, with the first violation in the log. */
WHIT_CHECK whit_result whit_accel_validate(const whit_accel *accel);

enum { WHIT_DEPTH_BINS = 130, WHIT_LEAF_BINS = 16 };
/* Figures of all mesh trees together; a mesh with several instances counts once. Means over meshes
   are weighted by the area of their boxes, for that is how often a random line meets them. */
typedef struct whit_accel_report {
    uint64_t leaves_at_depth[WHIT_DEPTH_BINS]; /* the root is depth 0; the last: and below */
    uint64_t leaves_of_size[WHIT_LEAF_BINS];   /* triangles in a leaf */
    double sah_cost; /* predicted_inner_nodes times the traversal cost, and predicted_triangles */
    double epo;      /* end-point overlap (Aila, Karras and Laine 2013, section 3), relative to the
                        area of all triangles */
    double overlap;  /* area shared by siblings, relative to the area of their parents */
    /* Counts for a random line that meets a root box: predicted by ratios of areas, as if nothing
       stopped it; measured on the CPU by closest-hit traversal, which does not look behind a hit.
     */
    double predicted_inner_nodes, predicted_triangles;
    double measured_inner_nodes, measured_triangles;
    uint64_t measured_rays;
} whit_accel_report;
/* WHIT_ERROR_STATUS where a traversal says that its hits are not to be trusted. */
WHIT_CHECK whit_result whit_accel_get_report(const whit_accel *accel, whit_accel_report *report);

/* A box of a tree's node, in world space: parallel to the axes of its own space, not always to the
   world's. Corner i has the upper end of axis k where bit k of i is set. */
typedef struct whit_box {
    float corners[8][3];
    uint32_t instance; /* WHIT_NONE: of the tree over instances, or of one tree over all of them */
    uint32_t level;    /* the root is 0 */
    bool leaf;
} whit_box;
/* The nodes at `level`, and the leaves above it, of the tree over instances, or of the mesh trees
   of every instance, at `time_s`, which the accel must stand at. At most `max` of them; *boxes is
   one block for whit_memory_destroy. *total: how many there are. WHIT_ERROR_INPUT where the scene
   has no finite pose at that time. */
WHIT_CHECK whit_result whit_accel_boxes(const whit_accel *accel, double time_s, bool over_instances,
                                        uint32_t level, uint64_t max, whit_box **boxes,
                                        uint64_t *total);

#ifdef __cplusplus
}
#endif

#endif
