/* The rays of the hard cases. */
#include <math.h>
#include <string.h>

#include "accel/accel.h"
#include "base/random.h"
#include "hard/rays.h"

/* ---- Numbers ---- */

static uint32_t draw(uint64_t *state)
{
    return (uint32_t)(splitmix64(state) >> 32);
}

/* [0, 1) */
static double draw_unit(uint64_t *state)
{
    return (double)draw(state) * 0x1p-32;
}

/* [-1, 1) */
static double draw_signed(uint64_t *state)
{
    return 2.0 * draw_unit(state) - 1.0;
}

static double draw_sign(uint64_t *state)
{
    return draw(state) & 1u << 31 ? -1.0 : 1.0;
}

/* A whole number from -max to max. */
static double draw_whole(uint64_t *state, uint32_t max)
{
    return (double)(draw(state) % (2 * max + 1)) - (double)max;
}

static double power_of_half(uint32_t n)
{
    double value = 1.0;
    for (uint32_t i = 0; i < n; ++i)
        value *= 0.5;
    return value;
}

/* ---- What to aim at ---- */

struct target {
    uint32_t instance, primitive;
    double corner[3][3]; /* world */
    double point[3];
    double size[3]; /* per axis: the largest sum of the magnitudes that are added to transform a
                       corner to world space */
};

static void mix(double corner[3][3], double u, double v, double out[3])
{
    for (int k = 0; k < 3; ++k)
        out[k] =
            corner[0][k] + u * (corner[1][k] - corner[0][k]) + v * (corner[2][k] - corner[0][k]);
}

static void draw_triangle(const struct hard_scene *hard, uint64_t *state, struct target *target)
{
    const struct scene *scene = hard->scene;
    const struct scene_mesh *mesh;
    uint32_t at = draw(state) % scene->instance_count;
    do {
        at = (at + 1) % scene->instance_count;
        mesh = &scene->meshes[scene->instances[at].mesh];
    } while (mesh->triangle_count == 0);
    target->instance = at;
    target->primitive = draw(state) % mesh->triangle_count;
    const double *m = hard->pose.instances[at].m;
    double local[3][3];
    scene_mesh_corners(mesh, target->primitive, local);
    for (int i = 0; i < 3; ++i) {
        affine_point(&hard->pose.instances[at], local[i], target->corner[i]);
        for (int k = 0; k < 3; ++k) {
            if (hard->flatten)
                target->corner[i][k] = (double)(float)target->corner[i][k];
            target->size[k] = fmax(i ? target->size[k] : 0.0,
                                   fabs(m[4 * k] * local[i][0]) + fabs(m[4 * k + 1] * local[i][1]) +
                                       fabs(m[4 * k + 2] * local[i][2]) + fabs(m[4 * k + 3]));
        }
    }
}

/* Draws a vertex, a point on an edge, or, where `inside`, also a point inside of the triangle. */
static void draw_target(const struct hard_scene *hard, bool inside, uint64_t *state,
                        struct target *target)
{
    draw_triangle(hard, state, target);
    uint32_t kind = draw(state) % (inside ? 3u : 2u), first = draw(state) % 3u;
    double turned[3][3], s = draw_unit(state), t = draw_unit(state);
    for (uint32_t i = 0; i < 3; ++i)
        memcpy(turned[i], target->corner[(first + i) % 3], sizeof turned[i]);
    if (kind == 0)
        mix(turned, 0.0, 0.0, target->point);
    else if (kind == 1)
        mix(turned, s, 0.0, target->point);
    else
        mix(turned, s * (1.0 - t), t, target->point);
}

/* ---- Rays ---- */

static void set_origin(struct hard_ray *out, const double origin[3])
{
    for (int k = 0; k < 3; ++k)
        out->ray.origin[k] = (float)origin[k];
}

static void set_dir(struct hard_ray *out, const double dir[3])
{
    for (int k = 0; k < 3; ++k)
        out->ray.dir[k] = (float)dir[k];
}

/* Points the ray from its origin, already rounded to float, at `at`. */
static void aim(struct hard_ray *out, const double at[3])
{
    for (int k = 0; k < 3; ++k)
        out->ray.dir[k] = (float)(at[k] - (double)out->ray.origin[k]);
}

/* Gives the origin the target's coordinates on all axes but one, exactly or nearly, as far as it
   stays within reach. */
static void level_origin(const struct hard_scene *hard, const double at[3], uint64_t *state,
                         double origin[3])
{
    int axis = (int)(draw(state) % 3u);
    double nearly = draw(state) % 2u ? 0.0 : 0x1p-20 * draw_signed(state);
    for (int k = 0; k < 3; ++k)
        if (k != axis && fabs(at[k] - hard->middle[k]) < hard->reach[k])
            origin[k] = at[k] + nearly * hard->reach[k];
}

static void make_aimed(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    struct target target;
    double origin[3];
    draw_target(hard, false, state, &target);
    for (int k = 0; k < 3; ++k)
        origin[k] = hard->middle[k] + hard->reach[k] * draw_signed(state);
    if (draw(state) % 4u == 0)
        level_origin(hard, target.point, state, origin);
    set_origin(out, origin);
    aim(out, target.point);
}

