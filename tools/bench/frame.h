/* One picture, drawn in turns by all who can. */
#ifndef BENCH_FRAME_H
#define BENCH_FRAME_H

#include "figures.h"
#include "peer.h"

/* What is here to compare with, and where pictures are made. */
struct peers {
    struct figures *figures;
    char folder[BENCH_SCRATCH];
    char pov_scenes[BENCH_PATH]; /* scenes.sh; "": not here */
    char against[BENCH_PATH];    /* --against from the root on, or a name that PATH has */
    bool wants_pov, has_pov, has_embree;
};

/* The whit that --against names, or says that there is none. WHIT_ERROR_INPUT: it is no whit. */
WHIT_CHECK whit_result peers_find_against(struct peers *peers);
/* Looks who is here, and says who is left out. WHIT_ERROR_INPUT: --against is no whit. */
WHIT_CHECK whit_result frame_find_peers(struct peers *peers);

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
    const char *folder;              /* for its files */
    char name[40], path[BENCH_PATH]; /* absolute */
    const char *bailout;
    uint32_t depth, width, height;
    uint32_t small_width, small_height; /* a picture whose time is taken off; 0: none */
    bool is_cpu;                        /* the device: else times are by the clock */
    struct bench_scene loaded;
    whit_accel *accel;
    whit_reference *reference;
    struct peer peer;
    enum frame_side sides[FRAME_SIDES]; /* who draws */
    uint32_t side_count;
    struct sample_runs
        ms[FRAME_SIDES]; /* by side: processor time of all threads, or by the clock */
};

/* The scene, its trees and the reference. */
WHIT_CHECK whit_result frame_prepare(struct frame *frame);
/* The rays of the picture as files, and whit-embree on its triangles: for FRAME_EMBREE. */
WHIT_CHECK whit_result frame_prepare_rays(struct frame *frame);
/* All sides, once before the clock counts and then as often as the bench has runs. */
WHIT_CHECK whit_result frame_run(struct frame *frame);
/* Device memory of the picture beyond what the scene and the pixels take, in MB. */
WHIT_CHECK whit_result frame_memory(const struct frame *frame, double *megabytes);
void frame_finish(struct frame *frame);

#endif
