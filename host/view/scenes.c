/* Which scene is shown, asked for and refused; its files, and its cameras.

   If a request for a scene fails, the scene that is shown stays, and everything that the user does
   is about that one. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/input.h"
#include "base/vec.h"
#include "base/watch.h"
#include "view/remembered_cameras.h"
#include "view/scenes.h"
#include "view/view_private.h"
#include "whit/whit_program.h"

/* ---- Cameras ---- */

/* Sets view->camera to a camera of the scene, which the user then moves. */
static void read_camera(struct view *view, uint32_t index)
{
    whit_camera_info info;
    view->camera_time_s = view->frame.settings.picture.time_s;
    if (whit_scene_pose_camera(view->scene->scene, index, view->camera_time_s, &info) != WHIT_OK)
        whit_scene_get_camera(view->scene->scene, index, &info);
    camera_set(&view->camera, info.eye, info.target, info.up, info.fov_y_degrees);
    if (info.target_is_direction)
        camera_reach(&view->camera, view->scene->info.objects_lo, view->scene->info.objects_hi);
    if (!(info.fov_y_degrees > 0.0)) { /* orthographic or panorama: it has no angle */
        double distance = double3_distance(view->camera.target, view->camera.eye);
        view->camera.fov_y_degrees =
            info.height > 0.0 && distance > 0.0
                ? 2.0 * atan(0.5 * info.height / distance) * 57.29577951308232
                : 60.0;
    }
}

void view_use_camera(struct view *view, int index)
{
    read_camera(view, (uint32_t)index);
    view->file_camera = index;
    snprintf(view->settings.camera, sizeof view->settings.camera, "%d", index);
    if (index == 0)
        view->settings.camera[0] = '\0'; /* index 0 is the default */
    view->dirty = true;
}

void view_learn_camera(struct view *view)
{
    const char *text = view->settings.camera;
    if (!view->scene)
        return;
    view->camera_known = true;
    if (camera_from_text(text, &view->camera)) {
        view->file_camera = -1;
        return;
    }
    view->file_camera = 0;
    for (uint32_t i = 0; text[0] && i < view->scene->info.camera_count; ++i) {
        whit_camera_info info;
        char number[16];
        whit_scene_get_camera(view->scene->scene, i, &info);
        snprintf(number, sizeof number, "%u", i);
        if (strcmp(text, info.name) == 0 || strcmp(text, number) == 0)
            view->file_camera = (int)i;
    }
    if (view->scene->info.camera_count > 0)
        read_camera(view, (uint32_t)view->file_camera);
}

/* Whether cameras are remembered; not for standard input, which is another scene the next time. */
static bool remembers(const struct view *view)
{
    return view->params->remember && !is_input(view->settings.scene);
}

/* Remembers the camera that the user has moved. */
static void remember_camera(const struct view *view)
{
    bool by_hand = view->file_camera < 0;
    if (remembers(view) && view->camera_known)
        memory_keep(&view->log, view->settings.scene, by_hand ? view->settings.camera : "");
}

static void recall_camera(struct view *view)
{
    struct view_camera camera;
    char text[SETTING_TEXT_BYTES];
    if (remembers(view) && !view->settings.camera[0] &&
        memory_find(view->settings.scene, text, sizeof text) && camera_from_text(text, &camera))
        memcpy(view->settings.camera, text, sizeof text);
}

/* ---- Scenes that are asked for ---- */

/* Watches the file that is asked for; the file of the shown scene is watched by view->watch
   already. */
static void set_asked(struct view *view, const char *path)
{
    snprintf(view->asked, sizeof view->asked, "%s", path);
    watch_clear(view->watch_asked);
    if (strcmp(path, view->fallback.scene) != 0)
        watch_add(view->watch_asked, path, watch_now_ns());
}

