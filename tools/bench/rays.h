/* Rays of one kind in one order, through whit and Embree in turns. */
#ifndef BENCH_RAYS_H
#define BENCH_RAYS_H

#include "app/bvh/study.h"
#include "bench/peer.h"
#include "bench/table.h"

enum rays_side { RAYS_WHIT, RAYS_SINGLE, RAYS_PACKETS, RAYS_STREAM, RAYS_BACK, RAYS_SIDES = 7 };
enum rays_kind { RAYS_CAMERA, RAYS_SHADOW, RAYS_BOUNCE, RAYS_KINDS };

/* One set of rays in one order, and what it took each side in ms. */
struct batch {
    struct sample_runs sides[RAYS_SIDES];
    bool any, coherent; /* any: any hit will do; coherent: neighbours go the same way */
};

/* Hits of both sides beside each other. Of two triangles that a ray meets at once, at an edge, each
   side may name another one. */
struct agreement {
    uint64_t rays, one_alone, other_ids, other_t;
};

struct model {
    struct bench *bench;
    struct table *table;
    char name[40]; /* letters and digits of the file's, which is a name in the folder */
    struct bench_scene loaded;
    whit_accel *accel;
    whit_renderer *renderer;
    struct peer peer;
    bool has_peer;
    struct study_rays camera;
    whit_hit *hits; /* of camera rays: there the others begin */
    /* The batch that is being traced; arrays have room for as many rays as the camera has: */
    struct batch *batch;
    whit_ray *rays;
    whit_hit *traced;
    uint64_t count;
};

extern const char *const rays_kind_names[RAYS_KINDS];

#endif
