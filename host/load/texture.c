#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/load.h"
#include "load/picture.h"

#define FILE_BYTES_MOST ((uint64_t)1 << 29)
#define SIDE_MOST       4096u

static bool known(const struct scene *scene, const char *name, uint32_t *index)
{
    for (uint32_t i = 0; i < scene->texture_count; ++i) {
        if (scene->textures[i].name && strcmp(scene->textures[i].name, name) == 0) {
            *index = i;
            return true;
        }
    }
    return false;
}

/* Silent: a missing texture is a warning of the scene, not an error. */
static whit_result decode_file(struct scene *scene, const char *path,
                               const struct foreign_params *foreign, struct picture *picture,
                               char reason[FOREIGN_REASON_BYTES])
{
    uint8_t *data = NULL;
    size_t size_bytes = 0;
    const struct log silent = {0};
    const char *why_not = roots_why_not(&scene->roots, path);
    whit_result result =
        why_not ? WHIT_ERROR_INPUT
                : file_read(&silent, &scene->roots, path, FILE_BYTES_MOST, &data, &size_bytes);
    snprintf(reason, FOREIGN_REASON_BYTES, "%s",
             why_not                       ? why_not
             : result == WHIT_ERROR_MEMORY ? "out of memory for a texture"
                                           : "it cannot be read");
    if (result != WHIT_OK)
        return result;
    scene->file_bytes += size_bytes;
    result = picture_read(&scene->log, foreign, data, size_bytes, picture, reason);
    free(data);
    return result;
}

/* What a texture that cannot be had looks like; never mistaken for one that can. */
static bool make_magenta(struct picture *picture)
{
    *picture = (struct picture){.width = 1, .height = 1, .rgba = array_alloc(1, 4)};
    if (picture->rgba)
        memcpy(picture->rgba, (const uint8_t[]){255, 0, 255, 255}, 4);
    return picture->rgba != NULL;
}

static bool shrink(struct scene *scene, const char *name, const struct load_params *params,
                   struct picture *picture)
{
    uint32_t most = params && params->texture_limit ? params->texture_limit : SIDE_MOST;
    uint32_t width = picture->width, height = picture->height;
    if (!picture_shrink(picture, most))
        return false;
    if (picture->width != width || picture->height != height)
        scene_note(scene, SCENE_NOTE_INFO, "texture `%s`: shrunk from %ux%u to %ux%u",
                   text_token(path_name(name)).text, width, height, picture->width,
                   picture->height);
    return true;
}

whit_result load_texture(struct scene *scene, const char *path, const uint8_t *data,
                         size_t size_bytes, const struct load_params *params, uint32_t *index,
                         const char **reason)
{
    struct picture picture = {0};
    static _Thread_local char why[FOREIGN_REASON_BYTES]; /* outlives the call */
    const struct foreign_params foreign = load_foreign(params);
    whit_result result = WHIT_ERROR_MEMORY;
    snprintf(why, sizeof why, "out of memory for a texture");
    char *name = data ? string_copy(path) : picture_find(&scene->roots, path);
    *index = SCENE_NONE;
    if (!name)
        goto fail;
    /* A model's stand-in for a missing file does not make it less missing. */
    bool missing = reason && !data && roots_reach(&scene->roots, name) != REACH_FILE;
    if (!missing && known(scene, name, index)) {
        free(name);
        return WHIT_OK;
    }
    result = data ? picture_read(&scene->log, &foreign, data, size_bytes, &picture, why)
                  : decode_file(scene, name, &foreign, &picture, why);
    if (result != WHIT_OK && result != WHIT_ERROR_INPUT)
        goto fail;
    if (result != WHIT_OK && reason) {
        free(name);
        *reason = why;
        return WHIT_ERROR_INPUT;
    }
    if (result != WHIT_OK) {
        scene_note(scene, SCENE_NOTE_WARNING, "texture `%s`: %s; magenta takes its place", name,
                   why);
        if (!make_magenta(&picture))
            goto no_memory;
    }
    if (!shrink(scene, name, params, &picture))
        goto no_memory;
    *index = scene_add_texture(scene, (struct scene_texture){name, picture.width, picture.height,
                                                             picture.rgba, picture.mapped_bytes});
    if (*index != SCENE_NONE)
        return WHIT_OK;
    name = NULL;
    picture = (struct picture){0};
no_memory:
    result = WHIT_ERROR_MEMORY;
    snprintf(why, sizeof why, "out of memory for a texture");
fail:
    log_error(&scene->log, "%s: %s", path, why);
    free(name);
    picture_finish(&picture);
    return result;
}
