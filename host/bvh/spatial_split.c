/* Spatial splits: chooses a plane, and splits references at it. */
#include <math.h>
#include <string.h>

#include "bvh/clip.h"
#include "bvh/spatial_split.h"

struct bins {
    struct build_box axis[3][SPATIAL_BINS];
    uint32_t starts[3][SPATIAL_BINS], ends[3][SPATIAL_BINS]; /* references that start, end here */
};

struct span {
    int first[3], last[3]; /* bins on each axis */
};

/* ---- Bins of a reference ---- */

/* Nodes of few references have fewer bins: more would take more time than they save. */
static int bins_for(uint32_t count)
{
    return count < 12 ? 4 : count < 48 ? 8 : SPATIAL_BINS;
}

static struct spatial_grid grid_over(const struct build_box *box, uint32_t count)
{
    struct spatial_grid grid = {.origin = box->lo * 0.5f, .bins = bins_for(count)};
    for (int a = 0; a < 3; ++a) {
        float half = 0.5f * box->hi[a] - 0.5f * box->lo[a];
        bool some = half > 1e-35f;
        grid.bins_per_half[a] = some ? (float)grid.bins / half : 0.0f;
        grid.start[a] = box->lo[a];
        grid.width[a] = some ? 2.0f * (half / (float)grid.bins) : 0.0f;
    }
    return grid;
}

static inline f4 grid_position(const struct spatial_grid *grid, f4 x)
{
    f4 position = (x * 0.5f - grid->origin) * grid->bins_per_half;
    return f4_min(position, f4_splat((float)(grid->bins - 1)));
}

/* The bins that a box overlaps. A box that ends on the border of two bins ends in the lower one. A
   reference that must stay whole is in the bin of its centre. */
static inline struct span span_of(const struct spatial_grid *grid, struct build_box box,
                                  uint32_t flags)
{
    if (flags & SPATIAL_WHOLE)
        box.lo = box.hi = box.lo * 0.5f + box.hi * 0.5f;
    f4 end = grid_position(grid, box.hi);
    i4 first = f4_truncate(grid_position(grid, box.lo)), last = f4_truncate(end);
    struct span span;
    for (int a = 0; a < 3; ++a) {
        span.first[a] = first[a];
        span.last[a] = last[a] > first[a] && end[a] == (float)last[a] ? last[a] - 1 : last[a];
    }
    return span;
}

/* ---- Chopping ---- */

/* A triangle prepared to be cut by planes across `axis`; `at`: its coordinates along that axis. */
struct chopped {
    f4 v[3], slope[3]; /* of the edge from v[i] to v[i + 1], per unit along `axis` */
    float at[3];
    uint32_t axis;
};

static struct chopped chopped_make(const struct clip_triangle *triangle, uint32_t axis)
{
    struct chopped c = {.axis = axis};
    for (int i = 0; i < 3; ++i) {
        const float *p = triangle->v[i];
        c.v[i] = (f4){p[0], p[1], p[2], 0.0f};
        c.at[i] = p[axis];
    }
    for (int i = 0; i < 3; ++i) {
        int next = i < 2 ? i + 1 : 0;
        float along = c.at[next] - c.at[i];
        c.slope[i] = (c.v[next] - c.v[i]) * (along != 0.0f ? 1.0f / along : 0.0f);
    }
    return c;
}

/* Adds the points where the triangle's edges cross the plane to *out. */
static inline void chopped_cut(const struct chopped *c, float plane, struct build_box *out)
{
    for (int i = 0; i < 3; ++i) {
        float a = c->at[i], b = c->at[i < 2 ? i + 1 : 0];
        if ((a < plane) == (b < plane))
            continue;
        f4 p = c->v[i] + c->slope[i] * (plane - a);
        *out = build_box_unite(*out, (struct build_box){p, p});
    }
}

/* Grows each of the bins [first, last] of one axis by the part of the reference in it. The boxes
   have rounding errors, since only costs are computed from them. */
