/* Finds the small part of a scene that a picture should show: what stands on a wide floor, or in
   the middle of a sky or a backdrop. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/vec.h"
#include "scene/soup.h"

#define BINS      1024
#define TAIL      0.025 /* share of triangles that a core leaves out at either end of an axis */
#define PART      0.25  /* largest size of a part, in diagonals of the scene */
#define FLAT      1e-5f /* heights of a level floor differ by no more */
#define FLOOR     0.5   /* share of the ground that a floor covers at least */
#define SLAB      0.02  /* largest thickness of a floor, in radii of the scene */
#define SKY       0.4   /* share of all directions that a sky covers at least */
#define SKY_FAR   0.5   /* least radius of a sky, in radii of the scene */
#define SKY_LEAST 48    /* triangles of a round sky */
#define SIDE      0.9   /* share of each side of the scene's box that a box of sky covers */
#define ROUND     0.85 /* distance of its nearest corner from its middle, in that of the farthest */
#define SCRAPS    0.01 /* what is outside of a part may have this area, in squared diagonals, */
#define MARGIN    0.15 /* or it surrounds the part, with this share of its width on each side, */
#define FACING    0.8  /* or this share of its area faces the part */
#define DIAGONAL  2.0  /* of the scene, in the space of a soup */

#define SIDES     6

/* aside: 1 for triangles of floor and sky; `counted`: how many others there are. */
struct narrowing {
    const struct soup *soup;
    uint8_t *aside;
    uint32_t counted;
};

struct part {
    double lo[3], hi[3];
};

static uint32_t bin_of(float place)
{
    return (uint32_t)fminf(fmaxf(0.5f * BINS * (1.0f + place), 0.0f), BINS - 1);
}

static void put_aside(struct narrowing *n, size_t triangle)
{
    n->counted -= !n->aside[triangle];
    n->aside[triangle] = 1;
}

/* --- floor and sky -------------------------------------------------------------------------- */

/* Level triangles whose heights fall in one bin: their area, and the height of the largest. */
struct level {
    double area, largest;
    float height;
};

static void add_to_level(const float *p, struct level *levels)
{
    float lo = fminf(fminf(p[1], p[4]), p[7]), hi = fmaxf(fmaxf(p[1], p[4]), p[7]);
    if (hi - lo > FLAT)
        return;
    struct level *level = &levels[bin_of(lo)];
    double area = 0.5 * fabs((double)(p[3] - p[0]) * (double)(p[8] - p[2]) -
                             (double)(p[6] - p[0]) * (double)(p[5] - p[2]));
    level->area += area;
    if (area > level->largest) {
        level->largest = area;
        level->height = lo;
    }
}

/* Puts the floor aside: all between the lowest level that covers enough of the ground and another
   one just above it, as of a slab. */
static void put_floor_aside(struct narrowing *n)
{
    struct level levels[BINS] = {0};
    const struct soup *soup = n->soup;
    double enough = FLOOR * 4.0 * soup->half[0] * soup->half[2];
    uint32_t low = 0;
    for (size_t t = 0; t < soup->count; ++t) {
        if (!n->aside[t])
            add_to_level(soup->corners + 9 * t, levels);
    }
    while (low < BINS && !(levels[low].area >= enough))
        ++low;
    if (low == BINS)
        return;
    float lo = levels[low].height - FLAT, hi = levels[low].height + FLAT;
    for (uint32_t i = low; i < BINS && i <= low + (uint32_t)(SLAB * 0.5 * BINS); ++i) {
        if (levels[i].area >= enough)
            hi = levels[i].height + FLAT;
    }
    for (size_t t = 0; t < soup->count; ++t) {
        const float *p = soup->corners + 9 * t;
        if (fminf(fminf(p[1], p[4]), p[7]) >= lo && fmaxf(fmaxf(p[1], p[4]), p[7]) <= hi)
            put_aside(n, t);
    }
}

static double distance_to(const float *corner, const double from[3])
{
    return double3_distance((double[]){(double)corner[0], (double)corner[1], (double)corner[2]},
                            from);
}