static void open_scene(struct view *view, const char *path)
{
    struct settings *settings = &view->settings;
    remember_camera(view);
    if (settings_same_scene(settings, &view->fallback))
        view->played = view->clock.playing;
    if (strcmp(settings->scene, path) == 0)
        settings->reload = ++view->reloads;
    snprintf(settings->scene, sizeof settings->scene, "%s", path);
    settings->camera[0] = settings->clip[0] = '\0';
    settings->picture.time_s = 0.0;
    view->clock.playing = false;
    view->camera_known = false;
    view->hint = false;
    recall_camera(view);
    view->dirty = true;
}

void view_open(struct view *view, const char *path)
{
    if (path_is(path, "view")) {
        panels_load(view, path);
        return;
    }
    if (skies_drop(view, path))
        return;
    if (path_is(path, "png")) {
        /* A picture may hold functions of a shader. Only `whit view` asks whether they may run. */
        view_say(view, "%s is a picture; `whit view %s` shows what it was made from",
                 path_name(path), path_name(path));
        return;
    }
    if (strlen(path) >= sizeof view->settings.scene) {
        view_say(view, "the path is too long");
        return;
    }
    view->refused[0] = '\0';
    set_asked(view, path);
    open_scene(view, path);
}

/* Reads a scene again, even if it is loaded already: the one asked for (`asked`), or the one of the
   settings. */
static void read_again(struct view *view, bool asked)
{
    char path[SETTING_PATH_BYTES];
    memcpy(path, asked ? view->asked : view->settings.scene, sizeof path);
    set_asked(view, path);
    if (strcmp(view->settings.scene, path) != 0)
        open_scene(view, path);
    view->settings.reload = ++view->reloads;
    view->dirty = true;
}

void scenes_read_again(struct view *view)
{
    read_again(view, view->refused[0] != '\0');
    view_say(view, "reading %s again", path_name(view->asked));
}

/* Goes back to the scene that is shown. */
static void go_back(struct view *view)
{
    struct settings *settings = &view->settings;
    const struct settings *back = &view->fallback;
    settings_set_scene(settings, back);
    view->dirty = true;
    if (view->camera_known) /* the same scene was read again: its camera stays */
        return;
    memcpy(settings->camera, back->camera, sizeof settings->camera);
    settings->picture.time_s = back->picture.time_s;
    view->clock.playing = view->played;
    view->clock.last_ms = view_now_ms(view);
    view_learn_camera(view);
}

bool scenes_stop(struct view *view)
{
    if (settings_same_scene(&view->settings, &view->fallback))
        return false;
    go_back(view);
    scenes_forget(view);
    view->asked[0] = '\0';
    return true;
}

bool scenes_refuse(struct view *view)
{
    struct settings *settings = &view->settings;
    const struct settings *back = &view->fallback;
    char allowed[SETTING_FOLDERS_MAX][SETTING_PATH_BYTES];
    if (settings_same_scene(settings, back))
        return false;
    if (strcmp(view->refused, view->status.error) != 0) {
        memcpy(view->refused, view->status.error, sizeof view->refused);
        log_error(&view->log, "%s", view->refused);
    }
    /* The scene is read again when one of its files is mended, or comes. A sky that was dropped is
       given up instead. */
    if (strcmp(settings->environment, back->environment) == 0) {
        set_asked(view, settings->scene);
        engine_watch_unread(view->engine, view->watch_asked);
    }
    /* Folders that the user has allowed stay so: a scene may need several, and is asked for again.
     */
    _Static_assert(sizeof allowed == sizeof settings->allowed, "all folders are kept");
    memcpy(allowed, settings->allowed, sizeof allowed);
    go_back(view);
    memcpy(settings->allowed, allowed, sizeof allowed);
    return true;
}

void scenes_forget(struct view *view)
{
    view->refused[0] = '\0';
    watch_clear(view->watch_asked);
}

const char *scenes_question(const struct view *view)
{
    const char *folder = view->status.refused;
    return folder[0] && strcmp(folder, view->answered) != 0 ? folder : NULL;
}

