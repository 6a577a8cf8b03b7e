/* Planes that split references: the choice of one, and what it does to them. */
#include <math.h>
#include <string.h>

#include "bvh/clip.h"
#include "bvh/spatial.h"

struct bin {
    f4 lo, hi;
};

struct bins {
    struct bin axis[3][SPATIAL_BINS];
    uint32_t starts[3][SPATIAL_BINS], ends[3][SPATIAL_BINS]; /* references that start, end here */
};

/* Bin of a coordinate: (x / 2 - origin) * bins_per_half, so that no extent overflows. */
struct grid {
    f4 origin, bins_per_half;
    float start[3], width[3]; /* of bins; 0: the axis has one */
    int bins;
};

struct span {
    int first[3], last[3]; /* bins */
};

static inline void bin_add(struct bin *bin, f4 lo, f4 hi)
{
    bin->lo = f4_min(bin->lo, lo);
    bin->hi = f4_max(bin->hi, hi);
}

/* ---- Bins of a reference ---- */

/* Few references are cut into fewer bins: more would cost more than they find. */
static int bins_for(uint32_t count)
{
    return count < 12 ? 4 : count < 48 ? 8 : SPATIAL_BINS;
}

static struct grid grid_over(const struct build_bounds *bounds, uint32_t count)
{
    alignas(16) float lo[4], hi[4], scale[4] = {0};
    f4_store(lo, bounds->lo);
    f4_store(hi, bounds->hi);
    struct grid grid = {.origin = f4_mul(bounds->lo, f4_splat(0.5f)), .bins = bins_for(count)};
    for (int a = 0; a < 3; ++a) {
        float half = 0.5f * hi[a] - 0.5f * lo[a];
        bool some = half > 1e-35f;
        scale[a] = some ? (float)grid.bins / half : 0.0f;
        grid.start[a] = lo[a];
        grid.width[a] = some ? 2.0f * (half / (float)grid.bins) : 0.0f;
    }
    grid.bins_per_half = f4_load(scale);
    return grid;
}

static inline f4 grid_position(f4 origin, f4 bins_per_half, f4 last, f4 x)
{
    f4 position = f4_mul(f4_sub(f4_mul(x, f4_splat(0.5f)), origin), bins_per_half);
    return f4_min(position, last);
}

/* What ends on the border of two bins is in the lower one. References that must stay whole are
   where their centre is. */
static inline struct span span_of(f4 origin, f4 bins_per_half, f4 last_bin, f4 lo, f4 hi,
                                  uint32_t flags)
{
    if (flags & SPATIAL_WHOLE) {
        lo = hi = f4_add(f4_mul(lo, f4_splat(0.5f)), f4_mul(hi, f4_splat(0.5f)));
    }
    alignas(16) int first[4], last[4];
    alignas(16) float end[4];
    f4 at = grid_position(origin, bins_per_half, last_bin, hi);
    f4_truncate(grid_position(origin, bins_per_half, last_bin, lo), first);
    f4_truncate(at, last);
    f4_store(end, at);
    struct span span;
    for (int a = 0; a < 3; ++a) {
        span.first[a] = first[a];
        span.last[a] = last[a] > first[a] && end[a] == (float)last[a] ? last[a] - 1 : last[a];
    }
    return span;
}

/* ---- Chopping ---- */

/* A triangle whose coordinates along `axis` are apart from the rest. */
struct chopped {
    f4 v[3], slope[3]; /* of the edge from v[i] to v[i + 1], by the coordinate */
    float at[3];
    uint32_t axis;
};

static struct chopped chopped_make(const struct clip_triangle *triangle, uint32_t axis)
{
    struct chopped c = {.axis = axis};
    for (int i = 0; i < 3; ++i) {
        const float *p = triangle->v[i];
        c.v[i] = f4_set(p[0], p[1], p[2], 0.0f);
        c.at[i] = p[axis];
    }
    for (int i = 0; i < 3; ++i) {
        int next = i < 2 ? i + 1 : 0;
        float along = c.at[next] - c.at[i];
        c.slope[i] = f4_mul(f4_sub(c.v[next], c.v[i]), f4_splat(along != 0.0f ? 1.0f / along : 0));
    }
    return c;
}

/* Where the triangle's border passes the plane. */
static inline void chopped_cut(const struct chopped *c, float plane, struct bin *out)
{
    for (int i = 0; i < 3; ++i) {
        float a = c->at[i], b = c->at[i < 2 ? i + 1 : 0];
        if ((a < plane) == (b < plane))
            continue;
        f4 p = f4_add(c->v[i], f4_mul(c->slope[i], f4_splat(plane - a)));
        bin_add(out, p, p);
    }
}