/* The solid angle, roughly, under which a triangle is seen from a point. */
static double angle_from(const float *corners, const double from[3])
{
    double p[3][3], edges[2][3], normal[3], away[3];
    for (int i = 0; i < 9; ++i)
        p[i / 3][i % 3] = (double)corners[i];
    for (int k = 0; k < 3; ++k)
        away[k] = (p[0][k] + p[1][k] + p[2][k]) / 3.0 - from[k];
    double3_sub(p[1], p[0], edges[0]);
    double3_sub(p[2], p[0], edges[1]);
    double3_cross(edges[0], edges[1], normal);
    double distance = double3_length(away);
    return 0.5 * fabs(double3_dot(normal, away)) / (distance * distance * distance);
}

static bool is_beyond(const float *corners, const double from[3], double distance)
{
    return distance_to(corners, from) >= distance && distance_to(corners + 3, from) >= distance &&
           distance_to(corners + 6, from) >= distance;
}

/* Puts a sky aside, whose corners are all about as far from the middle: a sphere or a half of one.
   False: there is none around this middle. */
static bool put_sky_aside(struct narrowing *n, const double middle[3])
{
    const struct soup *soup = n->soup;
    double farthest = 0.0, covered = 0.0;
    uint32_t count = 0;
    for (size_t i = 0; i < 3 * (size_t)soup->count; ++i) {
        if (!n->aside[i / 3])
            farthest = fmax(farthest, distance_to(soup->corners + 3 * i, middle));
    }
    for (size_t t = 0; farthest >= SKY_FAR && t < soup->count; ++t) {
        const float *p = soup->corners + 9 * t;
        bool beyond = is_beyond(p, middle, ROUND * farthest);
        count += beyond && !n->aside[t];
        covered += beyond && !n->aside[t] ? angle_from(p, middle) : 0.0;
    }
    bool found = covered >= SKY * 4.0 * PI && count >= SKY_LEAST;
    for (size_t t = 0; found && t < soup->count; ++t) {
        if (is_beyond(soup->corners + 9 * t, middle, ROUND * farthest))
            put_aside(n, t);
    }
    return found;
}

/* The area of a triangle, and whether its front faces a point. */
static double area_facing(const float *corners, const double point[3], bool *facing)
{
    double edges[2][3], way[3], normal[3];
    for (int i = 0; i < 6; ++i)
        edges[i / 3][i % 3] = (double)corners[3 + i] - (double)corners[i % 3];
    for (int k = 0; k < 3; ++k)
        way[k] = point[k] - (double)corners[k];
    double3_cross(edges[0], edges[1], normal);
    *facing = double3_dot(normal, way) > 0.0;
    return 0.5 * double3_length(normal);
}

/* The side of the scene's box that a triangle lies in; SIDES: in none. */
static int side_of(const struct soup *soup, const float *p)
{
    for (int side = 0; side < SIDES; ++side) {
        int k = side / 2;
        double at = side % 2 ? soup->half[k] : -soup->half[k];
        if (fmax(fmax(fabs((double)p[k] - at), fabs((double)p[k + 3] - at)),
                 fabs((double)p[k + 6] - at)) <= (double)FLAT)
            return side;
    }
    return SIDES;
}

/* Puts the sides of the scene's box aside if all six are there and face inwards. */
static bool put_box_aside(struct narrowing *n)
{
    const struct soup *soup = n->soup;
    const double *half = soup->half, middle[3] = {0};
    double areas[SIDES + 1] = {0};
    bool all = true, facing;
    for (size_t t = 0; t < soup->count; ++t) {
        double area = area_facing(soup->corners + 9 * t, middle, &facing);
        areas[side_of(soup, soup->corners + 9 * t)] += facing ? area : 0.0;
    }
    for (int side = 0; side < SIDES; ++side)
        all =
            all && areas[side] >= SIDE * 4.0 * half[(side / 2 + 1) % 3] * half[(side / 2 + 2) % 3];
    for (size_t t = 0; all && t < soup->count; ++t) {
        if (side_of(soup, soup->corners + 9 * t) < SIDES)
            put_aside(n, t);
    }
    return all;
}

/* --- the part ------------------------------------------------------------------------------- */