/* An origin in the bounds, enlarged by half, or near the target's triangle, which may be small
   among others. */
static void make_around(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    struct target target;
    double origin[3], size = 0.0;
    bool near = draw(state) % 2u;
    draw_target(hard, true, state, &target);
    for (int k = 0; k < 3; ++k)
        for (int i = 1; i < 3; ++i)
            size = fmax(size, fabs(target.corner[i][k] - target.corner[0][k]));
    for (int k = 0; k < 3; ++k) {
        double across = draw_signed(state), half = 0.5 * (hard->pose.hi[k] - hard->pose.lo[k]);
        origin[k] = near ? target.point[k] + 4.0 * size * across
                         : hard->pose.lo[k] + half + 1.5 * half * across;
    }
    if (draw(state) % 4u == 0) {
        uint32_t axis = draw(state) % 3u;
        origin[axis] = target.point[axis];
    }
    set_origin(out, origin);
    aim(out, target.point);
}

static void make_axial(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    struct target target;
    draw_target(hard, false, state, &target);
    uint32_t axis = draw(state) % 3u;
    double origin[3], dir[3], size = hard->pose.hi[axis] - hard->pose.lo[axis];
    for (int k = 0; k < 3; ++k) {
        origin[k] = target.point[k];
        dir[k] = 0.0 * draw_sign(state);
    }
    dir[axis] = draw_sign(state);
    origin[axis] = dir[axis] > 0.0 ? hard->pose.lo[axis] - size : hard->pose.hi[axis] + size;
    set_origin(out, origin);
    set_dir(out, dir);
}

/* A vertical ray through HARD_GRID at multiples of a quarter of its squares. */
static void make_lattice(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    double dir[3], origin[3];
    for (int k = 0; k < 3; ++k)
        dir[k] = (k == 1 ? 1.0 : 0.0) * draw_sign(state);
    for (int k = 0; k < 3; ++k)
        origin[k] = k == 1 ? hard->middle[1] - 1024.0 * dir[1]
                           : hard->middle[k] + 0.25 * draw_whole(state, 31);
    set_origin(out, origin);
    set_dir(out, dir);
}

static void make_cross(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    double origin[3], dir[3], eighth = (hard->pose.hi[0] - hard->pose.lo[0]) / 8.0;
    uint32_t axis = draw(state) % 3u, zeros = draw(state) % 4u;
    for (uint32_t k = 0; k < 3; ++k) {
        origin[k] = hard->middle[k] + 0.25 * eighth * draw_whole(state, 15);
        dir[k] = draw_whole(state, 4);
        bool zero = k != axis && (zeros < 2 || (zeros == 2 && k == (axis + 1) % 3));
        if (zero)
            dir[k] = 0.0 * draw_sign(state);
        else if (k == axis) {
            double sign = draw_sign(state);
            dir[k] = sign * (1.0 + draw_unit(state));
        }
    }
    set_origin(out, origin);
    set_dir(out, dir);
}

/* A point in the triangle's plane, up to `halves` half edges from its first corner. Half an edge is
   exact in floating point where the edge is. */
static void draw_in_plane(struct target *target, uint32_t halves, uint64_t *state, double out[3])
{
    double v = 0.5 * draw_whole(state, halves), u = 0.5 * draw_whole(state, halves);
    mix(target->corner, u, v, out);
}

/* A ray from one point of the triangle's plane to another. */
static void make_flat(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    struct target target;
    double from[3], to[3];
    draw_triangle(hard, state, &target);
    draw_in_plane(&target, 8, state, from);
    draw_in_plane(&target, 2, state, to);
    if (from[0] == to[0] && from[1] == to[1] && from[2] == to[2])
        mix(target.corner, 2.5, 1.0, to);
    set_origin(out, from);
    aim(out, to);
}

static void triangle_normal(double corner[3][3], double out[3])
{
    double first[3], second[3];
    for (int k = 0; k < 3; ++k) {
        first[k] = corner[1][k] - corner[0][k];
        second[k] = corner[2][k] - corner[0][k];
    }
    double3_cross(first, second, out);
    double3_unit(out);
}

static void make_grazing(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    struct target target;
    double n[3], beside[3], origin[3];
    draw_target(hard, true, state, &target);
    triangle_normal(target.corner, n);
    double t = 4.0 * draw_signed(state), s = 4.0 * draw_signed(state);
    mix(target.corner, s, t, beside);
    double along[3], length;
    for (int k = 0; k < 3; ++k)
        along[k] = beside[k] - target.point[k];
    length = sqrt(double3_dot(along, along));
    double sign = draw_sign(state);
    double height = length * sign * power_of_half(4 + draw(state) % 21u);
    for (int k = 0; k < 3; ++k)
        origin[k] = beside[k] + height * n[k];
    set_origin(out, origin);
    aim(out, target.point);
}

