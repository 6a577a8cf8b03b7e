/* merge_parts SIDE TILES EXTENSION: writes parts of a picture for `whit merge` without drawing:
   TILES files pN.EXTENSION, SIDE x SIDE pixels together, into the working folder. With a fourth
   argument the parts are grey, of one channel, and are runs of samples instead of tiles. */
#include <stdio.h>
#include <stdlib.h>

#include "image/image.h"
#include "whit/whit.h"

int main(int argc, char **argv)
{
    bool grey = argc == 5;
    unsigned side = argc >= 4 ? (unsigned)atoi(argv[1]) : 0,
             tiles = side ? (unsigned)atoi(argv[2]) : 0;
    unsigned strips = (side + 15) / 16;
    for (unsigned tile = 1; tile <= tiles; ++tile) {
        unsigned first = grey ? 0 : strips * (tile - 1) / tiles * 16,
                 end = grey ? side : strips * tile / tiles * 16;
        unsigned rows = (end < side ? end : side) - first;
        char name[64], part[256];
        snprintf(name, sizeof name, "p%u.%s", tile, argv[3]);
        snprintf(
            part, sizeof part,
            "{\"tile\":%u,\"tiles\":%u,\"samples_part\":%u,\"samples_parts\":%u,\"first_row\":%u,"
            "\"rows\":%u,\"width\":%u,\"height\":%u,\"samples\":%u}",
            grey ? 0 : tile, grey ? 0 : tiles, grey ? tile : 0, grey ? tiles : 0, first, rows, side,
            side, grey ? tiles : 1);
        const whit_text texts[] = {{"Software", "whit " WHIT_VERSION}, {"whit:part", part}};
        const whit_log log = {0};
        struct image image;
        if (image_init(&image, side, rows, grey ? 1 : 4, false) != WHIT_OK)
            return 1;
        for (size_t i = 0; i < (size_t)side * rows * image.channels; ++i)
            image.pixels[i] =
                i % 4 == 3 ? 1.0f : (float)((i / 4 * 7 + first + i % 4) % 256) / 256.0f;
        whit_result result = image_save(&log, &image, NULL, 0, name, texts, 2);
        image_finish(&image);
        if (result != WHIT_OK)
            return 1;
    }
    return tiles ? 0 : 2;
}
