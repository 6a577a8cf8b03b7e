/* The ray tree of one pixel as the device traced it, and what the CPU says of each of its rays. */
#ifndef RENDER_PROBE_H
#define RENDER_PROBE_H

#include "abi/shade.h"
#include "render/render.h"

struct probe_ray {
    struct gpu_probe_ray traced; /* as the device has it, but for the origin of a ray that was cut:
                                    the point that it would have left */
    uint32_t parent;             /* index, below its own; HIT_NONE: the camera ray */
    uint32_t generation;         /* of the camera ray 0 */
    /* Closest hits: the first one that the material does not let pass. Shadow rays: what the device
       was blocked by, else the first that blocks. t infinity: none. Not traced: none. */
    struct gpu_hit twin;
    uint32_t passed; /* surfaces that let it through on the way there: cut-outs, one-sided ones from
                        behind; shadow rays: filters, and what casts none */
    bool equal;      /* to the device's answer: ids, and every bit of t, u and v */
    /* What exact arithmetic says (oracle/rational.h). Unknown: not traced, or too many surfaces let
       the ray pass. */
    bool exact_known;
    float exact_t; /* a key; infinity: none */
    uint32_t exact_instance, exact_primitive;
    bool exact_equal; /* ids (shadow rays: blocked or not); at NUMERICS_EXACT t as well */
};

/* One value that a dbg(x) of the user's file had when it was reached. */
struct probe_value {
    struct gpu_dbg traced;
    uint32_t call; /* index in shader_dbg.sites */
    uint32_t ray;  /* index in rays, of the ray that the function was called for */
};

struct probe_report {
    uint32_t x, y;
    uint32_t samples;       /* that `color` is of; of an adaptive picture the 4 of its first pass */
    uint32_t light_samples; /* of each light: see gpu_probe_ray.light_sample */
    float color[4];         /* of the pixel, as in the picture */
    /* The rays of the first sample, as they were traced: a ray is followed by its shadow rays,
       then by what the surface reflects and lets through, each with all that comes of it. */
    struct probe_ray *rays;
    uint32_t ray_count;
    uint32_t dropped;   /* rays that had no room; what is recorded of their tree is its front */
    uint32_t differing; /* rays with equal == false */
    /* dbg(x) recorded this in the first sample, and in post(), which gets the mean of all samples:
       how often each dbg(x) was reached, and the first DBG_VALUES values of each but for rays that
       were dropped, in the order of calls, then of rays. */
    uint32_t call_counts[DBG_CALLS];
    struct probe_value *values;
    uint32_t value_count;
};

/* Traces pixel (x, y) from the upper left once more, and nothing else of the picture; what was
   rendered stays. The first call compiles a kernel. `max`: rays that are recorded; 0: as many as
   there is room for. WHIT_ERROR_USAGE outside of the picture; WHIT_ERROR_STATUS as renderer_render.
   On failure *out is empty. */
WHIT_CHECK whit_result renderer_probe(struct renderer *renderer, uint32_t x, uint32_t y,
                                      uint32_t max, struct probe_report *out);
void probe_report_finish(struct probe_report *report);

/* probe_twin.c: fills in `twin` and all below it, of every ray. */
WHIT_CHECK whit_result probe_ask_twin(const struct renderer *renderer, struct probe_report *report);

#endif
