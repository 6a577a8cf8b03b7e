#include "image/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/color.h"
#include "base/file.h"
#include "image/formats.h"

enum { KEY_MAX = 79, LAYER_NAME_MAX = 200 };

whit_result image_init(struct image *image, uint32_t width, uint32_t height, uint32_t channels,
                       bool integers)
{
    *image = (struct image){0};
    if (width == 0 || height == 0 || channels == 0 || channels > (integers ? 8 : 4))
        return WHIT_ERROR_USAGE;
    uint64_t pixel_count = (uint64_t)width * height;
    if (pixel_count > SIZE_MAX / 2 / (sizeof(float) * channels))
        return WHIT_ERROR_MEMORY;
    void *memory = array_alloc_zeroed((size_t)pixel_count, sizeof(float) * channels);
    if (!memory)
        return WHIT_ERROR_MEMORY;
    image->width = width;
    image->height = height;
    image->channels = channels;
    if (integers)
        image->words = memory;
    else
        image->pixels = memory;
    return WHIT_OK;
}

whit_result image_init_logged(const whit_log *log, struct image *image, uint32_t width,
                              uint32_t height, uint32_t channels, bool integers)
{
    whit_result result = image_init(image, width, height, channels, integers);
    if (result == WHIT_ERROR_MEMORY)
        log_error(log, "out of memory for %u x %u pixels", width, height);
    return result;
}

void image_finish(struct image *image)
{
    if (!image)
        return;
    if (!image->borrowed) {
        free(image->pixels);
        free(image->words);
    }
    *image = (struct image){0};
}

whit_result image_init_loaded(const struct image_source *source, struct image *image,
                              uint64_t width, uint64_t height, uint32_t channels, bool integers)
{
    if (width == 0 || height == 0)
        return log_failure(source->log, WHIT_ERROR_INPUT, "%s: the picture is empty", source->path);
    if (width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX ||
        width * height > IMAGE_BYTES_MAX / (sizeof(float) * channels))
        return log_failure(source->log, WHIT_ERROR_INPUT, "%s: %llu x %llu pixels are too many",
                           source->path, (unsigned long long)width, (unsigned long long)height);
    whit_result result = image_init(image, (uint32_t)width, (uint32_t)height, channels, integers);
    if (result != WHIT_OK)
        log_error(source->log, "%s: no memory for %llu x %llu pixels", source->path,
                  (unsigned long long)width, (unsigned long long)height);
    return result;
}

float image_srgb_from_linear(float linear)
{
    if (!(linear > 0.0f))
        return 0.0f;
    if (linear >= 1.0f)
        return 1.0f;
    return (float)srgb_from_linear((double)linear);
}

float image_linear_from_srgb(float srgb)
{
    if (!(srgb > 0.0f))
        return 0.0f;
    if (srgb >= 1.0f)
        return 1.0f;
    return (float)linear_from_srgb((double)srgb);
}

enum image_format image_format_of(const char *path)
{
    char extension[8];
    path_extension(path, extension, sizeof extension);
    return strcmp(extension, "png") == 0   ? IMAGE_PNG
           : strcmp(extension, "exr") == 0 ? IMAGE_EXR
           : strcmp(extension, "pfm") == 0 ? IMAGE_PFM
                                           : IMAGE_UNKNOWN;
}

bool image_format_known(const char *path, bool integers)
{
    enum image_format format = image_format_of(path);
    return format == IMAGE_EXR || (format != IMAGE_UNKNOWN && !integers);
}

whit_result image_check_savable(const whit_log *log, const struct image *image, const char *path)
{
    bool integers = image->words != NULL;
    if (!image->pixels == !image->words || image->width == 0 || image->height == 0 ||
        image->channels == 0 || image->channels > 4 || (!integers && image->channels == 2))
        return log_failure(log, WHIT_ERROR_USAGE, "%s: not a picture that can be saved", path);
    if (image->width > IMAGE_SIDE_MAX || image->height > IMAGE_SIDE_MAX)
        return log_failure(log, WHIT_ERROR_USAGE, "%s: %u x %u pixels are too many", path,
                           image->width, image->height);
    if (!image_format_known(path, integers))
        return log_failure(log, WHIT_ERROR_USAGE, "%s: unknown picture format; use %s", path,
                           integers ? ".exr, which keeps integers" : ".png, .exr or .pfm");
    return WHIT_OK;
}

