/* The buffers between the stages of a picture. */
#include <stdlib.h>

#include "base/array.h"
#include "device/buffer.h"
#include "render/pixels.h"
#include "render/queues.h"
#include "render/renderer.h"
#include "render/textures.h"
#include "render/variants.h"

/* Room for rays of a tile, and for hits of one generation that go on to the lights, by slot; a tile
   that needs more is drawn in smaller parts. GENERATIONS_MAX: the most bounces, and more, as a
   surface that a ray passes unseen takes a generation too. */
enum {
    RAYS_A_SLOT = 16,
    LIT_A_SLOT = 2,
    RAYS_MIN = 1 << 16,
    GENERATIONS_MAX = 640,
    QUEUE_GROWTH = 4
};

static whit_result write_empty(const struct renderer *renderer, const struct queue_buffers *queues)
{
    struct gpu_generation *empty = array_alloc_zeroed(queues->generation_count, sizeof *empty);
    if (!empty)
        return render_no_memory(renderer, "generations of rays");
    for (uint32_t i = 0; i < queues->generation_count; ++i) {
        struct gpu_generation *g = &empty[i];
        for (uint32_t list = 0; list < LISTS_COUNT; ++list)
            g->lists[list].groups_y = g->lists[list].groups_z = 1;
    }
    const struct gpu_tally none = {0};
    whit_result result = buffer_write(queues->empty, 0, &none, sizeof none);
    if (result == WHIT_OK)
        result = buffer_write(queues->empty, sizeof none, empty,
                              queues->generation_count * sizeof *empty);
    free(empty);
    return result;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Two generations of rays are kept at a time, each of up to a fourth of a tile's rays: see
   generation_capacity() of bind/queues.glsl. */
static uint64_t ray_bytes(uint64_t rays)
{
    return rays / 2 * RAY_ROWS * 16;
}

static uint32_t hook_rows(const whit_shader *shader)
{
    return (shader_has(shader, WHIT_HOOK_SURFACE) ? HOOK_SURFACE_ROWS : 0) +
           (shader_has(shader, WHIT_HOOK_SHADE) ? HOOK_LIGHT_ROWS : 0);
}

/* Rows for the hits of one dispatch of STAGE_HIT_FETCH. A tile of one block has at most as many
   hits as a generation of the smallest queues, or of the queues after they had to grow. */
static uint64_t met_rows(const struct target *target)
{
    enum { ITEMS = 1 << 15 };
    _Static_assert(ITEMS >= RAYS_MIN / 4, "a generation of the smallest queues");
    uint64_t items = larger(ITEMS, target->stages.rays_min / 4);
    return variant_can_split_hits(target) ? items * MET_ROWS : 0;
}

whit_result queues_create(struct target *target)
{
    const struct pixel_buffers *p = &target->buffers;
    struct renderer *renderer = target->renderer;
    struct queue_buffers *queues = &target->buffers.queues;
    bool secondary = renderer->has_secondary;
    const bool *called = renderer->effects.called;
    bool calls = called[SCENE_EFFECT_REFLECTION] || called[SCENE_EFFECT_REFRACTION] ||
                 called[SCENE_EFFECT_CUTOUTS] || called[SCENE_EFFECT_CATCHERS];
    queues->generation_count = secondary ? GENERATIONS_MAX : 2;
    queues->ray_capacity = p->chunk_slots;
    queues->lit_capacity =
        p->chunk_slots * 2; /* each half of a dispatch fills its own half of a list */
    if (secondary) {
        uint32_t min = larger(target->stages.rays_min, RAYS_MIN);
        queues->ray_capacity = larger(p->chunk_slots * RAYS_A_SLOT, min);
        queues->lit_capacity = larger(p->chunk_slots * LIT_A_SLOT, min / 4);
    }
    uint64_t rays = queues->ray_capacity, sent = secondary ? rays : 0;
    struct gpu_spec spec = variant_async_spec(target); /* no kernel of the picture has more rows */
    uint64_t cut_sums =
        pixels_have_data(target) ? (uint64_t)renderer->params.width * p->band_rows : p->chunk_slots;
    uint64_t heads = sizeof(struct gpu_tally) +
                     (uint64_t)queues->generation_count * sizeof(struct gpu_generation);
    uint32_t lights = renderer->pose.light_count, lists = lights <= LIGHT_LISTS ? lights : 1;
    /* Invocations without an item of their own read another item, which may not have been written
       yet: buffers start as zeros, which are valid ids. */
    const uint32_t loaded = BUFFER_STORAGE | BUFFER_TEXELS | BUFFER_ZEROED;
    const struct buffer_request all[] = {
        {&queues->generations, heads,
         BUFFER_STORAGE | BUFFER_TEXELS | BUFFER_INDIRECT | BUFFER_HOST, "generations"},
        {&queues->empty, heads, BUFFER_STORAGE | BUFFER_HOST, "empty generations"},
        {&queues->rays, ray_bytes(sent), loaded, "rays"},
        {&queues->hits, rays * variant_hit_rows(&spec) * 16, loaded, "hits"},
        {&queues->lit, (uint64_t)queues->lit_capacity * LIT_ROWS * 16, loaded, "lit hits"},
        {&queues->sums, rays * 16, loaded, "sums"},
        {&queues->lit_list, (uint64_t)lists * queues->lit_capacity * 4, loaded, "hits by lights"},
        {&queues->hit_list, rays * 4 * CLASSES_MAX, loaded, "hits to shade"},
        {&queues->cuts, calls ? (uint64_t)p->chunk_slots * 8 : 0, BUFFER_STORAGE | BUFFER_TEXELS,
         "weights that are cut"},
        {&queues->cut_sums, calls ? cut_sums * 8 : 0, BUFFER_STORAGE,
         "sums of weights that are cut"},
        {&queues->deferred,
         variant_has_deferred(target) ? sizeof(struct gpu_work) + rays * sizeof(uint32_t) : 0,
         BUFFER_STORAGE | BUFFER_INDIRECT, "waiting items"},
        {&queues->hook_rows, (rays * hook_rows(renderer->params.shader) + met_rows(target)) * 16,
         loaded, "functions at hits"},
        {&queues->shape_shadows,
         shader_has(renderer->params.shader, WHIT_HOOK_INTERSECT)
             ? (uint64_t)queues->lit_capacity * 2 * sizeof(uint32_t)
             : 0,
         BUFFER_STORAGE, "shadows of a shape"},
        {&queues->kinds,
         renderer->params.count || target->probed || textures_minify(renderer) ? sent * 4 : 0,
         BUFFER_STORAGE, "kinds of rays"},
    };
    whit_result result =
        buffer_create_all(renderer->device, all, sizeof all / sizeof *all, &queues->bytes);
    renderer->scene_buffers.bytes += queues->bytes;
    return result == WHIT_OK ? write_empty(renderer, queues) : result;
}

bool queues_can_grow(const struct target *target)
{
    const struct renderer *renderer = target->renderer;
    uint64_t rays = (uint64_t)target->buffers.queues.ray_capacity * QUEUE_GROWTH;
    uint64_t limit = device_get_info(renderer->device)->max_storage_range_bytes;
    return renderer->has_secondary && ray_bytes(rays) <= limit;
}

whit_result queues_grow(struct target *target)
{
    struct pixel_buffers *p = &target->buffers;
    target->stages.rays_min = p->queues.ray_capacity * QUEUE_GROWTH;
    target->renderer->scene_buffers.bytes -= p->queues.bytes;
    p->bytes -= p->queues.bytes;
    queues_finish(&p->queues);
    whit_result result = queues_create(target);
    p->bytes += p->queues.bytes;
    target->renderer->picture.stats.device_bytes = target->renderer->scene_buffers.bytes;
    return result;
}

void queues_finish(struct queue_buffers *queues)
{
    struct buffer *all[] = {queues->hook_rows, queues->shape_shadows, queues->generations,
                            queues->empty,     queues->rays,          queues->hits,
                            queues->lit,       queues->sums,          queues->hit_list,
                            queues->cuts,      queues->cut_sums,      queues->kinds,
                            queues->lit_list,  queues->deferred};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
        buffer_destroy(all[i]);
    *queues = (struct queue_buffers){0};
}
