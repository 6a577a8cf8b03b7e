#include "image/edges.h"

static bool differ(const struct image *ids, size_t a, size_t b, bool of_primitives)
{
    const uint32_t *words = ids->words;
    return words[2 * a] != words[2 * b] || (of_primitives && words[2 * a + 1] != words[2 * b + 1]);
}

void image_draw_edges(struct image *color, const struct image *ids, bool of_primitives)
{
    uint32_t width = color->width, height = color->height,
             lit = color->channels < 4 ? color->channels : 3;
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            size_t here = (size_t)y * width + x;
            bool edge = (x + 1 < width && differ(ids, here, here + 1, of_primitives)) ||
                        (y + 1 < height && differ(ids, here, here + width, of_primitives));
            for (uint32_t c = 0; edge && c < lit; ++c)
                color->pixels[here * color->channels + c] = 0.0f;
        }
    }
}
