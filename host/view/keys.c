#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "view/choices.h"
#include "view/keys.h"
#include "view/pick.h"
#include "view/price_panel.h"
#include "view/scenes.h"
#include "view/view_private.h"

static const double ESCAPE_MS = 1500.0; /* most time between two Escapes that quit */

/* ---- Trees ---- */

static void switch_trees(struct view *view)
{
    const struct setting *row = settings_row("build");
    char why[SETTING_WHY_BYTES];
    bool none = view->settings.trees.build == WHIT_BUILD_NONE;
    setting_read(row, none ? row->values[0].word : row->key_skips, &view->settings, why);
}

static void say_trees(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, view->settings.trees.build == WHIT_BUILD_NONE ? "off" : "on");
}

/* ---- What is painted ---- */

static void switch_depth_view(struct view *view)
{
    bool color = view->settings.paint == PAINT_COLOR;
    view->settings.paint = color ? PAINT_DEPTH : PAINT_COLOR;
}

static void next_cost_view(struct view *view)
{
    uint32_t next = view->settings.paint + 1;
    view->settings.paint = next < PAINT_COUNT ? next : PAINT_DEPTH;
}

/* Switches from colours to the shader's aovs one by one, and back to colours. */
static void next_aov(struct view *view)
{
    const struct shader_ref *shown = view->shaders.shown;
    uint32_t count = shown ? shown->info.aov_count : 0;
    uint32_t next = shader_ref_find_aov(shown, view->settings.aov) + 1; /* 0: no such aov */
    if (count == 0)
        view_say(view, "there is no `//@ aov` of a shader");
    snprintf(view->settings.aov, sizeof view->settings.aov, "%s",
             next < count ? shown->info.aovs[next] : "");
}

static void say_aov(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, "%s", view->settings.aov[0] ? view->settings.aov : "colours");
}

/* Doubles the scale of the difference if that is shown, else the scale of costs; halves it where
   `by` is below 0. */
static void turn_scale(struct view *view, int by)
{
    double factor = by < 0 ? 0.5 : 2.0;
    struct compare *compare = &view->compare;
    bool costs = view->settings.paint != PAINT_COLOR;
    double *scale = &view->settings.paint_scale, shown = costs ? view->frame.scale : 0.0;
    if (compare->mode == COMPARE_DIFFERENCE) {
        scale = &compare->scale;
        shown = compare->heat.scale;
    }
    double now = *scale > 0.0 ? *scale : shown;
    if (now > 0.0)
        *scale = compare->mode == COMPARE_DIFFERENCE ? now * factor : fmax(1.0, now * factor);
}

static void own_scale(struct view *view)
{
    if (view->compare.mode == COMPARE_DIFFERENCE)
        view->compare.scale = 0.0;
    else
        view->settings.paint_scale = 0.0;
}

static void say_scale(const struct view *view, char *text, size_t bytes)
{
    bool difference = view->compare.mode == COMPARE_DIFFERENCE;
    double scale = difference ? view->compare.scale : view->settings.paint_scale;
    if (scale > 0.0)
        snprintf(text, bytes, "%g", scale);
    else
        snprintf(text, bytes, "by the picture");
}

/* ---- Comparing ---- */

static void switch_split(struct view *view)
{
    compare_set(view, view->compare.mode == COMPARE_OFF ? COMPARE_SPLIT : COMPARE_OFF);
}

static void say_split(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, view->compare.mode == COMPARE_OFF ? "off" : "on");
}

static void switch_difference(struct view *view)
{
    compare_set(view,
                view->compare.mode == COMPARE_DIFFERENCE ? COMPARE_SPLIT : COMPARE_DIFFERENCE);
}

static void say_difference(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, view->compare.mode == COMPARE_DIFFERENCE ? "on" : "off");
}

/* ---- Panels ---- */

