/* Which materials the hits wear that a shading kernel works on: those of the timed tiles, counted
   on the host from the lists that the tile has left. A kernel's time divided by these counts is a
   share, no price: a hit of one material may take longer than one of another. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "render/renderer.h"

/* The lists and rows of hits of a tile, read back from the device. */
struct tile_hits {
    uint32_t *list; /* ids, class by class */
    uint32_t *rows; /* HIT_ROWS of four words an id */
    uint32_t capacity;
};

static void tile_hits_finish(struct tile_hits *hits)
{
    free(hits->list);
    free(hits->rows);
}

static whit_result read_tile(struct target *target, struct tile_hits *hits)
{
    const struct queue_buffers *queues = &target->buffers.queues;
    uint64_t ids = queues->ray_capacity;
    uint64_t list_bytes = ids * 4 * target->stages.set.classes, row_bytes = ids * HIT_ROWS * 16;
    hits->capacity = queues->ray_capacity;
    hits->list = array_alloc(list_bytes, 1);
    hits->rows = array_alloc(row_bytes, 1);
    if (!hits->list || !hits->rows)
        return render_no_memory(target->renderer, "shares of materials");
    whit_result result = buffer_read(queues->hit_list, 0, hits->list, list_bytes);
    return result == WHIT_OK ? buffer_read(queues->hits, 0, hits->rows, row_bytes) : result;
}

static uint32_t material_of(const struct renderer *renderer, const struct tile_hits *hits,
                            uint32_t id)
{
    const struct accel *accel = renderer->accel;
    const struct scene *scene = renderer->scene;
    const uint32_t *row = &hits->rows[(size_t)id * HIT_ROWS * 4];
    uint32_t instance = accel->single_identity && !accel->flat ? 0 : row[4];
    uint32_t primitive = accel->triangles[row[3] & ~HIT_AT_EXIT].primitive;
    return scene->meshes[scene->instances[instance].mesh].materials[primitive];
}

whit_result material_shares_add(struct target *target, const struct gpu_generation *generations,
                                uint32_t generation_count)
{
    const struct renderer *renderer = target->renderer;
    uint32_t material_count = renderer->scene->material_count;
    uint64_t **counts = &target->stages.material_hits;
    if (material_count == 0) /* nothing can be hit */
        return WHIT_OK;
    if (!*counts)
        *counts = array_alloc_zeroed((size_t)material_count * CLASSES_MOST, sizeof **counts);
    if (!*counts)
        return render_no_memory(renderer, "shares of materials");
    struct tile_hits hits = {0};
    whit_result result = read_tile(target, &hits);
    for (uint32_t g = 0; result == WHIT_OK && g < generation_count; ++g) {
        for (uint32_t k = 0; k < target->stages.set.classes; ++k) {
            const struct gpu_items *items = &generations[g].lists[LIST_HITS + k];
            const uint32_t *list = &hits.list[(size_t)k * hits.capacity];
            const gpu_uint *firsts = generations[g].firsts;
            for (uint32_t i = 0; i < items->front; ++i)
                ++(*counts)[k * material_count + material_of(renderer, &hits, list[firsts[0] + i])];
            for (uint32_t i = 0; i < items->back; ++i)
                ++(*counts)[k * material_count +
                            material_of(renderer, &hits, list[hits.capacity - 1 - firsts[1] - i])];
        }
    }
    tile_hits_finish(&hits);
    return result;
}

void material_shares_clear(struct target *target)
{
    free(target->stages.material_hits);
    target->stages.material_hits = NULL;
}

/* Into a list that is sorted, largest first, and drops its last. */
static void insert_share(struct render_stats *stats, struct render_share share)
{
    uint32_t at = stats->share_count;
    if (at == RENDER_SHARES && stats->shares[at - 1].share >= share.share)
        return;
    if (at < RENDER_SHARES)
        ++stats->share_count;
    else
        --at;
    for (; at > 0 && stats->shares[at - 1].share < share.share; --at)
        stats->shares[at] = stats->shares[at - 1];
    stats->shares[at] = share;
}

void material_shares_get(const struct target *target, struct render_stats *stats)
{
    uint32_t material_count = target->renderer->scene->material_count;
    const uint64_t *counts = target->stages.material_hits;
    stats->share_count = 0;
    for (uint32_t k = 0; counts && k < CLASSES_MOST; ++k) {
        uint64_t all = 0;
        for (uint32_t i = 0; i < material_count; ++i)
            all += counts[k * material_count + i];
        for (uint32_t i = 0; i < material_count; ++i) {
            uint64_t own = counts[k * material_count + i];
            if (own)
                insert_share(stats, (struct render_share){.stage = RENDER_STAGE_SHADE + k,
                                                          .material = i,
                                                          .share = (double)own / (double)all});
        }
    }
}
