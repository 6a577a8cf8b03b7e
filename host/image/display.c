#include "image/display.h"

#include <math.h>
#include <string.h>

#include "base/color.h"
#include "base/threads.h"
#include "image/compare.h"

void display_encoder_init(struct display_encoder *encoder)
{
    encoder->from[0] = 0.0f;
    for (int code = 1; code < 256; ++code) {
        double srgb = (code - 0.5) / 255.0;
        double linear = linear_from_srgb(srgb);
        float rounded = (float)linear;
        encoder->from[code] = (double)rounded < linear ? nextafterf(rounded, 2.0f) : rounded;
    }
    encoder->from[256] = INFINITY;
    int code = 0;
    for (int cell = 0; cell <= DISPLAY_CELLS; ++cell) {
        while ((float)cell / DISPLAY_CELLS >= encoder->from[code + 1])
            ++code;
        encoder->first[cell] = (uint8_t)code;
    }
}

static uint8_t encode(const struct display_encoder *encoder, float linear)
{
    if (!(linear > 0.0f))
        return 0;
    if (linear >= 1.0f)
        return 255;
    uint32_t code = encoder->first[(int)(linear * DISPLAY_CELLS)];
    while (linear >= encoder->from[code + 1])
        ++code;
    return (uint8_t)code;
}

static uint8_t encode_alpha(float alpha)
{
    return (uint8_t)(fminf(fmaxf(alpha, 0.0f), 1.0f) * 255.0f + 0.5f);
}

static void encode_pixel(const struct display_encoder *encoder, const struct image *image,
                         size_t index, uint8_t *to, uint32_t to_channels)
{
    float rgba[4];
    image_displayed_pixel(image, index, rgba);
    if (!isfinite(rgba[0]) || !isfinite(rgba[1]) || !isfinite(rgba[2]) || !isfinite(rgba[3])) {
        memcpy(to, (const uint8_t[]){255, 0, 255, 255}, to_channels);
        return;
    }
    for (uint32_t c = 0; c < to_channels; ++c)
        to[c] = c == 3 ? encode_alpha(rgba[c]) : encode(encoder, rgba[c]);
}

/* The number of pixels that a thread encodes at a time. */
enum { PART_PIXELS = 1 << 14 };

struct display_job {
    const struct display_encoder *encoder;
    const struct image *image;
    size_t first, count; /* pixels */
    uint32_t channels;
    uint8_t *to;
};

static void encode_part(void *context, uint32_t part)
{
    const struct display_job *job = context;
    size_t first = (size_t)part * PART_PIXELS, left = job->count - first;
    size_t end = first + (left < PART_PIXELS ? left : PART_PIXELS);
    for (size_t i = first; i < end; ++i)
        encode_pixel(job->encoder, job->image, job->first + i, job->to + i * job->channels,
                     job->channels);
}

void display_encode(const struct display_encoder *encoder, const struct image *image,
                    uint32_t first_row, uint32_t row_count, uint8_t *to, uint32_t to_channels)
{
    struct display_job job = {.encoder = encoder,
                              .image = image,
                              .first = (size_t)first_row * image->width,
                              .count = (size_t)row_count * image->width,
                              .channels = to_channels,
                              .to = to};
    threads_for(0, (uint32_t)((job.count + PART_PIXELS - 1) / PART_PIXELS), encode_part, &job);
}

void display_bytes(const struct image *image, uint8_t *rgba)
{
    struct display_encoder encoder;
    display_encoder_init(&encoder);
    display_encode(&encoder, image, 0, image->height, rgba, 4);
}
