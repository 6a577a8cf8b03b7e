/* The side of a peer of `whit bench`, which is a program of its own: PROGRAM TRIANGLES [DEVICE].
   TRIANGLES, rays and hits are records of `whit scene --triangles` and `whit trace`. It answers
   each line of standard input by one line:

       rays FILE closest|any     `rays COUNT`: loads the rays that the next lines trace
       trace WAY forth|back coherent|scattered
                                 `time CPU_MS MS`: processor time of all threads; the wall clock's,
                                 or for a GPU its own time. `none`: the peer cannot trace in this
                                 way. back: from the end of each ray, which must have one, to its
                                 origin. coherent: neighbouring rays are coherent
       build QUALITY THREADS     `built WALL_MS BYTES`: builds a tree of medium or high quality;
                                 BYTES: peak memory by the peer's own monitor
       hits FILE                 `hits COUNT`: writes the hits of the last trace. Only t, primitive
                                 and instance have a meaning; for any-hit rays only whether there is
                                 a hit

   Its first line is `ready VERSION`, or `none WHY` where this machine lacks what it needs. Errors
   are printed on standard error, and end it with exit code 2. */
#ifndef BENCH_PEER_SIDE_H
#define BENCH_PEER_SIDE_H

#include "whit/whit.h"

struct peer_side {
    const char *name; /* of the program, before its errors */
    whit_triangle *triangles;
    uint64_t triangle_count;
    whit_ray *rays; /* as in the file */
    whit_hit *hits;
    uint64_t count;
    bool any;
    void *user;               /* given to these: */
    void (*load)(void *user); /* called when there are other rays */
    bool (*trace)(void *user, const char *way, bool back, bool coherent, double ms[2]);
    void (*build)(void *user, const char *quality, int threads, double *ms, double *bytes);
};

/* Prints an error, and ends the program. */
_Noreturn void peer_fail(const struct peer_side *side, const char *format, ...) WHIT_PRINTF(2, 3);
/* Memory that starts as zeros; at least one record. Ends the program where there is none. */
void *peer_alloc(const struct peer_side *side, uint64_t count, size_t record);
/* Sets triangles and triangle_count; an error for a file without whole records, or without any. */
void peer_read_triangles(struct peer_side *side, const char *path);
/* Keeps hit i of the last trace: a triangle, or WHIT_NONE for a miss. */
void peer_keep_hit(const struct peer_side *side, uint64_t i, float t, uint32_t triangle);
/* Milliseconds of the wall clock, and of the processor on all threads of the program. */
double peer_wall_ms(void);
double peer_cpu_ms(void);
/* Prints the first line, and answers until the end of standard input. */
void peer_serve(struct peer_side *side, const char *version);

#endif
