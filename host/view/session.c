#include "view/session.h"
#include "base/array.h"
#include "base/log.h"
#include "base/text.h"
#include "base/watch.h"
#include "whit/whit_program.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WARM_WIDTH = 32, WARM_HEIGHT = 24 };

struct scene_ref *scene_ref_take(struct scene_ref *ref)
{
    if (ref)
        atomic_fetch_add(&ref->refs, 1);
    return ref;
}

enum { FILES_MAX = 4096 };

void file_list_finish(struct file_list *list)
{
    for (uint32_t i = 0; i < list->count; ++i)
        free(list->paths[i]);
    free(list->paths);
    *list = (struct file_list){0};
}

/* A file that is left out, for lack of memory or because there are too many, is not watched. */
static void add_file(void *user, const char *path)
{
    struct file_list *list = user;
    if (list->count == FILES_MAX)
        return;
    for (uint32_t i = 0; i < list->count; ++i) {
        if (strcmp(list->paths[i], path) == 0)
            return;
    }
    char *copy = string_copy(path);
    if (!copy || !ARRAY_PUSH(list->paths, list->count, list->capacity, copy))
        free(copy);
}

void scene_ref_drop(struct scene_ref *ref)
{
    if (!ref || atomic_fetch_sub(&ref->refs, 1) > 1)
        return;
    whit_scene_destroy(ref->scene);
    file_list_finish(&ref->files);
    free(ref);
}

struct shader_ref *shader_ref_take(struct shader_ref *ref)
{
    if (ref)
        atomic_fetch_add(&ref->refs, 1);
    return ref;
}

void shader_ref_drop(struct shader_ref *ref)
{
    if (!ref || atomic_fetch_sub(&ref->refs, 1) > 1)
        return;
    whit_shader_destroy(ref->shader);
    free(ref);
}

uint32_t shader_ref_find_aov(const struct shader_ref *ref, const char *name)
{
    for (uint32_t i = 0; ref && i < ref->info.aov_count; ++i) {
        if (strcmp(ref->info.aovs[i], name) == 0)
            return i;
    }
    return UINT32_MAX;
}

const char *session_stage_name(enum session_stage stage)
{
    static const char *const names[] = {"compiling the shader", "loading the scene",
                                        "building trees",       "opening the device",
                                        "compiling the kernel", ""};
    return names[stage <= SESSION_DONE ? stage : SESSION_DONE];
}

WHIT_PRINTF(2, 3)
static void add_error(struct session *session, const char *format, ...)
{
    char line[SESSION_ERROR];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    text_add(session->errors, sizeof session->errors, "%s%s", session->errors[0] ? "\n" : "", line);
    log_error(&session->log, "%s", line);
}

/* Copies the errors of the compiler to the session, and logs them. */
static void log_shader_errors(struct session *session, const whit_shader_compiler *compiler)
{
    const whit_shader_error *errors;
    uint32_t count = whit_shader_compiler_errors(compiler, &errors);
    uint32_t left = whit_shader_compiler_errors_left(compiler);
    for (uint32_t i = 0; i < count; ++i) {
        char place[32] = "";
        if (errors[i].line)
            text_add(place, sizeof place, ":%u", errors[i].line);
        if (errors[i].column)
            text_add(place, sizeof place, ":%u", errors[i].column);
        add_error(session, "%s%s: %s", errors[i].file, place, errors[i].reason);
    }
    if (left > 0)
        add_error(session, "and %u more errors", left);
    if (count == 0)
        add_error(session, "%s: could not be compiled",
                  session->settings.shader[0] ? session->settings.shader
                                              : session->settings.stages);
}

static whit_result load_shader(struct session *session, whit_shader_compiler *compiler)
{
    const struct settings *settings = &session->settings;
    struct shader_ref *ref = calloc(1, sizeof *ref);
    if (!ref)
        return WHIT_ERROR_MEMORY;
    atomic_init(&ref->refs, 1);
    ref->settings = *settings;
    ref->since_ns = watch_now_ns();
    whit_result result = whit_shader_load_stages(
        compiler, settings->shader[0] ? settings->shader : NULL,
        settings->stages[0] ? settings->stages : NULL, settings->trust, &ref->shader);
    if (result != WHIT_OK) {
        log_shader_errors(session, compiler);
        free(ref);
        return result;
    }
    whit_shader_get_info(ref->shader, &ref->info);
    session->shader = ref;
    return WHIT_OK;
}

static whit_result load(struct session *session, const whit_log *log)
{
    const struct settings *settings = &session->settings;
    const char *allowed[SETTING_FOLDERS_MAX];
    whit_refused refused = {0};
    whit_load_params params = settings_load(settings, allowed);
    params.cancel = &session->cancel;
    params.refused = &refused;
    params.found = add_file;
    struct scene_ref *ref = calloc(1, sizeof *ref);
    if (!ref)
        return WHIT_ERROR_MEMORY;
    atomic_init(&ref->refs, 1);
    ref->settings = *settings;
    ref->files.since_ns = watch_now_ns();
    params.found_user = &ref->files;
    session->scene = ref;
    whit_result result = whit_scene_load(settings->scene, &params, log, &ref->scene);
    if (strlen(refused.folder) < sizeof session->refused)
        memcpy(session->refused, refused.folder, strlen(refused.folder) + 1);
    if (result == WHIT_OK)
        whit_scene_get_info(ref->scene, &ref->info);
    return result;
}

static whit_result build(struct session *session)
{
    double start_ms = whit_clock_ms();
    whit_result result =
        whit_accel_create(session->scene->scene, &session->settings.trees, &session->accel);
    session->build_ms = whit_clock_ms() - start_ms;
    if (result == WHIT_OK)
        whit_accel_get_info(session->accel, &session->accel_info);
    return result;
}

