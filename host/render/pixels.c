/* The buffers of pixels: for as many rows and slots as the device holds at once. */
#include "render/pixels.h"
#include "device/buffer.h"
#include "render/hooks.h"
#include "render/material_shares.h"
#include "render/queues.h"
#include "render/stage_set.h"

/* Pixels on a side of the largest tile, where no size is asked for. On a CPU the queues of a tile
   should stay in the caches. Other devices have more threads than such a tile has rays, and each
   dispatch has a fixed cost: there the queues may take one MEMORY_SHARE-th of the memory. */
enum { TILE_CPU = 192, TILE_OTHER = 768, MEMORY_SHARE = 16 };
/* A slot takes about SLOT_BYTES in all queues together, and at most SLOT_LARGEST_BYTES in one
   queue. */
enum { SLOT_BYTES = 2048, SLOT_LARGEST_BYTES = 1024 };

uint32_t pixels_slot_shift(uint32_t depth)
{
    uint32_t bits = STATE_BOUNCES_SHIFT;
    while (depth >> (bits - STATE_BOUNCES_SHIFT))
        ++bits;
    return bits;
}

static uint32_t usual_tile(const struct device *device)
{
    const whit_device_info *info = device_get_info(device);
    if (info->kind == WHIT_DEVICE_CPU)
        return TILE_CPU;
    uint32_t tile = TILE_OTHER;
    while (tile > TILE_CPU &&
           (uint64_t)tile * tile * SLOT_BYTES > info->memory_bytes / MEMORY_SHARE)
        tile /= 2;
    return tile;
}

bool pixels_have_data(const struct target *target)
{
    return target->probed || !target->renderer->params.color_only;
}

uint32_t pixels_blocks_across(uint32_t pixels)
{
    return (pixels + 7) / 8;
}

uint32_t pixels_levels(const whit_renderer_params *params)
{
    uint32_t max = params->sampling.kind == WHIT_SAMPLING_ADAPTIVE ? params->sampling.count_max
                                                                   : params->sampling.count,
             levels = 0;
    while ((max - 1) >> levels)
        ++levels;
    return levels;
}

whit_result pixels_create(struct target *target, uint32_t height, uint32_t tile_size)
{
    struct renderer *renderer = target->renderer;
    struct pixel_buffers *p = &target->buffers;
    struct device *device = renderer->device;
    uint32_t width = renderer->params.width;
    uint64_t limit = device_get_info(device)->max_storage_range_bytes;
    uint32_t tile = tile_size ? tile_size : usual_tile(device);
    uint64_t slots = (uint64_t)tile * tile,
             slots_max = UINT64_C(1) << (32 - pixels_slot_shift(renderer->params.depth));
    uint32_t aovs = hooks_aov_count(target);
    /* Slots leave at least half of the buffer of aovs to pixels. */
    uint64_t largest = aovs > SLOT_LARGEST_BYTES / 32 ? 32 * aovs : SLOT_LARGEST_BYTES;
    slots_max = slots_max < limit / largest ? slots_max : limit / largest;
    slots = slots > slots_max ? slots_max : slots;
    p->levels = pixels_levels(&renderer->params);
    /* The pixels share their buffer with the partial sums of samples, which lie behind them. */
    bool posts = shader_has(renderer->params.shader, WHIT_HOOK_POST);
    uint64_t max_pixels = (limit / 16 - slots * p->levels) / (posts ? 2 : 1);
    if (aovs && limit / 16 / aovs - slots < max_pixels)
        max_pixels = limit / 16 / aovs - slots;
    uint64_t rows = max_pixels / width / 8 * 8;
    uint32_t wanted = pixels_blocks_across(height) * 8;
    p->band_rows = rows < wanted ? (uint32_t)rows : wanted;
    if (p->band_rows == 0)
        return log_failure(&renderer->log, WHIT_ERROR_DEVICE,
                           "width %u is over what one buffer of the device holds", width);
    uint64_t frame_slots = (uint64_t)pixels_blocks_across(width) * (p->band_rows / 8) * 64;
    p->chunk_slots = (uint32_t)(slots < frame_slots ? slots : frame_slots);
    uint64_t pixels = (uint64_t)width * p->band_rows;
    uint64_t sums = (uint64_t)p->chunk_slots * p->levels;
    p->before_post = posts ? (uint32_t)(pixels + sums) : 0;
    /* Buffers of 0 bytes are not needed for this picture, and not created. */
    bool lists = renderer->params.sampling.kind == WHIT_SAMPLING_ADAPTIVE || target->probed;
    uint64_t before = renderer->scene_buffers.bytes;
    const struct buffer_request all[] = {
        {&p->pixels, (pixels + sums + (posts ? pixels : 0)) * 16, BUFFER_STORAGE | BUFFER_HOST,
         "pixels"},
        {&p->ids, pixels_have_data(target) ? pixels * 8 : 0, BUFFER_STORAGE | BUFFER_HOST, "ids"},
        {&p->aovs, (p->chunk_slots + pixels) * 16 * aovs, BUFFER_STORAGE | BUFFER_HOST,
         "values of functions"},
        {&p->distances, renderer->views.count && !target->probed ? pixels * 4 : 0,
         BUFFER_STORAGE | BUFFER_HOST, "distances"},
        {&p->status, 16, BUFFER_STORAGE | BUFFER_HOST, "status"},
        {&p->costs,
         renderer->params.count ? p->chunk_slots * RAY_KIND_COUNT * sizeof(struct gpu_cost) : 0,
         BUFFER_STORAGE | BUFFER_HOST, "costs"},
        {&p->listed, lists ? pixels * 4 : 0, BUFFER_STORAGE | BUFFER_HOST, "listed pixels"},
    };
    whit_result result =
        buffer_create_all(device, all, sizeof all / sizeof *all, &renderer->scene_buffers.bytes);
    if (result == WHIT_OK)
        result = hooks_clear_status(target);
    if (result == WHIT_OK)
        result = queues_create(target);
    p->bytes = renderer->scene_buffers.bytes - before;
    return result;
}

static void pixels_finish(struct pixel_buffers *p)
{
    struct buffer *all[] = {p->pixels, p->ids,  p->status,   p->costs,
                            p->listed, p->aovs, p->distances};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
        buffer_destroy(all[i]);
    queues_finish(&p->queues);
    *p = (struct pixel_buffers){0};
}

/* The status buffer stays: kernels of ray batches are bound to it. */
void target_drop_pixels(struct target *target)
{
    struct buffer *status = target->buffers.status;
    target->renderer->kept.known &= target->probed;
    stages_unbind(&target->stages);
    target->buffers.status = NULL;
    target->renderer->scene_buffers.bytes -= target->buffers.bytes;
    pixels_finish(&target->buffers);
    target->buffers.status = status;
}

void target_finish(struct target *target)
{
    stage_set_finish(&target->stages.set);
    material_shares_clear(target);
    pixels_finish(&target->buffers);
    buffer_destroy(target->records);
    buffer_destroy(target->dbg);
    *target = (struct target){0};
}
