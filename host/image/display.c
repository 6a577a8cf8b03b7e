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

void display_encode(const struct display_encoder *encoder, const struct image *image, size_t index,
                    uint8_t *to, uint32_t to_channels)
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

enum { BAND_ROWS = 128 };

struct display_job {
    const struct image *image;
    uint8_t *rgba;
    struct display_encoder encoder;
};

static void encode_band(void *context, uint32_t band)
{
    const struct display_job *job = context;
    const struct image *image = job->image;
    size_t first = (size_t)band * BAND_ROWS * image->width;
    size_t end = first + (size_t)BAND_ROWS * image->width;
    size_t pixel_count = (size_t)image->width * image->height;
    for (size_t i = first; i < end && i < pixel_count; ++i) {
        job->rgba[4 * i + 3] = 255;
        display_encode(&job->encoder, image, i, &job->rgba[4 * i], image->channels == 4 ? 4 : 3);
    }
}

void display_bytes(const struct image *image, uint8_t *rgba)
{
    struct display_job job = {.image = image, .rgba = rgba};
    display_encoder_init(&job.encoder);
    threads_for(0, (image->height + BAND_ROWS - 1) / BAND_ROWS, encode_band, &job);
}
