#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"
#include "load/texture_ahead.h"
#include "scene/afford.h"

#define FILE_BYTES_MAX ((uint64_t)1 << 29)
#define SIDE_MAX       4096u

enum { BY_FILE = 1, BY_BYTES };

static uint32_t limit_of(const whit_load_params *params)
{
    return params && params->texture_limit ? params->texture_limit : SIDE_MAX;
}

void texture_key_file(const char *path, const whit_load_params *params,
                      struct texture_source *source)
{
    struct stat info;
    if (stat(path, &info) == 0)
        source->keys[source->key_count++] = (struct texture_key){
            BY_FILE,
            0,
            limit_of(params),
            {info.st_dev, info.st_ino, (uint64_t)info.st_size,
             (uint64_t)info.st_mtim.tv_sec ^ (uint64_t)info.st_mtim.tv_nsec << 34}};
}

/* If a texture with this key exists, makes it also the texture of `name`. `damaged_too`: finds also
   pictures that could not be decoded, whose texture is magenta. */
static bool share(struct scene *scene, const char *name, struct texture_key key, bool damaged_too,
                  uint32_t *index)
{
    bool found = key_table_find(&scene->texture_keys, &key, sizeof key, index);
    key.damaged = 1;
    if (!found && damaged_too && key_table_find(&scene->texture_keys, &key, sizeof key, index)) {
        scene_note(scene, SCENE_NOTE_WARNING,
                   "texture `%s`: the same as `%s`; magenta takes its place",
                   text_token(path_name(name)).text,
                   text_token(path_name(scene->textures[*index].name)).text);
        found = true;
    }
    if (found)
        scene->lacks_memory |= !key_table_add(&scene->texture_keys, name, strlen(name), *index);
    return found;
}

/* Keeps the reason of an error that is logged about `path`. */
struct unread {
    const char *path;
    char *reason;
};

static void keep_reason(void *user, whit_log_level level, const char *message)
{
    const struct unread *unread = user;
    char path[4 * 2048]; /* escaped, as in messages */
    whit_text_show(unread->path, path, sizeof path);
    size_t length = strlen(path);
    bool named = strncmp(message, path, length) == 0 && message[length] == ':';
    (void)level;
    snprintf(unread->reason, FOREIGN_REASON_BYTES, "%s",
             named ? message + length + 2 : "it cannot be read");
}

whit_result texture_read(const struct scene *scene, const char *path,
                         const whit_load_params *params, struct texture_source *source,
                         char reason[FOREIGN_REASON_BYTES])
{
    struct unread unread = {path, reason};
    const whit_log silent = {.fn = keep_reason, .user = &unread, .level = WHIT_LOG_ERROR};
    if (!source->data) {
        whit_result result = file_read(&silent, &scene->roots, path, FILE_BYTES_MAX, &source->owned,
                                       &source->size_bytes);
        if (result != WHIT_OK)
            return result;
        source->data = source->owned;
    }
    source->keys[source->key_count++] = (struct texture_key){
        BY_BYTES,
        0,
        limit_of(params),
        {source->size_bytes, hash_bytes(HASH_START, source->data, source->size_bytes),
         hash_bytes(1, source->data, source->size_bytes)}};
    source->hashed = true;
    return WHIT_OK;
}

/* Decodes the picture, unless its header states more pixels than the memory limit allows. */
static whit_result decode_source(struct scene *scene, const char *name,
                                 const struct foreign_params *foreign,
                                 struct texture_source *source, struct picture *picture,
                                 char reason[FOREIGN_REASON_BYTES])
{
    uint64_t pixels_max = scene_room(scene) / scene_texture_cost(1, 1);
    whit_result result = WHIT_OK;
    if (!texture_take_picture(scene, source, pixels_max, picture))
        result = picture_read(&scene->log, foreign, pixels_max, source->data, source->size_bytes,
                              picture, reason);
    uint64_t pixels = (uint64_t)picture->width * picture->height;
    if (result != WHIT_OK && (result != WHIT_ERROR_INPUT || pixels <= pixels_max))
        return result;
    source->too_large = !scene_afford(
        scene, scene_texture_cost(picture->width, picture->height), "texture `%s` of %ux%u pixels",
        text_token(path_name(name)).text, picture->width, picture->height);
    return source->too_large ? WHIT_ERROR_INPUT : result;
}

