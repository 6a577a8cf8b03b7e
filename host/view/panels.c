#include "view/panels.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "settings/quote.h"
#include "view/choices.h"
#include "view/price_panel.h"
#include "view/scenes.h"
#include "view/view_private.h"

enum { NAMES_LAST = 9999, WORDS_BYTES = 8192 };
static const double FPS_MIN = 1.0, FPS_MAX = 240.0;

/* ---- Files of settings ---- */

bool view_free_name(const char *extension, char name[VIEW_FREE_NAME])
{
    for (int i = 1; i <= NAMES_LAST; ++i) {
        snprintf(name, VIEW_FREE_NAME, "whit-%04d.%.8s", i, extension);
        if (!file_exists(name))
            return true;
    }
    return false;
}

static void list_states(struct panels *panels)
{
    glob_t found = {0};
    (void)glob("whit-[0-9][0-9][0-9][0-9].view", 0, NULL, &found);
    panels->state_count = 0;
    panels->states_known = true;
    for (size_t i = found.gl_pathc; i > 0 && panels->state_count < STATES_MAX; --i)
        snprintf(panels->states[panels->state_count++], VIEW_FREE_NAME, "%s",
                 found.gl_pathv[i - 1]);
    globfree(&found);
}

static whit_result write_state(const struct view *view, const char *path, const whit_log *log)
{
    char words[WORDS_BYTES];
    struct file_write file;
    size_t length = settings_write(&view->settings, SETTINGS_STATE, "\n", words, sizeof words);
    if (length >= sizeof words)
        return WHIT_ERROR_MEMORY;
    whit_result result = file_write_begin(log, path, &file);
    if (result != WHIT_OK)
        return result;
    fputs("# whit view ", file.stream);
    quote_print(view->settings.scene, file.stream);
    fprintf(file.stream, " --state %s\n%s\n", path, words); /* path is from view_free_name */
    return file_write_commit(log, &file);
}

void panels_save(struct view *view)
{
    char path[VIEW_FREE_NAME];
    struct view_saving saving;
    const whit_log log = view_saving_begin(view, &saving);
    view_say_saved(view, &saving, path,
                   view_free_name("view", path) && write_state(view, path, &log) == WHIT_OK);
    view->panels.states_known = false;
}

static void set_fps_goal(struct view *view, double fps)
{
    view->settings.fps_goal = fps;
    engine_set_budget(view->engine, 1e3 / fps);
}

void panels_load(struct view *view, const char *path)
{
    struct settings loaded = view->settings;
    const struct view_params *params = view->params;
    char message[TOAST_BYTES];
    if (params->load_state(params->load_user, path, &loaded, message, sizeof message) != WHIT_OK) {
        view_say(view, "%s", message);
        return;
    }
    const whit_renderer_params *now = &view->settings.picture, *next = &loaded.picture;
    if (next->width != now->width || next->height != now->height)
        window_set_pixels(view->window, next->width, next->height);
    view->settings = loaded;
    view->resized = true;       /* the images are made anew even if the window keeps its size */
    view->camera_known = false; /* read again from the text settings.camera */
    view_learn_camera(view);
    set_fps_goal(view, loaded.fps_goal);
    view_say(view, "%s: these settings", path);
}

/* ---- Settings ---- */

static void draw_number(struct view *view, const struct setting *row)
{
    double number = choice_number(&view->settings, row);
    bool is_count = row->kind == SETTING_COUNT;
    uint32_t count = is_count ? (uint32_t)number : 0; /* other numbers may be below 0 */
    if (is_count ? ui_slider_count(row->title, &count, (uint32_t)row->shown_min,
                                   (uint32_t)row->shown_max)
                 : ui_slider(row->title, &number, row->shown_min, row->shown_max, false))
        choice_set_number(&view->settings, row, is_count ? count : number);
}

static void draw_choice(struct view *view, const struct setting *row)
{
    char shown[CHOICE_WORDS];
    const char *words[CHOICE_WORDS_MAX];
    uint32_t count = choice_words(row, words);
    int value = choice_get(&view->settings, row);
    if (count == 0) {
        draw_number(view, row);
        return;
    }
    choice_say(&view->settings, row, shown, sizeof shown);
    if (ui_choice(row->title, shown, words, (int)count, &value))
        choice_set(&view->settings, row, (uint32_t)value);
}

static void draw_hud_choice(struct view *view)
{
    int value = (int)view->hud;
    if (ui_choice("figures", hud_names[value], hud_names, HUD_COUNT, &value))
        view->hud = (enum view_hud)value;
}