static void switch_settings(struct view *view)
{
    view->panels.settings = !view->panels.settings;
    view->panels.states_known = false; /* other files may have come */
    if (view->panels.effects)
        panels_switch_effects(view);
}

static void say_settings(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, view->panels.settings ? "open" : "closed");
}

static void switch_effects(struct view *view)
{
    panels_switch_effects(view);
    view->panels.settings = false;
}

static void say_effects(const struct view *view, char *text, size_t bytes)
{
    char effects[SETTING_VALUE_BYTES];
    effects_write(&view->settings.picture, effects);
    snprintf(text, bytes, "%.40s", effects);
}

/* ---- Cameras ---- */

/* Puts the eye on an axis through the target: 1 is x, 2 is y, 3 is z; below 0 on the other side. */
static void look_along(struct view *view, int axis)
{
    if (!view->camera_known)
        return;
    camera_along(&view->camera, abs(axis) - 1, axis < 0 ? -1 : 1);
    view_moved(view);
}

/* Takes the camera that whit chooses for files without a camera. */
static void look_as_whit(struct view *view)
{
    whit_camera camera;
    if (whit_scene_choose_camera(view->scene->scene, &camera) != WHIT_OK)
        return;
    camera_set(&view->camera, camera.eye, camera.target, camera.up, camera.fov_y_degrees);
    view_moved(view);
    view_say(view, "whit's own camera");
}

/* Goes through the file's cameras in their order; after the last one follows whit's own. */
static void next_camera(struct view *view)
{
    uint32_t count = view->scene ? view->scene->info.camera_count : 0;
    whit_camera_info last = {0};
    if (count == 0)
        return;
    whit_scene_get_camera(view->scene->scene, count - 1, &last);
    if (view->file_camera == (int)count - 1 && !last.made_by_whit)
        look_as_whit(view);
    else
        view_use_camera(view, (int)((uint32_t)(view->file_camera + 1) % count));
}

static void say_camera(const struct view *view, char *text, size_t bytes)
{
    whit_camera_info info = {0};
    if (view->scene && view->file_camera >= 0)
        whit_scene_get_camera(view->scene->scene, (uint32_t)view->file_camera, &info);
    snprintf(text, bytes, "%s", view->file_camera < 0 ? "by hand" : info.name ? info.name : "");
}

static void fit_scene(struct view *view)
{
    double lo[3], hi[3];
    if (!view->camera_known || !view_bounds(view, lo, hi))
        return;
    camera_show(&view->camera, lo, hi, view_aspect(view));
    view_moved(view);
}

/* ---- Time ---- */

static bool moves(struct view *view)
{
    bool has_time = view->scene && view->scene->info.time_end_s > 0.0;
    if (!has_time)
        view_say(view, "nothing moves in this scene");
    return has_time;
}

static void switch_playing(struct view *view)
{
    if (!moves(view))
        return;
    view->clock.playing = !view->clock.playing;
    view->clock.last_ms = view_now_ms(view);
    if (view->clock.playing && view->clock.once &&
        view->settings.picture.time_s >= view->scene->info.time_end_s)
        view->settings.picture.time_s = 0.0;
}

static void say_playing(const struct view *view, char *text, size_t bytes)
{
    double end_s = view->scene ? view->scene->info.time_end_s : 0.0;
    if (end_s > 0.0)
        snprintf(text, bytes, "%s, %.2f of %.2f s", view->clock.playing ? "plays" : "stands",
                 view->settings.picture.time_s, end_s);
    else
        snprintf(text, bytes, "nothing moves");
}

static void step_time(struct view *view, int by)
{
    if (!moves(view))
        return;
    double fps = view->settings.fps;
    double last = floor(view->scene->info.time_end_s * fps + 1e-9);
    double frame = floor(view->settings.picture.time_s * fps + 0.5) + by;
    frame = frame < 0.0 ? last : frame > last ? 0.0 : frame;
    view->clock.playing = false;
    view->settings.picture.time_s = frame / fps;
}

