#include "load/picture.h"

#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/array.h"
#include "base/file.h"
#include "load/jpeg.h"

/* Set where stb_image could not allocate, which it does not always report. Blocks over
   block_bytes_max are refused: in a PNG stb_image trusts every length, and inflates all data,
   whatever size its header states. */
static _Thread_local bool lacks_memory, over_limit;
static _Thread_local uint64_t block_bytes_max;

/* Bytes from `held` on are zero: of a damaged file stb_image gives away pixels that it has not
   written. */
static void *take_block(void *block, size_t held, size_t bytes)
{
    if (bytes > block_bytes_max) {
        over_limit = true;
        return NULL;
    }
    void *memory = block ? realloc(block, bytes) : calloc(1, bytes);
    lacks_memory |= !memory;
    if (block && memory && bytes > held)
        memset((char *)memory + held, 0, bytes - held);
    return memory;
}

#define STBI_MALLOC(bytes)                     take_block(NULL, 0, bytes)
#define STBI_REALLOC_SIZED(block, held, bytes) take_block(block, held, bytes)
#define STBI_FREE(block)                       free(block)
#define STBI_NO_STDIO
#define STBI_NO_JPEG /* a damaged file makes stb_image write out of bounds */
#define STBI_NO_PIC
#define STBI_NO_PSD
#define STBI_NO_PNM
#define STBI_NO_HDR /* stb_image never ends on a truncated row; image/ reads .hdr instead */
#define STBI_NO_LINEAR
#define SIDE_MAX            16384
#define STBI_MAX_DIMENSIONS SIDE_MAX
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
/* Never popped: unused declarations are reported at the end of the file. */
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

#define PIXELS_MAX       ((uint64_t)1 << 26)
/* Decoders allocate the size that a header states, so headers that cannot be true are refused. A
   byte of a PNG makes the most pixels: deflate expands it to at most 1032 bytes of 8 pixels
   each. */
#define PIXELS_FREE      ((uint64_t)1 << 16)
#define PIXELS_PER_BYTE  ((uint64_t)8 * 1032)
#define BLOCK_BYTES_FREE ((uint64_t)1 << 18) /* tables of decoders */

const char *picture_why_refused(uint32_t width, uint32_t height, size_t size_bytes,
                                uint64_t pixels_max, struct picture *sides)
{
    uint64_t pixels = (uint64_t)width * height;
    *sides = (struct picture){0};
    if (pixels == 0)
        return "it is empty";
    if (pixels > PIXELS_MAX)
        return "it has more than 2^26 pixels";
    if (width > SIDE_MAX || height > SIDE_MAX)
        return "a side has more than 16384 pixels";
    if (pixels > PIXELS_FREE + PIXELS_PER_BYTE * size_bytes)
        return "its header tells of more than there is in it";
    if (pixels <= pixels_max)
        return NULL;
    *sides = (struct picture){.width = width, .height = height};
    return "it has more pixels than the memory limit allows";
}

/* stb_image's reason for a failure; "damaged" if it quotes unprintable bytes of the file. */
static const char *failure_reason(void)
{
    const char *reason = stbi_failure_reason();
    for (const char *at = reason; at && *at; ++at) {
        if (*at < ' ' || *at > '~')
            return "damaged";
    }
    return reason && *reason ? reason : "damaged";
}

whit_result picture_decode(const uint8_t *data, size_t size_bytes, uint64_t pixels_max,
                           struct picture *out, const char **reason)
{
    *out = (struct picture){0};
    *reason = "it is not a picture that whit reads (PNG, JPEG, BMP, TGA, GIF)";
    if (size_bytes > INT_MAX)
        return WHIT_ERROR_INPUT;
    if (jpeg_is(data, size_bytes))
        return jpeg_decode(data, size_bytes, pixels_max, out, reason);
    int size = (int)size_bytes, width, height, channels;
    block_bytes_max = BLOCK_BYTES_FREE;
    lacks_memory = over_limit = false;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels))
        return WHIT_ERROR_INPUT;
    const char *refused =
        picture_why_refused((uint32_t)(width > 0 ? width : 0), (uint32_t)(height > 0 ? height : 0),
                            size_bytes, pixels_max, out);
    if (refused) {
        *reason = refused;
        return WHIT_ERROR_INPUT;
    }
    /* Room for 4 channels of 16 bits in a buffer that grows by doubling, and for the file's bytes
       in another such buffer. */
    block_bytes_max =
        BLOCK_BYTES_FREE + 2 * size_bytes + 16 * ((uint64_t)(uint32_t)width + 1) * (uint32_t)height;
    out->rgba = stbi_load_from_memory(data, size, &width, &height, &channels, 4);
    if (!out->rgba) {
        *reason = over_limit ? "it holds more than its header tells of" : failure_reason();
        if (!lacks_memory)
            return WHIT_ERROR_INPUT;
        *reason = "out of memory";
        return WHIT_ERROR_MEMORY;
    }
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    return WHIT_OK;
}

/* --- in a child ----------------------------------------------------------------------------- */

struct file {
    const uint8_t *data;
    size_t size_bytes;
    uint64_t pixels_max;
};

