/* One picture, drawn in turns by all who can. */
#ifndef BENCH_FRAME_H
#define BENCH_FRAME_H

#include "bench/peer.h"
#include "bench/table.h"

/* What is here to compare with. */
struct peers {
    char pov_scenes[BENCH_PATH]; /* scenes.sh */
    char against[BENCH_PATH];    /* --against from the root on, or a name that PATH has; or "" */
    bool has_pov, has_embree;
};

/* The whit that --against names, or says that there is none. WHIT_ERROR_INPUT: it is no whit. */
WHIT_CHECK whit_result peers_find_against(struct peers *peers, struct table *table);
/* Looks who else is here, and says who is left out. */
void peers_find(struct peers *peers, struct table *table, bool wants_pov);

enum frame_side {
    FRAME_WHIT, /* at `watertight` */
    FRAME_FAST,
    FRAME_EXACT,
    FRAME_AGAINST,
    FRAME_POV,
    FRAME_REFERENCE, /* whit's own, in double */
    FRAME_EMBREE,    /* the rays of the picture alone */
    FRAME_SIDES,
};

struct frame {
    struct bench *bench;
    const struct peers *peers;
    char name[40], path[BENCH_PATH]; /* absolute */
    const char *bailout;
    uint32_t depth, width, height;
    uint32_t small_width, small_height; /* a picture whose time is taken off; 0: none */
    struct bench_scene loaded;
    whit_accel *accel;
    whit_reference *reference;
    struct peer peer;
    enum frame_side sides[FRAME_SIDES]; /* who draws */
    uint32_t side_count;
    struct sample_runs ms[FRAME_SIDES]; /* by side: of the processor, or by the clock */
};

/* The scene, its trees and the reference. */
WHIT_CHECK whit_result frame_prepare(struct frame *frame);
/* The rays of the picture as files, and whit-embree on its triangles: for FRAME_EMBREE
   (frame_rays.c). */
WHIT_CHECK whit_result frame_prepare_rays(struct frame *frame);
/* Single rays; shadow rays from the end where Embree is quicker. */
WHIT_CHECK whit_result frame_trace_rays(struct frame *frame, double *ms);
/* All sides, once before the clock counts and then as often as the bench has runs. */
WHIT_CHECK whit_result frame_run(struct frame *frame);
/* Device memory of the picture beyond what the scene and the pixels take, in MB. */
WHIT_CHECK whit_result frame_memory(const struct frame *frame, double *megabytes);
void frame_finish(struct frame *frame);

#endif
