/* Hard cases: meshes and rays at which ray tracers fail, and a judge of the hits. For `whit hard`
   and the tests.

   Meshes and rays are made only with + - * / and square roots of doubles, each rounded once, and
   ray i of a case depends only on the case, a seed and i. So every machine makes the same meshes
   and rays, bit for bit. */
#ifndef HARD_HARD_H
#define HARD_HARD_H

#include "base/affine.h"
#include "hard/topology.h"
#include "oracle/rational.h"
#include "whit/whit_hard.h"

enum hard_mesh {
    HARD_SPHERE,     /* subdivided octahedron with vertices moved to the unit sphere: in-plane
                        edges */
    HARD_SPIKES,     /* as HARD_SPHERE, vertices at distances 1 to 3 from the middle */
    HARD_SLIVERS,    /* the sphere scaled by 1, 2^-10, 2^10 along the axes */
    HARD_UNWELDED,   /* the sphere, where triangles share no vertices */
    HARD_GRID,       /* height field with integer coordinates */
    HARD_CUBE,       /* axis-parallel, integer vertices: many flat boxes in the tree */
    HARD_OCTAHEDRON, /* |x| + |y| + |z| = 16, integer vertices: exactly convex */
    HARD_NEEDLES,    /* open: edges of 1 and of 2^-20 to 2^-40 */
    HARD_SIZES,      /* open: triangles 2^-60 to 2^58 in size */
    HARD_DUPLICATES, /* open: a square whose triangles are each there 25 times */
    HARD_JUNCTION,   /* open: a vertex close to an edge but not on it, a real crack */
    HARD_ANCHORS,    /* open: triangles from bug reports of other ray tracers */
    HARD_MESHES
};

/* The answer that every ray of a set must give. */
enum hard_truth {
    HARD_MUST_HIT,  /* it starts inside a closed surface */
    HARD_MUST_MISS, /* it leaves a convex surface that it starts on */
    HARD_ORACLE,    /* hit or miss as exact arithmetic says */
};

enum hard_rays {
    HARD_AROUND,  /* from in and around the bounds, at vertices, at points of edges and at points
                     inside triangles */
    HARD_AXIAL,   /* along an axis through vertices and points of edges; zero components have either
                     sign */
    HARD_FLAT,    /* in a triangle's plane, along its edges and across */
    HARD_GRAZING, /* at a height of 2^-4 to 2^-24 above a triangle's plane */
    HARD_FAR,     /* from 2^6 to 2^12 times the scene's size away */
    HARD_LEAVING, /* away from the surface, from a point moved by its error bound, as secondary
                     rays */
    HARD_MIXED_KINDS,
    HARD_MIXED = HARD_MIXED_KINDS, /* those above in turn */
    HARD_AIMED,   /* from around the middle at vertices and points of edges; for a fourth of them
                     the origin has the target's coordinate on one axis or two */
    HARD_LATTICE, /* HARD_GRID: up and down through vertices, edges and diagonals */
    HARD_CROSS,   /* HARD_CUBE: along axes and planes from points of its lattice */
    HARD_LISTED,  /* HARD_ANCHORS: the rays of the bug reports */
    HARD_RAY_KINDS
};

struct hard_case {
    const char *name;
    enum hard_mesh mesh;
    enum hard_rays rays;
    double offset;     /* of the mesh's middle: +offset on x and z, -offset on y */
    double scale;      /* a power of 2 */
    bool instanced;    /* the mesh is at the origin, and an instance rotates, mirrors, scales and
                          moves it */
    bool not_promised; /* the mesh has real cracks: misses are only counted, and leaks break no
                          promise */
};

/* A scene to trace hard rays in. */
struct hard_scene {
    const struct scene *scene;
    struct scene *owned; /* equal to `scene` where this struct owns it; NULL: `scene` is borrowed */
    struct scene_pose pose;
    struct hard_topology topology;
    struct accel *accel;
    bool flatten;               /* `accel` is a single tree over triangles transformed to world
                                   space and rounded */
    double middle[3], reach[3]; /* HARD_AIMED rays start within `reach` of `middle` on each axis */
    enum hard_rays rays;
    enum hard_truth truth;
};

#endif