static void switch_loop(struct view *view)
{
    view->clock.once = !view->clock.once;
}

static void say_loop(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, view->clock.once ? "once" : "again and again");
}

static void turn_speed(struct view *view, int by)
{
    double speed = view->clock.speed * (by < 0 ? 0.5 : 2.0);
    view->clock.speed = fmin(fmax(speed, 1.0 / 16.0), 16.0);
}

static void say_speed(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, "x %g", view->clock.speed);
}

/* ---- Files ---- */

static void say_scene(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, "%s", path_name(view->settings.scene));
}

/* Saves as whit-0001.png or the next free number, in the folder where whit was started. */
static void save_picture(struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    char path[VIEW_FREE_NAME];
    if (!frame->whole || frame->settings.paint != PAINT_COLOR) {
        view_say(view, frame->whole ? "costs are saved by `whit render --view`: see Ctrl+C"
                                    : "the picture is not whole yet");
        return;
    }
    const struct settings drawn = view_drawn(view, &frame->settings);
    const struct view_shot shot = {.settings = &drawn,
                                   .color = frame->color,
                                   .scene = frame->scene->scene,
                                   .shader = frame->shader ? frame->shader->shader : NULL,
                                   .device = &frame->device,
                                   .stats = frame->refined ? &frame->all : &frame->stats};
    struct view_saving saving;
    const whit_log log = view_saving_begin(view, &saving);
    view_say_saved(view, &saving, path,
                   view_free_name("png", path) && view->params->save(&shot, path, &log) == WHIT_OK);
}

static void copy_line(struct view *view)
{
    char line[VIEW_LINE];
    view_line(view, line);
    window_copy(view->window, line);
    view_say(view, "copied: %s", line);
}

/* ---- The window ---- */

static void switch_help(struct view *view)
{
    view->help = !view->help;
    view->hint = false;
}

static void next_hud(struct view *view)
{
    view->hud = (enum view_hud)((view->hud + 1) % HUD_COUNT);
}

static void say_hud(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, "%s", hud_names[view->hud]);
}

static void switch_fullscreen(struct view *view)
{
    window_set_fullscreen(view->window, !window_is_fullscreen(view->window));
}

static void say_fullscreen(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, window_is_fullscreen(view->window) ? "on" : "off");
}

static void escape(struct view *view)
{
    double now_ms = view_now_ms(view);
    if (scenes_question(view)) {
        scenes_answer(view, false);
        return;
    }
    if (ui_close_menus(view->ui))
        return;
    if (view->help || view->picked || view->panels.settings || view->panels.effects ||
        view->prices_open || view->refused[0]) {
        view->help = view->picked = false;
        if (view->prices_open)
            price_switch(view);
        scenes_forget(view);
        view->panels.settings = false;
        if (view->panels.effects)
            panels_switch_effects(view);
        return;
    }
    if (scenes_stop(view) || view_go_back(view)) {
        view_say(view, "stopped: as it was");
        return;
    }
    view->quit = now_ms - view->escape_ms < ESCAPE_MS;
    view->escape_ms = now_ms;
    if (!view->quit)
        view_say(view, "Escape once more quits");
}

static void say_prices(const struct view *view, char *text, size_t bytes)
{
    snprintf(text, bytes, view->prices_open ? "shown" : "not shown");
}

/* Keys other than those of settings, in the order of the cheat sheet. In each of its groups the
   keys of settings come first. */
