/* Whole subtrees over so few boxes that bins would cost more than the boxes in them: surface area
   heuristic over every position. Sorted once; the three axes are the lanes of one sweep. Most nodes
   of a tree are made here. */
#include "accel/build.h"

struct small_range {
    f4 lo, hi;
    uint32_t node, pair, first, count, depth; /* `first` counts from the range's first record */
};

struct cut {
    uint32_t axis, left_count;
    float cost;
};

/* For each axis the union of the boxes met so far along it. */
struct sides {
    f4 lo[3], hi[3];
};

void small_sort(struct small *small, uint32_t count)
{
    f4 one = f4_splat(1.0f);
    for (uint32_t i = 0; i < count; ++i) {
        f4 own = f4_load(small->centroid[i]), rank = f4_splat(0.0f);
        for (uint32_t j = 0; j < i; ++j) /* not above: before */
            rank = f4_add(
                rank, f4_select(f4_less(own, f4_load(small->centroid[j])), f4_splat(0.0f), one));
        for (uint32_t j = i + 1; j < count; ++j)
            rank = f4_add(
                rank, f4_select(f4_less(f4_load(small->centroid[j]), own), one, f4_splat(0.0f)));
        alignas(16) int at[4];
        f4_truncate(rank, at);
        for (int a = 0; a < 3; ++a)
            small->order[a][at[a]] = (uint8_t)i;
    }
}

static inline void sides_add(struct sides *sides, const struct small *s, const uint8_t *order[3],
                             uint32_t i)
{
    for (int a = 0; a < 3; ++a) {
        sides->lo[a] = f4_min(sides->lo[a], s->lo[order[a][i]]);
        sides->hi[a] = f4_max(sides->hi[a], s->hi[order[a][i]]);
    }
}

static inline f4 sides_areas(const struct sides *sides, f4 scale)
{
    f4 d[3];
    for (int a = 0; a < 3; ++a)
        d[a] = f4_sub(f4_mul(sides->hi[a], scale), f4_mul(sides->lo[a], scale));
    return f4_half_areas(d[0], d[1], d[2]);
}

static inline f4 keys_at(const struct small *s, const uint8_t *order[3], uint32_t i)
{
    return f4_set(s->centroid[order[0][i]][0], s->centroid[order[1][i]][1],
                  s->centroid[order[2][i]][2], 0.0f);
}

static inline struct sides sides_at(const struct small *s, const uint8_t *order[3], uint32_t i)
{
    struct sides sides;
    for (int a = 0; a < 3; ++a) {
        sides.lo[a] = s->lo[order[a][i]];
        sides.hi[a] = s->hi[order[a][i]];
    }
    return sides;
}

/* A plane cannot part equal centroids. */
static void sweep(const struct small *s, const struct small_range *r, f4 scale, struct cut *best)
{
    const uint8_t *order[3] = {s->order[0] + r->first, s->order[1] + r->first,
                               s->order[2] + r->first};
    uint32_t count = r->count;
    f4 right_cost[BUILD_SMALL], best_cost = f4_splat(INFINITY), best_at = f4_splat(0.0f);
    struct sides sides = sides_at(s, order, count - 1);
    for (uint32_t i = count - 1;;) {
        right_cost[i] = f4_mul(sides_areas(&sides, scale), f4_splat((float)(count - i)));
        if (--i == 0)
            break;
        sides_add(&sides, s, order, i);
    }
    sides = sides_at(s, order, 0);
    f4 before = keys_at(s, order, 0);
    for (uint32_t i = 1;;) {
        f4 left = f4_mul(sides_areas(&sides, scale), f4_splat((float)i));
        f4 cost = f4_add(left, right_cost[i]), key = keys_at(s, order, i);
        f4 better = f4_both(f4_less(before, key), f4_less(cost, best_cost));
        best_cost = f4_select(better, cost, best_cost);
        best_at = f4_select(better, f4_splat((float)i), best_at);
        before = key;
        if (i + 1 == count)
            break;
        sides_add(&sides, s, order, i++);
    }
    alignas(16) float cost[4];
    alignas(16) int at[4];
    f4_store(cost, best_cost);
    f4_truncate(best_at, at);
    for (uint32_t a = 0; a < 3; ++a) {
        if (cost[a] < best->cost)
            *best = (struct cut){a, (uint32_t)at[a], cost[a]};
    }
}

