/* The trees of a scene, as flat arrays that go to the device as they are. A ref names a node in 32
   bits: see BVH_EMPTY_REF in abi/bvh.h. */
#ifndef ACCEL_ACCEL_H
#define ACCEL_ACCEL_H

#include "abi/spec.h"
#include "bvh/bvh.h"
#include "scene/scene.h"

/* ---- All trees of a scene ---- */

/* The tree of one mesh inside the shared arrays. */
struct accel_mesh {
    uint32_t root; /* ref, or BVH_EMPTY_REF */
    uint32_t first_node, node_count;
    uint32_t first_triangle, record_count; /* in the triangle array */
    uint32_t triangle_count;               /* below record_count where triangles were split */
    uint32_t shade_base; /* place of primitive 0 in arrays with one element per primitive */
    uint32_t depth;
    double sah_cost;
    struct bvh_box box;
    uint32_t hull; /* HULL_*; HULL_NONE in a flat tree */
};

/* With WHIT_BUILD_NONE: the most primitives over all instances, and the most loop iterations of one
   ray. lavapipe grants a subgroup 65,535. */
enum { ACCEL_BARE_MAX = 40000, ACCEL_ITERATIONS_MAX = 65000 };

/* The same trees with up to eight children per node, for kernels in which each lane tests one
   child. Node i is nodes[8 i] to nodes[8 i + 7]; `first` of an inner child is the number of its
   node, and empty children come last. The mesh trees come first, then the tree over instances. */
struct accel_bvh8 {
    struct gpu_bvh_node *nodes;
    uint32_t *mesh_roots; /* refs, as instance_root is: BVH_EMPTY_REF for an empty tree */
    uint32_t node_count, mesh_node_count, capacity;
    uint32_t instance_root;
    uint32_t mesh_depth, instance_depth; /* inner nodes on the longest path */
};

/* nodes: [0, instance_node_count) is the tree over instances, rebuilt by accel_pose within
   [0, instance_node_capacity); mesh trees follow. */
struct accel {
    const struct scene *scene; /* borrowed */
    whit_log log;
    whit_accel_params params;
    struct gpu_bvh_node *nodes;
    struct gpu_triangle *triangles;
    struct gpu_instance *instances; /* in the order of the scene */
    struct accel_mesh *meshes;      /* in the order of the scene */
    uint32_t node_count, instance_count, mesh_count;
    uint32_t record_count, triangle_count; /* in `triangles`; of all meshes, spheres included */
    uint32_t instance_node_count, instance_node_capacity;
    uint32_t instance_root;  /* ref, or BVH_EMPTY_REF */
    uint32_t instance_depth; /* of the tree over instances */
    uint32_t mesh_depth;     /* deepest mesh tree */
    bool single_identity;    /* one instance, not moved: traversal may start at meshes[..].root */
    bool clipped;            /* some mesh tree holds clipped triangles */
    bool flat; /* one tree over the primitives of all instances: meshes[0], the only mesh, is the
                  whole world, which accel_pose builds anew. In `instances`, mesh and shade_base are
                  those of the scene's mesh; root, centre and reach are those of the world */
    bool no_trees; /* WHIT_BUILD_NONE: a ray that hits a tree's root box tests all its primitives */
    uint32_t iterations; /* with no_trees: the most loop iterations of one ray; at most
                            ACCEL_ITERATIONS_MAX */
    double posed_s;      /* the time of the present pose; NAN: none, since posing failed */
    double build_ms, instance_build_ms;
    struct accel_bvh8 bvh8;      /* after accel_widen */
    struct accel_posing *posing; /* buffers of accel_pose */
    struct accel_flat *world;    /* with `flat`: what is kept from build to build */
};

/* Builds the mesh trees and poses the instances at time 0. `scene` is frozen and outlives *out.
   WHIT_INSTANCES_AUTO is taken as WHIT_INSTANCES_ON: the caller asks accel_flat_suits. */
WHIT_CHECK whit_result accel_create(const whit_log *log, const struct scene *scene,
                                    const whit_accel_params *params, struct accel **out);
void accel_destroy(struct accel *accel);
uint64_t accel_bytes(const struct accel *accel);

#endif
