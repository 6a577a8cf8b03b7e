/* Part of whit.h: why a pixel looks as it does. */
#ifndef WHIT_PROBE_H
#define WHIT_PROBE_H

#include "whit_renderer.h"

WHIT_C_BEGIN

/* The reason why a ray ended. */
typedef enum whit_probe_end {
    WHIT_PROBE_MISSED = 0, /* it meets nothing, and sees the environment */
    WHIT_PROBE_OPAQUE,     /* it meets a surface that spawns no further ray */
    WHIT_PROBE_DIVIDED,    /* it meets a surface that reflects it or lets it through */
    WHIT_PROBE_ABSORBED,   /* the medium that it crossed absorbed too much of it */
    WHIT_PROBE_DEPTH,      /* not traced: it would exceed the limit of bounces */
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
    bool straight; /* it continues straight through a blended surface, a shadow catcher, or a
                      surface with the same medium on both sides */
    whit_probe_end end;
    uint32_t parent;     /* index of the ray that spawned it, less than its own index; WHIT_NONE:
                            none */
    uint32_t generation; /* 0: the camera ray */
    whit_ray ray;        /* one that was not traced starts where its parent ended */
    float weight[3];     /* factor by which its radiance counts in the pixel; shadow rays: the
                            weight of their surface */
    float added[3];      /* radiance times weight that this ray itself added, without its branches;
                            shadow rays: the share of the light that passes */
    /* The hit by the device, by its twin on the CPU, and by exact arithmetic. */
    whit_probe_hit device, twin, exact;
    bool equal; /* the twin's ids and every bit of t, u and v equal the device's. The twin takes
                   from the device whether a cut-out is solid there; for shadow rays any blocker
                   that the device may have met counts as equal */
    bool exact_known; /* false: the ray was not traced, or it passed too many surfaces */
    bool exact_equal; /* ids (shadow rays: blocked or not) equal the exact ones; at
                         WHIT_NUMERICS_EXACT t as well */
    uint32_t passed;  /* number of surfaces that it went through: cut-outs and back faces of
                         one-sided surfaces; shadow rays: also filters and surfaces that cast no
                         shadow */
    /* The material of the surface that it met; WHIT_NONE: it met nothing. */
    uint32_t material;
    float point[3], normal[3];    /* `normal`: unit length, interpolated, on the ray's side, without
                                     bump maps */
    bool inside;                  /* the surface was met from inside */
    uint32_t medium;              /* material of the medium that the ray crossed; WHIT_NONE: air */
    float ior;                    /* of the medium */
    uint32_t light, light_sample; /* of shadow rays; WHIT_NONE for others */
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
    double v[4];         /* the components, exactly; a bool is 0 or 1 */
    uint32_t ray;        /* index of the ray that the function was called for; for post() that of
                            the camera ray */
    uint32_t generation; /* of that ray */
} whit_probe_value;
/* Writes a value as text: "0.5", "(1, 2, 3)", "true". Floats get `digits` significant digits; 9 are
   enough to be exact. Writes at most `bytes` to `text`, including the 0 at the end. */
void whit_probe_value_text(const whit_probe_value *value, int digits, char *text, size_t bytes);

#define WHIT_PROBE_VALUES 8
/* One dbg(x) in the text of the shader. */
typedef struct whit_probe_call {
    const char *text; /* the argument x as the file has it, cut where it is long */
    const char *file; /* path as whit opened it */
    uint32_t line;
    uint32_t count;                             /* how often it was reached */
    whit_probe_value values[WHIT_PROBE_VALUES]; /* the first values, in the order of rays; dropped
                                                   rays have none */
    uint32_t value_count;
} whit_probe_call;

typedef struct whit_probe_report {
    uint32_t x, y;
    uint32_t samples; /* the number that `color` is the mean of; for an adaptive picture those of
                         its first pass */
    float color[4];   /* as in the picture: the same bytes */
    uint8_t shown[4]; /* as displayed: sRGB */
    /* The tree of the first sample: a ray is followed by its shadow rays, then by its branches in
       the order in which they were traced, each with its own shadow rays and branches behind it.
       The first ray is the camera ray. */
    whit_probe_ray *rays;
    uint32_t ray_count;
    uint32_t dropped;   /* number of rays that did not fit into `max_rays` */
    uint32_t differing; /* rays whose hit by the twin differs from the device's (`equal` is
                           false) */
    /* Each dbg(x) of the shader, in the order of files and lines. Values are those of the first
       sample; post() runs once for all samples. */
    whit_probe_call *calls;
    uint32_t call_count;
    bool shaded;     /* shade() of the shader has lit the surfaces: which lights it asked is not
                        recorded */
    bool unshadowed; /* there are no shadows, and so no shadow rays */
} whit_probe_report;

/* Traces pixel (x, y), counted from the upper left, once more and alone; the rendered picture
   stays, but views of whit_renderer_render_views are gone. The first call compiles a kernel.
   `max_rays`: how many rays are recorded; 0: 16383, which is the limit. Rays that functions of a
   shader trace themselves are not recorded. WHIT_ERROR_USAGE for a pixel outside of the picture,
   where sampling.first leaves the first sample out (as whit_refine_step leaves it), or without a
   device; WHIT_ERROR_DEVICE; WHIT_ERROR_STATUS, WHIT_ERROR_TIME_LIMIT and WHIT_ERROR_CANCELLED as
   whit_renderer_render. */
WHIT_CHECK whit_result whit_probe(whit_renderer *renderer, uint32_t x, uint32_t y,
                                  uint32_t max_rays, whit_probe_report **out);
void whit_probe_report_destroy(whit_probe_report *report);

/* One line of a printed report: a ray, or several shadow rays from one surface point to one light
   that share their end and the instance that they ended at. */
typedef struct whit_probe_row {
    uint32_t ray; /* the first one */
    uint32_t count;
    float added[3]; /* as whit_probe_ray.added; the mean over several rays */
} whit_probe_row;
/* The rows of a report, which hold each ray once: a ray is followed by its shadow rays, those that
   reach their light first, then by its branches, those that added most first. *rows is one block,
   for whit_memory_destroy. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_probe_rows(const whit_probe_report *report, whit_probe_row **rows,
                                       uint32_t *count);

/* Explains in words why the pixel is as bright as it is, by the rays of its first sample: where its
   light comes from, and which lights reach the surface seen there. `scene` must be the renderer's;
   names are written as it has them. Writes at most `bytes` to `text`, including the 0 at the end;
   longer text is cut. */
#define WHIT_PROBE_WHY_BYTES 512
void whit_probe_why(const whit_probe_report *report, const whit_scene *scene, char *text,
                    size_t bytes);

WHIT_C_END

#endif
