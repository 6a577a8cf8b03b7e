/* Batches of rays of one kind in one order, traced by whit and its peers in turns. */
#ifndef BENCH_RAYS_H
#define BENCH_RAYS_H

#include "app/bvh/study.h"
#include "bench/peer.h"
#include "bench/table.h"

/* RAYS_BACK and the next two: as from RAYS_SINGLE on, from the ends of rays back. */
enum rays_side {
    RAYS_WHIT,
    RAYS_SINGLE,
    RAYS_PACKETS,
    RAYS_STREAM,
    RAYS_PIPELINE,
    RAYS_BACK,
    RAYS_SIDES = RAYS_BACK + 3
};
enum rays_kind { RAYS_CAMERA, RAYS_SHADOW, RAYS_BOUNCE, RAYS_KINDS };

/* One set of rays in one order, and the times of each side in ms. */
struct batch {
    struct sample_runs sides[RAYS_SIDES];
    bool any, coherent; /* any: any-hit rays; coherent: neighbouring rays are coherent */
};

/* Differences between the hits of whit and a peer, as numbers of rays. Where a ray meets two
   triangles at an edge, the sides may name different ones. */
struct agreement {
    uint64_t rays, one_alone, other_ids, other_t;
};

/* What the rays of a batch visit in packets, and each alone. In packets nodes have up to eight
   children, and a packet or a ray that is in none is a record. */
struct visits {
    whit_cost together, alone;
};

struct model {
    struct bench *bench;
    struct table *table;
    char name[40]; /* made from the file's name, with only characters that file names allow */
    struct bench_scene loaded;
    whit_renderer *renderer;
    struct peer peers[PEER_KINDS];
    bool has_peer[PEER_KINDS];
    struct study_rays camera;
    whit_hit *hits; /* hits of camera rays, where shadow and bounce rays start */
    /* The batch that is being traced; arrays have room for the number of camera rays: */
    struct batch *batch;
    whit_ray *rays;
    whit_hit *traced;
    uint64_t count;
};

extern const char *const rays_kind_names[RAYS_KINDS];

#endif