void scenes_answer(struct view *view, bool allow)
{
    uint32_t count = 0;
    memcpy(view->answered, view->status.refused, sizeof view->answered);
    view->dirty = true;
    while (count < SETTING_FOLDERS_MAX && view->settings.allowed[count][0])
        ++count;
    if (allow && count == SETTING_FOLDERS_MAX)
        view_say(view, "%d folders are the most that can be allowed", SETTING_FOLDERS_MAX);
    if (!allow || count == SETTING_FOLDERS_MAX)
        return;
    memcpy(view->settings.allowed[count], view->answered, sizeof view->answered);
    scenes_read_again(view);
}

const struct settings *scenes_shown(const struct view *view)
{
    return settings_same_scene(&view->settings, &view->fallback) ? &view->settings
                                                                 : &view->fallback;
}

/* ---- Scenes beside it ---- */

static int is_scene(const struct dirent *entry)
{
    static const char *const endings[] = {"json", "obj", "gltf", "glb", "ply",
                                          "stl",  "fbx", "dae",  "3mf", "off"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; ++i) {
        if (path_is(entry->d_name, endings[i]))
            return entry->d_name[0] != '.';
    }
    return 0;
}

static int compare_names(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

/* Finds the scene that stands `by` places behind `path` in its folder, by name; behind the last one
   comes the first. A path that is not there any more counts as standing before the first. False:
   the folder has no other scene. */
static bool find_beside(const char *path, int by, char *found, size_t found_bytes)
{
    const char *name = path_name(path);
    int folder_bytes = (int)(name - path), own = by > 0 ? -1 : 0;
    struct dirent **entries = NULL;
    snprintf(found, found_bytes, "%.*s", folder_bytes, path);
    int count = scandir(found[0] ? found : ".", &entries, is_scene, compare_names);
    for (int i = 0; i < count; ++i) {
        if (strcmp(entries[i]->d_name, name) == 0)
            own = i;
    }
    bool any = count > 0;
    if (any) {
        const char *next = entries[(own + count + by) % count]->d_name;
        any = strcmp(next, name) != 0;
        snprintf(found, found_bytes, "%.*s%s", folder_bytes, path, next);
    }
    for (int i = 0; i < count; ++i)
        free(entries[i]);
    free(entries);
    return any;
}

void scenes_turn(struct view *view, int by)
{
    char path[SETTING_PATH_BYTES];
    /* From the scene that was asked for last, so that one that cannot be loaded is passed. */
    const char *from = view->asked[0] ? view->asked : view->settings.scene;
    if (!is_input(from) && find_beside(from, by, path, sizeof path))
        view_open(view, path);
    else
        view_say(view, "no other scene beside this one");
}

/* ---- Files ---- */

static void watch_scene(struct view *view)
{
    const struct file_list *files = &view->scene->files;
    watch_clear(view->watch);
    for (uint32_t i = 0; i < files->count; ++i)
        watch_add(view->watch, files->paths[i], files->since_ns);
}

void scenes_watch(struct view *view)
{
    bool asked = watch_changed(view->watch_asked), shown = watch_changed(view->watch);
    if (!asked && !shown)
        return;
    read_again(view, asked);
    view_say(view, "%s was written: reading it again", path_name(view->asked));
}

void scenes_show(struct view *view)
{
    const struct settings *shown = &view->frame.settings;
    char title[300];
    snprintf(title, sizeof title, "%s - whit", path_name(shown->scene));
    window_set_title(view->window, title);
    watch_scene(view);
    if (view->params->tell && strcmp(view->told, shown->scene) != 0)
        view->params->tell(view->scene->scene);
    snprintf(view->told, sizeof view->told, "%s", shown->scene);
    if (settings_same_scene(shown, &view->settings))
        scenes_forget(view);
}

void scenes_begin(struct view *view)
{
    view->watch = watch_create(window_wake);
    view->watch_asked = watch_create(window_wake);
    recall_camera(view);
    view->fallback = view->settings;
}

void scenes_end(struct view *view)
{
    remember_camera(view);
    watch_destroy(view->watch);
    watch_destroy(view->watch_asked);
}