static double size_of(const struct part *part)
{
    double size[3];
    for (int k = 0; k < 3; ++k)
        size[k] = fmax(part->hi[k] - part->lo[k], 0.0);
    return double3_length(size);
}

/* Sets the core's interval along an axis: it holds the centroids of all triangles but the share
   TAIL of them at either end. */
static void find_core(const struct narrowing *n, int axis, struct part *core)
{
    uint32_t bins[BINS] = {0}, below = 0, tail = (uint32_t)(TAIL * n->counted), bin = 0;
    for (size_t t = 0; t < n->soup->count; ++t) {
        const float *p = n->soup->corners + 9 * t + axis;
        bins[bin_of((p[0] + p[3] + p[6]) / 3.0f)] += !n->aside[t];
    }
    while (below + bins[bin] <= tail)
        below += bins[bin++];
    core->lo[axis] = 2.0 * bin / BINS - 1.0;
    for (bin = BINS, below = 0; below + bins[bin - 1] <= tail; --bin)
        below += bins[bin - 1];
    core->hi[axis] = 2.0 * bin / BINS - 1.0;
}

static void grow(struct part *part, const float *corners)
{
    for (int i = 0; i < 9; i += 3)
        double3_grow_box(
            part->lo, part->hi,
            (double[]){(double)corners[i], (double)corners[i + 1], (double)corners[i + 2]});
}

static bool is_in(const float *corners, const struct part *part)
{
    bool in = true;
    for (int i = 0; i < 9; ++i)
        in = in && (double)corners[i] >= part->lo[i % 3] && (double)corners[i] <= part->hi[i % 3];
    return in;
}

/* Whether all that is not aside is far from the sides of the scene's box, as things in a room,
   which stand on its floor, are not. */
static bool hovers(const struct narrowing *n)
{
    struct part middle;
    bool all = true;
    for (int k = 0; k < 3; ++k)
        middle.hi[k] = (1.0 - 2.0 * MARGIN) * n->soup->half[k], middle.lo[k] = -middle.hi[k];
    for (size_t t = 0; all && t < n->soup->count; ++t)
        all = n->aside[t] || is_in(n->soup->corners + 9 * t, &middle);
    return all;
}

/* The box of all triangles whose corners are in the core, or outside of it by no more than `around`
   along each axis. *count: how many there are. */
static struct part find_box(const struct narrowing *n, struct part core, double around,
                            uint32_t *count)
{
    struct part part;
    double3_no_box(part.lo, part.hi);
    for (int k = 0; k < 3; ++k) {
        core.lo[k] -= around;
        core.hi[k] += around;
    }
    *count = 0;
    for (size_t t = 0; t < n->soup->count; ++t) {
        const float *p = n->soup->corners + 9 * t;
        if (n->aside[t] || !is_in(p, &core))
            continue;
        ++*count;
        grow(&part, p);
    }
    return part;
}

/* Sums over the triangles outside of the part, floor and sky aside: their box, their area, and the
   area of those whose front faces the part. */
struct rest {
    struct part box;
    double area, facing;
};

static void add_to_rest(const float *corners, const double toward[3], struct rest *rest)
{
    bool facing;
    double area = area_facing(corners, toward, &facing);
    rest->area += area;
    rest->facing += facing ? area : 0.0;
    grow(&rest->box, corners);
}

/* Whether a picture of the part alone shows what matters: the rest is little, as strays are, or it
   is a backdrop, around the part or behind it. A house with a door knob of many triangles is more
   than the knob. */
static bool stands_for_all(const struct narrowing *n, const struct part *part)
{
    struct rest rest = {.area = 0.0};
    double middle[3];
    bool surrounds = true;
    double3_no_box(rest.box.lo, rest.box.hi);
    for (int k = 0; k < 3; ++k)
        middle[k] = 0.5 * (part->lo[k] + part->hi[k]);
    for (size_t t = 0; t < n->soup->count; ++t) {
        const float *p = n->soup->corners + 9 * t;
        if (!n->aside[t] && !is_in(p, part))
            add_to_rest(p, middle, &rest);
    }
    for (int k = 0; k < 3; k += 2) {
        double margin = MARGIN * (rest.box.hi[k] - rest.box.lo[k]);
        surrounds =
            surrounds && middle[k] - rest.box.lo[k] > margin && rest.box.hi[k] - middle[k] > margin;
    }
    return surrounds || rest.facing >= FACING * rest.area ||
           rest.area <= SCRAPS * DIAGONAL * DIAGONAL;
}

