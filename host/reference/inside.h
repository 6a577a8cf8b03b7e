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

/* ---- meet.c: primitives ---- */

/* A ray in the space of a tree, with what the test of triangles needs. */
struct line {
    double origin[3], dir[3];
    int x, y, z; /* z: where the direction is longest */
    double shear_x, shear_y;
};

struct candidate {
    bool met;
    double t, u, v;
    struct dvec3 normal;
    bool front;
    bool owned; /* of triangles that share the point one owns it */
};

struct line line_make(const double origin[3], const double dir[3]);
struct candidate meet_triangle(const struct line *line, const struct gpu_triangle *triangle);
/* One of the ends of the chord. `own`: the line starts on it; then only the far end is there. */
struct candidate meet_sphere(const struct line *line, const struct gpu_triangle *sphere,
                             bool at_exit, bool own);

/* ---- hits.c: what rays meet ---- */

struct hit hit_closest(const struct reference *reference, const struct ray *ray);
/* The one behind `known`, up to t_max. */
struct hit hit_next(const struct reference *reference, const struct ray *ray,
                    const struct hit *known, double t_max);

struct shadow_ray {
    struct dvec3 origin, dir;
    double distance; /* to the light; infinity: a sun */
    uint32_t skip_instance, skip_primitive;
};

/* What is between a point and a light. */
struct shadow {
    bool blocked;
    struct hit blocker; /* where blocked */
    double stops[3];    /* 1/64 stops of light that filters take; may be below 0 */
};

struct shadow hit_shadow(const struct reference *reference, const struct shadow_ray *ray);

/* ---- surface.c: where a ray meets something ---- */

struct surface {
    struct dvec3 p, ng, ns; /* world; normals unit, ns on the side of ng */
    struct dvec3 e1, e2;    /* edges of the triangle; of spheres the derivatives of p by u and v */
    struct dvec3 color;     /* of the vertices */
    double alpha;
    double u, v; /* of spheres: texture coordinates */
    double room; /* by how much a ray starts off the surface */
    /* By how much the texture's place moves for unit steps to both sides of the ray, in e1 and e2,
       times the side of what the ray stands for; 0: a point. */
    double footprint[2][2];
    const struct scene_mesh *mesh;
    const struct scene_material *material;
    uint32_t material_index, instance, primitive;
    bool sphere;
};

struct surface surface_at(const struct reference *reference, const struct hit *hit);
/* Turns its normals to the ray's side. True: the ray comes from inside. */
bool surface_face(struct surface *s, struct dvec3 dir);
/* From an instance's object space, by the inverse transpose; not unit. */
struct dvec3 surface_place_normal(const struct reference *reference, uint32_t instance,
                                  struct dvec3 n);
/* The vertex normal at corner 0..2 in world space, unit; 0 for spheres and where the mesh is
   flat. */
struct dvec3 surface_vertex_normal(const struct reference *reference, const struct surface *s,
                                   uint32_t corner);
/* What identifies the place for textures, without the rest: mesh, material, u, v, colours. */
struct surface surface_texture_place(const struct reference *reference, uint32_t instance,
                                     const struct candidate *m, const struct gpu_triangle *record);
/* ---- texture.c ---- */

struct texel {
    struct dvec3 rgb;
    double alpha;
};

bool texture_used(const struct scene_material *m, enum scene_slot slot);
/* White where the slot is empty. */
struct texel texture_sample(const struct reference *reference, const struct surface *s,
                            enum scene_slot slot);
/* Opacity of masked and blended materials, colours of vertices left out. */
double texture_opacity(const struct reference *reference, const struct surface *s);
/* Normal or bump map: s->ns. */
void texture_bend_normal(const struct reference *reference, struct surface *s);

/* ---- optics.c: what a surface does with light ---- */

struct optics {
    struct dvec3 diffuse, ambient, highlight, emission;
    struct dvec3 reflected, refracted; /* weights of the two rays */
    double straight;                   /* share that passes undisturbed */
    double shininess, alpha, eta;
    bool thin, unlit, metal_rough;
};

