/* Adaptive anti-aliasing: which pixels get more samples. The whole picture so far decides that, so
   that bands, tiles and devices cannot change it. */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "device/buffer.h"
#include "render/adaptive_samples.h"
#include "render/renderer.h"
#include "render/tiles.h"

static float displayed(float value)
{
    return value < 0.0f ? 0.0f : value > 1.0f ? 1.0f : value;
}

static bool differ(const float *a, const float *b, float contrast)
{
    for (int c = 0; c < 3; ++c) {
        if (fabsf(displayed(a[c]) - displayed(b[c])) > contrast)
            return true;
    }
    return false;
}

/* Marks both pixels of every pair of neighbours that differ. Each pair is compared once, from the
   pixel that is left of or above the other. */
static void mark_around(const struct image *color, uint32_t x, uint32_t y, float contrast,
                        uint8_t level, uint8_t *levels)
{
    static const int dx[] = {1, -1, 0, 1}, dy[] = {0, 1, 1, 1};
    size_t width = color->width, own = (size_t)y * width + x;
    for (int i = 0; i < 4; ++i) {
        if ((dx[i] < 0 && x == 0) || (dx[i] > 0 && x + 1 == color->width) ||
            (dy[i] > 0 && y + 1 == color->height))
            continue;
        size_t other = own + (size_t)dy[i] * width + (dx[i] > 0 ? 1 : 0) - (dx[i] < 0 ? 1 : 0);
        if (differ(&color->pixels[4 * own], &color->pixels[4 * other], contrast))
            levels[own] = levels[other] = level;
    }
}

uint64_t adaptive_mark(const struct image *color, double contrast, uint8_t level, uint8_t *levels)
{
    for (uint32_t y = 0; y < color->height; ++y) {
        for (uint32_t x = 0; x < color->width; ++x)
            mark_around(color, x, y, (float)contrast, level, levels);
    }
    uint64_t count = 0;
    for (size_t i = 0; i < (size_t)color->width * color->height; ++i)
        count += levels[i] == level;
    return count;
}

bool adaptive_draws(const struct progress *progress, size_t index)
{
    if (!progress->listed)
        return true;
    return 1u << (2 * progress->levels[index]) == progress->samples;
}

whit_result adaptive_list(struct target *target, const struct progress *progress,
                          uint32_t first_block, uint32_t end_block, uint32_t *count)
{
    struct renderer *renderer = target->renderer;
    uint32_t *list =
        array_alloc((size_t)(end_block - first_block) * RENDER_BLOCK_PIXELS, sizeof *list);
    *count = 0;
    if (!list)
        return render_no_memory(renderer, "a list of pixels");
    for (uint32_t block = first_block; block < end_block; ++block) {
        for (uint32_t i = 0; i < RENDER_BLOCK_PIXELS; ++i) {
            uint32_t x, y;
            if (render_slot_pixel(renderer, block, i, &x, &y) &&
                adaptive_draws(progress, (size_t)y * renderer->params.width + x))
                list[(*count)++] = x | y << LISTED_Y_SHIFT;
        }
    }
    whit_result result = WHIT_OK;
    if (*count > 0)
        result = buffer_write(target->buffers.listed, 0, list, (uint64_t)*count * sizeof *list);
    free(list);
    return result;
}
