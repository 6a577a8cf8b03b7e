#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "image/image.h"
#include "image/image_reply.h"
#include "load/load.h"
#include "load/picture.h"
#include "scene/afford.h"

#define FILE_BYTES_MAX ((uint64_t)1 << 30)
#define SIDE_MAX       4096u /* 4096 x 2048 floats RGB are 96 MiB, under the storage-buffer limit */

/* Reads a .hdr, .exr or .pfm: grey spreads to RGB, alpha is dropped. */
static whit_result read_image(const struct scene *scene, const char *path,
                              const struct foreign_params *foreign, struct picture *out)
{
    const whit_log *log = &scene->log;
    struct image image = {0};
    whit_result result = image_load(log, &scene->roots, path, foreign, &image);
    if (result != WHIT_OK)
        return result;
    size_t pixels = (size_t)image.width * image.height;
    *out = (struct picture){.width = image.width, .height = image.height};
    if (!image.pixels) {
        log_error(log, "%s: it holds integers, not colours", path);
        result = WHIT_ERROR_INPUT;
        goto done;
    }
    out->rgb = array_alloc(pixels, 3 * sizeof(float));
    if (!out->rgb) {
        log_error(log, "%s: out of memory", path);
        result = WHIT_ERROR_MEMORY;
        goto done;
    }
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t k = 0; k < 3; ++k)
            out->rgb[3 * i + k] = image.pixels[i * image.channels + (image.channels >= 3 ? k : 0)];
    }
done:
    image_finish(&image);
    return result;
}

static whit_result linearize(const whit_log *log, const char *path, struct picture *picture)
{
    float table[256];
    for (int i = 0; i < 256; ++i)
        table[i] = image_linear_from_srgb((float)i / 255.0f);
    size_t pixels = (size_t)picture->width * picture->height;
    picture->rgb = array_alloc(pixels, 3 * sizeof(float));
    if (!picture->rgb)
        return log_failure(log, WHIT_ERROR_MEMORY, "%s: out of memory", path);
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t k = 0; k < 3; ++k)
            picture->rgb[3 * i + k] = table[picture->rgba[4 * i + k]];
    }
    struct picture bytes = {.rgba = picture->rgba, .mapped_bytes = picture->mapped_bytes};
    picture_finish(&bytes);
    picture->rgba = NULL;
    picture->mapped_bytes = 0;
    return WHIT_OK;
}

static uint64_t cost_of(uint32_t width, uint32_t height)
{
    return scene_texel_cost(3 * (uint64_t)width, height);
}

static bool afford(struct scene *scene, const char *path, const struct picture *picture)
{
    return scene_afford(scene, cost_of(picture->width, picture->height),
                        "environment `%s` of %ux%u pixels", text_token(path_name(path)).text,
                        picture->width, picture->height);
}

/* Reads an 8-bit picture. It is not decoded if its header states more pixels than the scene's
   memory limit allows. */
static whit_result read_picture(struct scene *scene, const char *path,
                                const struct foreign_params *foreign, struct picture *out)
{
    const whit_log *log = &scene->log;
    uint8_t *data = NULL;
    size_t size_bytes = 0;
    char reason[FOREIGN_REASON_BYTES];
    whit_result result = file_read(log, &scene->roots, path, FILE_BYTES_MAX, &data, &size_bytes);
    if (result != WHIT_OK)
        return result;
    uint64_t max = scene_room(scene) / scene_texel_cost(3, 1);
    result = picture_read(log, foreign, max, data, size_bytes, out, reason);
    free(data);
    bool too_large = result == WHIT_ERROR_INPUT && (uint64_t)out->width * out->height > max;
    if (too_large && !afford(scene, path, out))
        return result;
    if (result != WHIT_OK)
        log_error(log, "%s: %s", path, reason);
    else
        result = linearize(log, path, out);
    return result;
}

static uint64_t bytes_of(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? (uint64_t)info.st_size : 0;
}

whit_result load_environment(struct scene *scene, const char *path, const whit_load_params *params)
{
    const struct foreign_params foreign = load_foreign(params);
    const whit_log *log = &scene->log;
    char extension[16];
    struct picture picture = {0};
    whit_result result = WHIT_ERROR_MEMORY;
    char *found = picture_find(&scene->roots, path);
    if (!found) {
        log_error(log, "%s: out of memory", path);
        return result;
    }
    path_extension(found, extension, sizeof extension);
    if (strcmp(extension, "hdr") == 0 || strcmp(extension, "exr") == 0 ||
        strcmp(extension, "pfm") == 0)
        result = read_image(scene, found, &foreign, &picture);
    else
        result = read_picture(scene, found, &foreign, &picture);
    if (result != WHIT_OK)
        goto fail;
    if (!afford(scene, path, &picture)) {
        result = WHIT_ERROR_INPUT;
        goto fail;
    }
    uint64_t whole_cost = cost_of(picture.width, picture.height);
    if (!picture_shrink(&picture, SIDE_MAX)) {
        log_error(log, "%s: out of memory", path);
        result = WHIT_ERROR_MEMORY;
        goto fail;
    }
    scene_give_back(scene, whole_cost - cost_of(picture.width, picture.height));
    load_drop_environment(scene);
    struct scene_environment *sky = &scene->environment;
    sky->kind = WHIT_ENVIRONMENT_MAP;
    sky->width = picture.width;
    sky->height = picture.height;
    sky->rgb = picture.rgb;
    sky->name = found;
    scene->has_environment = true;
    scene->file_bytes += bytes_of(sky->name);
    return WHIT_OK;
fail:
    picture_finish(&picture);
    free(found);
    return result;
}