/* Grows bins [first, last] of one axis by what each holds of the reference. Good to a rounding:
   only costs come of it. */
static void chop(const struct clip_triangle *triangle, const struct grid *grid, uint32_t axis,
                 int first, int last, f4 lo, f4 hi, struct bin *bins)
{
    const struct build_bounds empty = build_bounds_empty();
    struct chopped c = chopped_make(triangle, axis);
    alignas(16) float ends[2][4];
    f4_store(ends[0], lo);
    f4_store(ends[1], hi);
    float from = ends[0][axis];
    struct bin cut = {empty.lo, empty.hi};
    chopped_cut(&c, from, &cut);
    for (int i = first; i <= last; ++i) {
        float to =
            i < last ? grid->start[axis] + grid->width[axis] * (float)(i + 1) : ends[1][axis];
        struct bin next = {empty.lo, empty.hi}, part = cut;
        chopped_cut(&c, to, &next);
        bin_add(&part, next.lo, next.hi);
        for (int k = 0; k < 3; ++k) {
            if (c.at[k] >= from && c.at[k] <= to)
                bin_add(&part, c.v[k], c.v[k]);
        }
        part.lo = f4_max(part.lo, lo);
        part.hi = f4_min(part.hi, hi);
        if ((f4_below(part.hi, part.lo) & 7u) == 0)
            bin_add(&bins[i], part.lo, part.hi);
        cut = next;
        from = to;
    }
}

/* ---- The best plane ---- */

static void bins_fill(struct bins *bins, const struct grid *grid,
                      const struct build_record *records, uint32_t count,
                      const struct bvh_triangles *triangles)
{
    const struct build_bounds empty = build_bounds_empty();
    for (int a = 0; a < 3; ++a) {
        for (int i = 0; i < grid->bins; ++i)
            bins->axis[a][i] = (struct bin){empty.lo, empty.hi};
    }
    memset(bins->starts, 0, sizeof bins->starts);
    memset(bins->ends, 0, sizeof bins->ends);
    f4 last = f4_splat((float)(grid->bins - 1));
    for (uint32_t i = 0; i < count; ++i) {
        f4 lo = build_record_lo(&records[i]), hi = build_record_hi(&records[i]);
        struct span span = span_of(grid->origin, grid->bins_per_half, last, lo, hi, records[i].pad);
        for (uint32_t a = 0; a < 3; ++a) {
            ++bins->starts[a][span.first[a]];
            ++bins->ends[a][span.last[a]];
            if (span.first[a] == span.last[a]) {
                bin_add(&bins->axis[a][span.first[a]], lo, hi);
                continue;
            }
            struct clip_triangle triangle = clip_fetch(triangles, records[i].primitive);
            chop(&triangle, grid, a, span.first[a], span.last[a], lo, hi, bins->axis[a]);
        }
    }
}

static void sweep_axis(const struct bins *bins, int bin_count, uint32_t axis, uint32_t count,
                       uint32_t spare, f4 scale, struct spatial_plane *best)
{
    const struct bin *bin = bins->axis[axis];
    struct bin right[SPATIAL_BINS], left = bin[0];
    right[bin_count - 1] = bin[bin_count - 1];
    for (int i = bin_count - 2; i > 0; --i) {
        right[i] = bin[i];
        bin_add(&right[i], right[i + 1].lo, right[i + 1].hi);
    }
    uint32_t started = 0, ended = 0;
    for (int i = 1; i < bin_count; ++i) {
        started += bins->starts[axis][i - 1];
        ended += bins->ends[axis][i - 1];
        uint32_t rest = count - ended;
        if (started > 0 && rest > 0 && started + rest <= count + spare) {
            float cost = build_scaled_area(left.lo, left.hi, scale) * (float)started +
                         build_scaled_area(right[i].lo, right[i].hi, scale) * (float)rest;
            if (cost < best->cost) {
                best->axis = axis;
                best->bin = (uint32_t)i;
                best->cost = cost;
                best->left_count = started;
                best->right_count = rest;
                best->left_lo = left.lo, best->left_hi = left.hi;
                best->right_lo = right[i].lo, best->right_hi = right[i].hi;
            }
        }
        bin_add(&left, bin[i].lo, bin[i].hi);
    }
}

