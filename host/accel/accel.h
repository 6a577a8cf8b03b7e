/* Trees over a scene, as flat arrays that go to the device as they are. */
#ifndef ACCEL_ACCEL_H
#define ACCEL_ACCEL_H

#include <stdbool.h>
#include <stdint.h>

#include "abi/bvh.h"
#include "abi/spec.h"
#include "base/log.h"
#include "scene/scene.h"

/* ---- One tree over boxes (bvh.c: the skeleton; split_*.c: how to choose a split) ---- */

struct bvh_box {
    float lo[3], hi[3];
};

enum bvh_builder {
    BVH_BINNED,  /* SAH over equal bins */
    BVH_MEDIAN,  /* halves */
    BVH_SWEEP,   /* SAH over every position, sorted once */
    BVH_SPATIAL, /* SAH over object and spatial splits (SBVH): needs `triangles` */
    BVH_NONE,    /* no choice: the order of the input, full leaves, every box that of everything */
};

/* The triangles that the boxes are of. */
struct bvh_triangles {
    const float *positions;  /* 3 a vertex */
    const uint32_t *indices; /* 3 a triangle */
    const uint8_t *whole;    /* 1: must stay in one leaf; NULL: none must */
};

struct bvh_params {
    enum bvh_builder builder;
    uint32_t bins;         /* BVH_BINNED: 2..256; 0: up to 32, fewer for fewer primitives */
    uint32_t leaf_limit;   /* 1..BVH_LEAF_MAX; 0: 4 */
    uint32_t thread_count; /* 0: one a core; the tree is the same for any count */
    float traversal_cost;  /* of one node pair relative to one primitive; 0: 1 */
    bool optimize;         /* improve the finished tree by reinsertion */
    const struct bvh_triangles *triangles; /* BVH_SPATIAL */
    float spatial_alpha;  /* overlap, relative to the root's area, from which spatial splits are
                             tried (Stich et al. 2009, 4.5); 0: 1e-5 */
    float spatial_budget; /* references beyond one a triangle, relative to triangles; 0: 0.5;
                             < 0: none */
};

/* nodes[0] is the root, nodes[1] is unused. `order` lists the primitives leaf by leaf. */
struct bvh {
    struct gpu_bvh_node *nodes; /* 64-byte aligned; free() */
    uint32_t *order;            /* free() */
    uint32_t node_count;        /* with the unused one; 0: no primitives */
    uint32_t primitive_count, leaf_count;
    uint32_t
        reference_count; /* length of `order`; beyond primitive_count where triangles were split */
    uint32_t depth;      /* inner nodes on the longest path: the stack a traversal needs */
    uint32_t leaf_largest;
    bool clipped;    /* leaf boxes may hold parts of their triangles only */
    double sah_cost; /* expected cost of a random ray, relative to the root's area */
    double build_ms;
};

/* Boxes must be finite with lo <= hi. Deterministic. */
WHIT_CHECK whit_result bvh_build(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                                 const struct bvh_params *params, struct bvh *out);
void bvh_finish(struct bvh *bvh);

static inline uint32_t bvh_count(const struct gpu_bvh_node *node)
{
    return node->count & BVH_COUNT_MASK;
}

/* Completes finished nodes: sets the axis bits of every pair, sah_cost, leaf_count, leaf_largest
   and depth (bvh_complete.c). Every builder ends with it. */
void bvh_complete(struct bvh *bvh, double traversal_cost);
/* Sets only the axis bits of the pair of sibling nodes at `first`. */
void bvh_set_axis(struct gpu_bvh_node *first);

/* Improves a finished tree by moving subtrees to where they cost less: Meister and Bittner 2018,
   "Parallel reinsertion for bounding volume hierarchy optimization". Keeps leaves as they are; the
   depth stays within BVH_DEPTH_MAX. Deterministic whatever the thread count. */
WHIT_CHECK whit_result bvh_optimize(const struct log *log, uint32_t thread_count,
                                    double traversal_cost, struct bvh *bvh);
enum { BVH_DEPTH_MAX = 128 };