static void note_part(void *user, double done)
{
    struct session *session = user;
    float share = session->part_share > 0.0f ? session->part_share : 1.0f;
    atomic_store(&session->part, session->part_done + share * (float)done);
}

static void note_step(void *user, const whit_step *step)
{
    const struct session *session = user;
    if (session->step)
        session->step(session->step_user, step);
}

whit_renderer_params session_picture(const struct session *session)
{
    whit_renderer_params params = settings_picture(&session->settings);
    params.time_stages = session->time_stages;
    return params;
}

/* Draws a small picture, as drivers compile a kernel when it runs for the first time. */
static whit_result warm_up(struct session *session, bool few_pixels)
{
    whit_renderer_params params = session_picture(session);
    params.width = WARM_WIDTH;
    params.height = WARM_HEIGHT;
    params.sampling.count = 1;
    params.many_pictures = true;
    params.few_pixels = few_pixels;
    params.keep_unread = true; /* later versions and probes may read what this one does not */
    params.shader = session->shader ? session->shader->shader : NULL;
    params.cancel = &session->cancel;
    params.progress = note_part;
    params.step = note_step;
    params.progress_user = session;
    double start_ms = whit_clock_ms();
    whit_result result =
        whit_renderer_create(session->device, session->accel, &params, &session->renderer);
    if (result == WHIT_OK)
        result = whit_renderer_render(session->renderer);
    session->compile_ms = whit_clock_ms() - start_ms;
    return result;
}

whit_result session_open(struct session *session, const struct settings *settings,
                         const struct session_parts *parts, const whit_log *log,
                         const whit_log *scene_log)
{
    session->settings = *settings;
    const whit_device_params device = settings_device(&session->settings);
    session->log = *log;
    session->scene = scene_ref_take(parts->scene);
    session->shader = shader_ref_take(parts->shader);
    whit_device_opening *opening = whit_device_open_begin(&device, &session->log);
    whit_result result = WHIT_OK;
    atomic_store(&session->stage, SESSION_SHADER);
    if (!session->shader && parts->compiler && settings_compiles(settings))
        result = load_shader(session, parts->compiler);
    atomic_store(&session->stage, SESSION_LOADING);
    if (result == WHIT_OK && !session->scene)
        result = load(session, scene_log);
    if (result == WHIT_OK)
        result = settings_choose_camera(&session->settings, session->scene->scene);
    atomic_store(&session->stage, SESSION_BUILDING);
    if (result == WHIT_OK)
        result = build(session);
    atomic_store(&session->stage, SESSION_OPENING);
    if (result != WHIT_OK)
        whit_device_open_abandon(opening);
    else if (opening)
        result = whit_device_open_end(opening, &session->device);
    else
        result = whit_device_create(&device, &session->log, &session->device);
    atomic_store(&session->stage, SESSION_COMPILING);
    if (result == WHIT_OK) {
        whit_device_get_info(session->device, &session->device_info);
        result = warm_up(session, parts->awaits_version);
    }
    atomic_store(&session->stage, SESSION_DONE);
    return result;
}

/* Draws the first step, for which the driver compiles. No more is drawn if session->step cancels
   there. */
static whit_result draw_step(struct session *session, const whit_renderer_params *params)
{
    bool takes = whit_renderer_takes_shader(session->renderer, params->shader);
    whit_result result = takes ? whit_renderer_set_shader(session->renderer, params) : WHIT_OK;
    if (!takes || result != WHIT_OK) {
        whit_renderer_destroy(session->renderer);
        session->renderer = NULL;
        return takes ? result : warm_up(session, false);
    }
    result = whit_renderer_render(session->renderer);
    return result == WHIT_ERROR_CANCELLED ? WHIT_OK : result;
}

whit_result session_reload(struct session *session, const struct settings *settings,
                           const struct session_parts *parts)
{
    enum { FIRST_STEP = 8 };
    const struct settings settings_before = session->settings;
    struct shader_ref *before = session->shader;
    whit_result result = WHIT_OK;
    session->settings = *settings;
    session->shader = shader_ref_take(parts->shader);
    atomic_store(&session->stage, SESSION_SHADER);
    if (!session->shader)
        result = load_shader(session, parts->compiler);
    if (result == WHIT_OK)
        result = settings_choose_camera(&session->settings, session->scene->scene);
    if (result != WHIT_OK) { /* the renderer goes on borrowing the shader before */
        shader_ref_drop(session->shader);
        session->settings = settings_before;
        session->shader = before;
        return result;
    }
    atomic_store(&session->stage, SESSION_COMPILING);
    double start_ms = whit_clock_ms();
    whit_renderer_params params = session_picture(session);
    params.shader = session->shader->shader;
    params.sampling = (whit_sampling){.kind = WHIT_SAMPLING_FIXED, .count = 1};
    params.step_spacing = parts->moves ? 0 : FIRST_STEP;
    params.width = parts->moves ? WARM_WIDTH : params.width;
    params.height = parts->moves ? WARM_HEIGHT : params.height;
    params.reuse_rays = true;
    params.few_pixels = true;
    params.step_aov = shader_ref_find_aov(session->shader, session->settings.aov) + 1;
    result = draw_step(session, &params);
    session->compile_ms = whit_clock_ms() - start_ms;
    shader_ref_drop(before);
    atomic_store(&session->stage, SESSION_DONE);
    return result;
}

uint32_t session_close(struct session *session)
{
    whit_renderer_destroy(session->renderer);
    uint32_t messages = session->device ? whit_device_validation_messages(session->device) : 0;
    whit_device_destroy(session->device);
    whit_accel_destroy(session->accel);
    scene_ref_drop(session->scene);
    shader_ref_drop(session->shader);
    *session = (struct session){0};
    return messages;
}
