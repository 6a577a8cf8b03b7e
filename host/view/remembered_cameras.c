#include "view/remembered_cameras.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <jansson.h>

#include "base/array.h"
#include "base/file.h"

enum { SCENES_MAX = 200 };

/* The folder, with a slash at its end; NULL: there is none. free(). */
static char *state_folder(void)
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    if (state && state[0] == '/')
        return string_format("%s/whit/", state);
    return home && home[0] == '/' ? string_format("%s/.local/state/whit/", home) : NULL;
}

/* Makes the folder, and those above it. */
static void make_folder(const char *folder)
{
    char *path = string_copy(folder);
    for (char *at = path ? path + 1 : NULL; at && *at; ++at) {
        if (*at != '/')
            continue;
        *at = '\0';
        (void)mkdir(path, 0700); /* if it fails, writing fails too */
        *at = '/';
    }
    free(path);
}

static char *file_path(void)
{
    char *folder = state_folder();
    char *path = folder ? string_format("%scameras.json", folder) : NULL;
    free(folder);
    return path;
}

/* Loads the file. One that is damaged counts as empty, as it holds nothing of value. NULL: no
   memory. */
static json_t *load(const char *path)
{
    json_t *all = path ? json_load_file(path, 0, NULL) : NULL;
    if (json_is_object(all))
        return all;
    json_decref(all);
    return json_object();
}

/* The absolute path of a scene file, so that it is the same from every folder. free(). */
static char *scene_key(const char *scene)
{
    char *real = realpath(scene, NULL);
    return real ? real : string_copy(scene);
}

bool memory_find(const char *scene, char *camera, size_t camera_bytes)
{
    char *path = file_path(), *key = scene_key(scene);
    json_t *all = load(path);
    const char *text = key ? json_string_value(json_object_get(all, key)) : NULL;
    bool found = text && strlen(text) < camera_bytes;
    if (found)
        memcpy(camera, text, strlen(text) + 1);
    json_decref(all);
    free(key);
    free(path);
    return found;
}

/* Drops the oldest entries: objects keep the order in which they were filled. */
static void forget_old(json_t *all)
{
    while (json_object_size(all) > SCENES_MAX)
        json_object_del(all, json_object_iter_key(json_object_iter(all)));
}

static void save(const whit_log *log, const char *path, const json_t *all)
{
    struct file_write file = {0};
    char *text = json_dumps(all, JSON_INDENT(1));
    if (!text || file_write_begin(log, path, &file) != WHIT_OK) {
        free(text);
        return;
    }
    fputs(text, file.stream);
    free(text);
    if (file_write_commit(log, &file) != WHIT_OK)
        log_warning(log, "%s: cameras are not remembered", path);
}

void memory_keep(const whit_log *log, const char *scene, const char *camera)
{
    char *folder = state_folder(), *path = file_path(), *key = scene_key(scene);
    if (folder && path && key) {
        make_folder(folder);
        json_t *all = load(path);
        json_object_del(all, key); /* the scene is then added as the newest */
        if (camera[0])
            json_object_set_new(all, key, json_string(camera));
        forget_old(all);
        save(log, path, all);
        json_decref(all);
    }
    free(folder);
    free(path);
    free(key);
}
