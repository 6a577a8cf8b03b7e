/* Part of whit.h: trees over scenes. */
#ifndef WHIT_ACCEL_H
#define WHIT_ACCEL_H

#include "whit_types.h"

WHIT_C_BEGIN

typedef enum whit_build {
    WHIT_BUILD_BINNED = 0, /* surface area heuristic over equal bins */
    WHIT_BUILD_MEDIAN,     /* halves */
    WHIT_BUILD_SWEEP,      /* surface area heuristic over every position */
    WHIT_BUILD_SPATIAL,    /* splits space too, which may put a triangle in several leaves */
    WHIT_BUILD_NONE, /* no hierarchy: every box bounds the whole scene, so rays test every triangle.
                        WHIT_ERROR_USAGE above 40,000 triangles over all instances, or some 10,000
                        instances; renderers allow fewer under many lights */
} whit_build;

typedef struct whit_accel_params {
    whit_build build;
    bool optimize;       /* improve the finished trees by reinsertion */
    uint32_t bins;       /* WHIT_BUILD_BINNED: 2..256; 0: the default, chosen by measurement */
    uint32_t leaf_limit; /* triangles in a leaf, 1..15; 0: 4 */
    /* WHIT_BUILD_SPATIAL only. Alpha: space is split where siblings overlap by at least this share
       of the root's area, not below 0; 0: 1e-5. Budget: how many extra references, as a share of
       the triangles, splits may add to the one reference per triangle, finite; 0: 0.5; < 0:
       none. */
    float spatial_alpha, spatial_budget;
    uint32_t threads;          /* 0: one per core; does not change the tree */
    whit_build instance_build; /* builds the tree over instances: WHIT_BUILD_BINNED or _MEDIAN */
    bool instance_refit;       /* when instances move, their tree is kept and only its boxes are
                                  recomputed */
    whit_instances instances;
    bool validate; /* check the tree after the build (always in debug builds) */
} whit_accel_params;

/* WHIT_ERROR_USAGE for params out of range, also those of another builder, or for a scene too large
   for WHIT_BUILD_NONE; WHIT_ERROR_INPUT for more primitives than trees can hold, for instances that
   floats cannot hold, and with WHIT_INSTANCES_OFF for spheres that are turned, mirrored or
   stretched; WHIT_ERROR_STATUS where `validate` finds a violation. */
WHIT_CHECK whit_result whit_accel_create(const whit_scene *scene, const whit_accel_params *params,
                                         whit_accel **out);
void whit_accel_destroy(whit_accel *accel);

typedef struct whit_accel_info {
    uint32_t node_count, leaf_count, triangle_count, sphere_count, depth, instance_depth;
    uint32_t reference_count; /* in leaves: more than triangles and spheres together where triangles
                                 are split */
    uint64_t bytes;
    double build_ms, instance_build_ms, sah_cost; /* sah_cost: of the largest mesh */
    bool one_tree;                                /* a single tree in world space, see
                                                     whit_instances */
    whit_accel_params params;                     /* the params that the accel was made with */
} whit_accel_info;
void whit_accel_get_info(const whit_accel *accel, whit_accel_info *info);

/* Checks every tree: each triangle is in a leaf, children inside parents, indices in range, no
   cycle, leaf sizes, depth. WHIT_ERROR_STATUS, with the first violation in the log. */
WHIT_CHECK whit_result whit_accel_validate(const whit_accel *accel);

enum { WHIT_DEPTH_BINS = 130, WHIT_LEAF_BINS = 16 };
/* Figures of all mesh trees together; a mesh with several instances counts once. Means over meshes
   are weighted by the area of their boxes, for that is how often a random line meets them. */
typedef struct whit_accel_report {
    uint64_t leaves_at_depth[WHIT_DEPTH_BINS]; /* the root is depth 0; the last bin also counts
                                                  deeper leaves */
    uint64_t leaves_of_size[WHIT_LEAF_BINS];   /* triangles in a leaf */
    double sah_cost;                           /* predicted_inner_nodes plus predicted_triangles */
    double epo;     /* end-point overlap (Aila, Karras and Laine 2013, section 3), relative to the
                       area of all triangles */
    double overlap; /* area shared by siblings, relative to the area of their parents */
    /* Mean counts for a random line that meets a root box. Predicted: from ratios of surface areas,
       as if no hit ended the line. Measured: by closest-hit traversal on the CPU, which skips nodes
       behind a hit. */
    double predicted_inner_nodes, predicted_triangles;
    double measured_inner_nodes, measured_triangles;
    uint64_t measured_rays;
} whit_accel_report;
/* WHIT_ERROR_STATUS where a traversal reports that its hits cannot be trusted. */
WHIT_CHECK whit_result whit_accel_get_report(const whit_accel *accel, whit_accel_report *report);

/* The box of a tree's node, as corners in world space. Its edges are parallel to the axes of the
   tree's own space, so not always to the world's. Corner i has the upper end of axis k where bit k
   of i is set. */
typedef struct whit_box {
    float corners[8][3];
    uint32_t instance; /* WHIT_NONE: the box is in the tree over instances, or in a single tree over
                          the whole scene */
    uint32_t level;    /* the root is 0 */
    bool leaf;
} whit_box;
/* The nodes at `level`, and the leaves above it, of the tree over instances (`over_instances`) or
   else of every instance's mesh tree, at `time_s`, which must be the time that the accel is posed
   at. At most `max` are given; *boxes is one block for whit_memory_destroy. *total: how many there
   are in all. WHIT_ERROR_USAGE for a time that is not finite or at which the accel of an animated
   scene is not posed, WHIT_ERROR_INPUT where the scene has no finite pose at that time. */
WHIT_CHECK whit_result whit_accel_boxes(const whit_accel *accel, double time_s, bool over_instances,
                                        uint32_t level, uint64_t max, whit_box **boxes,
                                        uint64_t *total);

WHIT_C_END

#endif