static uint64_t count_nonfinite(const struct image *image)
{
    uint64_t count = 0;
    size_t pixel_count = (size_t)image->width * image->height;
    for (size_t i = 0; image->pixels && i < pixel_count; ++i) {
        const float *pixel = image->pixels + i * image->channels;
        bool finite = true;
        for (uint32_t c = 0; c < image->channels; ++c)
            finite = finite && isfinite(pixel[c]);
        count += !finite;
    }
    return count;
}

static void warn_of_nonfinite(const whit_log *log, const struct image *image, const char *path)
{
    uint64_t count = count_nonfinite(image);
    if (count)
        log_warning(log, "%s: %llu of %llu pixels are not finite%s", path,
                    (unsigned long long)count, (unsigned long long)image->width * image->height,
                    image_format_of(path) == IMAGE_PNG ? " and shown as magenta" : "");
}

static bool is_new_layer(const struct image_layer *layers, uint32_t index)
{
    for (uint32_t i = 0; i < index; ++i) {
        if (strcmp(layers[i].name, layers[index].name) == 0)
            return false;
    }
    return true;
}

static whit_result check_layers(const whit_log *log, const struct image *image,
                                const struct image_layer *layers, uint32_t count, const char *path)
{
    bool fit = count <= WHIT_LAYERS_MAX && (count == 0 || image_format_of(path) == IMAGE_EXR);
    for (uint32_t i = 0; fit && i < count; ++i) {
        const char *name = layers[i].name;
        size_t length = strcspn(name, "."); /* a dot stands before the channel */
        if (length == 0 || length > LAYER_NAME_MAX || name[length] || !is_new_layer(layers, i))
            return log_failure(
                log, WHIT_ERROR_USAGE,
                "%s: a layer `%s`: names have 1 to %d bytes and no dots, and differ from one "
                "another",
                path, name, LAYER_NAME_MAX);
    }
    for (uint32_t i = 0; fit && i < count; ++i) {
        const struct image *layer = layers[i].image;
        fit = layer->pixels && layer->channels == 4 && layer->width == image->width &&
              layer->height == image->height;
    }
    if (fit)
        return WHIT_OK;
    return log_failure(log, WHIT_ERROR_USAGE,
                       "%s: an .exr alone keeps images beside another one, up to %d of its size",
                       path, WHIT_LAYERS_MAX);
}

/* The keywords of PNG: Latin-1 without spaces that its readers drop. */
static bool is_key(const char *key)
{
    size_t length = strlen(key);
    bool good = length > 0 && length <= KEY_MAX && key[0] != ' ' && key[length - 1] != ' ';
    for (const unsigned char *c = (const unsigned char *)key; good && *c; ++c)
        good = *c >= ' ' && (*c < 127 || *c > 160) && (*c != ' ' || c[1] != ' ');
    return good;
}

