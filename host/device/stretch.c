#include "device/stretch.h"

#include <string.h>

/* A pixel is kept as four channels of 16 bits, so that one multiplication weighs all of them:
   weights are in units of 1/256, and 255 * 256 + 128 fits. */
static const uint64_t LOW_BYTES = 0x00ff00ff00ff00ff, HALVES = 0x0080008000800080;
enum { WEIGHT_BITS = 8, WEIGHT_ONE = 1 << WEIGHT_BITS };

/* Between which two pixels of the source one of the target lies. */
struct place {
    uint32_t at, next;
    uint32_t weight; /* of `next`, in 1/256 */
};

static uint64_t unpack(uint32_t pixel)
{
    uint64_t spread = (pixel | (uint64_t)pixel << 16) & 0x0000ffff0000ffff;
    return (spread | spread << 8) & LOW_BYTES;
}

static uint32_t pack(uint64_t channels)
{
    uint64_t pairs = (channels | channels >> 8) & 0x0000ffff0000ffff;
    return (uint32_t)(pairs | pairs >> 16);
}

static uint64_t mix(uint64_t a, uint64_t b, uint32_t weight)
{
    return (a * (WEIGHT_ONE - weight) + b * weight + HALVES) >> WEIGHT_BITS & LOW_BYTES;
}

static struct place place_of(uint32_t target, uint32_t count, uint32_t from_count)
{
    /* (target + 1/2) * from_count / count - 1/2, rounded to 1/256 */
    int64_t middle = (2 * (int64_t)target + 1) * from_count * WEIGHT_ONE;
    int64_t at = (middle + count) / (2 * (int64_t)count) - WEIGHT_ONE / 2;
    int64_t last = ((int64_t)from_count - 1) * WEIGHT_ONE;
    at = at < 0 ? 0 : at > last ? last : at;
    uint32_t low = (uint32_t)(at >> WEIGHT_BITS);
    return (struct place){low, low + 1 < from_count ? low + 1 : low, (uint32_t)at % WEIGHT_ONE};
}

/* Scratch memory: a row of the source, then the places of a row's pixels. */
uint64_t stretch_scratch_bytes(const struct stretch *stretch)
{
    return (uint64_t)stretch->from_width * sizeof(uint64_t) +
           (uint64_t)stretch->width * sizeof(struct place);
}

static struct place *places_of(const struct stretch *stretch, void *scratch)
{
    return (struct place *)((uint64_t *)scratch + stretch->from_width);
}

void stretch_begin(const struct stretch *stretch, void *scratch)
{
    struct place *places = places_of(stretch, scratch);
    for (uint32_t x = 0; x < stretch->width; ++x)
        places[x] = place_of(x, stretch->width, stretch->from_width);
}

static uint64_t read_pixel(const uint8_t *from, bool swaps)
{
    uint32_t pixel;
    memcpy(&pixel, from, sizeof pixel);
    if (swaps)
        pixel = (pixel & 0xff00ff00) | (pixel >> 16 & 0xff) | (pixel & 0xff) << 16;
    return unpack(pixel);
}

void stretch_row(const struct stretch *stretch, void *scratch, uint32_t y, uint32_t *row)
{
    struct place place = place_of(y, stretch->height, stretch->from_height);
    const struct place *places = places_of(stretch, scratch);
    uint64_t *mixed = scratch;
    const uint8_t *above = stretch->from + (uint64_t)place.at * stretch->from_width * 4;
    const uint8_t *below = stretch->from + (uint64_t)place.next * stretch->from_width * 4;
    for (uint32_t x = 0; x < stretch->from_width; ++x)
        mixed[x] = mix(read_pixel(above + 4 * (uint64_t)x, stretch->swaps),
                       read_pixel(below + 4 * (uint64_t)x, stretch->swaps), place.weight);
    for (uint32_t x = 0; x < stretch->width; ++x)
        row[x] = pack(mix(mixed[places[x].at], mixed[places[x].next], places[x].weight));
}
