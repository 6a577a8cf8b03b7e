/* Pictures stretched to the size of a window, beside bilinear filtering in double. */
#include "device/stretch.h"
#include "unit.h"

static void fill(uint8_t *bytes, size_t count)
{
    uint32_t seed = 1;
    for (size_t i = 0; i < count; ++i) {
        seed = seed * 1664525 + 1013904223;
        bytes[i] = (uint8_t)(seed >> 24);
    }
}

static double clamp(double value, double max)
{
    return fmin(fmax(value, 0.0), max);
}

/* The channel of the target's pixel, by the definition. */
static double expected(const struct stretch *s, uint32_t x, uint32_t y, int channel)
{
    double u = clamp((x + 0.5) * s->from_width / s->width - 0.5, s->from_width - 1.0);
    double v = clamp((y + 0.5) * s->from_height / s->height - 0.5, s->from_height - 1.0);
    double left = floor(u), top = floor(v), sum = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        double cx = left + corner % 2, cy = top + corner / 2;
        double weight = (1.0 - fabs(u - cx)) * (1.0 - fabs(v - cy));
        size_t pixel = (size_t)fmin(cy, s->from_height - 1.0) * s->from_width +
                       (size_t)fmin(cx, s->from_width - 1.0);
        sum += weight * s->from[4 * pixel + (size_t)channel];
    }
    return sum;
}

static void check(uint32_t from_width, uint32_t from_height, uint32_t width, uint32_t height,
                  bool swaps)
{
    own_memory uint8_t *from = malloc((size_t)from_width * from_height * 4),
                       *row = malloc((size_t)width * 4);
    const struct stretch s = {from, from_width, from_height, width, height, swaps};
    own_memory void *scratch = malloc(stretch_scratch_bytes(&s));
    assert_true(from && row && scratch);
    fill(from, (size_t)from_width * from_height * 4);
    stretch_begin(&s, scratch);
    double largest = 0.0;
    for (uint32_t y = 0; y < height; ++y) {
        stretch_row(&s, scratch, y, (uint32_t *)(void *)row);
        for (uint32_t x = 0; x < width; ++x) {
            for (int i = 0; i < 4; ++i) {
                int channel = swaps && i < 3 ? 2 - i : i;
                double off = row[4 * x + (uint32_t)i] - expected(&s, x, y, channel);
                largest = fmax(largest, fabs(off));
            }
        }
    }
    assert_true(largest <= 2.0);
}

TEST(pixels_are_mixed_as_defined)
{
    check(160, 90, 1280, 720, false);
    check(213, 120, 1280, 720, true);
    check(107, 61, 640, 480, false);
    check(640, 480, 100, 37, true); /* a picture that came before the window became smaller */
    check(1, 1, 7, 5, false);
    check(2, 1, 3, 1, true);
}

TEST(one_colour_stays)
{
    uint8_t from[6 * 4 * 4];
    uint32_t row[50];
    uint64_t scratch[400];
    const struct stretch s = {from, 6, 4, 50, 30, false};
    assert_true(stretch_scratch_bytes(&s) <= sizeof scratch);
    for (int level = 0; level < 256; ++level) {
        memset(from, level, sizeof from);
        stretch_begin(&s, scratch);
        for (uint32_t y = 0; y < 30; ++y) {
            stretch_row(&s, scratch, y, row);
            for (int x = 0; x < 50; ++x)
                assert_int_equal(row[x], (uint32_t)level * 0x01010101u);
        }
    }
}