static const struct key_binding bindings[] = {
    {KEY_HOME, 0, "Home", NULL, "all objects", fit_scene, .group = KEYS_CAMERA},
    {'F', 0, "F", "frame what is there", "frame what is under the mouse", pick_focus,
     .group = KEYS_CAMERA},
    {'1', 0, "1 2 3", "from front right above", "from the front", .turn = look_along, .by = 3,
     .group = KEYS_CAMERA},
    {'2', 0, NULL, NULL, "from the right", .turn = look_along, .by = 1, .group = KEYS_CAMERA},
    {'3', 0, NULL, NULL, "from above", .turn = look_along, .by = 2, .group = KEYS_CAMERA},
    {'4', 0, "4 5 6", "from back left below", "from behind", .turn = look_along, .by = -3,
     .group = KEYS_CAMERA},
    {'5', 0, NULL, NULL, "from the left", .turn = look_along, .by = -1, .group = KEYS_CAMERA},
    {'6', 0, NULL, NULL, "from below", .turn = look_along, .by = -2, .group = KEYS_CAMERA},
    {'0', 0, "0", "cameras: file's, whit's", "next camera", next_camera, .state = say_camera,
     .group = KEYS_CAMERA},
    {KEY_TAB, 0, "Tab", NULL, "settings by mouse", switch_settings, .state = say_settings,
     .group = KEYS_PICTURE},
    {'X', 0, "X", "effects, each one's cost", "effects and prices", switch_effects,
     .state = say_effects, .group = KEYS_PICTURE},
    {'P', 0, "P", "what each setting costs", "prices of this view", price_switch,
     .state = say_prices, .group = KEYS_PICTURE},
    {KEY_SPACE, 0, "Space", NULL, "animation", switch_playing, .state = say_playing,
     .group = KEYS_PICTURE},
    {',', 0, ", .", "frame before, after", "a frame back", .turn = step_time, .by = -1,
     .group = KEYS_PICTURE},
    {'.', 0, NULL, NULL, "a frame on", .turn = step_time, .by = 1, .group = KEYS_PICTURE},
    {'L', 0, "L", NULL, "animation runs", switch_loop, .state = say_loop, .group = KEYS_PICTURE},
    {'9', 0, "9 Shift+9", "slower, faster", "half speed", .turn = turn_speed, .by = -1,
     .state = say_speed, .group = KEYS_PICTURE},
    {'9', EVENT_SHIFT, NULL, NULL, "double speed", .turn = turn_speed, .by = 1, .state = say_speed,
     .group = KEYS_PICTURE},
    {KEY_F12, 0, "F12", NULL, "save the picture", save_picture, .group = KEYS_FILES},
    {'C', EVENT_CTRL, "Ctrl+C", "copy command", "copy the `whit render` line", copy_line,
     .group = KEYS_FILES},
    {'S', EVENT_CTRL, "Ctrl+S", "save settings", "save these settings", panels_save,
     .group = KEYS_FILES},
    {KEY_LEFT, 0, "Left Right", "other scenes", "scene before", .turn = scenes_turn, .by = -1,
     .state = say_scene, .group = KEYS_FILES},
    {KEY_RIGHT, 0, NULL, NULL, "scene after", .turn = scenes_turn, .by = 1, .state = say_scene,
     .group = KEYS_FILES},
    {'R', 0, "R", "read it again", "read the scene again", scenes_read_again, .group = KEYS_FILES},
    {'H', 0, "H F1", NULL, "this list", switch_help, .group = KEYS_FILES},
    {KEY_F1, 0, NULL, NULL, "this list", switch_help, .group = KEYS_FILES},
    {KEY_F1 + 1, 0, "F2", NULL, "figures", next_hud, .state = say_hud, .group = KEYS_FILES},
    {KEY_F1 + 10, 0, "F11", NULL, "full screen", switch_fullscreen, .state = say_fullscreen,
     .group = KEYS_FILES},
    {KEY_ESCAPE, 0, "Escape", NULL, "twice: quit", escape, .group = KEYS_FILES},
    {'I', 0, "I", "keep as B, change A", "A beside B, frozen now", switch_split, .state = say_split,
     .group = KEYS_EXPERTS},
    {'U', 0, "U", "difference of A and B", "A minus B", switch_difference, .state = say_difference,
     .group = KEYS_EXPERTS},
    {'B', 0, "B Shift+B", "depth, next cost", "depth view", switch_depth_view,
     .group = KEYS_EXPERTS},
    {'B', EVENT_SHIFT, NULL, NULL, "next cost view", next_cost_view, .group = KEYS_EXPERTS},
    {KEY_F1 + 2, 0, "F3", NULL, "aov of the shader", next_aov, .state = say_aov,
     .group = KEYS_PICTURE},
    {'[', 0, "[ ] \\", "scale of costs", "half the scale of costs", .turn = turn_scale, .by = -1,
     .state = say_scale, .group = KEYS_EXPERTS},
    {']', 0, NULL, NULL, "twice the scale", .turn = turn_scale, .by = 1, .state = say_scale,
     .group = KEYS_EXPERTS},
    {'\\', 0, NULL, NULL, "scale by the picture", own_scale, .group = KEYS_EXPERTS},
    {'G', 0, "G", NULL, "trees", switch_trees, .state = say_trees, .group = KEYS_EXPERTS},
};

