/* The materials of the hits that each shading kernel works on, in timed tiles, counted on the host
   from the lists that the tile has left. A kernel's time split by these counts is a share, not a
   price: a hit of one material may take longer than one of another. */
#include <stdlib.h>
#include <string.h>

#include "accel/pose.h"
#include "base/array.h"
#include "device/buffer.h"
#include "render/material_shares.h"
#include "render/renderer.h"
#include "render/variants.h"

/* The lists and rows of hits of a tile, read back from the device. Lists are filled from both ends:
   of `capacity` items the tile has used the `first` ones and the `last` ones. */
struct tile_hits {
    uint32_t *list; /* ids of hits: `capacity` items for each class of materials (CLASS_*) */
    uint32_t *rows; /* by id: hit_rows of struct stage_set, of four words each */
    uint32_t capacity, first, last;
};

/* Reads the used items of array number `index`, of several arrays of `capacity` items in a
   buffer. */
static whit_result read_used(struct buffer *buffer, const struct tile_hits *hits, uint64_t index,
                             uint64_t item_bytes, uint32_t *words)
{
    uint64_t start = index * hits->capacity * item_bytes, last_bytes = hits->last * item_bytes;
    uint64_t last = start + (hits->capacity - hits->last) * item_bytes;
    whit_result result = buffer_read(buffer, start, words + start / 4, hits->first * item_bytes);
    return result == WHIT_OK ? buffer_read(buffer, last, words + last / 4, last_bytes) : result;
}

static whit_result read_tile(struct target *target, const struct gpu_generation *generations,
                             uint32_t generation_count, uint32_t camera_rays,
                             struct tile_hits *hits)
{
    const struct queue_buffers *queues = &target->buffers.queues;
    uint64_t row_bytes = target->stages.set.hit_rows * 16;
    *hits = (struct tile_hits){.capacity = queues->ray_capacity, .first = camera_rays};
    for (uint32_t g = 1; g < generation_count; ++g) {
        const struct gpu_items *rays = &generations[g].lists[LIST_RAYS];
        uint32_t first =
            generations[g].firsts[0] + rays->front; /* 0 where the generation has no rays */
        uint32_t last = generations[g].firsts[1] + rays->back;
        hits->first = first > hits->first ? first : hits->first;
        hits->last = last > hits->last ? last : hits->last;
    }
    hits->list = array_alloc((size_t)hits->capacity * CLASSES_MAX, 4);
    hits->rows = array_alloc(hits->capacity, row_bytes);
    if (!hits->list || !hits->rows)
        return render_no_memory(target->renderer, "shares of materials");
    whit_result result = read_used(queues->hits, hits, 0, row_bytes, hits->rows);
    for (uint32_t k = 0; result == WHIT_OK && k < target->stages.set.classes; ++k)
        result = read_used(queues->hit_list, hits, k, 4, hits->list);
    return result;
}

static uint32_t material_of(const struct target *target, const struct tile_hits *hits, uint32_t id)
{
    const struct renderer *renderer = target->renderer;
    const struct accel *accel = renderer->accel;
    const struct scene *scene = renderer->scene;
    const uint32_t *row = &hits->rows[(size_t)id * target->stages.set.hit_rows * 4];
    uint32_t index = row[3] & ~HIT_AT_EXIT;
    if (index == HIT_SHAPE)
        return renderer->frame.shape_material & ~SHAPE_IS_GLASS;
    const struct gpu_triangle *record = &accel->triangles[index];
    uint32_t instance = accel->flat              ? record->flags >> TRIANGLE_INSTANCE_SHIFT
                        : accel->single_identity ? 0
                                                 : row[4];
    return scene->meshes[scene->instances[instance].mesh].materials[record->primitive];
}

whit_result material_shares_add(struct target *target, const struct gpu_generation *generations,
                                uint32_t generation_count, uint32_t camera_rays)
{
    const struct renderer *renderer = target->renderer;
    uint32_t material_count = renderer->scene->material_count;
    uint64_t **counts = &target->stages.material_hits;
    if (material_count == 0) /* without materials no surface can be hit */
        return WHIT_OK;
    if (!*counts)
        *counts = array_alloc_zeroed((size_t)material_count * CLASSES_MAX, sizeof **counts);
    if (!*counts)
        return render_no_memory(renderer, "shares of materials");
    struct tile_hits hits = {0};
    whit_result result = accel_pose_again(renderer->accel, &renderer->pose);
    if (result == WHIT_OK)
        result = read_tile(target, generations, generation_count, camera_rays, &hits);
    for (uint32_t g = 0; result == WHIT_OK && g < generation_count; ++g) {
        for (uint32_t k = 0; k < target->stages.set.classes; ++k) {
            const struct gpu_items *items = &generations[g].lists[LIST_HITS + k];
            const uint32_t *list = &hits.list[(size_t)k * hits.capacity];
            const gpu_uint *firsts = generations[g].firsts;
            uint32_t end = g == 0 ? camera_rays : hits.capacity; /* hit_capacity() of queues.glsl */
            for (uint32_t i = 0; i < items->front; ++i)
                ++(*counts)[k * material_count + material_of(target, &hits, list[firsts[0] + i])];
            for (uint32_t i = 0; i < items->back; ++i)
                ++(*counts)[k * material_count +
                            material_of(target, &hits, list[end - 1 - firsts[1] - i])];
        }
    }
    free(hits.list);
    free(hits.rows);
    return result;
}

void material_shares_clear(struct target *target)
{
    free(target->stages.material_hits);
    target->stages.material_hits = NULL;
}

/* Inserts into a list that is sorted, largest first; a full list loses its last entry. */
static void insert_share(whit_stats *stats, whit_share share)
{
    uint32_t at = stats->share_count;
    if (at == WHIT_SHARES && stats->shares[at - 1].share >= share.share)
        return;
    if (at < WHIT_SHARES)
        ++stats->share_count;
    else
        --at;
    for (; at > 0 && stats->shares[at - 1].share < share.share; --at)
        stats->shares[at] = stats->shares[at - 1];
    stats->shares[at] = share;
}

void material_shares_get(const struct target *target, whit_stats *stats)
{
    uint32_t material_count = target->renderer->scene->material_count;
    const uint64_t *counts = target->stages.material_hits;
    stats->share_count = 0;
    for (uint32_t k = 0; counts && k < CLASSES_MAX; ++k) {
        uint64_t all = 0;
        for (uint32_t i = 0; i < material_count; ++i)
            all += counts[k * material_count + i];
        for (uint32_t i = 0; i < material_count; ++i) {
            uint64_t own = counts[k * material_count + i];
            if (own)
                insert_share(stats, (whit_share){.stage = RENDER_STAGE_SHADE + k,
                                                 .material = i,
                                                 .share = (double)own / (double)all});
        }
    }
}
