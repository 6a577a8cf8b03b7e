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

/* NULL: there is no folder for it. free(). */
static char *file_path(void)
{
    static const char name[] = "whit/cameras.json";
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    if (state && state[0] == '/')
        return string_format("%s/%s", state, name);
    return home && home[0] == '/' ? string_format("%s/.local/state/%s", home, name) : NULL;
}

/* Makes the folders that the file lies in. */
static void make_folders(char *path)
{
    for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        (void)mkdir(path, 0700); /* if it fails, writing fails too */
        *slash = '/';
    }
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
    const whit_log silence = log_or_silence(NULL);
    char *text = json_dumps(all, JSON_INDENT(1));
    if (!text || file_write_whole(&silence, path, text, strlen(text)) != WHIT_OK)
        log_warning(log, "%s: cannot be written: the camera is not remembered", path);
    free(text);
}

void memory_keep(const whit_log *log, const char *scene, const char *camera)
{
    char *path = file_path(), *key = scene_key(scene);
    if (path && key) {
        make_folders(path);
        json_t *all = load(path);
        json_object_del(all, key); /* the scene is then added as the newest */
        if (camera[0])
            json_object_set_new(all, key, json_string(camera));
        forget_old(all);
        save(log, path, all);
        json_decref(all);
    }
    free(path);
    free(key);
}
