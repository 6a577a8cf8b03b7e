/* Textures: PNG, JPEG, BMP, TGA and GIF, by libjpeg and stb_image. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "load/picture.h"

static void decode(const uint8_t *data, size_t size_bytes)
{
    struct picture picture;
    const char *reason = NULL;
    whit_result result = picture_decode(data, size_bytes, UINT64_MAX, &picture, &reason);
    fuzz_check(result == WHIT_OK || (result == WHIT_ERROR_INPUT && reason && *reason),
               "the result is %d", (int)result);
    /* No format makes more of its bytes than PNG can. */
    uint64_t max = ((uint64_t)1 << 16) + (uint64_t)8 * 1032 * size_bytes;
    fuzz_check((uint64_t)picture.width * picture.height <= max, "%u x %u pixels out of %zu bytes",
               picture.width, picture.height, size_bytes);
    if (result == WHIT_OK && picture.width <= 256 && picture.height <= 256)
        fuzz_check(picture_shrink(&picture, 4), "a picture that cannot be halved");
    picture_finish(&picture);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    uint8_t *copy = fuzz_signed(data, size_bytes);
    decode(copy, size_bytes);
    free(copy);
}

/* 2^26 pixels at most, of 16 bits in each of 4 channels. */
const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(1) << 30};