static bool is_small(const struct part *part)
{
    return size_of(part) > 0.0 && size_of(part) <= PART * DIAGONAL;
}

/* The part that all triangles but floor and sky are in, or nearly all of them. Long triangles, as
   those of a cone, reach farther beyond the core, which is one of centroids. False: there is no
   such part that is small. */
static bool find_part(const struct narrowing *n, struct part *part)
{
    struct part core = {{-1, -1, -1}, {1, 1, 1}};
    uint32_t count = 0;
    *part = find_box(n, core, FLAT, &count);
    if (is_small(part))
        return true;
    for (int k = 0; k < 3; ++k)
        find_core(n, k, &core);
    for (double reach = 0.5; reach <= 4.0; reach *= 2.0) {
        *part = find_box(n, core, reach * size_of(&core), &count);
        if (count >= (1.0 - 6.0 * TAIL) * n->counted)
            return is_small(part) && stands_for_all(n, part);
    }
    return false;
}

/* Appends to `narrow` the triangles of the part, or (`in` false) the others. */
static void take_run(const struct narrowing *n, const struct part *part, bool in,
                     struct soup *narrow)
{
    for (size_t t = 0; t < n->soup->count; ++t) {
        const float *p = n->soup->corners + 9 * t;
        if ((is_in(p, part) && !n->aside[t]) != in)
            continue;
        narrow->pictured[narrow->count] = n->soup->pictured[t];
        float *out = narrow->corners + 9 * (size_t)narrow->count++;
        for (int i = 0; i < 9; ++i)
            out[i] = (float)(((double)p[i] - narrow->centre[i % 3]) / narrow->radius);
    }
}

static whit_result take_part(const struct narrowing *n, const struct part *part,
                             struct soup *narrow)
{
    const struct soup *soup = n->soup;
    narrow->corners = array_alloc(soup->count, 9 * sizeof *narrow->corners);
    narrow->pictured = array_alloc(soup->count, sizeof *narrow->pictured);
    if (!narrow->corners || !narrow->pictured) {
        soup_finish(narrow);
        *narrow = (struct soup){0};
        return WHIT_ERROR_MEMORY;
    }
    soup_measure(part->lo, part->hi, narrow);
    take_run(n, part, true, narrow);
    narrow->fit_count = narrow->count;
    take_run(n, part, false, narrow);
    narrow->whole = true;
    for (int k = 0; k < 3; ++k)
        narrow->centre[k] = soup->centre[k] + soup->radius * narrow->centre[k];
    narrow->radius *= soup->radius;
    soup_find_outline(narrow);
    return WHIT_OK;
}

whit_result soup_narrow(const struct soup *soup, struct soup *narrow)
{
    struct part part;
    *narrow = (struct soup){0};
    if (!soup->whole || !soup->count || soup->fit_count != soup->count)
        return WHIT_OK;
    struct narrowing n = {soup, array_alloc_zeroed(soup->count, 1), soup->count};
    if (!n.aside)
        return WHIT_ERROR_MEMORY;
    bool boxed = put_box_aside(&n);
    put_floor_aside(&n);
    if (boxed && !hovers(&n)) {
        boxed = false;
        memset(n.aside, 0, soup->count);
        n.counted = soup->count;
        put_floor_aside(&n);
    }
    bool under_sky = boxed || put_sky_aside(&n, (const double[]){0, 0, 0}) ||
                     put_sky_aside(&n, (const double[]){0, -soup->half[1], 0});
    bool found = n.counted > 0 && find_part(&n, &part);
    whit_result result = found ? take_part(&n, &part, narrow) : WHIT_OK;
    narrow->under_sky = under_sky;
    narrow->in_box = boxed;
    free(n.aside);
    return result;
}
