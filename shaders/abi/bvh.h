/* Trees, triangles and instances as traversal reads them. */
#ifndef ABI_BVH_H
#define ABI_BVH_H

#include "base.h"

/* A node: a box and its contents. Nodes come in pairs: the two children of a node are nodes `first`
   and `first + 1` with `first` even, so that siblings share one 64-byte line. In a tree over
   instances a leaf holds one instance, and `first` is its index. */
struct gpu_bvh_node {
    gpu_vec3 lo;
    gpu_uint first; /* inner: left child; leaf: first record of the triangle array */
    gpu_vec3 hi;
    gpu_uint count; /* its bits BVH_COUNT_MASK: 0: inner; else number of primitives of the leaf. In
                       the first node of a pair also the bits of BVH_AXIS_* */
};
GPU_ASSERT_SIZE(gpu_bvh_node, 32)

/* A ref: a node in the 32 bits that the traversal stack holds: count in the upper 4, first in the
   lower 28. */
#define BVH_LEAF_MAX    15u
#define BVH_COUNT_MASK  15u
#define BVH_COUNT_SHIFT 28u
#define BVH_FIRST_MASK  0x0fffffffu
#define BVH_EMPTY_REF   0xffffffffu /* a tree without primitives */

/* The same nodes in 16 bytes, by the same indices, where a tree has no instances. A side of a box is
   in steps of the grid from its corner on: lowest in the lower 16 bits, highest in the upper 16. */
struct gpu_quantized_node {
    gpu_uint x, y, z;
    gpu_uint ref;
};
GPU_ASSERT_SIZE(gpu_quantized_node, 16)

/* The grid of these nodes, in the place of the first one. */
struct gpu_quantized_grid {
    gpu_vec3 corner;
    gpu_float scale; /* steps a unit of length: a power of two */
};
GPU_ASSERT_SIZE(gpu_quantized_grid, 16)
#define QUANTIZED_STEPS 65536 /* no side of a tree is longer */

/* In `count` of the first node of a pair: the axis on which the centres of the two boxes are
   farthest apart, and whether the second node is the lower one on it. For ORDER_SIGN. */
#define BVH_AXIS_SHIFT 4u
#define BVH_AXIS_MASK  3u
#define BVH_SECOND_LOW 64u

/* The child that is visited first where a ray hits both of a pair. */
#define ORDER_DISTANCE 0u /* the one that the ray enters first */
#define ORDER_SIGN     1u /* the lower one on the pair's axis, for rays that go up along it; else
                             the other */
#define ORDER_BASIC    2u /* the first of the pair */

/* A record: one primitive, in the order of the leaves. In object space, or in world space where
   instances are flattened. */
struct gpu_triangle {
    gpu_vec3 v0;
    gpu_uint primitive; /* index within its mesh */
    gpu_vec3 v1;
    gpu_uint flags; /* TRIANGLE_* */
    gpu_vec3 v2;
    gpu_uint shadow; /* optical depth of a filter: 3 x 10 bits, red lowest; see TRIANGLE_FILTER */
};
GPU_ASSERT_SIZE(gpu_triangle, 48)

#define TRIANGLE_CUTOUT    1u /* opacity decides whether it is hit */
#define TRIANGLE_NO_SHADOW 2u /* casts no shadow: the surface of a light, or a shadow catcher */
/* Lets shadow rays through, weakened by 2^(-shadow / 64) per channel. Depths are added as integers,
   so that the order in which a ray hits its filters cannot change the sum. */
#define TRIANGLE_FILTER    4u
#define TRIANGLE_MIRRORED  8u /* flat tree: its instance mirrors it, so its normal is reversed */
/* A sphere: centre in v0, radius in v1.x. v1.yz are 0 and v2 is v1, so that no ray would hit it as
   a triangle. */
#define TRIANGLE_SPHERE        16u
#define TRIANGLE_ONE_SIDED     32u  /* not hit from behind, except by shadow rays */
#define TRIANGLE_FILTER_DETAIL 64u  /* a filter whose depth depends on the point that is hit */
#define TRIANGLE_GLASS         128u /* light passes through it */
#define TRIANGLE_INSTANCE_SHIFT 8u /* flat tree: its instance is in the bits from here up */
#define SHADOW_DEPTH_SCALE 64.0

/* Sums of filters' depths along a shadow ray are in units of 1/256 stop. A filter that nothing
   passes has 160 stops, whose share is less than the least float above 0. */
#define FILTER_DEPTH_SCALE  256.0
#define FILTER_DEPTH_OF_RECORD 4 /* 1/64 stop */
#define FILTER_DEPTH_OPAQUE 40960.0
#define FILTER_DEPTH_OF_ABSORPTION 369.3299304675746 /* FILTER_DEPTH_SCALE / ln 2 */

/* An instance of a mesh. t is the same in object and world space, as directions are not
   renormalised. The inverse is applied to (p - origin), never to p: so nothing cancels far from the
   origin. */