static void chop(const struct clip_triangle *triangle, const struct spatial_grid *grid,
                 uint32_t axis, int first, int last, struct build_box box, struct build_box *bins)
{
    struct chopped c = chopped_make(triangle, axis);
    float from = box.lo[axis];
    struct build_box cut = build_box_empty();
    chopped_cut(&c, from, &cut);
    for (int i = first; i <= last; ++i) {
        float to = i < last ? grid->start[axis] + grid->width[axis] * (float)(i + 1) : box.hi[axis];
        struct build_box next = build_box_empty(), part;
        chopped_cut(&c, to, &next);
        part = build_box_unite(cut, next);
        for (int k = 0; k < 3; ++k) {
            if (c.at[k] >= from && c.at[k] <= to)
                part = build_box_unite(part, (struct build_box){c.v[k], c.v[k]});
        }
        part.lo = f4_max(part.lo, box.lo);
        part.hi = f4_min(part.hi, box.hi);
        if ((f4_below(part.hi, part.lo) & 7u) == 0)
            bins[i] = build_box_unite(bins[i], part);
        cut = next;
        from = to;
    }
}

/* ---- The best plane ---- */

static void bins_fill(struct bins *bins, const struct spatial_grid *grid,
                      const struct build_record *records, uint32_t count,
                      const struct bvh_triangles *triangles)
{
    for (int a = 0; a < 3; ++a) {
        for (int i = 0; i < grid->bins; ++i)
            bins->axis[a][i] = build_box_empty();
    }
    memset(bins->starts, 0, sizeof bins->starts);
    memset(bins->ends, 0, sizeof bins->ends);
    for (uint32_t i = 0; i < count; ++i) {
        struct build_box box = build_record_box(&records[i]);
        struct span span = span_of(grid, box, records[i].flags);
        for (uint32_t a = 0; a < 3; ++a) {
            struct build_box *bin = &bins->axis[a][span.first[a]];
            ++bins->starts[a][span.first[a]];
            ++bins->ends[a][span.last[a]];
            if (span.first[a] == span.last[a]) {
                *bin = build_box_unite(*bin, box);
                continue;
            }
            struct clip_triangle triangle = clip_fetch(triangles, records[i].primitive);
            chop(&triangle, grid, a, span.first[a], span.last[a], box, bins->axis[a]);
        }
    }
}

static void sweep_axis(const struct bins *bins, uint32_t axis, const struct build_range *range,
                       struct spatial_plane *best)
{
    const struct build_box *bin = bins->axis[axis];
    struct build_box right[SPATIAL_BINS], left = bin[0];
    int last = best->grid.bins - 1;
    right[last] = bin[last];
    for (int i = last - 1; i > 0; --i)
        right[i] = build_box_unite(bin[i], right[i + 1]);
    uint32_t started = 0, ended = 0;
    for (int i = 1; i <= last; ++i) {
        started += bins->starts[axis][i - 1];
        ended += bins->ends[axis][i - 1];
        uint32_t rest = range->count - ended;
        if (started > 0 && rest > 0 && started + rest <= range->count + range->spare) {
            float cost = build_area(left, best->scale) * (float)started +
                         build_area(right[i], best->scale) * (float)rest;
            if (cost < best->cost) {
                best->axis = axis;
                best->bin = (uint32_t)i;
                best->cost = cost;
                best->count[0] = started, best->count[1] = rest;
                best->side[0] = left, best->side[1] = right[i];
            }
        }
        left = build_box_unite(left, bin[i]);
    }
}

bool spatial_find(const struct build_record *records, const struct build_range *range,
                  const struct bvh_triangles *triangles, f4 scale, struct spatial_plane *plane)
{
    struct bins bins;
    const struct spatial_grid *grid = &plane->grid;
    plane->grid = grid_over(&range->bounds.box, range->count);
    plane->cost = INFINITY;
    plane->scale = scale;
    bins_fill(&bins, grid, records, range->count, triangles);
    for (uint32_t axis = 0; axis < 3; ++axis) {
        if (grid->width[axis] > 0.0f)
            sweep_axis(&bins, axis, range, plane);
    }
    if (!(plane->cost < INFINITY))
        return false;
    plane->at = grid->start[plane->axis] + grid->width[plane->axis] * (float)plane->bin;
    return true;
}

/* ---- Splitting ---- */

enum side { SIDE_LEFT = 1, SIDE_RIGHT = 2, SIDE_BOTH = 3 };

