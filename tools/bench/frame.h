/* One picture, drawn in turns by all programs and modes that can. */
#ifndef BENCH_FRAME_H
#define BENCH_FRAME_H

#include "bench/peer.h"
#include "bench/table.h"

/* The programs on this machine to compare with. */
struct peers {
    char pov_scenes[BENCH_PATH]; /* path of scenes.sh */
    char against[BENCH_PATH];    /* program of --against: an absolute path, or a name found by PATH;
                                    or "" */
    bool has_pov, has_embree;
    bool against_chooses; /* that whit has --packets and --classes; versions before the stages lack
                             them */
};

enum frame_side {
    FRAME_WHIT, /* whit at `watertight` */
    FRAME_FAST,
    FRAME_EXACT,
    FRAME_AGAINST,
    FRAME_POV,
    FRAME_REFERENCE, /* whit's reference in double */
    FRAME_EMBREE,    /* Embree tracing only the rays of the picture */
    FRAME_SIDES,
};

struct frame {
    struct bench *bench;
    const struct peers *peers;
    char name[40], path[BENCH_PATH]; /* absolute */
    const char *bailout;
    uint32_t depth, width, height;
    uint32_t small_width, small_height; /* size of a small picture whose time is subtracted; 0:
                                           none */
    bool packets[FRAME_SIDES];          /* whether whit chooses packets for the picture */
    struct bench_scene loaded;
    whit_reference *reference;
    struct peer peer;
    enum frame_side sides[FRAME_SIDES]; /* the sides that draw */
    uint32_t side_count;
    struct sample_runs ms[FRAME_SIDES]; /* by side: processor time, or wall clock */
};

#endif
