/* Builds whole subtrees over few boxes, for which bins would cost more than sweeping over every
   position (surface area heuristic). The boxes are sorted once; the three axes are the lanes of one
   sweep. Most nodes of a tree are made here. */
#include "bvh/sweep_small.h"

struct small_range {
    struct build_box box;
    uint32_t node, pair, first, count,
        depth;     /* `first`: relative to the first record of small_grow's range */
    uint32_t side; /* which side of `order` holds its lists */
};

void small_put(struct small *small, uint32_t index, const struct build_record *record)
{
    small->box[index] = build_record_box(record);
    small->centroid[index] = build_centroid(small->box[index]);
}

void small_sort(struct small *small, uint32_t count)
{
    f4 one = f4_splat(1.0f);
    for (uint32_t i = 0; i < count; ++i) {
        f4 own = small->centroid[i], rank = f4_splat(0.0f);
        for (uint32_t j = 0; j < i; ++j) /* before i unless above it */
            rank += f4_select(own < small->centroid[j], f4_splat(0.0f), one);
        for (uint32_t j = i + 1; j < count; ++j)
            rank += f4_select(small->centroid[j] < own, one, f4_splat(0.0f));
        i4 at = f4_truncate(rank);
        for (int a = 0; a < 3; ++a)
            small->order[0][a][at[a]] = (uint8_t)i;
    }
}

/* Adds the box at position i of each axis to that axis's union. */
static inline void sides_add(struct build_box sides[3], const struct small *s,
                             const uint8_t *order[3], uint32_t i)
{
    for (int a = 0; a < 3; ++a)
        sides[a] = build_box_unite(sides[a], s->box[order[a][i]]);
}

static inline f4 keys_at(const struct small *s, const uint8_t *order[3], uint32_t i)
{
    return (f4){s->centroid[order[0][i]][0], s->centroid[order[1][i]][1],
                s->centroid[order[2][i]][2], 0.0f};
}

/* Sweeps all three axes at once. No plane separates equal centroids; with `equal_too` a cut may
   still lie between them, on an axis where not all are equal. */
static void sweep_all(const struct small *s, const struct small_range *r, f4 scale, bool equal_too,
                      struct small_cut *best)
{
    const uint8_t *order[3];
    for (int a = 0; a < 3; ++a)
        order[a] = s->order[r->side][a] + r->first;
    f4 right_cost[BUILD_SMALL], best_cost = f4_splat(INFINITY), best_at = f4_splat(0.0f);
    struct build_box empty = build_box_empty(), sides[3] = {empty, empty, empty};
    for (uint32_t i = r->count - 1; i > 0; --i) {
        sides_add(sides, s, order, i);
        right_cost[i] = build_areas(sides, scale) * (float)(r->count - i);
    }
    sides[0] = sides[1] = sides[2] = empty;
    f4 before = keys_at(s, order, 0);
    i4 differs = before < keys_at(s, order, r->count - 1);
    for (uint32_t i = 1; i < r->count; ++i) {
        sides_add(sides, s, order, i - 1);
        f4 cost = build_areas(sides, scale) * (float)i + right_cost[i], key = keys_at(s, order, i);
        i4 better = (equal_too ? differs : before < key) & (cost < best_cost);
        best_cost = f4_select(better, cost, best_cost);
        best_at = f4_select(better, f4_splat((float)i), best_at);
        before = key;
    }
    i4 at = f4_truncate(best_at);
    for (uint32_t a = 0; a < 3; ++a) {
        if (best_cost[a] < best->cost)
            *best = (struct small_cut){a, (uint32_t)at[a], best_cost[a]};
    }
}

/* Finds what sweep_all would find for two boxes: the cost is the same on every axis that separates
   them. */
static void sweep_two(const struct small *s, const struct small_range *r, f4 scale,
                      struct small_cut *best)
{
    uint32_t i = s->order[r->side][0][r->first], j = s->order[r->side][0][r->first + 1];
    f4 ci = s->centroid[i], cj = s->centroid[j];
    unsigned differ = (f4_below(ci, cj) | f4_below(cj, ci)) & 7u;
    if (differ == 0)
        return;
    best->axis = differ & 1u ? 0 : differ & 2u ? 1 : 2;
    best->left_count = 1;
    best->cost = build_area(s->box[i], scale) + build_area(s->box[j], scale);
}

struct small_cut small_find(const struct small *small, uint32_t count, f4 scale)
{
    struct small_cut cut = {.cost = INFINITY};
    const struct small_range all = {.count = count};
    if (count == 2)
        sweep_two(small, &all, scale, &cut);
    else
        sweep_all(small, &all, scale, true, &cut);
    return cut;
}

