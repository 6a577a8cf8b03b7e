/* merge_parts SIDE TILES EXTENSION: writes parts of a picture for `whit merge` without drawing:
   TILES files pN.EXTENSION, SIDE x SIDE pixels together, into the working folder. */
#include <stdio.h>
#include <stdlib.h>

#include "image/image.h"
#include "whit/whit.h"

int main(int argc, char **argv)
{
    unsigned side = argc == 4 ? (unsigned)atoi(argv[1]) : 0,
             tiles = side ? (unsigned)atoi(argv[2]) : 0;
    unsigned strips = (side + 15) / 16;
    for (unsigned tile = 1; tile <= tiles; ++tile) {
        unsigned first = strips * (tile - 1) / tiles * 16, end = strips * tile / tiles * 16;
        unsigned rows = (end < side ? end : side) - first;
        char name[64], part[256];
        snprintf(name, sizeof name, "p%u.%s", tile, argv[3]);
        snprintf(
            part, sizeof part,
            "{\"tile\":%u,\"tiles\":%u,\"samples_part\":0,\"samples_parts\":0,\"first_row\":%u,"
            "\"rows\":%u,\"width\":%u,\"height\":%u,\"samples\":1}",
            tile, tiles, first, rows, side, side);
        const whit_text texts[] = {{"Software", "whit " WHIT_VERSION}, {"whit:part", part}};
        const whit_log log = {0};
        struct image image;
        if (image_init(&image, side, rows, 4, false) != WHIT_OK)
            return 1;
        for (size_t i = 0; i < (size_t)side * rows * 4; ++i)
            image.pixels[i] =
                i % 4 == 3 ? 1.0f : (float)((i / 4 * 7 + first + i % 4) % 256) / 256.0f;
        whit_result result = image_save(&log, &image, NULL, 0, name, texts, 2);
        image_finish(&image);
        if (result != WHIT_OK)
            return 1;
    }
    return tiles ? 0 : 2;
}