static void draw_files(struct view *view)
{
    struct panels *panels = &view->panels;
    const char *names[STATES_MAX];
    int value = -1;
    if (!panels->states_known)
        list_states(panels);
    for (uint32_t i = 0; i < panels->state_count; ++i)
        names[i] = panels->states[i];
    if (ui_button("save"))
        panels_save(view);
    ui_same_line(0);
    if (ui_choice("files", panels->state_count ? "load" : "none here", names,
                  (int)panels->state_count, &value))
        panels_load(view, names[value]);
}

/* Whether a setting has an effect now: the kind of rays needs a cost view, the level of boxes needs
   boxes. */
static bool says_something(const struct view *view, const struct setting *row)
{
    return strcmp(row->name, "view-rays") == 0     ? view->settings.paint != PAINT_COLOR
           : strcmp(row->name, "boxes-level") == 0 ? view->settings.boxes != BOXES_OFF
                                                   : true;
}

static void draw_choices(struct view *view, enum choice_group group)
{
    for (const struct setting *row = choice_next(NULL); row; row = choice_next(row)) {
        if (choice_group(row) == group && says_something(view, row))
            draw_choice(view, row);
    }
}

static void draw_settings(struct view *view)
{
    double fps = view->settings.fps_goal;
    if (ui_panel_begin("Settings", 0.0f, 0.0f, UI_PANEL_HOLD)) {
        draw_choices(view, CHOICE_SCENE);
        skies_draw(view);
        draw_choices(view, CHOICE_PICTURE);
        if (ui_slider("fps goal", &fps, FPS_MIN, FPS_MAX, true))
            set_fps_goal(view, fps);
        draw_hud_choice(view);
        ui_separator();
        draw_choices(view, CHOICE_EXPERTS);
        if (view->wish.stage != WISH_NONE && ui_button("choose again"))
            wish_again(view, true);
        draw_files(view);
        if (ui_button("close##settings"))
            view->panels.settings = false;
    }
    ui_panel_end();
}

/* ---- Effects ---- */

void panels_switch_effects(struct view *view)
{
    struct panels *panels = &view->panels;
    panels->effects = !panels->effects;
    prices_leave(view, &panels->measured);
    bool can = !settings_compiles(&view->settings); /* prices are for whit's own functions */
    if (can && panels->effects && view->scene && view->frame.number > 0)
        panels->measured = prices_start(&(struct prices_params){
            .settings = view->frame.settings, .scene = view->scene, .effects = true});
}

static void switch_effect(struct view *view, uint32_t index, bool called, bool on)
{
    effects_set(&view->settings.picture, index, called, on);
    bool together = view->panels.pending && view->status.drawing;
    view->panels.pending = together ? -1 : (int)index + 1;
}

/* Whether a price has room on one line, and else is drawn on two. */
static bool prices_are_short(void)
{
    return ui_characters(3) >= 120;
}

/* Draws "on: 3.10 -> 3.52 ms, 120 of 12288 pixels". */
static void draw_price(const struct effect_price *price)
{
    ui_text("%s: %.2f -> %.2f ms,", price->added ? "on" : "off", price->before_ms, price->after_ms);
    if (prices_are_short())
        ui_same_line(0);
    ui_text("%llu of %llu pixels", (unsigned long long)price->other_colors,
            (unsigned long long)price->pixels);
}

/* Shows up to three effects that take the largest shares of the picture's time, each more than 5 %,
   with their reasons: "refraction: 41 % of the time, for material `glass`". */
static void draw_dearest(struct prices *measured, const whit_scene *scene)
{
    enum { TOLD = 3 };
    double last = 1.0;
    for (int told = 0; told < TOLD; ++told) {
        uint32_t dearest = EFFECTS_MAX;
        double part = 0.05;
        for (uint32_t i = 0; i < EFFECTS_MAX && whit_effect_name(i); ++i) {
            struct effect_price price;
            prices_get_effect(measured, i, &price);
            double own = price.known && !price.added ? 1.0 - price.after_ms / price.before_ms : 0.0;
            if (own > part && own < last) {
                part = own;
                dearest = i;
            }
        }
        if (dearest == EFFECTS_MAX)
            return;
        whit_effect_info info;
        whit_scene_get_effect(scene, dearest, &info);
        ui_text_color(UI_COLOR_GOOD, "%s: %.0f %% of the time, for %.60s", info.name, 100.0 * part,
                      info.reason);
        last = part;
    }
}

