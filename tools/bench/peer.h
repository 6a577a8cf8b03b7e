/* whit-embree (embree.c), a separate program that is asked one line at a time. */
#ifndef BENCH_PEER_H
#define BENCH_PEER_H

#include "bench/process.h"

struct peer {
    int socket;
    FILE *answers;
    struct process process;
    char program[BENCH_PATH], version[32];
};

/* Why whit-embree is left out: it is not beside this program, or it cannot trace the scene (which
   may be NULL). NULL: it can be used. */
const char *peer_why_not(const whit_scene_info *scene);
/* Writes the scene's triangles, with whit's ids, into the file `triangles` of the bench's folder,
   and starts whit-embree on them. Call peer_end in any case, also for a zeroed struct. */
WHIT_CHECK whit_result peer_begin(struct peer *peer, const struct bench *bench,
                                  const whit_scene *scene, const char *triangles);
void peer_end(struct peer *peer);
/* Send `rays NAME closest` (or any) and `hits NAME`; names are files in the folder. */
WHIT_CHECK whit_result peer_rays(struct peer *peer, const char *name, bool any);
WHIT_CHECK whit_result peer_hits(struct peer *peer, const char *name);
/* ms[0]: processor time of all its threads, ms[1]: wall clock; < 0: this build of Embree lacks the
   way. `coherent`: tells Embree that neighbouring rays are coherent. */
WHIT_CHECK whit_result peer_trace(struct peer *peer, const char *way, bool back, bool coherent,
                                  double ms[2]);
/* Builds a tree over all triangles: *ms is wall clock, *bytes the peak memory. */
WHIT_CHECK whit_result peer_build(struct peer *peer, const char *quality, uint32_t threads,
                                  double *ms, double *bytes);

#endif