enum { SETTING_KEYS_MAX = 32, KEY_NAME = 8 };

/* All keys, group by group. */
static struct key_binding all[SETTING_KEYS_MAX + sizeof bindings / sizeof *bindings];
static uint32_t all_count;

static void add_setting(const struct setting *row, enum key_group group)
{
    static char names[SETTING_KEYS_MAX][KEY_NAME];
    static uint32_t named;
    if (named == SETTING_KEYS_MAX)
        return;
    char *name = names[named];
    named += 2;
    if (row->key_back)
        snprintf(name, KEY_NAME, "%c %c", row->key_back, row->key);
    else
        snprintf(name, KEY_NAME, "%c", row->key);
    all[all_count++] = (struct key_binding){
        .key = row->key, .keys = name, .name = row->title, .setting = row, .by = 1, .group = group};
    all[all_count++] = (struct key_binding){.key = row->key_back ? row->key_back : row->key,
                                            .mods = row->key_back ? 0 : EVENT_SHIFT,
                                            .name = row->title,
                                            .setting = row,
                                            .by = -1,
                                            .group = group};
}

static void add_group(enum key_group group)
{
    for (const struct setting *row = choice_next(NULL); row; row = choice_next(row)) {
        enum key_group own = choice_group(row) == CHOICE_EXPERTS ? KEYS_EXPERTS : KEYS_PICTURE;
        if (row->key && own == group)
            add_setting(row, group);
    }
    for (size_t i = 0; i < sizeof bindings / sizeof *bindings; ++i) {
        if (bindings[i].group == group)
            all[all_count++] = bindings[i];
    }
}

const struct key_binding *key_bindings(uint32_t *count)
{
    if (all_count == 0) {
        for (int group = 0; group < KEY_GROUPS; ++group)
            add_group((enum key_group)group);
    }
    *count = all_count;
    return all;
}

bool key_state(const struct view *view, const struct key_binding *key, char *text, size_t bytes)
{
    if (key->setting)
        choice_say(&view->settings, key->setting, text, bytes);
    else if (key->state)
        key->state(view, text, bytes);
    return key->setting || key->state;
}

bool key_act(struct view *view, int key, unsigned mods, bool held)
{
    uint32_t count;
    const struct key_binding *keys = key_bindings(&count);
    for (uint32_t i = 0; i < count; ++i) {
        if (keys[i].key != key || keys[i].mods != mods)
            continue;
        if (held && !keys[i].setting && !keys[i].turn)
            return true;
        if (keys[i].setting)
            choice_turn(&view->settings, keys[i].setting, keys[i].by);
        else if (keys[i].turn)
            keys[i].turn(view, keys[i].by);
        else
            keys[i].act(view);
        if (keys[i].turn == look_along && view->camera_known)
            view_say(view, "%s", keys[i].name);
        view->dirty = true;
        return true;
    }
    return false;
}
