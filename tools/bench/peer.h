/* whit-embree (embree.c), a program beside whit: asked in turns, one line at a time. */
#ifndef BENCH_PEER_H
#define BENCH_PEER_H

#include "app/bench/bench.h"

struct peer {
    int socket;
    FILE *answers;
    long pid; /* 0: not running */
    char version[32];
};

/* Whether there is one beside this program. */
bool peer_is_here(void);
/* The triangles of a scene, as it works on them, and as it names them: a file in `folder`. */
WHIT_CHECK whit_result peer_write_triangles(const whit_scene *scene, const char *folder,
                                            const char *name);
WHIT_CHECK whit_result peer_write_rays(const char *folder, const char *name, const whit_ray *rays,
                                       uint64_t count);
/* Starts it in `folder`, on triangles there. End it in any case. */
WHIT_CHECK whit_result peer_begin(struct peer *peer, const char *folder, const char *triangles);
void peer_end(struct peer *peer);
/* `rays NAME closest` (or any), and `hits NAME`: names in the folder. */
WHIT_CHECK whit_result peer_rays(struct peer *peer, const char *name, bool any);
WHIT_CHECK whit_result peer_hits(struct peer *peer, const char *name);
/* ms[0]: what all its threads took of the processor, ms[1]: by the clock; < 0: Embree lacks this
   way. `coherent`: Embree is told that neighbours go the same way. */
WHIT_CHECK whit_result peer_trace(struct peer *peer, const char *way, bool back, bool coherent,
                                  double ms[2]);

#endif
