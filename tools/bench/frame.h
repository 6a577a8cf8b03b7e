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

#endif
