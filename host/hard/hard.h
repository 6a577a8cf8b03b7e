/* Hard cases: meshes and rays at which ray tracers fail, and a judge of the hits. For `whit hard`
   and the tests.

   All of it is made with + - * / and square roots of doubles alone, each rounded once, and ray i
   of a case depends on nothing but the case, a seed and i: every machine makes the same meshes and
   rays, bit for bit. */
#ifndef HARD_HARD_H
#define HARD_HARD_H

#include "base/affine.h"
#include "oracle/rational.h"
#include "whit/whit_hard.h"

enum hard_mesh {
    HARD_SPHERE,     /* octahedron, divided, vertices put on the unit sphere: in-plane edges */
    HARD_SPIKES,     /* the same with vertices 1 to 3 from the middle */
    HARD_SLIVERS,    /* the sphere times 1, 2^-10, 2^10 */
    HARD_UNWELDED,   /* the sphere, every triangle with vertices of its own */
    HARD_GRID,       /* landscape of whole numbers */
    HARD_CUBE,       /* axis-parallel, vertices at whole numbers: flat boxes all over the tree */
    HARD_OCTAHEDRON, /* |x| + |y| + |z| = 16, vertices at whole numbers: convex exactly */
    HARD_NEEDLES,    /* open: edges of 1 and of 2^-20 to 2^-40 */
    HARD_SIZES,      /* open: triangles 2^-60 to 2^58 in size */
    HARD_DUPLICATES, /* open: every triangle of a square 25 times */
    HARD_JUNCTION,   /* open: a vertex beside the middle of an edge, a real crack */
    HARD_ANCHORS,    /* open: triangles of other tracers' bug reports */
    HARD_MESHES
};

/* What is true of every ray of a set, whatever it hits. */
enum hard_truth {
    HARD_MUST_HIT,  /* it starts inside a closed surface */
    HARD_MUST_MISS, /* it leaves a convex surface that it starts on */
    HARD_ORACLE,    /* what exact arithmetic says */
};

enum hard_rays {
    HARD_AIMED,   /* from around the middle at vertices and points of edges; a fourth of them level
                     with the target on one axis or two */
    HARD_AROUND,  /* the same from in and around the bounds, and at points inside triangles */
    HARD_AXIAL,   /* along an axis through vertices and points of edges, zeros of both signs */
    HARD_LATTICE, /* HARD_GRID: up and down through vertices, edges and diagonals */
    HARD_CROSS,   /* HARD_CUBE: along axes and planes from points of its lattice */
    HARD_FLAT,    /* in a triangle's plane, along its edges and across */
    HARD_GRAZING, /* 2^-4 to 2^-24 above a triangle's plane */
    HARD_FAR,     /* from 2^6 to 2^12 sizes away */
    HARD_LEAVING, /* off the surface: from a point moved by its error bound, as secondary rays */
    HARD_LISTED,  /* HARD_ANCHORS */
    HARD_MIXED,   /* around, axial, flat, grazing, far, leaving by turns */
    HARD_RAY_KINDS
};

struct hard_case {
    const char *name;
    enum hard_mesh mesh;
    enum hard_rays rays;
    double offset;     /* of the middle on every axis, up, down, up */
    double scale;      /* a power of 2 */
    bool instanced;    /* mesh at the origin; an instance turns, mirrors, scales and moves it */
    bool not_promised; /* cracks that are there: misses are counted, nothing more */
};

/* A scene to shoot at. */
struct hard_scene {
    const struct scene *scene;
    struct scene *owned; /* the same, or NULL: borrowed */
    struct scene_pose pose;
    struct accel *accel;
    bool flatten;               /* `accel` is one tree, of placed and rounded triangles */
    double middle[3], reach[3]; /* HARD_AIMED rays start within */
    double lo[3], hi[3];        /* bounds */
    enum hard_rays rays;
    enum hard_truth truth;
};

#endif
