/* Pictures: PNG, EXR, PFM and HDR as whit reads them, with their recipes, and what textures may be,
   by libjpeg and stb_image. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include "image/image.h"
#include "load/picture.h"

enum { PNG_HEAD = 8, CHUNK_HEAD = 8, CHUNK_TAIL = 4 };

static void put_u32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

static uint32_t get_u32(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* The right checksum for every chunk of a PNG: else nothing behind the first change is read. */
static void sign_png(uint8_t *data, size_t size_bytes)
{
    static const uint8_t magic[PNG_HEAD] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
    if (size_bytes < PNG_HEAD || memcmp(data, magic, PNG_HEAD) != 0)
        return;
    for (size_t at = PNG_HEAD; size_bytes - at >= CHUNK_HEAD + CHUNK_TAIL;) {
        size_t bytes = get_u32(data + at);
        if (bytes > size_bytes - at - CHUNK_HEAD - CHUNK_TAIL)
            return;
        uint8_t *end = data + at + CHUNK_HEAD + bytes;
        put_u32(end, (uint32_t)crc32(0, data + at + 4, (uInt)(bytes + 4)));
        at += CHUNK_HEAD + bytes + CHUNK_TAIL;
    }
}

static void load_whole(const char *path)
{
    struct image image;
    fuzz_log_clear();
    whit_result result = image_load(&fuzz_log, path, &image);
    fuzz_check_errors(result, path);
    bool empty = !image.pixels && !image.words;
    fuzz_check((result == WHIT_OK) != empty, "a result without its picture");
    image_finish(&image);
}

static void load_texts(const char *path)
{
    struct image_text *texts;
    uint32_t count;
    fuzz_log_clear();
    fuzz_check_errors(image_load_texts(&fuzz_log, path, &texts, &count), path);
    size_t bytes = 0;
    for (uint32_t i = 0; i < count; i++)
        bytes += strlen(texts[i].key) + strlen(texts[i].value);
    fuzz_check(bytes < (size_t)1 << 30, "texts of %zu bytes", bytes);
    free(texts);
}

static void decode(const uint8_t *data, size_t size_bytes)
{
    struct picture picture;
    const char *reason = NULL;
    whit_result result = picture_decode(data, size_bytes, &picture, &reason);
    fuzz_check(result == WHIT_OK || (result == WHIT_ERROR_INPUT && reason && *reason),
               "the result is %d", (int)result);
    /* No format makes more of its bytes than PNG can. */
    uint64_t most = ((uint64_t)1 << 16) + (uint64_t)8 * 1032 * size_bytes;
    fuzz_check((uint64_t)picture.width * picture.height <= most, "%u x %u pixels out of %zu bytes",
               picture.width, picture.height, size_bytes);
    if (result == WHIT_OK && picture.width <= 256 && picture.height <= 256)
        fuzz_check(picture_shrink(&picture, 4), "a picture that cannot be halved");
    picture_finish(&picture);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    fuzz_check(copy, "out of memory");
    memcpy(copy, data, size_bytes);
    sign_png(copy, size_bytes);
    const char *path = fuzz_file("picture", copy, size_bytes);
    load_whole(path);
    load_texts(path);
    decode(copy, size_bytes);
    free(copy);
}

/* The limit of image_load is 1 GiB of pixels. */
const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(1) << 30};