/* Which halves a reference goes to (reference unsplitting, Stich et al. 2009, 4.4). It uses the
   counts and boxes that the plane was chosen for: so the order of references does not matter. */
static enum side side_of(const struct spatial_plane *plane, const struct build_record *record)
{
    const struct build_box *side = plane->side, box = build_record_box(record);
    struct span span = span_of(&plane->grid, box, record->flags);
    if (span.last[plane->axis] < (int)plane->bin)
        return SIDE_LEFT;
    if (span.first[plane->axis] >= (int)plane->bin)
        return SIDE_RIGHT;
    float left = build_area(side[0], plane->scale), right = build_area(side[1], plane->scale);
    float left_whole = build_area(build_box_unite(side[0], box), plane->scale);
    float right_whole = build_area(build_box_unite(side[1], box), plane->scale);
    float left_count = (float)plane->count[0], right_count = (float)plane->count[1];
    float both_cost = left * left_count + right * right_count;
    float left_cost = left_whole * left_count + right * (right_count - 1.0f);
    float right_cost = left * (left_count - 1.0f) + right_whole * right_count;
    if (both_cost <= left_cost && both_cost <= right_cost)
        return SIDE_BOTH;
    return left_cost <= right_cost ? SIDE_LEFT : SIDE_RIGHT;
}

/* The part of a reference below or above the plane; false: nothing of it is there. */
static bool record_half(const struct build_record *record, const struct spatial_plane *plane,
                        bool above, const struct bvh_triangles *triangles, struct build_record *out)
{
    struct clip_triangle triangle = clip_fetch(triangles, record->primitive);
    struct bvh_box cell, part;
    memcpy(cell.lo, record->lo, sizeof cell.lo);
    memcpy(cell.hi, record->hi, sizeof cell.hi);
    float *bound = above ? &cell.lo[plane->axis] : &cell.hi[plane->axis];
    *bound = above ? fmaxf(*bound, plane->at) : fminf(*bound, plane->at);
    if (!(cell.lo[plane->axis] <= cell.hi[plane->axis]) ||
        !clip_triangle_box(&triangle, &cell, &part))
        return false;
    *out = *record;
    out->flags |= SPATIAL_PART;
    memcpy(out->lo, part.lo, sizeof out->lo);
    memcpy(out->hi, part.hi, sizeof out->hi);
    return true;
}

static bool halves_filled(const struct build_record *records, uint32_t count,
                          const struct spatial_plane *plane)
{
    uint32_t left = 0, right = 0;
    for (uint32_t i = 0; i < count && !(left && right); ++i) {
        enum side side = side_of(plane, &records[i]);
        left += (side & SIDE_LEFT) != 0;
        right += (side & SIDE_RIGHT) != 0;
    }
    return left && right;
}

bool spatial_apply(struct build_record *records, const struct build_range *range,
                   const struct spatial_plane *plane, const struct bvh_triangles *triangles,
                   struct build_halves *halves)
{
    if (!halves_filled(records, range->count, plane))
        return false;
    struct build_bounds *bounds = halves->bounds;
    bounds[0] = bounds[1] = build_bounds_empty();
    uint32_t i = 0, j = range->count, end = range->count;
    while (i < j) {
        enum side side = side_of(plane, &records[i]);
        struct build_record low, high;
        if (side == SIDE_BOTH) {
            bool has_low = record_half(&records[i], plane, false, triangles, &low);
            bool has_high = record_half(&records[i], plane, true, triangles, &high);
            /* A triangle with an empty part on one side, by rounding, goes whole to the other. */
            if (!has_high || (has_low && end == range->count + range->spare))
                side = SIDE_LEFT;
            else if (!has_low)
                side = SIDE_RIGHT;
        }
        if (side == SIDE_BOTH) {
            records[i] = low;
            records[end++] = high;
            build_bounds_add(&bounds[1], build_record_box(&high));
        }
        if (side & SIDE_LEFT) {
            build_bounds_add(&bounds[0], build_record_box(&records[i++]));
        } else {
            build_bounds_add(&bounds[1], build_record_box(&records[i]));
            build_records_swap(&records[i], &records[--j]);
        }
    }
    halves->count[0] = j;
    halves->count[1] = end - j;
    return j > 0 && end > j;
}