/* Decodes a picture; if it is a texture of the scene already, sets *index to that instead. */
static whit_result decode(struct scene *scene, const char *name, const whit_load_params *params,
                          bool damaged_too, struct texture_source *source, struct picture *picture,
                          uint32_t *index, char reason[FOREIGN_REASON_BYTES])
{
    const struct foreign_params foreign = load_foreign(params);
    if (!source->data) {
        const char *why_not = roots_why_not(&scene->roots, name);
        if (why_not) {
            snprintf(reason, FOREIGN_REASON_BYTES, "%s", why_not);
            return WHIT_ERROR_INPUT;
        }
        texture_key_file(name, params, source);
        if (source->key_count > 0 && share(scene, name, source->keys[0], damaged_too, index))
            return WHIT_OK;
        texture_take_source(scene, source);
    }
    bool is_file = !source->data || source->owned;
    whit_result result =
        source->hashed ? WHIT_OK : texture_read(scene, name, params, source, reason);
    scene->file_bytes += is_file ? source->size_bytes : 0;
    if (result != WHIT_OK ||
        share(scene, name, source->keys[source->key_count - 1], damaged_too, index))
        return result;
    return decode_source(scene, name, &foreign, source, picture, reason);
}

/* Makes the picture that replaces an unreadable texture: plain magenta, which nobody overlooks. */
static bool make_magenta(struct picture *picture)
{
    *picture = (struct picture){.width = 1, .height = 1, .rgba = array_alloc(1, 4)};
    if (picture->rgba)
        memcpy(picture->rgba, (const uint8_t[]){255, 0, 255, 255}, 4);
    return picture->rgba != NULL;
}

static bool shrink(struct scene *scene, const char *name, const whit_load_params *params,
                   struct picture *picture)
{
    uint32_t width = picture->width, height = picture->height;
    if (!picture_shrink(picture, limit_of(params)))
        return false;
    scene_give_back(scene, scene_texture_cost(width, height) -
                               scene_texture_cost(picture->width, picture->height));
    if (picture->width != width || picture->height != height)
        scene_note(scene, SCENE_NOTE_INFO, "texture `%s`: shrunk from %ux%u to %ux%u",
                   text_token(path_name(name)).text, width, height, picture->width,
                   picture->height);
    return true;
}

static bool add(struct scene *scene, char *name, const struct picture *picture, bool damaged,
                struct texture_source *source, uint32_t *index)
{
    *index = scene_add_texture(scene, (struct scene_texture){name, picture->width, picture->height,
                                                             picture->rgba, picture->mapped_bytes});
    bool ok = *index != SCENE_NONE;
    for (uint32_t i = 0; ok && i < source->key_count; ++i) {
        source->keys[i].damaged = damaged;
        ok = key_table_add(&scene->texture_keys, &source->keys[i], sizeof source->keys[i], *index);
    }
    return ok;
}

whit_result load_texture(struct scene *scene, const char *path, const uint8_t *data,
                         size_t size_bytes, const whit_load_params *params, uint32_t *index,
                         const char **reason)
{
    static _Thread_local char why[FOREIGN_REASON_BYTES]; /* *reason points here after the call */
    struct picture picture = {0};
    struct texture_source source = {.data = data, .size_bytes = size_bytes};
    char *name = data ? string_copy(path) : picture_find(&scene->roots, path);
    whit_result result = WHIT_ERROR_MEMORY;
    bool said = false;
    snprintf(why, sizeof why, "out of memory for a texture");
    *index = SCENE_NONE;
    if (!name)
        goto done;
    /* A missing file is reported to the caller even if it has a magenta texture by now. */
    bool missing = reason && !data && roots_reach(&scene->roots, name) != REACH_FILE;
    result = WHIT_OK;
    if (!missing && scene_find_texture(scene, name, index))
        goto done;
    result = decode(scene, name, params, !reason, &source, &picture, index, why);
    said = source.too_large;
    if ((result != WHIT_OK && result != WHIT_ERROR_INPUT) || *index != SCENE_NONE || said)
        goto done;
    bool damaged = result != WHIT_OK;
    if (damaged && reason) {
        *reason = why;
        said = true; /* the caller will report it */
        goto done;
    }
    if (damaged)
        scene_note(scene, SCENE_NOTE_WARNING, "texture `%s`: %s; magenta takes its place",
                   text_token(path_name(name)).text, why);
    result = WHIT_ERROR_MEMORY;
    snprintf(why, sizeof why, "out of memory for a texture");
    if ((damaged && !make_magenta(&picture)) || !shrink(scene, name, params, &picture))
        goto done;
    if (add(scene, name, &picture, damaged, &source, index)) {
        scene->textures_missing += damaged;
        result = WHIT_OK;
    }
    name = NULL;
    picture = (struct picture){0};
done:
    if (result != WHIT_OK && !said)
        log_error(&scene->log, "%s: %s", path, why);
    free(name);
    free(source.owned);
    picture_finish(&picture);
    return result;
}