struct gpu_instance {
    gpu_vec3 inverse0;
    gpu_float origin_x;
    gpu_vec3 inverse1;
    gpu_float origin_y;
    gpu_vec3 inverse2;
    gpu_float origin_z;
    gpu_uint root;       /* ref of the mesh tree, or BVH_EMPTY_REF */
    gpu_uint shade_base; /* index of its primitive 0 among the primitives of all meshes */
    gpu_uint mesh;
    gpu_uint hull; /* HULL_* */
    gpu_vec3 forward0; /* object to world, rows */
    gpu_float center_x; /* of the mesh's box, object space */
    gpu_vec3 forward1;
    gpu_float center_y;
    gpu_vec3 forward2;
    gpu_float center_z;
    gpu_float reach; /* half the longest side of that box */
    gpu_uint root8;  /* ref of the mesh tree with eight children per node */
    gpu_float pad1;
    gpu_float pad2;
};
GPU_ASSERT_SIZE(gpu_instance, 128)

/* Whether a ray that starts on a primitive of the mesh, and goes away from it, can meet another. */
#define HULL_NONE   0u /* it may */
#define HULL_CONVEX 1u /* not if it starts outside: no primitive has another in front of it */
#define HULL_PLANAR 2u /* it cannot: all primitives lie in one plane */

/* A ray of `whit trace` and its answer. */
struct gpu_ray {
    gpu_vec3 origin;
    gpu_float t_min;
    gpu_vec3 dir;
    gpu_float t_max;
};
GPU_ASSERT_SIZE(gpu_ray, 32)

struct gpu_hit {
    gpu_float t; /* infinity: miss */
    gpu_float u, v;
    gpu_uint primitive; /* HIT_NONE: miss */
    gpu_uint instance;
    gpu_float ng_x, ng_y, ng_z; /* geometric normal in world space, not unit length */
};
GPU_ASSERT_SIZE(gpu_hit, 32)

/* Counters of the traversals of one kind of ray: for a pixel, for a ray of a batch, or summed. */
struct gpu_cost {
    gpu_uint rays;
    gpu_uint inner_nodes; /* inner nodes opened: box tests are twice that */
    gpu_uint leaves;    /* leaves of mesh trees entered */
    gpu_uint instances; /* instances entered */
    gpu_uint triangles; /* triangle tests */
    gpu_uint stack;     /* most refs on the node stack */
    gpu_uint depth;     /* deepest level whose boxes were tested. The root is level 0, and the root
                           of a mesh tree has the level of its instance's leaf */
    gpu_uint pad;
};
GPU_ASSERT_SIZE(gpu_cost, 32)

/* Kinds of rays, with counters of their own. */
#define RAY_PRIMARY    0u
#define RAY_SHADOW     1u
#define RAY_REFLECTED  2u
#define RAY_REFRACTED  3u
#define RAY_KIND_COUNT 4u

/* Push constants of the ray batch kernel. */
struct gpu_batch {
    gpu_uint ray_count;
    gpu_uint root;
    gpu_uint deferred; /* 1: works on the rays of the deferred list */
    gpu_uint root8;   /* root of the tree with eight children per node, for SPEC_PACKETS */
};

/* Head of a work list. The items follow it: pixels (slots within the chunk), or rays of a batch.
   The first three words are the arguments of an indirect dispatch. */
struct gpu_work {
    gpu_uint groups_x;
    gpu_uint groups_y;
    gpu_uint groups_z;
    gpu_uint count;
};
GPU_ASSERT_SIZE(gpu_work, 16)

#define HIT_NONE 0xffffffffu

/* In place of the primitive on which a ray starts: all primitives of its instance, none of which it
   can meet (HULL_*). */
#define SKIP_ALL 0xfffffffeu

/* Stands for the record and the instance of a hit on a user's shape (HOOK_INTERSECT), which is in
   no tree. The primitive of such a hit is 0. */
#define HIT_SHAPE 0x7fffffffu

/* Reasons not to trust a result. Kernels or these bits into the status word; the host checks it. */
#define STATUS_UNFINISHED_TRAVERSAL 1u /* a loop ended before its stack was empty */
#define STATUS_NODE_STACK_OVERFLOW  2u
#define STATUS_NON_FINITE           8u /* NaN or infinite radiance */
#define STATUS_UNFINISHED_LOOP      16u /* the loop over lights or another one was cut short */
#define STATUS_MEDIUM_STACK_OVERFLOW 32u /* a ray was in more than MEDIA_MAX media */
#define STATUS_UNFINISHED (STATUS_UNFINISHED_TRAVERSAL | STATUS_UNFINISHED_LOOP)
/* A queue between stages was full. This is no error: the tile is drawn again in smaller ones. */
#define STATUS_QUEUE_FULL 128u
#define STATUS_FUEL 256u /* a loop of a user's function took more iterations than it may */
#define STATUS_CUT_LOOPS 1024u /* loops behind a user's functions no longer have a second iteration */
#define STATUS_SHAPE 512u /* a user's intersect() gave an answer that is not allowed: SHAPE_* */
/* The status of a single ray, never in the status word: the ray is deferred, as floats do not
   decide its hit (without SPEC_SETTLES). The rest of its result is ignored. */
#define STATUS_RAY_DEFERRED 64u

/* The error of an answer for a user's shape. It stands in the upper bits of status_shape;
   below it is SHAPE_PIXEL_MASK less the number of the pixel, so that by atomicMax the first pixel
   remains of those with the same reason. */
#define SHAPE_NOT_A_NUMBER 1u
#define SHAPE_BY_REACH     2u /* the answer differs with a larger `far` */
#define SHAPE_OUTSIDE      3u /* the shape is hit outside of its box */
#define SHAPE_REASON_SHIFT 30u
#define SHAPE_PIXEL_MASK   0x3fffffffu

#endif
