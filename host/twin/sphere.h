/* shaders/lib/sphere.glsl in C, operation by operation: see there for the method. */
#ifndef TWIN_SPHERE_H
#define TWIN_SPHERE_H

#include "accel/accel.h"
#include "accel/extent.h"
#include "twin/intersect.h"

/* The shader's struct Foot: the dominant axis is last. */
struct foot {
    struct vec3 c, d, off;
    float dd, mid, rr, room, half_length;
};

struct chord {
    bool met, inward;
    float t_near, t_far, t_box;
    struct vec3 middle, to_exit; /* the dominant axis is last */
};

static inline struct foot drop_perpendicular(const struct ray_setup *ray, struct vec3 center,
                                             float radius)
{
    struct foot foot;
    struct vec3 c = turn_dominant(ray, vec3_sub(center, ray->origin));
    struct vec3 d = vec3_make(ray->shear.x, ray->shear.y, 1.0f);
    float dd = (d.x * d.x + d.y * d.y) + 1.0f;
    float cd = (c.x * d.x + c.y * d.y) + c.z;
    float mid = cd / dd;
    struct vec3 off = vec3_make(c.x - d.x * mid, c.y - d.y * mid, c.z - d.z * mid);
    foot.rr = radius * radius;
    foot.room = foot.rr - ((off.x * off.x + off.y * off.y) + off.z * off.z);
    foot.half_length = sqrtf((foot.room > 0.0f ? foot.room : 0.0f) / dd);
    foot.c = c;
    foot.d = d;
    foot.off = off;
    foot.dd = dd;
    foot.mid = mid;
    return foot;
}

static inline struct chord intersect_sphere(const struct ray_setup *ray, struct vec3 center,
                                            float radius, float t_min)
{
    struct chord chord;
    const float at[3] = {center.x, center.y, center.z};
    struct bvh_box box = accel_sphere_box(at, radius);
    float box_near, box_far;
    slab_interval(ray, vec3_sub(vec3_load(box.lo), ray->origin),
                  vec3_sub(vec3_load(box.hi), ray->origin), t_min, &box_near, &box_far);

    struct foot foot = drop_perpendicular(ray, center, radius);
    struct vec3 c = foot.c, d = foot.d;
    float mid = foot.mid, half_length = foot.half_length;
    float farther = mid < 0.0f ? mid - half_length : mid + half_length;
    float product = ((c.x * c.x + c.y * c.y) + c.z * c.z) - foot.rr;
    float nearer = product / (foot.dd * farther);
    bool down = ray->shear.z < 0.0f;
    bool ends_nearer = (mid < 0.0f) != down;
    chord.t_near = (ends_nearer ? farther : nearer) * ray->shear.z;
    chord.t_far = (ends_nearer ? nearer : farther) * ray->shear.z;
    chord.t_box = box_near;
    chord.met = foot.room >= 0.0f && box_near <= box_far;
    chord.inward = mid != 0.0f && (mid < 0.0f) == down;
    float forward = down ? -half_length : half_length;
    chord.to_exit = vec3_make(d.x * forward, d.y * forward, d.z * forward);
    chord.middle = vec3_make(-foot.off.x, -foot.off.y, -foot.off.z);
    return chord;
}

static inline struct vec3 chord_end(const struct ray_setup *ray, const struct chord *chord,
                                    bool at_exit)
{
    struct vec3 p =
        at_exit ? vec3_add(chord->middle, chord->to_exit) : vec3_sub(chord->middle, chord->to_exit);
    if (ray->dominant_x)
        return vec3_make(p.z, p.x, p.y);
    if (ray->dominant_y)
        return vec3_make(p.y, p.z, p.x);
    return p;
}

static inline void square_from_dir(struct vec3 dir, float *u, float *v)
{
    float size = (fabsf(dir.x) + fabsf(dir.y)) + fabsf(dir.z);
    float x = dir.x / size, y = dir.z / size;
    float folded_x = 1.0f - fabsf(y), folded_y = 1.0f - fabsf(x);
    folded_x = x >= 0.0f ? folded_x : -folded_x;
    folded_y = y >= 0.0f ? folded_y : -folded_y;
    float at_x = (dir.y < 0.0f ? folded_x : x) * 0.5f + 0.5f;
    float at_y = (dir.y < 0.0f ? folded_y : y) * 0.5f + 0.5f;
    *u = size > 0.0f ? at_x : 0.5f;
    *v = size > 0.0f ? at_y : 0.5f;
}

static inline struct vec3 dir_from_square(float u, float v)
{
    float x = u * 2.0f - 1.0f, z = v * 2.0f - 1.0f;
    float y = (1.0f - fabsf(x)) - fabsf(z);
    float folded_x = 1.0f - fabsf(z), folded_z = 1.0f - fabsf(x);
    folded_x = x >= 0.0f ? folded_x : -folded_x;
    folded_z = z >= 0.0f ? folded_z : -folded_z;
    return y < 0.0f ? vec3_make(folded_x, y, folded_z) : vec3_make(x, y, z);
}

#endif
