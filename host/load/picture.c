#include "load/picture.h"

#include <dirent.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/array.h"
#include "base/file.h"

/* stb_image does not always say so. */
static _Thread_local bool lacks_memory;

static void *taken(void *memory)
{
    lacks_memory |= !memory;
    return memory;
}

#define STBI_MALLOC(bytes)         taken(malloc(bytes))
#define STBI_REALLOC(block, bytes) taken(realloc(block, bytes))
#define STBI_FREE(block)           free(block)
#define STBI_NO_STDIO
#define STBI_NO_PIC
#define STBI_NO_PSD
#define STBI_NO_PNM
#define STBI_MAX_DIMENSIONS 16384
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
/* Functions declared and never defined are reported at the end of the file: no pop helps there. */
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wcast-align"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

/* 8192 x 8192: what a small file can make us allocate. */
#define PIXELS_MOST ((uint64_t)1 << 26)

whit_result picture_decode(const uint8_t *data, size_t size_bytes, bool linear, struct picture *out,
                           const char **reason)
{
    *out = (struct picture){0};
    *reason = "it is not a picture that whit reads (PNG, JPEG, BMP, TGA, GIF)";
    if (size_bytes > INT_MAX)
        return WHIT_ERROR_INPUT;
    int size = (int)size_bytes, width, height, channels;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels))
        return WHIT_ERROR_INPUT;
    if (width <= 0 || height <= 0 || (uint64_t)width * (uint64_t)height > PIXELS_MOST) {
        *reason = "it has more than 2^26 pixels";
        return WHIT_ERROR_INPUT;
    }
    lacks_memory = false;
    if (linear)
        out->rgb = stbi_loadf_from_memory(data, size, &width, &height, &channels, 3);
    else
        out->rgba = stbi_load_from_memory(data, size, &width, &height, &channels, 4);
    if (!out->rgb && !out->rgba) {
        *reason = stbi_failure_reason() ? stbi_failure_reason() : "damaged";
        if (!lacks_memory)
            return WHIT_ERROR_INPUT;
        *reason = "out of memory";
        return WHIT_ERROR_MEMORY;
    }
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    return WHIT_OK;
}

static void halve_bytes(const struct picture *from, struct picture *to)
{
    for (uint32_t y = 0; y < to->height; ++y) {
        for (uint32_t x = 0; x < 4 * to->width; ++x) {
            size_t x0 = 4 * (size_t)(x / 4) * 2 + x % 4, y0 = 2 * (size_t)y;
            size_t right = from->width > 1 ? 4 : 0, down = from->height > 1 ? 1 : 0;
            const uint8_t *a = from->rgba + y0 * from->width * 4 + x0;
            const uint8_t *b = from->rgba + (y0 + down) * from->width * 4 + x0;
            to->rgba[(size_t)y * to->width * 4 + x] =
                (uint8_t)((a[0] + a[right] + b[0] + b[right] + 2) / 4);
        }
    }
}

static void halve_floats(const struct picture *from, struct picture *to)
{
    for (uint32_t y = 0; y < to->height; ++y) {
        for (uint32_t x = 0; x < 3 * to->width; ++x) {
            size_t x0 = 3 * (size_t)(x / 3) * 2 + x % 3, y0 = 2 * (size_t)y;
            size_t right = from->width > 1 ? 3 : 0, down = from->height > 1 ? 1 : 0;
            const float *a = from->rgb + y0 * from->width * 3 + x0;
            const float *b = from->rgb + (y0 + down) * from->width * 3 + x0;
            to->rgb[(size_t)y * to->width * 3 + x] =
                0.25f * ((a[0] + a[right]) + (b[0] + b[right]));
        }
    }
}

static bool halve(struct picture *picture)
{
    struct picture half = {.width = picture->width > 1 ? picture->width / 2 : 1,
                           .height = picture->height > 1 ? picture->height / 2 : 1};
    size_t pixels = (size_t)half.width * half.height;
    if (picture->rgba)
        half.rgba = array_alloc(pixels, 4);
    else
        half.rgb = array_alloc(pixels, 3 * sizeof(float));
    if (!half.rgba && !half.rgb)
        return false;
    if (picture->rgba)
        halve_bytes(picture, &half);
    else
        halve_floats(picture, &half);
    picture_finish(picture);
    *picture = half;
    return true;
}

bool picture_shrink(struct picture *picture, uint32_t side_most)
{
    while (picture->width > side_most || picture->height > side_most) {
        if ((picture->width <= 1 && picture->height <= 1) || !halve(picture))
            return false;
    }
    return true;
}

void picture_finish(struct picture *picture)
{
    free(picture->rgba);
    free(picture->rgb);
    *picture = (struct picture){0};
}

/* Replaces the part of `path` in [start, end) by the folder's entry that equals it but for case. */
static bool match_part(char *path, size_t start, size_t end)
{
    char kept_end = path[end], kept_start = path[start];
    char part[NAME_MAX + 1];
    if (end - start > NAME_MAX)
        return false;
    memcpy(part, path + start, end - start);
    part[end - start] = '\0';
    path[start] = '\0';
    DIR *folder = opendir(start ? path : ".");
    path[start] = kept_start;
    if (!folder)
        return false;
    bool found = false;
    for (struct dirent *entry; !found && (entry = readdir(folder));) {
        if (strcasecmp(entry->d_name, part) == 0) {
            memcpy(path + start, entry->d_name, end - start);
            found = true;
        }
    }
    closedir(folder);
    path[end] = kept_end;
    return found;
}

static bool exists_up_to(char *path, size_t end)
{
    char kept = path[end];
    path[end] = '\0';
    bool exists = access(path, F_OK) == 0;
    path[end] = kept;
    return exists;
}

char *picture_find(const char *path)
{
    char *found = string_copy(path);
    if (!found || file_exists(found))
        return found;
    for (char *c = found; *c; ++c) {
        if (*c == '\\')
            *c = '/';
    }
    char *plain = string_copy(found);
    if (!plain || file_exists(found)) {
        free(plain);
        return found;
    }
    for (size_t start = 0; found[start];) {
        size_t end = start + strcspn(found + start, "/");
        if (end > start && !exists_up_to(found, end) && !match_part(found, start, end)) {
            free(found);
            return plain;
        }
        start = end + (found[end] == '/');
    }
    free(plain);
    return found;
}
