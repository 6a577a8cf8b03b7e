/* Peers that trace rays: separate programs, asked one line at a time (peer_side.h). */
#ifndef BENCH_PEER_H
#define BENCH_PEER_H

#include "bench/process.h"

enum peer_kind {
    PEER_EMBREE,   /* embree.c */
    PEER_PIPELINE, /* the driver's own ray-tracing pipeline: ray_pipeline.c */
    PEER_KINDS
};
extern const char *const peer_names[PEER_KINDS];

struct peer {
    enum peer_kind kind;
    int socket;
    FILE *answers;
    struct process process;
    char program[BENCH_PATH], device[12]; /* device: its number */
    char version[256], why_not[256];
};

/* Why a peer is left out: its program is not beside this one, or it cannot trace the scene (which
   may be NULL). NULL: it can be used. */
const char *peer_why_not(enum peer_kind kind, const whit_scene_info *scene);
/* Writes the scene's triangles, with whit's ids, into the file `triangles` of the bench's folder,
   and starts the peer on them. Where this machine lacks what it needs, `why_not` is not empty, and
   it answers nothing. Call peer_end in any case, also for a zeroed struct. */
WHIT_CHECK whit_result peer_begin(struct peer *peer, enum peer_kind kind, const struct bench *bench,
                                  const whit_scene *scene, const char *triangles);
void peer_end(struct peer *peer);
/* Send `rays NAME closest` (or any) and `hits NAME`; names are files in the folder. */
WHIT_CHECK whit_result peer_rays(struct peer *peer, const char *name, bool any);
WHIT_CHECK whit_result peer_hits(struct peer *peer, const char *name);
/* ms[0]: processor time of all its threads, ms[1]: wall clock, or time of the device; < 0: the peer
   lacks the way. `coherent`: tells it that neighbouring rays are coherent. */
WHIT_CHECK whit_result peer_trace(struct peer *peer, const char *way, bool back, bool coherent,
                                  double ms[2]);
/* Builds a tree over all triangles: *ms is wall clock, *bytes the peak memory. */
WHIT_CHECK whit_result peer_build(struct peer *peer, const char *quality, uint32_t threads,
                                  double *ms, double *bytes);

#endif