/* Every primitive once, parents contain children, indices in range and paired, no cycle, leaf
   sizes, depth as stated. `boxes` may be NULL when only the structure is to be checked. Logs the
   first violation. */
WHIT_CHECK whit_result bvh_validate(const struct log *log, const struct bvh *bvh,
                                    const struct bvh_box *boxes, uint32_t leaf_limit);

/* ---- All trees of a scene ---- */

/* The tree of one mesh inside the shared arrays. */
struct accel_mesh {
    uint32_t root; /* ref, or BVH_EMPTY_REF */
    uint32_t first_node, node_count;
    uint32_t first_triangle, record_count; /* in the triangle array */
    uint32_t triangle_count;               /* below record_count where triangles were split */
    uint32_t shade_base;                   /* primitive 0 in arrays indexed by primitive */
    uint32_t depth;
    double sah_cost, build_ms;
    struct bvh_box box;
};

enum accel_update { ACCEL_REBUILD, ACCEL_REFIT };

/* The most primitives over all instances with BVH_NONE, and the most loop iterations of one ray:
   lavapipe grants an invocation 65,535. */
enum { ACCEL_BARE_MAX = 40000, ACCEL_ITERATIONS_MAX = 65000 };

struct accel_params {
    struct bvh_params mesh, instances; /* instances.leaf_limit is always 1 */
    /* What accel_pose does with the tree over instances when it has one: a new one, or new boxes
       for the one it has. */
    enum accel_update update;
    bool validate;
    uint32_t stack_floor; /* accel_stack_size is not below it: the size is part of a kernel, and so
                             scenes of different depth share one */
    bool flatten;         /* one tree for the whole scene, in world space */
};

/* The same trees with up to eight children a node, for kernels of which each lane tests one child.
   Node i is nodes[8 i] to nodes[8 i + 7]; `first` of an inner child is the number of its node, and
   empty children come last. Mesh trees first, that over instances behind them. */
struct accel_bvh8 {
    struct gpu_bvh_node *nodes;
    uint32_t *mesh_roots; /* refs, as instance_root: BVH_EMPTY_REF where nothing is */
    uint32_t node_count, mesh_node_count, capacity;
    uint32_t instance_root;
    uint32_t mesh_depth, instance_depth; /* inner nodes on the longest path */
};

/* nodes: [0, instance_node_count) is the tree over instances, rebuilt by accel_pose within
   [0, instance_node_capacity); mesh trees follow. */
struct accel {
    const struct scene *scene; /* borrowed */
    struct log log;
    struct accel_params params;
    struct gpu_bvh_node *nodes;
    struct gpu_triangle *triangles;
    struct gpu_instance *instances; /* in the order of the scene */
    struct accel_mesh *meshes;      /* in the order of the scene */
    uint32_t node_count, instance_count, mesh_count;
    uint32_t record_count, triangle_count; /* in `triangles`; of all meshes, with their spheres */
    uint32_t instance_node_count, instance_node_capacity;
    uint32_t instance_root;  /* ref, or BVH_EMPTY_REF */
    uint32_t instance_depth; /* of the tree over instances */
    uint32_t mesh_depth;     /* deepest mesh tree */
    bool single_identity;    /* one instance, not moved: traversal may start at meshes[..].root */
    bool clipped;            /* some mesh tree holds clipped triangles */
    bool flat;     /* one tree over the triangles of all instances: meshes[0], the only mesh, is the
                      world; accel_pose builds it anew. Instances say mesh and shade_base of the
                      scene's meshes, but root, centre and reach of the world */
    bool no_trees; /* BVH_NONE: rays that meet the box of everything test every primitive */
    uint32_t turns; /* of loops that a ray takes at most then: ACCEL_TURNS_MAX */
    double build_ms, instance_build_ms;
    struct accel_bvh8 bvh8;      /* after accel_widen */
    struct accel_posing *posing; /* buffers of accel_pose */
    struct accel_flat *world;    /* flat: what its builds share */
};

/* Builds the mesh trees and poses the instances at time 0. `scene` is frozen and outlives *out. */
WHIT_CHECK whit_result accel_create(const struct log *log, const struct scene *scene,
                                    const struct accel_params *params, struct accel **out);
