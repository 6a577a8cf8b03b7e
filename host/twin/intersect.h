/* shaders/lib/intersect.glsl in C, operation by operation: see there for the method. Built with
   contraction off, it gives the bits that the shader gives on IEEE arithmetic. */
#ifndef TWIN_INTERSECT_H
#define TWIN_INTERSECT_H

#include <math.h>
#include <stdbool.h>

#include "base/vec.h"

struct ray_setup {
    struct vec3 origin, dir, above, below, inv_dir;
    bool negative[3];
    bool dominant_x, dominant_y;
    struct vec3 shear;
    float far_scale;
};

#define SLAB_FAR_SCALE (1.0f + 1.0f / 1048576.0f)

static inline struct vec3 turn_dominant(const struct ray_setup *ray, struct vec3 p)
{
    if (ray->dominant_x)
        return vec3_make(p.y, p.z, p.x);
    if (ray->dominant_y)
        return vec3_make(p.z, p.x, p.y);
    return p;
}

static inline struct ray_setup make_ray_setup(struct vec3 origin, struct vec3 dir)
{
    struct ray_setup ray = {.origin = origin,
                            .dir = dir,
                            .above = origin,
                            .below = origin,
                            .far_scale = SLAB_FAR_SCALE};
    ray.inv_dir = vec3_make(1.0f / dir.x, 1.0f / dir.y, 1.0f / dir.z);
    ray.negative[0] = ray.inv_dir.x < 0.0f;
    ray.negative[1] = ray.inv_dir.y < 0.0f;
    ray.negative[2] = ray.inv_dir.z < 0.0f;
    float x = fabsf(dir.x), y = fabsf(dir.y), z = fabsf(dir.z);
    bool x_over_y = x > y, x_over_z = x > z, y_over_z = y > z;
    ray.dominant_x = x_over_y && x_over_z;
    ray.dominant_y = !x_over_y && y_over_z;
    struct vec3 turned = turn_dominant(&ray, dir);
    ray.shear = vec3_make(turned.x / turned.z, turned.y / turned.z, 1.0f / turned.z);
    return ray;
}

static inline float float_larger(float a, float b)
{
    return a > b ? a : b;
}

static inline float float_smaller(float a, float b)
{
    return a < b ? a : b;
}

static inline float vec3_largest_magnitude(struct vec3 p)
{
    return float_larger(fabsf(p.x), float_larger(fabsf(p.y), fabsf(p.z)));
}

/* For NUMERICS_EXACT. Vulkan bounds the error of quotients (2.5 ulp) only for divisors in
   2^-126..2^126; with others the shear is NaN, and no filter decides. The reciprocal of a denormal
   may be infinite, as if the ray did not move on that axis; NaN bounds nothing there. */
static inline void bound_ray_setup(struct ray_setup *ray)
{
    float size = vec3_largest_magnitude(ray->dir);
    if (!(size > 7.8886090522101181e-31f && size < 1.2676506002282294e+30f))
        ray->shear = vec3_make(NAN, NAN, NAN);
    ray->inv_dir.x = fpclassify(ray->dir.x) == FP_SUBNORMAL ? NAN : ray->inv_dir.x;
    ray->inv_dir.y = fpclassify(ray->dir.y) == FP_SUBNORMAL ? NAN : ray->inv_dir.y;
    ray->inv_dir.z = fpclassify(ray->dir.z) == FP_SUBNORMAL ? NAN : ray->inv_dir.z;
}

#define CLIP_MARGIN (1.0f / 524288.0f)

static inline void widen_boxes(struct ray_setup *ray, struct vec3 margin)
{
    ray->above = vec3_add(ray->origin, margin);
    ray->below = vec3_sub(ray->origin, margin);
}

static inline void widen_ray_setup(struct ray_setup *ray, struct vec3 center, float reach)
{
    float farthest = vec3_largest_magnitude(vec3_sub(ray->origin, center));
    float margin = (farthest + reach) * CLIP_MARGIN;
    widen_boxes(ray, vec3_make(margin, margin, margin));
}