static whit_result decode_file(void *user, void *to, child_write write,
                               struct foreign_answer *answer)
{
    const struct file *file = user;
    struct picture picture;
    const char *reason = "";
    whit_result result =
        picture_decode(file->data, file->size_bytes, file->pixels_max, &picture, &reason);
    snprintf(answer->reason, sizeof answer->reason, "%s", reason);
    answer->numbers[0] = picture.width;
    answer->numbers[1] = picture.height;
    if (result == WHIT_OK)
        (void)write(to, picture.rgba, (size_t)picture.width * picture.height * 4);
    picture_finish(&picture);
    return result;
}

whit_result picture_read(const whit_log *log, const struct foreign_params *params,
                         uint64_t pixels_max, const uint8_t *data, size_t size_bytes,
                         struct picture *out, char reason[FOREIGN_REASON_BYTES])
{
    struct file file = {data, size_bytes, pixels_max};
    struct child_reply reply;
    struct foreign_answer answer;
    struct child_limits limits = foreign_limits(params, "decoder", size_bytes, 4 * PIXELS_MAX);
    *out = (struct picture){0};
    whit_result result = foreign_ask(log, &limits, decode_file, &file, &reply, &answer);
    memcpy(reason, answer.reason, sizeof answer.reason);
    out->width = answer.numbers[0];
    out->height = answer.numbers[1];
    if (result != WHIT_OK)
        return result;
    uint64_t pixels = (uint64_t)answer.numbers[0] * answer.numbers[1];
    if (pixels == 0 || pixels > PIXELS_MAX || reply.size_bytes != 4 * pixels + sizeof answer) {
        snprintf(reason, FOREIGN_REASON_BYTES, "the decoder's reply is damaged");
        child_reply_free(&reply);
        return WHIT_ERROR_INPUT;
    }
    *out = (struct picture){.width = answer.numbers[0],
                            .height = answer.numbers[1],
                            .rgba = reply.data,
                            .mapped_bytes = reply.size_bytes};
    return WHIT_OK;
}

/* --- what becomes of it --------------------------------------------------------------------- */

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

bool picture_shrink(struct picture *picture, uint32_t side_max)
{
    while (picture->width > side_max || picture->height > side_max) {
        if ((picture->width <= 1 && picture->height <= 1) || !halve(picture))
            return false;
    }
    return true;
}

void picture_finish(struct picture *picture)
{
    struct child_reply held = {.data = picture->rgba, .size_bytes = picture->mapped_bytes};
    if (picture->mapped_bytes)
        child_reply_free(&held);
    else
        free(picture->rgba);
    free(picture->rgb);
    *picture = (struct picture){0};
}

/* Replaces the part of `path` in [start, end) by an entry of its folder that differs by case alone.
   Folders outside of the roots are not searched. */
static bool match_part(const struct roots *roots, char *path, size_t start, size_t end)
{
    char kept_end = path[end], kept_start = path[start];
    char part[NAME_MAX + 1];
    if (end - start > NAME_MAX)
        return false;
    memcpy(part, path + start, end - start);
    part[end - start] = '\0';
    path[start] = '\0';
    const char *name = start ? path : ".";
    DIR *folder = roots_reach(roots, name) == REACH_NOT_A_FILE ? opendir(name) : NULL;
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

char *picture_find(const struct roots *roots, const char *path)
{
    char *found = string_copy(path);
    if (!found || roots_reach(roots, found) != REACH_MISSING)
        return found;
    for (char *c = found; *c; ++c) {
        if (*c == '\\')
            *c = '/';
    }
    char *plain = string_copy(found);
    if (!plain || roots_reach(roots, found) != REACH_MISSING) {
        free(plain);
        return found;
    }
    for (size_t start = 0; found[start];) {
        size_t end = start + strcspn(found + start, "/");
        if (end > start && !exists_up_to(found, end) && !match_part(roots, found, start, end)) {
            free(found);
            return plain;
        }
        start = end + (found[end] == '/');
    }
    free(plain);
    return found;
}

char *picture_find_named(const struct roots *roots, const char *from, const char *name)
{
    char *written = roots_join(from, name);
    if (!written || roots_reach(roots, written) == REACH_FILE)
        return written;
    free(written);
    char *slashed = string_copy(name);
    for (char *c = slashed; c && *c; c++)
        *c = *c == '\\' ? '/' : *c;
    if (!slashed)
        return NULL;
    char *path = roots_join(from, slashed);
    char *bare = path_beside(from, path_name(slashed));
    free(slashed);
    if (!path || !bare || roots_reach(roots, path) == REACH_FILE) {
        free(bare);
        return path;
    }
    if (roots_reach(roots, bare) != REACH_FILE) { /* in another case */
        char *cased = picture_find(roots, path), *beside = picture_find(roots, bare);
        bool found = cased && roots_reach(roots, cased) != REACH_FILE && beside &&
                     roots_reach(roots, beside) == REACH_FILE;
        free(cased);
        free(bare);
        bare = found ? beside : NULL;
        if (!found)
            free(beside);
    }
    free(bare ? path : NULL);
    return bare ? bare : path;
}

void picture_inflate(const uint8_t *data, size_t size_bytes, char *out, int out_bytes)
{
    int bytes = size_bytes < INT_MAX ? (int)size_bytes : INT_MAX;
    /* Output that does not fit is an error of stb_image, but `out` is filled all the same. */
    (void)stbi_zlib_decode_noheader_buffer(out, out_bytes, (const char *)data, bytes);
}