bool spatial_find(const struct build_record *records, const struct build_bounds *bounds,
                  uint32_t count, uint32_t spare, const struct bvh_triangles *triangles, f4 scale,
                  struct spatial_plane *plane)
{
    struct grid grid = grid_over(bounds, count);
    struct bins bins;
    bins_fill(&bins, &grid, records, count, triangles);
    plane->cost = INFINITY;
    plane->scale = scale;
    plane->origin = grid.origin;
    plane->bins_per_half = grid.bins_per_half;
    plane->last_bin = f4_splat((float)(grid.bins - 1));
    for (uint32_t axis = 0; axis < 3; ++axis) {
        if (grid.width[axis] > 0.0f)
            sweep_axis(&bins, grid.bins, axis, count, spare, plane->scale, plane);
    }
    if (!(plane->cost < INFINITY))
        return false;
    plane->at = grid.start[plane->axis] + grid.width[plane->axis] * (float)plane->bin;
    return true;
}

/* ---- Splitting ---- */

enum side { SIDE_LEFT = 1, SIDE_RIGHT = 2, SIDE_BOTH = 3 };

/* Stich et al. 2009, 4.4, with the counts and boxes that the plane was chosen for: so the order of
   references does not matter. */
static enum side side_of(const struct spatial_plane *plane, const struct build_record *record)
{
    f4 lo = build_record_lo(record), hi = build_record_hi(record);
    struct span span =
        span_of(plane->origin, plane->bins_per_half, plane->last_bin, lo, hi, record->pad);
    if (span.last[plane->axis] < (int)plane->bin)
        return SIDE_LEFT;
    if (span.first[plane->axis] >= (int)plane->bin)
        return SIDE_RIGHT;
    float left = build_scaled_area(plane->left_lo, plane->left_hi, plane->scale);
    float right = build_scaled_area(plane->right_lo, plane->right_hi, plane->scale);
    float left_whole =
        build_scaled_area(f4_min(plane->left_lo, lo), f4_max(plane->left_hi, hi), plane->scale);
    float right_whole =
        build_scaled_area(f4_min(plane->right_lo, lo), f4_max(plane->right_hi, hi), plane->scale);
    float left_count = (float)plane->left_count, right_count = (float)plane->right_count;
    float both_cost = left * left_count + right * right_count;
    float left_cost = left_whole * left_count + right * (right_count - 1.0f);
    float right_cost = left * (left_count - 1.0f) + right_whole * right_count;
    if (both_cost <= left_cost && both_cost <= right_cost)
        return SIDE_BOTH;
    return left_cost <= right_cost ? SIDE_LEFT : SIDE_RIGHT;
}

/* The half of a reference below or above the plane; false: there is none. */
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
    out->pad |= SPATIAL_PART;
    memcpy(out->lo, part.lo, sizeof out->lo);
    memcpy(out->hi, part.hi, sizeof out->hi);
    return true;
}

static inline void half_add(struct build_bounds *half, const struct build_record *record)
{
    build_bounds_add(half, build_record_lo(record), build_record_hi(record));
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

bool spatial_apply(struct build_record *records, uint32_t count, uint32_t spare,
                   const struct spatial_plane *plane, const struct bvh_triangles *triangles,
                   uint32_t *left_count, uint32_t *right_count, struct build_bounds halves[2])
{
    if (!halves_filled(records, count, plane))
        return false;
    halves[0] = halves[1] = build_bounds_empty();
    uint32_t i = 0, j = count, end = count;
    while (i < j) {
        enum side side = side_of(plane, &records[i]);
        struct build_record low, high;
        if (side == SIDE_BOTH) {
            bool has_low = record_half(&records[i], plane, false, triangles, &low);
            bool has_high = record_half(&records[i], plane, true, triangles, &high);
            /* What rounding leaves nothing of on one side is whole on the other. */
            if (!has_high || (has_low && end == count + spare))
                side = SIDE_LEFT;
            else if (!has_low)
                side = SIDE_RIGHT;
        }
        if (side == SIDE_BOTH) {
            records[i] = low;
            records[end++] = high;
            half_add(&halves[1], &high);
        }
        if (side & SIDE_LEFT) {
            half_add(&halves[0], &records[i++]);
        } else {
            half_add(&halves[1], &records[i]);
            struct build_record moved = records[--j];
            records[j] = records[i];
            records[i] = moved;
        }
    }
    *left_count = j;
    *right_count = end - j;
    return j > 0 && end > j;
}
