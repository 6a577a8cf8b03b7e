/* Types that the files of reference/ share. Functions change nothing but the `struct tracer` that
   they get; each thread has one. */
#ifndef REFERENCE_INSIDE_H
#define REFERENCE_INSIDE_H

#include "abi/shade.h"
#include "base/affine.h"
#include "reference/reference.h"
#include "reference/vector.h"

/* An instance's matrices: object to world, and back. */
struct placing {
    struct affine forward, inverse;
};

struct reference {
    whit_log log;
    struct accel *accel;
    const struct scene *scene;
    struct reference_params params;
    struct scene_pose pose;
    struct gpu_frame frame; /* camera, media around it, contact, nested */
    uint32_t camera;        /* CAMERA_* */
    struct placing *placings;
    bool *alphas;       /* by texture: whether any alpha is below 255 */
    double linear[256]; /* linear value of each 8-bit sRGB code */
    /* Mipmap levels of each texture, by enum mipmap_kind, as mipmap_make makes them; NULL: none. */
    uint8_t *(*levels)[MIPMAP_COVER + 1];
    float level_pieces[2 * MIPMAP_PIECES];
    float *sky; /* octahedral map, RGBA; NULL: gradient */
    uint32_t sky_size;
    uint32_t light_samples;
    float *light_ends; /* of each light: accel_light_end */
    double bailout;
};

/* The media that a ray is in, as material index + 1, sorted by rising priority; among equal ones
   the one entered later comes later. The last one counts. */
struct media {
    uint32_t entries[MEDIA_MAX];
    uint32_t count;
};

struct ray {
    struct dvec3 origin, dir, weight;
    struct media media;
    uint32_t steps; /* high bits: ray_bounces(); low bits: surfaces passed within one medium */
    uint32_t kind;  /* enum reference_kind */
    uint32_t skip_instance, skip_primitive; /* primitive that it starts on; HIT_NONE: none */
    uint32_t node; /* index in the ray tree: the parent's while on the stack, then its own */
    double way;    /* length of the path from the eye to its origin */
};

/* Steps per bounce. Surfaces passed within one medium are counted in the low bits and add up to
   bounces, so that every ray tree ends. */
#define STEPS_OF_BOUNCE (1u << STATE_BOUNCES_SHIFT)

static inline uint32_t ray_bounces(uint32_t steps)
{
    return steps >> STATE_BOUNCES_SHIFT;
}

struct hit {
    double t;
    double u, v;                          /* barycentric weights of the second and third vertex */
    struct dvec3 normal;                  /* for spheres: unit, in the space of the record */
    uint32_t record, primitive, instance; /* primitive HIT_NONE: no hit */
};

/* One thread's work. */
struct tracer {
    const struct reference *reference;
    uint32_t sample; /* index of the pixel's sample; shifts the points of area lights */
    uint32_t x, y;   /* the pixel */
    uint64_t rays[REFERENCE_STRAIGHT + 1]; /* traced, by kind */
    uint64_t cut_depth, cut_bailout;       /* not traced, by reason */
    bool too_many_media, lacks_memory;
    struct ray *stack; /* rays that are still to be traced */
    uint32_t stack_count, stack_capacity;
    struct reference_ray *nodes; /* the ray tree, recorded if `records` */
    uint32_t node_count, node_capacity;
    bool records;
};

#endif