void accel_destroy(struct accel *accel);
/* Whether `flatten` suits a frozen scene, which stands at `pose`: no mesh but a single ball is
   there twice, nothing moves, vertices are rounded by next to nothing when they are placed, and
   memory is enough. It is no news for one instance that is where its mesh is. The same on every
   machine, but for memory. WHIT_ERROR_MEMORY, logged. */
WHIT_CHECK whit_result accel_flat_suits(const struct scene *scene, const struct scene_pose *pose,
                                        bool *out);
/* Moves the instances: rewrites `instances` and the tree over them, leaves mesh trees alone. */
WHIT_CHECK whit_result accel_pose(struct accel *accel, const struct scene_pose *pose);
/* Makes bvh8 of the trees that there are now, to be called again after accel_pose: mesh trees that
   did not change are kept. */
WHIT_CHECK whit_result accel_widen(struct accel *accel);
void accel_bvh8_finish(struct accel_bvh8 *bvh8);
/* bvh_validate over everything. */
WHIT_CHECK whit_result accel_validate(const struct accel *accel);
uint64_t accel_bytes(const struct accel *accel);
/* Refs that a traversal may have to keep: at least 1. */
uint32_t accel_stack_size(const struct accel *accel);
/* The same of rays that walk together through bvh8, a multiple of 4. */
uint32_t accel_packet_stack_size(const struct accel *accel);
/* Whether any record has TRIANGLE_FILTER_DETAIL. */
bool accel_filters_vary(const struct accel *accel);
/* Whether textures or vertex colours have a say in any of them; else these absorb, and that is all.
 */
bool accel_filters_patterned(const struct accel *accel);
/* TRIANGLE_* that the records of a primitive have, but those of its place in a tree. */
uint32_t accel_primitive_flags(const struct accel *accel, uint32_t instance, uint32_t primitive);

/* ---- Traversal on the CPU ---- */

struct traverse_params {
    uint32_t order;    /* ORDER_* */
    uint32_t numerics; /* NUMERICS_* */
    bool any;          /* any hit will do: then only `primitive` != HIT_NONE counts */
    bool brute;        /* no tree: every record of every instance */
    uint32_t skip_instance, skip_primitive; /* not hit; HIT_NONE: none */
};

/* The twin of shaders/bind/traverse.glsl: same operations in the same order, so the same bits
   and the same costs on a device whose arithmetic is IEEE. Tests t_min <= t <= t_max; equal t goes
   to the smaller instance, then primitive. The ray's cost is added to *cost (stack and depth: the
   larger one), which may be NULL; STATUS_* bits are or-ed into *status. */
void traverse_ray(const struct accel *accel, const struct traverse_params *params,
                  const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost,
                  uint32_t *status);
/* The same at NUMERICS_WATERTIGHT. */
void traverse_float(const struct accel *accel, uint32_t order, const struct gpu_ray *ray, bool any,
                    uint32_t skip_instance, uint32_t skip_primitive, struct gpu_hit *hit,
                    struct gpu_cost *cost, uint32_t *status);
/* All hits of a ray one after the other, in the order of (t, instance, primitive): the first one
   where `before` is NULL, else the one behind *before, a hit of the same ray. `hit` may be
   `before`. Only the first one minds what params say is not hit. */
void traverse_next(const struct accel *accel, const struct traverse_params *params,
                   const struct gpu_ray *ray, const struct gpu_hit *before, struct gpu_hit *hit,
                   uint32_t *status);
/* The same at NUMERICS_WATERTIGHT. */
void traverse_next_float(const struct accel *accel, const struct gpu_ray *ray,
                         const struct gpu_hit *before, struct gpu_hit *hit, uint32_t *status);
/* The same answer without any tree: every triangle of every instance. */
void traverse_brute_float(const struct accel *accel, const struct gpu_ray *ray,
                          struct gpu_hit *hit);

/* From a point to the nearest surface, world units, in double; to spheres that a transform
   stretches it may be less. Infinity in an empty scene. `pose` is the one that `accel` has. */
double accel_distance(const struct accel *accel, const struct scene_pose *pose, const double p[3]);

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