/* Whether OpenEXR has another use for a string of this name: it refuses it, or drops it. */
static bool is_reserved(const char *key)
{
    static const char *const names[] = {"channels",   "chunkCount",         "compression",
                                        "dataWindow", "displayWindow",      "lineOrder",
                                        "name",       "pixelAspectRatio",   "screenWindowWidth",
                                        "tiles",      "screenWindowCenter", "type",
                                        "version"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (strcmp(names[i], key) == 0)
            return true;
    return false;
}

whit_result image_check_texts(const whit_log *log, const char *path, const whit_text *texts,
                              uint32_t count)
{
    bool exr = image_format_of(path) == IMAGE_EXR;
    for (uint32_t i = 0; texts && i < count; ++i) {
        if (exr && is_reserved(texts[i].key))
            return log_failure(log, WHIT_ERROR_USAGE,
                               "%s: a text `%s`: .exr has this name for something else", path,
                               texts[i].key);
        bool good = is_key(texts[i].key);
        for (uint32_t k = 0; good && k < i; ++k)
            good = strcmp(texts[k].key, texts[i].key) != 0;
        if (good)
            continue;
        return log_failure(
            log, WHIT_ERROR_USAGE,
            "%s: a text `%s`: keys have 1 to %d printable characters, no spaces at their "
            "ends or side by side, and differ from one another",
            path, texts[i].key, KEY_MAX);
    }
    return WHIT_OK;
}

whit_result image_save(const whit_log *log, const struct image *image,
                       const struct image_layer *layers, uint32_t layer_count, const char *path,
                       const whit_text *texts, uint32_t text_count)
{
    whit_result result = image_check_savable(log, image, path);
    if (result == WHIT_OK)
        result = check_layers(log, image, layers, layer_count, path);
    if (result == WHIT_OK)
        result = image_check_texts(log, path, texts, text_count);
    if (result != WHIT_OK)
        return result;
    warn_of_nonfinite(log, image, path);
    struct image_target target = {.log = log,
                                  .path = path,
                                  .texts = texts,
                                  .text_count = texts ? text_count : 0,
                                  .layers = layers,
                                  .layer_count = layer_count};
    return image_write_whole(&target, image);
}

whit_result image_encode_png(const whit_log *log, const struct image *image, const whit_text *texts,
                             uint32_t text_count, uint8_t **data, size_t *size_bytes)
{
    static const char name[] = "memory.png";
    char *bytes = NULL;
    *data = NULL;
    *size_bytes = 0;
    whit_result result = image_check_savable(log, image, name);
    if (result == WHIT_OK)
        result = image_check_texts(log, name, texts, text_count);
    if (result != WHIT_OK)
        return result;
    struct image_target target = {.log = log,
                                  .path = name,
                                  .stream = open_memstream(&bytes, size_bytes),
                                  .texts = texts,
                                  .text_count = texts ? text_count : 0};
    if (!target.stream)
        return WHIT_ERROR_MEMORY;
    result = png_write(&target, image);
    bool whole = !ferror(target.stream);
    whole = fclose(target.stream) == 0 && whole;
    if (result == WHIT_OK && !whole)
        result = WHIT_ERROR_MEMORY;
    if (result != WHIT_OK)
        free(bytes);
    else
        *data = (uint8_t *)bytes;
    return result;
}

/* Tells the format by the content, since a file's extension may be wrong. */
static const struct decoder {
    const char *magic;
    whit_result (*load)(const struct image_source *source, struct image *image);
    whit_result (*load_texts)(const struct image_source *source, struct text_list *list);
} decoders[] = {
    {"\x89PNG", png_load, png_load_texts},
    {"\x76\x2f\x31\x01", exr_load, exr_load_texts},
    {"PF", pfm_load, NULL},
    {"Pf", pfm_load, NULL},
    {"#?", hdr_load, NULL},
};

/* NULL: the format is unknown, which was logged. */
static const struct decoder *find_decoder(const struct image_source *source)
{
    for (size_t i = 0; source->size_bytes >= 4 && i < sizeof decoders / sizeof *decoders; ++i)
        if (memcmp(source->data, decoders[i].magic, strlen(decoders[i].magic)) == 0)
            return &decoders[i];
    log_error(source->log, "%s: %s", source->path,
              source->size_bytes ? "not a PNG, EXR, PFM or HDR picture" : "the file is empty");
    return NULL;
}

/* Runs in the child process of image_reply.c. */
whit_result image_decode(const struct image_source *source, struct image *image)
{
    *image = (struct image){0};
    const struct decoder *decoder = find_decoder(source);
    whit_result result = decoder ? decoder->load(source, image) : WHIT_ERROR_INPUT;
    if (result != WHIT_OK)
        image_finish(image);
    return result;
}

whit_result image_decode_texts(const struct image_source *source, struct text_list *list)
{
    const struct decoder *decoder = find_decoder(source);
    if (!decoder)
        return WHIT_ERROR_INPUT;
    return decoder->load_texts ? decoder->load_texts(source, list) : WHIT_OK;
}

bool text_list_add(struct text_list *list, const char *key, const char *value)
{
    whit_text text = {.key = string_copy(key), .value = string_copy(value)};
    if (text.key && text.value && ARRAY_PUSH(list->texts, list->count, list->capacity, text))
        return true;
    free((void *)(uintptr_t)text.key);
    free((void *)(uintptr_t)text.value);
    return false;
}

void text_list_finish(struct text_list *list)
{
    for (uint32_t i = 0; i < list->count; ++i) {
        free((void *)(uintptr_t)list->texts[i].key);
        free((void *)(uintptr_t)list->texts[i].value);
    }
    free(list->texts);
    *list = (struct text_list){0};
}
