/* The parts of the reference: shared by the files of reference/ alone. All are pure but for the
   `struct tracer` that they are handed, one a thread. */
#ifndef REFERENCE_INSIDE_H
#define REFERENCE_INSIDE_H

#include "abi/shade.h"
#include "base/affine.h"
#include "reference/reference.h"
#include "reference/vector.h"

/* An instance in the world. */
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
    bool *alphas;       /* of each texture: whether its alpha is anything but 255 */
    double linear[256]; /* of 8-bit sRGB */
    /* Smaller levels of each texture, kind by kind, as mipmap_make makes them; NULL: there are
     * none. */
    uint8_t *(*levels)[MIPMAP_COVER + 1];
    float level_pieces[2 * MIPMAP_PIECES];
    float *sky; /* octahedral map, RGBA; NULL: gradient */
    uint32_t sky_size;
    uint32_t light_samples;
    double bailout;
};

/* Media that a ray is in: material + 1, by rising priority, of equal ones the later one higher. */
struct media {
    uint32_t entries[MEDIA_MAX];
    uint32_t count;
};

struct ray {
    struct dvec3 origin, dir, weight;
    struct media media;
    uint32_t steps; /* ray_bounces(), and below them surfaces that were passed unseen */
    uint32_t kind;  /* enum reference_kind */
    uint32_t skip_instance, skip_primitive; /* it starts on this; HIT_NONE: nothing */
    uint32_t node; /* of the ray tree: its parent's while it waits, then its own */
    double way;    /* from the eye to its origin along the rays before it */
};

/* Every ray tree ends: as many surfaces passed unseen as the steps of one bounce count as one. */
#define STEPS_OF_BOUNCE (1u << STATE_BOUNCES_SHIFT)

static inline uint32_t ray_bounces(uint32_t steps)
{
    return steps >> STATE_BOUNCES_SHIFT;
}

struct hit {
    double t;
    double u, v;                          /* weights of the second and third vertex */
    struct dvec3 normal;                  /* of spheres: unit, in the space of the record */
    uint32_t record, primitive, instance; /* primitive HIT_NONE: nothing is met */
};

/* One thread's work. */
struct tracer {
    const struct reference *reference;
    uint32_t sample; /* moves the points of area lights */
    uint32_t x, y;   /* the pixel */
    struct reference_stats stats;
    bool too_many_media, lacks_memory;
    struct ray *stack; /* rays that wait */
    uint32_t stack_count, stack_capacity;
    struct reference_ray *nodes; /* the ray tree, if `records` */
    uint32_t node_count, node_capacity;
    bool records;
};

#endif