/* What `sweep` finds for two: the same cost on every axis that parts them. */
static void sweep_two(const struct small *s, const struct small_range *r, f4 scale,
                      struct cut *best)
{
    uint32_t i = s->order[0][r->first], j = s->order[0][r->first + 1];
    f4 ci = f4_load(s->centroid[i]), cj = f4_load(s->centroid[j]);
    unsigned differ = f4_below(ci, cj) | f4_below(cj, ci);
    if ((differ & 7u) == 0)
        return;
    best->axis = differ & 1u ? 0 : differ & 2u ? 1 : 2;
    best->left_count = 1;
    best->cost =
        build_scaled_area(s->lo[i], s->hi[i], scale) + build_scaled_area(s->lo[j], s->hi[j], scale);
}

static uint32_t widest_axis(const struct small *s, const struct small_range *r)
{
    float extent[3];
    for (uint32_t a = 0; a < 3; ++a) {
        const uint8_t *order = s->order[a] + r->first;
        extent[a] = s->centroid[order[r->count - 1]][a] - s->centroid[order[0]][a];
    }
    uint32_t axis = extent[1] > extent[0] ? 1 : 0;
    return extent[2] > extent[axis] ? 2 : axis;
}

/* False: a leaf. */
static bool choose(const struct small *s, const struct small_range *r,
                   const struct bvh_params *params, struct cut *cut)
{
    *cut = (struct cut){.cost = INFINITY};
    if (r->count == 1)
        return false;
    if (r->depth < BUILD_DEPTH_OF_MEDIANS) {
        f4 scale = build_scale_of(r->lo, r->hi);
        float area = build_scaled_area(r->lo, r->hi, scale);
        if (area > 0.0f && r->count == 2)
            sweep_two(s, r, scale, cut);
        else if (area > 0.0f)
            sweep(s, r, scale, cut);
        if (r->count <= params->leaf_limit &&
            area * (float)r->count <= area * params->traversal_cost + cut->cost)
            return false;
    }
    if (cut->cost < INFINITY)
        return true;
    if (r->count <= params->leaf_limit)
        return false;
    cut->axis = widest_axis(s, r);
    cut->left_count = r->count / 2;
    return true;
}

/* Both runs of every list keep their order. */
static void lists_part(struct small *s, const struct small_range *r, const struct cut *cut)
{
    const uint8_t *chosen = s->order[cut->axis] + r->first;
    uint32_t left_set = 0;
    for (uint32_t i = 0; i < cut->left_count; ++i)
        left_set |= 1u << chosen[i];
    for (uint32_t a = 0; a < 3; ++a) {
        uint8_t *order = s->order[a] + r->first, right[BUILD_SMALL];
        uint32_t left_count = 0, right_count = 0;
        for (uint32_t i = 0; a != cut->axis && i < r->count; ++i) {
            uint8_t item = order[i];
            uint32_t is_left = left_set >> item & 1u;
            order[left_count] = item;
            right[right_count] = item;
            left_count += is_left;
            right_count += 1 - is_left;
        }
        memcpy(order + r->count - right_count, right, right_count);
    }
}

static void unite(const struct small *s, const uint8_t *order, struct small_range *r)
{
    r->lo = s->lo[order[0]];
    r->hi = s->hi[order[0]];
    for (uint32_t i = 1; i < r->count; ++i) {
        r->lo = f4_min(r->lo, s->lo[order[i]]);
        r->hi = f4_max(r->hi, s->hi[order[i]]);
    }
}

static void part(struct small *s, const struct small_range *r, const struct cut *cut,
                 struct small_range halves[2])
{
    uint32_t child = 2 + 2 * r->pair, left = cut->left_count;
    lists_part(s, r, cut);
    halves[0] =
        (struct small_range){.node = child, .pair = r->pair + 1, .first = r->first, .count = left};
    halves[1] = (struct small_range){.node = child + 1,
                                     .pair = r->pair + left,
                                     .first = r->first + left,
                                     .count = r->count - left};
    for (int i = 0; i < 2; ++i) {
        halves[i].depth = r->depth + 1;
        unite(s, s->order[cut->axis] + halves[i].first, &halves[i]);
    }
}

void small_grow(struct small *small, const struct build_output *output,
                const struct bvh_params *params, const struct build_range *range)
{
    struct small_range stack[BUILD_SMALL], halves[2];
    struct small_range r = {range->bounds.lo, range->bounds.hi, range->node, range->pair, 0,
                            range->count,     range->depth};
    uint32_t top = 0;
    for (;;) {
        struct gpu_bvh_node *node = &output->nodes[r.node];
        struct cut cut;
        if (choose(small, &r, params, &cut)) {
            build_node_write(node, r.lo, r.hi, 2 + 2 * r.pair, 0);
            output->slots[r.pair] = 1;
            part(small, &r, &cut, halves);
            stack[top++] = halves[1];
            r = halves[0];
            continue;
        }
        build_node_write(node, r.lo, r.hi, range->first + r.first, r.count);
        if (top == 0)
            return;
        r = stack[--top];
    }
}