static uint32_t widest_axis(const struct small *s, const struct small_range *r)
{
    f4 extent = f4_splat(0.0f);
    for (uint32_t a = 0; a < 3; ++a) {
        const uint8_t *order = s->order[r->side][a] + r->first;
        extent[a] = s->centroid[order[r->count - 1]][a] - s->centroid[order[0]][a];
    }
    return build_widest_axis(extent);
}

/* Chooses a cut. False: the range is to be a leaf. */
static bool choose(const struct small *s, const struct small_range *r,
                   const whit_accel_params *params, struct small_cut *cut)
{
    *cut = (struct small_cut){.cost = INFINITY};
    if (r->depth < BUILD_DEPTH_OF_MEDIANS) {
        f4 scale = build_scale(r->box);
        float area = build_area(r->box, scale);
        if (area > 0.0f && r->count == 2)
            sweep_two(s, r, scale, cut);
        else if (area > 0.0f)
            sweep_all(s, r, scale, false, cut);
        if (build_leaf_pays(params, r->count, area, cut->cost))
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

/* Parts the lists of all axes into left and right runs, which keep their order. */
static void lists_part(struct small *s, const struct small_range *r, uint32_t left_set,
                       uint32_t left_count)
{
    uint32_t lefts[3] = {0};
    for (uint32_t i = 0; i < r->count; ++i) {
        for (int a = 0; a < 3; ++a) {
            uint8_t box = s->order[r->side][a][r->first + i];
            uint32_t is_left = left_set >> box & 1u;
            uint32_t at = is_left ? lefts[a] : left_count + i - lefts[a];
            s->order[!r->side][a][r->first + at] = box;
            lefts[a] += is_left;
        }
    }
}

/* Sets the half's box. Returns the set of its boxes: bit i for box i. */
static uint32_t half_unite(const struct small *s, const uint8_t *order, struct small_range *half)
{
    uint32_t set = 1u << order[0];
    half->box = s->box[order[0]];
    for (uint32_t i = 1; i < half->count; ++i) {
        half->box = build_box_unite(half->box, s->box[order[i]]);
        set |= 1u << order[i];
    }
    return set;
}

static void part(struct small *s, const struct small_range *r, const struct small_cut *cut,
                 struct small_range halves[2])
{
    uint32_t child = 2 + 2 * r->pair, left = cut->left_count, side = !r->side;
    const uint8_t *order = s->order[r->side][cut->axis] + r->first;
    halves[0] = (struct small_range){
        .node = child, .pair = r->pair + 1, .first = r->first, .count = left, .side = side};
    halves[1] = (struct small_range){.node = child + 1,
                                     .pair = r->pair + left,
                                     .first = r->first + left,
                                     .count = r->count - left,
                                     .side = side};
    halves[0].depth = halves[1].depth = r->depth + 1;
    uint32_t left_set = half_unite(s, order, &halves[0]);
    (void)half_unite(s, order + left, &halves[1]);
    lists_part(s, r, left_set, left);
}

/* Makes two leaves of a range of two boxes. */
static void part_two(struct small *s, const struct small_range *r, const struct small_cut *cut,
                     struct gpu_bvh_node *pair, uint32_t first)
{
    const uint8_t *order = s->order[r->side][cut->axis] + r->first;
    for (uint32_t i = 0; i < 2; ++i) {
        build_node_write(&pair[i], s->box[order[i]], first + r->first + i, 1);
        s->leaves[r->first + i] = order[i];
    }
}

static void leaf_write(struct small *s, const struct small_range *r, struct gpu_bvh_node *node,
                       uint32_t first)
{
    build_node_write(node, r->box, first + r->first, r->count);
    for (uint32_t i = 0; i < r->count; ++i)
        s->leaves[r->first + i] = s->order[r->side][0][r->first + i];
}

void small_grow(struct small *small, const struct builder *builder,
                const struct build_output *output, const struct build_range *range)
{
    struct small_range stack[BUILD_SMALL], halves[2];
    struct small_range r = {.box = range->bounds.box,
                            .node = range->node,
                            .pair = range->pair,
                            .count = range->count,
                            .depth = range->depth};
    struct small_cut cut;
    uint32_t top = 0;
    for (;;) {
        struct gpu_bvh_node *node = &output->nodes[r.node];
        if (r.count > 1 && choose(small, &r, builder->params, &cut)) {
            build_node_write(node, r.box, 2 + 2 * r.pair, 0);
            output->slots[r.pair] = r.depth + 1;
            if (r.count > 2) {
                part(small, &r, &cut, halves);
                stack[top++] = halves[1];
                r = halves[0];
                continue;
            }
            part_two(small, &r, &cut, &output->nodes[2 + 2 * r.pair], range->first);
        } else {
            leaf_write(small, &r, node, range->first);
        }
        if (top == 0)
            return;
        r = stack[--top];
    }
}
