/* Top-down building with object and spatial splits: Stich, Friedrich and Dietrich 2009, "Spatial
   splits in bounding volume hierarchies". A reference is a triangle, or the part of one in a box.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bvh/clip.h"
#include "bvh/records.h"
#include "bvh/spatial_object.h"
#include "bvh/spatial_split.h"
#include "bvh/topdown.h"

static double extent_area(struct build_box box)
{
    struct gpu_bvh_node node;
    build_node_write(&node, box, 0, 0);
    bool some = (f4_below(box.hi, box.lo) & 7u) == 0;
    return some ? bvh_half_area(&node) : 0.0;
}

/* ---- Splits ---- */

struct spatial {
    const struct bvh_triangles *triangles;
    double overlap_min; /* half area of the overlap of both halves, above which spatial splits are
                           tried */
};

/* Whether a spatial split may pay: there is room for more references, and the halves of the best
   object split overlap. Without an object split all references count as overlapping. */
static bool spatial_worthwhile(const struct builder *builder, const struct build_range *range,
                               const struct object_plane *object)
{
    const struct spatial *spatial = builder->context;
    struct build_box overlap = range->bounds.box;
    if (range->spare == 0)
        return false;
    if (object->cost < INFINITY)
        overlap = (struct build_box){f4_max(object->side[0].lo, object->side[1].lo),
                                     f4_min(object->side[0].hi, object->side[1].hi)};
    return extent_area(overlap) > spatial->overlap_min;
}

static enum build_choice split(const struct builder *builder, const struct build_range *range,
                               uint32_t thread_count, void *scratch, struct build_halves *halves)
{
    const whit_accel_params *params = builder->params;
    const struct bvh_triangles *triangles = ((const struct spatial *)builder->context)->triangles;
    struct build_record *own = builder->records + range->first;
    f4 scale = build_scale(range->bounds.box);
    struct object_plane object;
    struct spatial_plane plane;
    (void)thread_count;
    (void)scratch;
    object_find(own, range, scale, &object);
    bool spatial = spatial_worthwhile(builder, range, &object) &&
                   spatial_find(own, range, triangles, scale, &plane) && plane.cost < object.cost;
    if (build_leaf_pays(params, range->count, build_area(range->bounds.box, scale),
                        spatial ? plane.cost : object.cost))
        return BUILD_LEAF;
    if (spatial && spatial_apply(own, range, &plane, triangles, halves))
        return BUILD_SPLIT;
    if (!(object.cost < INFINITY))
        return BUILD_NONE;
    object_apply(own, range->count, &object, halves);
    return BUILD_SPLIT;
}

/* ---- The finished tree ---- */

/* The record's box in a leaf. Parts of triangles get their margin only here: costs until now are
   those of the parts without it. */
static struct build_box leaf_box(const struct build_record *record, const struct bvh_box *boxes)
{
    struct build_record wide = *record;
    if (record->flags & SPATIAL_PART) {
        struct bvh_box part;
        memcpy(part.lo, record->lo, sizeof part.lo);
        memcpy(part.hi, record->hi, sizeof part.hi);
        part = clip_widen(&part, &boxes[record->primitive]);
        memcpy(wide.lo, part.lo, sizeof part.lo);
        memcpy(wide.hi, part.hi, sizeof part.hi);
    }
    return build_record_box(&wide);
}

/* Fills `order` with the leaves' references, without gaps, and sets the boxes of the leaves. */
static void leaves_place(const struct build_record *records, const struct bvh_box *boxes,
                         struct bvh *out)
{
    out->reference_count = 0;
    for (uint32_t i = 0; i < out->node_count; ++i) {
        struct gpu_bvh_node *node = &out->nodes[i];
        const struct build_record *own = &records[node->first];
        struct build_box box = build_box_empty();
        uint32_t first = out->reference_count, count = node->count;
        for (uint32_t k = 0; i != 1 && k < count; ++k) {
            box = build_box_unite(box, leaf_box(&own[k], boxes));
            out->order[out->reference_count++] = own[k].primitive;
            out->clipped |= (own[k].flags & SPATIAL_PART) != 0;
        }
        if (count > 0)
            build_node_write(node, box, first, count);
    }
}

/* Sets the boxes of inner nodes. From the end: children come after their parents. */
static void refit(struct bvh *bvh)
{
    for (uint32_t i = bvh->node_count; i-- > 0;) {
        struct gpu_bvh_node *node = &bvh->nodes[i];
        if (node->count > 0 || i == 1)
            continue;
        const struct gpu_bvh_node *a = &bvh->nodes[node->first];
        build_node_write(node, build_box_unite(build_node_box(a), build_node_box(a + 1)),
                         node->first, 0);
    }
}

/* How many references may be added: this share of `count`, and no more than a node can address. */
static uint32_t budget(uint32_t count, float share)
{
    double max = floor((double)count * (double)share);
    double room = (double)(BVH_FIRST_MASK / 2 - count);
    return (uint32_t)(max < room ? max : room);
}

whit_result spatial_build(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_triangles *triangles, const whit_accel_params *resolved,
                          struct bvh *out)
{
    if (!triangles)
        return log_failure(log, WHIT_ERROR_USAGE,
                           "tree over %u boxes: spatial splits need the triangles in them", count);
    struct spatial spatial = {.triangles = triangles};
    struct builder builder = {
        .params = resolved, .context = &spatial, .split = split, .halve = split_median};
    struct build_bounds bounds;
    const uint8_t *whole = triangles->whole;
    uint32_t spare = budget(count, resolved->spatial_budget);
    whit_result result =
        records_make(log, boxes, count, spare, resolved->threads, &builder.records, &bounds);
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; whole && i < count; ++i)
        builder.records[i].flags = whole[i] ? SPATIAL_WHOLE : 0;
    spatial.overlap_min = (double)resolved->spatial_alpha * extent_area(bounds.box);
    result = topdown_grow(log, &builder, &bounds, count, spare, out);
    if (result == WHIT_OK)
        leaves_place(builder.records, boxes, out);
    if (out->clipped)
        refit(out);
    free(builder.records);
    return result;
}
