/* The reference: the Whitted model of docs/effects.md once more, in double on the CPU, by other
   formulas where there are some. Its difference to a picture of the kernels is the error that these
   make by floats, approximations and limits.

   It shares what the host prepares: the scene and its pose, the trees of accel/ with their
   traversal in double (oracle/conservative.h), the camera and the media around it (media_view), the
   sample patterns. No code that decides a colour is shared with the kernels or their float mirrors.

   Intended differences to the kernels:
   - Rays start at the double hit point, moved off the surface by 2^-45 of the coordinates that it
   is computed from, and do not hit the primitive that they start on. Kernels move it by bounds of
   float errors.
   - Instances are placed by the pose's matrices in double. Vertices, materials and camera vectors
   are the floats that the kernels read. Vertex colours are not rounded to 16 bits.
   - Filters of shadow rays weaken light by their exact transmittance, not by whole steps (1/64 stop
     for those without textures and absorption, else 1/256), unless `whole_stops` asks for it.
   - All effects are there: params.all_effects, effects_added, tiles, load paths and numerics are
     ignored.
   As in the kernels, surfaces of two media touch if they do so within the rounding errors of
   floats, since their vertices were rounded. */
#ifndef REFERENCE_REFERENCE_H
#define REFERENCE_REFERENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "accel/accel.h"
#include "image/image.h"
#include "picture/camera.h"
#include "picture/environment.h"
#include "picture/media.h"
#include "picture/mipmap.h"
#include "picture/params.h"
#include "picture/sequence.h"
#include "whit/whit_probe.h"

struct reference_params {
    /* As for a renderer, but only the view, samples, depth, bailout, shadows, light_samples,
       schlick, cancel and progress count. `progress` is called from the calling thread. */
    whit_renderer_params picture;
    uint32_t thread_count; /* 0: one per core; the picture has the same bytes for any count */
    bool whole_stops;      /* rounds the light that each filter takes from a shadow ray to 1/64 or
                              1/256 stops, as kernels do (a stop is a factor of 2) */
};

struct reference;

/* Borrows `accel` (with its scene) until reference_destroy, and poses it at picture.time_s, so no
   renderer may be using it. WHIT_ERROR_USAGE, logged, for parameters that a renderer refuses, for
   adaptive samples, for effects left out, and for a shader. */
WHIT_CHECK whit_result reference_create(const whit_log *log, struct accel *accel,
                                        const struct reference_params *params,
                                        struct reference **out);
void reference_destroy(struct reference *reference);

/* Renders linear RGBA floats (alpha 1), rounded once from double, and into `ids` (may be NULL)
   instance and primitive of each pixel's first sample. *stats: the time, and the numbers of rays
   traced and cut. WHIT_ERROR_CANCELLED, WHIT_ERROR_TIME_LIMIT, WHIT_ERROR_MEMORY;
   WHIT_ERROR_STATUS, logged, where a ray was in more media than kernels can keep. */
WHIT_CHECK whit_result reference_render(const struct reference *reference, struct image *color,
                                        struct image *ids, whit_stats *stats);

/* ---- The ray tree of a pixel ---- */

enum reference_kind {
    REFERENCE_PRIMARY = RAY_PRIMARY,
    REFERENCE_SHADOW = RAY_SHADOW,
    REFERENCE_REFLECTED = RAY_REFLECTED,
    REFERENCE_REFRACTED = RAY_REFRACTED,
    REFERENCE_STRAIGHT, /* through a blended surface or a shadow catcher */
};

#define REFERENCE_NONE UINT32_MAX

struct reference_ray {
    uint32_t kind; /* enum reference_kind */
    whit_probe_end end;
    uint32_t parent; /* index in the list, smaller than its own; REFERENCE_NONE: the camera */
    uint32_t bounces;
    double origin[3], dir[3]; /* unit */
    double t;                 /* of the hit; shadow rays without a blocker: of the light; infinity:
                                 no hit */
    double t_max;             /* shadow rays: t of the light; else infinity */
    uint32_t instance, primitive, material; /* of the hit, or REFERENCE_NONE */
    uint32_t medium;                        /* material that it travels in; REFERENCE_NONE: air */
    uint32_t light;     /* shadow rays: index in the scene; else REFERENCE_NONE */
    uint32_t point;     /* shadow rays to an area light: index of the point */
    double normal[3];   /* shading normal of the hit, on the ray's side; 0: no hit */
    double weight[3];   /* factor of its radiance in the sample, at its origin; shadow rays: share
                           of the light that passes */
    double radiance[3]; /* what it adds to the sample: light of the sky or of the surface hit, times
                           weight and the transmittance on the way; 0 for shadow rays */
};

/* Gives all rays of one sample (0 .. samples - 1) of pixel (x, y), counted from the upper left,
   each ray after its parent; free() the list. The sum of all `radiance` is the sample's colour.
   WHIT_ERROR_USAGE outside of the picture; other errors as reference_render. */
WHIT_CHECK whit_result reference_ray_tree(const struct reference *reference, uint32_t x, uint32_t y,
                                          uint32_t sample, struct reference_ray **rays,
                                          uint32_t *count);

#endif
