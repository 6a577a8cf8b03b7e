/* Part of whit.h: the same picture in double. */
#ifndef WHIT_REFERENCE_H
#define WHIT_REFERENCE_H

#include "whit_renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The same picture in double, on the CPU, written a second time: what kernels get wrong is the
   difference to it. See host/reference/reference.h. */
typedef struct whit_reference whit_reference;

/* `accel` is borrowed until whit_reference_destroy and goes to params->time_s: no renderer may be
   at work on it. Of `params` size, camera, time, samples, depth, bailout, shadows, Fresnel, area
   lights, cancel, progress and time_limit_s (of one whit_reference_render) are obeyed; adaptive
   samples and effects left out are WHIT_ERROR_USAGE. `threads`: 0: one a core; the same bytes for
   any number. */
WHIT_CHECK whit_result whit_reference_create(whit_accel *accel, const whit_renderer_params *params,
                                             uint32_t threads, whit_reference **out);
void whit_reference_destroy(whit_reference *reference);
/* `ids`, as WHIT_AOV_IDS, may be NULL. WHIT_ERROR_CANCELLED and WHIT_ERROR_TIME_LIMIT leave no
   picture. WHIT_ERROR_STATUS: a ray was in too many media. */
WHIT_CHECK whit_result whit_reference_render(whit_reference *reference, whit_image **color,
                                             whit_image **ids);

typedef enum whit_tree_kind {
    WHIT_TREE_PRIMARY = 0,
    WHIT_TREE_SHADOW,
    WHIT_TREE_REFLECTED,
    WHIT_TREE_REFRACTED,
    WHIT_TREE_STRAIGHT, /* through a blended surface or a shadow catcher */
    WHIT_TREE_KINDS,
} whit_tree_kind;

typedef enum whit_tree_end {
    WHIT_TREE_MISS = 0, /* left the scene: sees the sky */
    WHIT_TREE_SURFACE,  /* met a surface, whose rays follow */
    WHIT_TREE_OPAQUE,   /* met a surface that calls for no further ray */
    WHIT_TREE_UNSEEN,   /* passed a surface between two places of the same medium */
    WHIT_TREE_LIGHT,    /* of shadow rays: came to the light */
    WHIT_TREE_BLOCKED,  /* of shadow rays: met something opaque */
    WHIT_TREE_ABSORBED, /* nothing is left of it */
    WHIT_TREE_DEPTH,    /* not traced, for the limit of bounces */
    WHIT_TREE_BAILOUT,  /* not traced, for what little it can add */
    WHIT_TREE_ENDS,
} whit_tree_end;

typedef struct whit_tree_ray {
    uint32_t kind, end; /* whit_tree_kind, whit_tree_end */
    uint32_t parent;    /* index, smaller than its own; WHIT_NONE: it comes from the camera */
    uint32_t bounces;
    double origin[3], dir[3]; /* unit */
    double
        t; /* of what it met; of shadow rays at the latest that of the light; infinity: nothing */
    uint32_t instance, primitive, material; /* of what it met, or WHIT_NONE */
    uint32_t medium;                        /* material that it travels in; WHIT_NONE: air */
    uint32_t light, point; /* of shadow rays: light of the scene (else WHIT_NONE), point of it */
    double normal[3];      /* of shading, where it met something that is seen; else 0 */
    double weight[3];      /* of its radiance in the sample; of shadow rays the share that passes */
    double radiance[3];    /* what it added to the sample; 0 for shadow rays */
} whit_tree_ray;

/* The ray tree of one sample (0: the first) of a pixel from the upper left; the sum of `radiance`
   is the sample's colour. It is for whit_memory_destroy. WHIT_ERROR_USAGE outside of the
   picture. */
WHIT_CHECK whit_result whit_reference_rays(whit_reference *reference, uint32_t x, uint32_t y,
                                           uint32_t sample, whit_tree_ray **rays, uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
