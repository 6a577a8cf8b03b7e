/* Pictures: PNG, EXR, PFM and HDR as whit reads them, with their recipes. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "image/image_reply.h"

static void load_whole(const char *path)
{
    struct image image;
    fuzz_log_clear();
    whit_result result = image_load(&fuzz_log, NULL, path, NULL, &image);
    fuzz_check_errors(result, path);
    bool empty = !image.pixels && !image.words;
    fuzz_check((result == WHIT_OK) != empty, "a result without its picture");
    image_finish(&image);
}

static void load_texts(const char *path)
{
    whit_text *texts;
    uint32_t count;
    fuzz_log_clear();
    fuzz_check_errors(image_load_texts(&fuzz_log, path, NULL, &texts, &count), path);
    size_t bytes = 0;
    for (uint32_t i = 0; i < count; i++)
        bytes += strlen(texts[i].key) + strlen(texts[i].value);
    fuzz_check(bytes < (size_t)1 << 30, "texts of %zu bytes", bytes);
    free(texts);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    uint8_t *copy = fuzz_signed(data, size_bytes);
    const char *path = fuzz_file("picture", copy, size_bytes);
    load_whole(path);
    load_texts(path);
    free(copy);
}

/* The limit of image_load is 1 GiB of pixels. */
const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(1) << 30};
