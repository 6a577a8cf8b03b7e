/* Part of whit.h: why a pixel looks as it does. */
#ifndef WHIT_PROBE_H
#define WHIT_PROBE_H

#include "whit_renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Why a ray ended. */
typedef enum whit_probe_end {
    WHIT_PROBE_MISSED = 0, /* it meets nothing, and sees the environment */
    WHIT_PROBE_OPAQUE,     /* it meets a surface that calls for no further ray */
    WHIT_PROBE_DIVIDED,    /* it meets a surface that reflects it or lets it through */
    WHIT_PROBE_ABSORBED,   /* too little is left of it behind what it went through */
    WHIT_PROBE_DEPTH,      /* not traced: its bounces were used up */
    WHIT_PROBE_BAILOUT,    /* not traced: it could add less than params.bailout */
    WHIT_PROBE_REACHED,    /* shadow rays: all of the light passes */
    WHIT_PROBE_FILTERED,   /* shadow rays: some of it does */
    WHIT_PROBE_BLOCKED,    /* shadow rays */
    WHIT_PROBE_ENDS,
} whit_probe_end;
/* "missed", "hit, opaque", "hit, goes on", ... */
const char *whit_probe_end_name(whit_probe_end end);

typedef struct whit_probe_hit {
    double t;                     /* infinity: none */
    uint32_t instance, primitive; /* WHIT_NONE: none */
} whit_probe_hit;

typedef struct whit_probe_ray {
    whit_ray_kind kind;
    bool straight; /* it is what passes a blended surface, a shadow catcher, or a surface that has
                      the same medium on both sides */
    whit_probe_end end;
    uint32_t parent;     /* index of the ray that it comes from, below its own; WHIT_NONE: none */
    uint32_t generation; /* 0: the camera ray */
    whit_ray ray;        /* one that was not traced starts where its parent ended */
    float weight[3];     /* of what it brings to the pixel; shadow rays: of their surface */
    float added[3]; /* radiance that it added, without its branches, by weight; shadow rays: the
                       share of the light that passes */
    /* What the device met, its twin on the CPU, and exact arithmetic. */
    whit_probe_hit device, twin, exact;
    bool equal; /* twin: ids and every bit of t, and of u and v. Whether a cut-out is solid is the
                   device's word; shadow rays: any blocker that the device may have met */
    bool exact_known; /* false: not traced, or too many surfaces let it pass */
    bool exact_equal; /* ids (shadow rays: blocked or not), at WHIT_NUMERICS_EXACT t as well */
    uint32_t passed;  /* cut-outs, and one-sided surfaces from behind, that it went through; shadow
                         rays: also filters, and what casts no shadow */
    /* The material of the surface that it met; WHIT_NONE: it met nothing. */
    uint32_t material;
    float point[3], normal[3];    /* unit, interpolated, to the ray's side; without bump maps */
    bool inside;                  /* met from inside */
    uint32_t medium;              /* material of what it went through; WHIT_NONE: air */
    float ior;                    /* of that */
    uint32_t light, light_sample; /* shadow rays; else WHIT_NONE */
} whit_probe_ray;

typedef enum whit_value_kind {
    WHIT_VALUE_FLOAT = 0,
    WHIT_VALUE_INT,
    WHIT_VALUE_UINT,
    WHIT_VALUE_BOOL,
} whit_value_kind;

/* One value that a dbg(x) of the user's file had when it was reached. */
typedef struct whit_probe_value {
    whit_value_kind kind;
    uint32_t size;       /* 1: a number; 2 to 4: a vector */
    double v[4];         /* of each component, exact; of a bool 0 or 1 */
    uint32_t ray;        /* index of the ray that the function was called for, of post() the camera
                            ray */
    uint32_t generation; /* of that */
} whit_probe_value;
/* "0.5", "(1, 2, 3)", "true": floats with `digits` digits, 9 of which tell all. At most `bytes` of
   `text`, which end with a 0. */
void whit_probe_value_text(const whit_probe_value *value, int digits, char *text, size_t bytes);

#define WHIT_PROBE_VALUES 8
/* A dbg(x) of the shader. */
typedef struct whit_probe_call {
    const char *text; /* x as the file has it, cut where it is long */
    const char *file; /* as whit opened it */
    uint32_t line;
    uint32_t count;                             /* how often it was reached */
    whit_probe_value values[WHIT_PROBE_VALUES]; /* the first ones, in the order of rays, but for
                                                   those of rays that were dropped */
    uint32_t value_count;
} whit_probe_call;

typedef struct whit_probe_report {
    uint32_t x, y;
    uint32_t samples; /* that `color` is of; of an adaptive picture the 4 of its first pass */
    float color[4];   /* as in the picture: the same bytes */
    uint8_t shown[4]; /* as displayed: sRGB */
    /* The tree of the first sample: a ray is followed by its shadow rays, then by its branches,
       each with its own, in the order in which they were traced. The first one is the camera ray.
     */
    whit_probe_ray *rays;
    uint32_t ray_count;
    uint32_t dropped;   /* rays that there was no room for */
    uint32_t differing; /* rays of which the twin says something else */
    /* Each dbg(x) of the shader, in the order of files and lines: of the first sample, and of
       post() that of all samples. */
    whit_probe_call *calls;
    uint32_t call_count;
} whit_probe_report;

/* Traces pixel (x, y), from the upper left, once more, and nothing else; the picture that was
   rendered stays. The first call compiles a kernel. `max_rays`: that are recorded; 0: 16383, which
   is the limit. With a shader the tree is that of whit's rays: those that its functions trace
   themselves are not in it. WHIT_ERROR_USAGE outside of the picture or without a device;
   WHIT_ERROR_DEVICE; WHIT_ERROR_STATUS, WHIT_ERROR_TIME_LIMIT and WHIT_ERROR_CANCELLED as
   whit_renderer_render. */
WHIT_CHECK whit_result whit_probe(whit_renderer *renderer, uint32_t x, uint32_t y,
                                  uint32_t max_rays, whit_probe_report **out);
void whit_probe_report_destroy(whit_probe_report *report);

/* A ray of a report, or several shadow rays from where it ended to one light that ended alike: the
   same end, at the same instance. */
typedef struct whit_probe_row {
    uint32_t ray; /* the first one */
    uint32_t count;
    float added[3]; /* as of a ray; the mean of several */
} whit_probe_row;
/* The rows of a report, which hold each ray once: a ray is followed by its shadow rays, those that
   reach their light first, then by its branches, what brought most first. *rows is the caller's,
   for whit_memory_destroy. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_probe_rows(const whit_probe_report *report, whit_probe_row **rows,
                                       uint32_t *count);

/* Why the pixel is as bright as it is, by the rays of its first sample: where its light comes from,
   and which lights reach what is seen there. Names are as `scene` has them, which is the
   renderer's. At most `bytes` of `text`, which end with a 0; more is cut. */
#define WHIT_PROBE_WHY_BYTES 512
void whit_probe_why(const whit_probe_report *report, const whit_scene *scene, char *text,
                    size_t bytes);

#ifdef __cplusplus
}
#endif

#endif
