#include "load/load.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "scene/afford.h"

/* Errors name what is loaded, also where they are about a file that it names. */
struct named_log {
    const whit_log *to;
    const char *path;
};

static void name_error(void *user, whit_log_level level, const char *message)
{
    const struct named_log *named = user;
    char path[1024], text[9216];
    whit_text_show(named->path, path, sizeof path);
    size_t length = strlen(path);
    bool names = strncmp(message, path, length) == 0 && message[length] == ':';
    if (!names && level == WHIT_LOG_ERROR) {
        snprintf(text, sizeof text, "%s: %s", path, message);
        message = text;
    }
    named->to->fn(named->to->user, level, message);
}

static whit_result read_into(struct scene *scene, const char *path, const whit_load_params *params)
{
    char extension[16];
    path_extension(path, extension, sizeof extension);
    if (strcmp(extension, "json") == 0)
        return load_scene_file(scene, path, params);
    if (load_is_model(path))
        return load_model(scene, path, SCENE_NONE, true, true, params);
    log_error(&scene->log,
              "%s: the extension `.%s` is not known; whit reads .json scenes and " LOAD_MODELS
              " models",
              path, extension);
    return WHIT_ERROR_INPUT;
}

static void tell_refused(const struct roots *roots, const whit_load_params *params)
{
    if (!params || !params->refused)
        return;
    const char *folder = roots->refused_folder ? roots->refused_folder : "";
    params->refused->count = roots->refused_count;
    snprintf(params->refused->folder, sizeof params->refused->folder, "%s", folder);
}

whit_result load_scene(const whit_log *log, const char *path, const whit_load_params *params,
                       struct scene **out)
{
    *out = NULL;
    if (!file_exists(path)) {
        log_error(log, "%s: there is no such file", path);
        return WHIT_ERROR_INPUT;
    }
    struct stat info;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode)) {
        log_error(log, "%s: this is a folder, not a scene or a model", path);
        return WHIT_ERROR_INPUT;
    }
    struct scene *scene = scene_create(log, path);
    if (!scene) {
        log_error(log, "%s: out of memory", path);
        return WHIT_ERROR_MEMORY;
    }
    scene->memory_limit = params && params->memory_limit_bytes ? params->memory_limit_bytes
                                                               : scene_default_memory_limit();
    whit_result result = roots_init(&scene->roots, path);
    for (uint32_t i = 0; params && result == WHIT_OK && i < params->allowed_count; i++)
        result = roots_allow(log, &scene->roots, params->allowed_folders[i]);
    scene->is_model = load_is_model(path);
    struct named_log named = {log, path};
    if (log && log->fn)
        scene->log = (whit_log){.fn = name_error, .user = &named, .level = log->level};
    if (result == WHIT_OK)
        result = read_into(scene, path, params);
    scene->log = log_or_silence(log);
    tell_refused(&scene->roots, params);
    if (result == WHIT_OK)
        result = scene_freeze(scene);
    if (result == WHIT_OK && params && params->cancel && *params->cancel)
        result = WHIT_ERROR_CANCELLED;
    if (result != WHIT_OK) {
        scene_destroy(scene);
        return result;
    }
    *out = scene;
    return WHIT_OK;
}