static void make_far(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    struct target target;
    double origin[3], away = 1.0 / power_of_half(6 + draw(state) % 7u), size = 0.0;
    draw_target(hard, true, state, &target);
    for (int k = 0; k < 3; ++k)
        size = fmax(size, hard->pose.hi[k] - hard->pose.lo[k]);
    for (int k = 0; k < 3; ++k)
        origin[k] = target.point[k] + size * away * draw_signed(state);
    set_origin(out, origin);
    aim(out, target.point);
}

/* The next float in the direction of `side`, as next_float of shaders/lib/spawn.glsl, except that 0
   is followed by the smallest denormal, which is harder for intersection tests. */
static float step_beyond(float x, float side)
{
    return side == 0.0f ? x : nextafterf(x, side > 0.0f ? INFINITY : -INFINITY);
}

/* A ray that starts as secondary rays do (shaders/bind/surface.glsl, lib/spawn.glsl; Pharr, Jakob
   and Humphreys 2023, section 6.8.6), in world space. With instances the error bound includes the
   rounding of the transform to object space and back. */
static void make_leaving(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out)
{
    struct target target;
    double n[3], dir[3], out_of[3];
    draw_triangle(hard, state, &target);
    triangle_normal(target.corner, n);
    float u = (float)(draw(state) % 257u) / 256.0f, v = (float)(draw(state) % 257u) / 256.0f;
    if (u + v > 1.0f) {
        u = 1.0f - u;
        v = 1.0f - v;
    }
    float w = 1.0f - u - v, carried = hard->accel->single_identity ? 0.0f : 0x1p-20f;
    for (int k = 0; k < 3; ++k)
        out_of[k] = target.corner[0][k] - hard->middle[k];
    double side = hard->truth == HARD_MUST_MISS ? 1.0 : draw_sign(state);
    if (hard->truth == HARD_MUST_MISS && double3_dot(n, out_of) < 0.0)
        side = -1.0;
    float distance = 0.0f, p[3], normal[3];
    for (int k = 0; k < 3; ++k) {
        float p0 = (float)target.corner[0][k] * w, p1 = (float)target.corner[1][k] * u,
              p2 = (float)target.corner[2][k] * v;
        normal[k] = (float)(n[k] * side);
        p[k] = p0 + p1 + p2;
        distance += fabsf(normal[k]) * (0x1.cp-22f * (fabsf(p0) + fabsf(p1) + fabsf(p2)) +
                                        carried * (float)target.size[k]);
        dir[k] = draw_signed(state);
    }
    for (int k = 0; k < 3; ++k)
        out->ray.origin[k] = step_beyond(p[k] + normal[k] * distance, normal[k]);
    if (double3_dot(dir, n) * side < 0.0)
        for (int k = 0; k < 3; ++k)
            dir[k] = -dir[k];
    set_dir(out, dir);
    out->instance = target.instance;
    out->primitive = target.primitive;
}

/* The rays for make_anchors of mesh.c. */
static void make_listed(uint64_t index, struct hard_ray *out)
{
    static const struct gpu_ray listed[] = {
        {{0, 0, 10}, 0.0f, {0.30458447f, 0.30458447f, -0.9024725f}, INFINITY},
        {{-1081.47925f, 99.9999542f, 87.7701111f},
         0.0f,
         {-32.1072998f, -183.355865f, -144.607635f},
         0.9999f},
        {{0, 0, 10}, 0.0f, {0, 0, -1}, INFINITY},
        {{5, 5, 10}, 0.0f, {-0.0f, 0, -1}, INFINITY},
    };
    out->ray = listed[index % (sizeof listed / sizeof *listed)];
}

/* All kinds but HARD_LISTED and HARD_MIXED have a function. */
static const struct {
    const char *name;
    void (*make)(const struct hard_scene *hard, uint64_t *state, struct hard_ray *out);
} kinds[HARD_RAY_KINDS] = {
    [HARD_AROUND] = {"aimed", make_around},
    [HARD_AXIAL] = {"along axes", make_axial},
    [HARD_FLAT] = {"in planes", make_flat},
    [HARD_GRAZING] = {"grazing", make_grazing},
    [HARD_FAR] = {"from far away", make_far},
    [HARD_LEAVING] = {"from the surface", make_leaving},
    [HARD_AIMED] = {"aimed from inside", make_aimed},
    [HARD_LATTICE] = {"upright", make_lattice},
    [HARD_CROSS] = {"axial from inside", make_cross},
    [HARD_LISTED] = {"listed", NULL},
    [HARD_MIXED] = {"all of these", NULL},
};

const char *hard_rays_name(enum hard_rays rays)
{
    return kinds[rays].name;
}

struct hard_ray hard_ray_make(const struct hard_scene *hard, enum hard_rays rays, uint64_t seed,
                              uint64_t index)
{
    struct hard_ray out = {{{0}, 0.0f, {0}, INFINITY}, HIT_NONE, HIT_NONE};
    uint64_t state = (seed << 40) + (index << 5);
    if (rays == HARD_LISTED)
        make_listed(index, &out);
    else
        kinds[rays == HARD_MIXED ? index % HARD_MIXED_KINDS : rays].make(hard, &state, &out);
    return out;
}
