/* The picture in double: the Whitted model of docs/effects.md on the CPU, written a second time, by
   other formulas where there are some. What kernels get wrong by their floats, approximations and
   limits is the difference to it.

   It shares what the host prepares: the scene and its pose, the trees of accel/ with their walk in
   double (oracle/conservative.h), the camera and the media around it (media_view), the patterns of
   samples. Nothing that decides a colour is shared with the kernels or with their float twins.

   What is other than in the kernels, on purpose:
   - Rays start at the double hit point, moved off the surface by 2^-45 of the coordinates it comes
   from, and do not meet the primitive that they start on. Kernels move by the bounds of float
   errors.
   - Instances are placed by the pose's matrices in double. Vertices, materials and camera vectors
   are the floats that the kernels read. Vertex colours are not rounded to 16 bits.
   - Filters of shadow rays weaken light by what they let through, not by whole 1/64 stops, unless
     `whole_stops` asks for it.
   - Surfaces of two media touch where they do within the roundings of floats, as in the kernels: it
     is their vertices that were rounded.
   - Everything is compiled: params.all_effects, effects_added, tiles, load paths and numerics mean
     nothing here. */
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
    /* As for a renderer: of the view, samples, depth, bailout, shadows, light_samples, schlick,
       cancel and progress are obeyed. `progress` is called from the calling thread.
     */
    whit_renderer_params picture;
    uint32_t thread_count; /* 0: one a core; the picture has the same bytes for any count */
    bool whole_stops;      /* filters of shadow rays in whole 1/64 stops, as kernels add them */
};

struct reference;

/* `accel` (with its scene) is borrowed until reference_destroy, and posed at picture.time_s: no
   renderer may be at work on it. WHIT_ERROR_USAGE, logged, for parameters that a renderer refuses,
   for adaptive samples, for effects left out, and for a shader. */
WHIT_CHECK whit_result reference_create(const whit_log *log, struct accel *accel,
                                        const struct reference_params *params,
                                        struct reference **out);
void reference_destroy(struct reference *reference);

/* Rays that were traced, by RAY_*, and sums over pixels. */
struct reference_stats {
    uint64_t rays[RAY_KIND_COUNT];
    uint64_t cut_depth, cut_bailout; /* rays not traced */
    uint64_t non_finite;             /* pixels */
    double render_ms;
};

/* Linear RGBA floats (alpha 1), rounded once from double, and in `ids`, which may be NULL, instance
   and primitive of the first sample. WHIT_ERROR_CANCELLED, WHIT_ERROR_TIME_LIMIT,
   WHIT_ERROR_MEMORY; WHIT_ERROR_STATUS, logged, where a ray was in more media than kernels can tell
   apart. */
WHIT_CHECK whit_result reference_render(const struct reference *reference, struct image *color,
                                        struct image *ids, struct reference_stats *stats);

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
    double t;                 /* of what it met; of shadow rays at the latest that of the light;
                                 infinity: nothing */
    double t_max;             /* of shadow rays, their light; else infinity */
    uint32_t instance, primitive, material; /* of what it met, or REFERENCE_NONE */
    uint32_t medium;                        /* material that it travels in; REFERENCE_NONE: air */
    uint32_t light;     /* of shadow rays: number in the scene; else REFERENCE_NONE */
    uint32_t point;     /* of an area light */
    double normal[3];   /* shading normal where it met something, on the ray's side; else 0 */
    double weight[3];   /* of its radiance in the pixel's sample, at its origin; of shadow rays the
                           share of the light that passes */
    double radiance[3]; /* what it added to the sample: sky, or light of the surface that it met,
                           times weight and what was absorbed on the way; 0 for shadow rays */
};

/* All rays of one sample (0 .. samples - 1) of pixel (x, y) from the upper left, each after its
   parent; free() the list. The sum of all `radiance` is the sample's colour. WHIT_ERROR_USAGE
   outside of the picture; else as reference_render. */
WHIT_CHECK whit_result reference_ray_tree(const struct reference *reference, uint32_t x, uint32_t y,
                                          uint32_t sample, struct reference_ray **rays,
                                          uint32_t *count);

#endif