static inline void widen_world_setup(struct ray_setup *ray, struct vec3 own, struct vec3 others)
{
    float farthest = vec3_largest_magnitude(ray->origin);
    widen_boxes(ray, vec3_make(fabsf(ray->origin.x) * own.x + farthest * others.x,
                               fabsf(ray->origin.y) * own.y + farthest * others.y,
                               fabsf(ray->origin.z) * own.z + farthest * others.z));
}

static inline void slab_axis(float lo, float hi, float inv_dir, bool negative, float *start,
                             float *end)
{
    float at_lo = lo * inv_dir;
    float at_hi = hi * inv_dir;
    float near = negative ? at_hi : at_lo;
    float far = negative ? at_lo : at_hi;
    *start = near > *start ? near : *start;
    *end = far < *end ? far : *end;
}

static inline void slab_interval(const struct ray_setup *ray, struct vec3 lo, struct vec3 hi,
                                 float t_min, float *t_near, float *t_far)
{
    float start = t_min, end = INFINITY;
    slab_axis(lo.x, hi.x, ray->inv_dir.x, ray->negative[0], &start, &end);
    slab_axis(lo.y, hi.y, ray->inv_dir.y, ray->negative[1], &start, &end);
    slab_axis(lo.z, hi.z, ray->inv_dir.z, ray->negative[2], &start, &end);
    *t_near = start;
    *t_far = end * ray->far_scale;
}

static inline struct vec3 vec3_smaller(struct vec3 a, struct vec3 b)
{
    return vec3_make(float_smaller(a.x, b.x), float_smaller(a.y, b.y), float_smaller(a.z, b.z));
}

static inline struct vec3 vec3_larger(struct vec3 a, struct vec3 b)
{
    return vec3_make(float_larger(a.x, b.x), float_larger(a.y, b.y), float_larger(a.z, b.z));
}

struct sheared {
    float ax, ay, bx, by, cx, cy;
    float ea, eb, ec;
};

static inline struct sheared shear_triangle(const struct ray_setup *ray, struct vec3 ta,
                                            struct vec3 tb, struct vec3 tc)
{
    struct sheared s;
    s.ax = ta.x - ray->shear.x * ta.z, s.ay = ta.y - ray->shear.y * ta.z;
    s.bx = tb.x - ray->shear.x * tb.z, s.by = tb.y - ray->shear.y * tb.z;
    s.cx = tc.x - ray->shear.x * tc.z, s.cy = tc.y - ray->shear.y * tc.z;
    s.ea = s.cx * s.by - s.cy * s.bx;
    s.eb = s.ax * s.cy - s.ay * s.cx;
    s.ec = s.bx * s.ay - s.by * s.ax;
    return s;
}

static inline bool intersect_triangle(const struct ray_setup *ray, struct vec3 a, struct vec3 b,
                                      struct vec3 c, float t_min, float *t, float *u, float *v)
{
    float t_near, t_far;
    slab_interval(ray, vec3_smaller(c, vec3_smaller(a, b)), vec3_larger(c, vec3_larger(a, b)),
                  t_min, &t_near, &t_far);
    struct vec3 ta = turn_dominant(ray, a), tb = turn_dominant(ray, b), tc = turn_dominant(ray, c);
    struct sheared s = shear_triangle(ray, ta, tb, tc);
    bool below = s.ea < 0.0f || s.eb < 0.0f || s.ec < 0.0f;
    bool above = s.ea > 0.0f || s.eb > 0.0f || s.ec > 0.0f;
    float det = (s.ea + s.eb) + s.ec;
    float az = ray->shear.z * ta.z, bz = ray->shear.z * tb.z, cz = ray->shear.z * tc.z;
    float inv_det = 1.0f / det;
    *u = s.eb * inv_det;
    *v = s.ec * inv_det;
    float at = ((s.ea * inv_det) * az + *u * bz) + *v * cz;
    *t = at > t_near ? at : t_near;
    return !(below && above) && det != 0.0f && at >= t_min && t_near <= t_far;
}

#endif