/* Draws the price of an effect: measured when the user switched it, else in the background
   (`measured`). */
static void draw_price_of(struct view *view, uint32_t index, bool in, bool can)
{
    struct panels *panels = &view->panels;
    struct effect_price price = panels->prices[index];
    struct prices_state state = {.finished = true};
    if (!price.known && panels->measured) {
        prices_get_effect(panels->measured, index, &price);
        prices_get_state(panels->measured, &state);
    }
    if (!can)
        ui_text_dim("by geometry or camera");
    else if (price.known)
        draw_price(&price);
    else if (state.finished || !in)
        ui_text_dim("press to measure");
    else {
        bool now = strcmp(state.what, whit_effect_name(index)) == 0;
        ui_text_dim("%s", now ? "measuring" : "to come");
        if (!prices_are_short()) /* as many lines as the price will have, so that nothing moves */
            ui_text_dim(" ");
    }
}

/* Characters that the columns of effects and prices take at most, and the column of reasons. */
enum { EFFECT_CHARACTERS = 46, REASON_CHARACTERS = 60 };

/* Whether there is room for the reasons of effects. */
static bool say_reasons(void)
{
    return ui_characters(3) >= 70;
}

static void draw_effect(struct view *view, uint32_t index)
{
    whit_effect_info info;
    const struct engine_frame *frame = &view->frame;
    whit_scene_get_effect(frame->scene->scene, index, &info);
    bool in = (frame->effects >> index & 1) != 0, on = in;
    bool can = in ? whit_effect_can_remove(index) : whit_effect_can_add(index);
    ui_table_next();
    if (can) {
        if (ui_checkbox(info.name, &on))
            switch_effect(view, index, info.called, on);
    } else {
        ui_text("%s  %s", in ? " x" : " -", info.name);
    }
    ui_table_next();
    draw_price_of(view, index, in, can);
    if (say_reasons())
        ui_cell(info.called ? UI_COLOR_TEXT : UI_COLOR_DIM,
                info.called ? info.reason : "not called for");
}

static void draw_effects(struct view *view)
{
    static const char *const titles[] = {"effect", "price of the switch", "called for by"};
    if (view->frame.number == 0)
        return;
    if (ui_panel_begin("Effects", 0.0f, 0.0f, UI_PANEL_HOLD)) {
        char effects[SETTING_VALUE_BYTES];
        effects_write(&view->settings.picture, effects);
        ui_text("--effects %s", effects);
        ui_text_dim("%s A click switches, and measures the whole picture.",
                    settings_compiles(&view->frame.settings)
                        ? "With --shader no price comes by itself."
                        : "Prices are of a small picture.");
        int columns = say_reasons() ? 3 : 2, room = ui_characters(columns) - EFFECT_CHARACTERS;
        const int widths[3] = {0, 0, room < REASON_CHARACTERS ? room : REASON_CHARACTERS};
        if (ui_table_begin("effects", columns)) {
            ui_table_columns(titles, widths, columns);
            for (uint32_t i = 0; i < EFFECTS_MAX && whit_effect_name(i); ++i)
                draw_effect(view, i);
            ui_table_end();
        }
        if (ui_button("close##effects"))
            panels_switch_effects(view);
        if (view->panels.measured) /* below the switches, which must not move under the mouse */
            draw_dearest(view->panels.measured, view->frame.scene->scene);
    }
    ui_panel_end();
}

void panels_step(struct view *view)
{
    struct panels *panels = &view->panels;
    const struct engine_change *change = &view->status.change;
    if (panels->scene != view->scene) { /* another scene has other prices; addresses suffice */
        panels->scene = view->scene;
        memset(panels->prices, 0, sizeof panels->prices);
        panels->pending = 0;
    }
    if (change->number == panels->change)
        return;
    panels->change = change->number;
    bool alone = strncmp(change->what, "effects ", 8) == 0 && !strstr(change->what, ", ");
    if (panels->pending > 0 && alone) {
        uint32_t index = (uint32_t)panels->pending - 1;
        panels->prices[index] =
            (struct effect_price){.known = true,
                                  .added = (view->frame.effects >> index & 1) != 0,
                                  .before_ms = change->before_ms,
                                  .after_ms = change->after_ms,
                                  .other_colors = change->difference.other_colors,
                                  .pixels = change->difference.pixels};
    }
    panels->pending = 0;
}

void panels_draw(struct view *view)
{
    if (view->panels.settings) {
        shaders_draw(view);
        draw_settings(view);
    }
    if (view->panels.effects)
        draw_effects(view);
}
