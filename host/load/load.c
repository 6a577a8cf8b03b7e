#include "load/load.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/color.h"
#include "base/file.h"
#include "base/input.h"
#include "base/path.h"
#include "base/text.h"
#include "load/format.h"
#include "load/model.h"
#include "load/up.h"
#include "scene/afford.h"

#define KNOWN "whit reads .json scenes and " LOAD_MODELS " models"

/* A log that puts the loaded file's path before errors about other files that it refers to. */
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

static bool has_no_axes(const char *path)
{
    char extension[8];
    path_extension(path, extension, sizeof extension);
    return strcmp(extension, "obj") == 0 || strcmp(extension, "ply") == 0 ||
           strcmp(extension, "stl") == 0 || strcmp(extension, "off") == 0;
}

static whit_result read_model(struct scene *scene, const char *path, const whit_load_params *params)
{
    whit_up up = params ? params->up : WHIT_UP_Y;
    uint32_t parent = SCENE_NONE;
    if (up != WHIT_UP_AUTO && up != WHIT_UP_Y)
        parent = up_add_node(scene, up);
    if (up != WHIT_UP_AUTO && up != WHIT_UP_Y && parent == SCENE_NONE)
        return WHIT_ERROR_MEMORY;
    whit_result result = load_model(scene, path, parent, true, true, params);
    return result == WHIT_OK && up == WHIT_UP_AUTO && has_no_axes(path)
               ? up_turn_by_shape(scene, path)
               : result;
}

void load_drop_environment(struct scene *scene)
{
    struct scene_environment *sky = &scene->environment;
    scene_give_back(scene, scene_texel_cost(3 * (uint64_t)sky->width, sky->height));
    free(sky->rgb);
    free(sky->name);
    *sky = (struct scene_environment){.scale = {1, 1, 1}};
}

/* Puts --environment or --background in the place of the file's environment. */
static whit_result replace_sky(struct scene *scene, const whit_load_params *params)
{
    struct scene_environment *sky = &scene->environment;
    if (params->environment) {
        /* The user named this file, so its folder is allowed; the scene itself was read before. */
        char *folder = path_folder(params->environment);
        whit_result result = folder
                                 ? roots_allow(&scene->log, &scene->roots, folder[0] ? folder : ".")
                                 : WHIT_ERROR_MEMORY;
        free(folder);
        return result == WHIT_OK ? load_environment(scene, params->environment, params) : result;
    }
    if (!params->has_background)
        return WHIT_OK;
    load_drop_environment(scene);
    for (int i = 0; i < 3; ++i)
        sky->zenith[i] = sky->horizon[i] = sky->ground[i] =
            (float)linear_from_srgb(params->background[i] / 255.0);
    scene->has_environment = true;
    return WHIT_OK;
}

static whit_result read_into(struct scene *scene, const char *path, const whit_load_params *params)
{
    char extension[16];
    path_extension(path, extension, sizeof extension);
    if (strcmp(extension, "json") == 0)
        return load_scene_file(scene, path, params);
    if (load_is_model(path))
        return read_model(scene, path, params);
    if (extension[0])
        log_error(&scene->log, "%s: the extension `.%s` is not known; " KNOWN, path, extension);
    else
        log_error(&scene->log, "%s: its name has no known extension; " KNOWN, path);
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

static whit_result check_path(const whit_log *log, const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0)
        return log_failure(log, WHIT_ERROR_INPUT, "%s: %s", path, reach_words(REACH_MISSING));
    if (S_ISDIR(info.st_mode))
        return log_failure(log, WHIT_ERROR_INPUT, "%s: this is a folder, not a scene or a model",
                           path);
    return WHIT_OK;
}

enum { INPUT_NAME_BYTES = 16 };

/* Names standard input with its format's extension, since extensions decide how files are read. */
static whit_result name_input(const whit_log *log, char name[INPUT_NAME_BYTES])
{
    const uint8_t *data;
    size_t size_bytes;
    whit_result result = input_read(log, &data, &size_bytes);
    const char *extension = result == WHIT_OK ? format_find(data, size_bytes) : NULL;
    if (extension)
        snprintf(name, INPUT_NAME_BYTES, "stdin.%s", extension);
    else if (result == WHIT_OK)
        log_error(log, "standard input: it begins like no .json scene and like none of " LOAD_MODELS
                       " models");
    return extension ? WHIT_OK : WHIT_ERROR_INPUT;
}

whit_result load_check(const whit_log *log, const char *path, const whit_load_params *params)
{
    if (!path)
        return log_failure(log, WHIT_ERROR_USAGE, "there is no path of a file to load");
    if (!params)
        return WHIT_OK;
    if ((uint32_t)params->up > WHIT_UP_AUTO || (uint32_t)params->lights > WHIT_LIGHTS_KEY)
        return log_failure(log, WHIT_ERROR_USAGE,
                           "%s: up %d or lights %d: the enumerations have 0 to %u and 0 to %u",
                           path, (int)params->up, (int)params->lights, WHIT_UP_AUTO,
                           WHIT_LIGHTS_KEY);
    if (params->import_limit_s >= 0.0 && params->time_limit_s >= 0.0)
        return WHIT_OK;
    return log_failure(log, WHIT_ERROR_USAGE,
                       "%s: limits of %g s and %g s for importers: must not be below 0", path,
                       params->import_limit_s, params->time_limit_s);
}

static whit_result load_named(const whit_log *log, const char *path, bool piped,
                              const whit_load_params *params, struct scene **out)
{
    struct scene *scene = scene_create(log, path);
    if (!scene)
        return log_failure(log, WHIT_ERROR_MEMORY, "%s: out of memory", path);
    scene->memory_limit = params && params->memory_limit_bytes ? params->memory_limit_bytes
                                                               : scene_default_memory_limit();
    whit_result result =
        piped ? roots_init_input(&scene->roots, path) : roots_init(&scene->roots, path);
    scene->roots.found = params ? params->found : NULL;
    scene->roots.found_user = params ? params->found_user : NULL;
    for (uint32_t i = 0; params && result == WHIT_OK && i < params->allowed_count; i++)
        result = roots_allow(log, &scene->roots, params->allowed_folders[i]);
    scene->is_model = load_is_model(path);
    struct named_log named = {log, path};
    if (log && log->fn)
        scene->log = (whit_log){.fn = name_error, .user = &named, .level = log->level};
    if (result == WHIT_OK)
        result = read_into(scene, path, params);
    if (result == WHIT_OK && params && params->clip && !scene->channel_count)
        scene_note(scene, SCENE_NOTE_WARNING, "no animation is played, neither `%s` nor another",
                   text_token(params->clip).text);
    if (result == WHIT_OK && params)
        result = replace_sky(scene, params);
    scene->lights_wanted = params ? params->lights : WHIT_LIGHTS_AUTO;
    if (scene->lights_wanted == WHIT_LIGHTS_NONE || scene->lights_wanted == WHIT_LIGHTS_KEY)
        scene_drop_lights(scene);
    scene->log = log_or_silence(log);
    scene->roots.found = NULL;
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

whit_result load_scene(const whit_log *log, const char *path, const whit_load_params *params,
                       struct scene **out)
{
    char name[INPUT_NAME_BYTES];
    *out = NULL;
    if (params && params->refused)
        *params->refused = (whit_refused){0};
    whit_result result = load_check(log, path, params);
    bool piped = result == WHIT_OK && is_input(path);
    if (result == WHIT_OK)
        result = piped ? name_input(log, name) : check_path(log, path);
    return result == WHIT_OK ? load_named(log, piped ? name : path, piped, params, out) : result;
}
