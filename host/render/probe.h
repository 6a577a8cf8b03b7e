/* The ray tree of one pixel as the device traced it, and what the CPU finds for each of its
   rays. */
#ifndef RENDER_PROBE_H
#define RENDER_PROBE_H

#include "abi/shade.h"
#include "render/render.h"

struct probe_ray {
    /* The device's record. A ray that was cut has no origin there: here it is the point that the
       ray would have left. */
    struct gpu_probe_ray traced;
    uint32_t parent;     /* index of the parent, below the ray's own; HIT_NONE: camera ray */
    uint32_t generation; /* 0: the camera ray */
    /* The hit of the float mirror (twin/). Closest hits: the first hit that the material does not
       let pass. Shadow rays: the device's blocker where the twin finds it too, else the first hit
       that blocks. t infinity: nothing was hit, or the ray was not traced. */
    struct gpu_hit twin;
    /* Surfaces before that hit which let the ray pass: cut-outs, one-sided surfaces from behind;
       for shadow rays also filters, and surfaces that cast no shadow. */
    uint32_t passed;
    bool equal; /* whether `twin` is the device's answer: ids, every bit of t, u, v */
    /* The hit of exact arithmetic (oracle/rational.h). Not known: the ray was not traced, or too
       many surfaces let it pass. */
    bool exact_known;
    float exact_t; /* the key, as in oracle/rational.h; infinity: no hit */
    uint32_t exact_instance, exact_primitive;
    bool exact_equal; /* the device has the same ids (shadow rays: the same answer); EXACT: t too */
};

/* A value of a dbg(x) of the user's file, recorded when that call was reached. */
struct probe_value {
    struct gpu_dbg traced;
    uint32_t call; /* index in shader_dbg.sites */
    uint32_t ray;  /* index in `rays`: the ray that the function was called for */
};

struct probe_report {
    uint32_t x, y;
    uint32_t samples;       /* samples in `color`; adaptive: those of the first pass */
    uint32_t light_samples; /* samples of each light, see gpu_probe_ray.light_sample */
    float color[4];         /* colour of the pixel, as in the picture */
    /* The ray tree of the first sample, depth first: a ray is followed by its shadow rays, then by
       what the surface reflects and lets through, each with its own subtree. */
    struct probe_ray *rays;
    uint32_t ray_count;
    uint32_t dropped;   /* rays without room; `rays` has the front, breadth first */
    uint32_t differing; /* rays with equal == false */
    /* Records of dbg(x) in the first sample, and in post(), which gets the mean of all samples: how
       often each call was reached, and its first DBG_VALUES values, without those of dropped rays;
       sorted by call, then by ray. */
    uint32_t call_counts[DBG_CALLS];
    struct probe_value *values;
    uint32_t value_count;
};

/* Traces pixel (x, y), counted from the upper left, once more; the rendered picture stays. The
   first call compiles kernels. `max`: rays to record; 0: as many as there is room for.
   WHIT_ERROR_USAGE outside of the picture; WHIT_ERROR_STATUS as renderer_render. On failure *out is
   empty. */
WHIT_CHECK whit_result renderer_probe(struct renderer *renderer, uint32_t x, uint32_t y,
                                      uint32_t max, struct probe_report *out);
void probe_report_finish(struct probe_report *report);

/* probe_twin.c: fills in `twin` and all fields after it, of every ray. */
WHIT_CHECK whit_result probe_ask_twin(const struct renderer *renderer, struct probe_report *report);

#endif
