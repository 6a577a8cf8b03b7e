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

/* ---- Meshes (hard_mesh.c) ---- */

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
const char *hard_rays_name(enum hard_rays rays);

struct hard_case {
    const char *name;
    enum hard_mesh mesh;
    enum hard_rays rays;
    double offset;     /* of the middle on every axis, up, down, up */
    double scale;      /* a power of 2 */
    bool instanced;    /* mesh at the origin; an instance turns, mirrors, scales and moves it */
    bool not_promised; /* cracks that are there: misses are counted, nothing more */
};

/* The built-in ones, quick or not. */
const struct hard_case *hard_cases(uint32_t *count);

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

WHIT_CHECK whit_result hard_scene_init(const whit_log *log, const struct hard_case *hard,
                                       struct hard_scene *out);
/* A scene of the user's at one time; `scene` is borrowed. */
WHIT_CHECK whit_result hard_scene_borrow(const whit_log *log, const struct scene *scene,
                                         double time_s, bool flatten, struct hard_scene *out);
/* A frozen scene of one mesh, which is taken over; `place` NULL: where it is. */
WHIT_CHECK whit_result hard_scene_of_mesh(const whit_log *log, const char *name,
                                          struct scene_mesh *mesh, const struct affine *place,
                                          struct scene **out);

/* All triangles of a scene as one mesh, changed: as vertices, each computed in double and rounded
   to float, which makes a mesh of its own; or as an instance of the mesh as it is in the world. */
struct hard_variant {
    const char *name;
    double scale, offset; /* offset on every axis: up, down, up */
    bool turned, mirrored, instanced;
};
const struct hard_variant *hard_variants(uint32_t *count);
/* out->scene is NULL where no triangle is left with an area. */
WHIT_CHECK whit_result hard_scene_vary(const whit_log *log, const struct hard_scene *given,
                                       const struct hard_variant *variant, struct hard_scene *out);

void hard_scene_finish(struct hard_scene *hard);

/* ---- Rays (hard_rays.c) ---- */

/* A ray and the primitive that it starts on; HIT_NONE: on none. */
struct hard_ray {
    struct gpu_ray ray;
    uint32_t instance, primitive;
};

/* Ray `index` of the set `seed`. `rays` is one that suits the mesh. The scene has triangles. */
struct hard_ray hard_ray_make(const struct hard_scene *hard, enum hard_rays rays, uint64_t seed,
                              uint64_t index);

/* ---- What surfaces are like (hard_topology.c) ---- */

/* Edges and triangles of all meshes together; vertices with equal coordinates count as one. */
struct hard_topology {
    uint64_t triangles, edges;
    uint64_t open_edges;    /* of one triangle */
    uint64_t crowded_edges; /* of more than two */
    uint64_t flipped_edges; /* of two triangles that go round it the same way */
    uint64_t duplicates;    /* triangles with the corners of another one */
    uint8_t *open;          /* 1 a triangle, mesh by mesh: it touches an open or crowded edge */
    uint64_t *first;        /* of each mesh in `open` */
};
WHIT_CHECK whit_result hard_topology_init(const struct scene *scene, struct hard_topology *out);
void hard_topology_finish(struct hard_topology *topology);

/* ---- The judge (hard_judge.c) ---- */

/* Adds counts of other rays. */
void hard_add_tally(whit_tally *sum, const whit_tally *more);

struct hard_judgement {
    const struct hard_scene *hard;
    const struct hard_topology *topology;
    const struct hard_ray *rays;
    const struct rational_hit *exact;
    const struct gpu_hit *hits;
    uint32_t numerics; /* of the level that is judged: NUMERICS_* */
    uint64_t count;
};

/* rational_trace of every ray. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result hard_trace_exact(const struct hard_scene *hard, const struct hard_ray *rays,
                                        uint64_t count, uint32_t thread_count,
                                        struct rational_hit *exact);
/* The C twin's hits. */
WHIT_CHECK whit_result hard_trace_twin(const struct hard_scene *hard, uint32_t numerics,
                                       const struct hard_ray *rays, uint64_t count,
                                       uint32_t thread_count, struct gpu_hit *hits);
WHIT_CHECK whit_result hard_judge(const struct hard_judgement *judgement, uint32_t thread_count,
                                  whit_tally *tally);
/* Floats between the two. */
double hard_ulps_between(float a, float b);
/* Whether the ray goes further than its origin's coordinates are rounded by. */
bool hard_goes_far(const struct gpu_ray *ray, float t);
/* Rays whose hits differ by a bit. */
uint64_t hard_count_differing(const struct gpu_hit *a, const struct gpu_hit *b, uint64_t count);
/* Hashes the (instance, primitive) pairs of exact hits; `value` is the hash to continue from. */
uint64_t hard_hash(uint64_t value, const struct rational_hit *exact, uint64_t count);

/* Whether all promises of the level `numerics` are kept; `promised`: no leaks is one of them. */
bool hard_promise_kept(uint32_t numerics, bool promised, const whit_tally *tally);

#endif