/* `eta`: index of the ray's side over that of the other. Bends s->ns. */
struct optics optics_at(const struct reference *reference, struct surface *s, struct dvec3 dir,
                        double eta);
/* A shadow catcher: light goes straight on. */
void optics_make_catcher(struct optics *o);
/* Unpolarised light that a smooth face reflects; 1 under total reflection. */
double optics_fresnel(double cos_in, double eta);
double optics_schlick(double cos_in, double eta);
/* False under total reflection. */
bool optics_refract(struct dvec3 dir, struct dvec3 n, double eta, struct dvec3 *out);
struct dvec3 optics_reflect(struct dvec3 dir, struct dvec3 n);
/* Highlight of light along `to_light` seen along `view`, times pi of a BRDF times cosine. */
struct dvec3 optics_highlight(const struct optics *o, struct dvec3 n, struct dvec3 to_light,
                              struct dvec3 view);

/* ---- media.c ---- */

/* The medium that counts: material; SCENE_NONE: air. */
uint32_t media_top(const struct media *media);
/* Beer's law along t in the medium that counts. */
struct dvec3 media_transmittance(const struct reference *reference, const struct media *media,
                                 double t);
/* Sum of the absorption of all of them. */
struct dvec3 media_absorption(const struct reference *reference, const struct media *media);
struct media media_around_eye(const struct reference *reference);

struct crossing {
    struct media before, after;
    double eta;
    bool seen;
    /* Where what passes goes on: the last of the surfaces that are crossed here. */
    struct dvec3 p, ng;
    double room;
    uint32_t instance, primitive;
};

/* `s` faces the ray, afterwards too, when it is another one of those that touch. */
struct crossing media_cross(struct tracer *tracer, const struct ray *ray, const struct hit *hit,
                            struct surface *s, bool inside);

/* ---- light.c ---- */

struct light_sample_info {
    struct dvec3 to_light; /* unit */
    double distance;       /* infinity: a sun */
    struct dvec3 arriving; /* irradiance over pi of what faces the light, before shadows */
    double strength;       /* flat emitters: arriving = color * area_share * strength */
};

/* Point `index` of a light, as seen from p. False: nothing arrives. */
bool light_at(const struct tracer *tracer, const struct scene_light *light, uint32_t index,
              struct dvec3 p, struct light_sample_info *from);
/* Area over pi and samples. */
double light_area_share(const struct reference *reference, const struct scene_light *light);
double light_form_factor(const struct scene_light *light, struct dvec3 p, struct dvec3 n);
struct dvec3 light_sky(const struct reference *reference, struct dvec3 dir);
#define LIGHT_MAX 1e24

/* ---- lighting.c ---- */

/* Light from all lights towards the eye. `open`: what lights would add without shadows. `media`: on
   the surface's side. */
struct dvec3 lighting_local(struct tracer *tracer, const struct surface *s, const struct optics *o,
                            const struct ray *ray, const struct hit *hit, const struct media *media,
                            struct dvec3 *open);
/* What a shadow catcher shows of what is behind it. */
struct dvec3 lighting_caught(struct dvec3 light, struct dvec3 open);

/* ---- camera.c ---- */

struct ray camera_first_ray(const struct reference *reference, uint32_t x, uint32_t y,
                            uint32_t sample);
/* The area of a texel that a sample of the pixel asks for, across its camera ray `way` from the
   eye. */
double camera_texel_area(const struct reference *reference, uint32_t x, uint32_t y, uint32_t sample,
                         double way);

/* ---- tree.c ---- */

/* The colour of a pixel's sample tracer->sample; the ray tree too, if tracer->records. `first`: hit
   of the camera ray. */
struct dvec3 tree_trace(struct tracer *tracer, uint32_t x, uint32_t y, struct hit *first);
/* Adds a ray to the ray tree and gives its number; REFERENCE_NONE where none is recorded. */
uint32_t tree_record(struct tracer *tracer, const struct reference_ray *ray);
void tree_finish(struct tracer *tracer);

#endif
