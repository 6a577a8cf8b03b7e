/* whit-embree (embree.c), a program beside whit: asked in turns, one line at a time. */
#ifndef BENCH_PEER_H
#define BENCH_PEER_H

#include "bench/process.h"

struct peer {
    int socket;
    FILE *answers;
    struct process process;
    char program[BENCH_PATH], version[32];
};

/* Why it is left out: it is not beside this program, or the scene (may be NULL) is none for it.
   NULL: it is here. */
const char *peer_why_not(const whit_scene_info *scene);
/* Writes the triangles of a scene, as it works on them, and as whit names them, into a file of the
   bench's folder, and starts it on these. End it in any case, also a zeroed one. */
WHIT_CHECK whit_result peer_begin(struct peer *peer, const struct bench *bench,
                                  const whit_scene *scene, const char *triangles);
void peer_end(struct peer *peer);
/* `rays NAME closest` (or any), and `hits NAME`: names in the folder. */
WHIT_CHECK whit_result peer_rays(struct peer *peer, const char *name, bool any);
WHIT_CHECK whit_result peer_hits(struct peer *peer, const char *name);
/* ms[0]: what all its threads took of the processor, ms[1]: by the clock; < 0: Embree lacks this
   way. `coherent`: Embree is told that neighbours go the same way. */
WHIT_CHECK whit_result peer_trace(struct peer *peer, const char *way, bool back, bool coherent,
                                  double ms[2]);
/* Builds a tree of all triangles: wall time, and the most memory that it held. */
WHIT_CHECK whit_result peer_build(struct peer *peer, const char *quality, uint32_t threads,
                                  double *ms, double *bytes);

#endif
