#include "view/shaders.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/path.h"
#include "base/text.h"
#include "base/watch.h"
#include "view/engine_turns.h"
#include "view/view_private.h"

enum { PAIR_BYTES = 256 };
/* Time for which a picture is shown before times are measured: a user who goes on typing comes
   first. */
static const double SEEN_MS = 250.0;

/* ---- The file ---- */

/* Watches the shader's file and the files of the shown version, also while there is an error. A
   picture that carries functions is not watched: the user was asked about these functions only. */
static void watch_files(struct view *view)
{
    const struct shader_ref *shown = view->shaders.shown;
    int64_t since_ns = shown ? shown->since_ns : watch_now_ns();
    watch_clear(view->shaders.watch);
    if (whit_image_format_known(view->settings.shader, false))
        return;
    if (view->settings.shader[0])
        watch_add(view->shaders.watch, view->settings.shader, since_ns);
    for (uint32_t i = 0; shown && i < shown->info.file_count; ++i)
        watch_add(view->shaders.watch, shown->info.files[i], since_ns);
}

/* Also watches the files that errors name, one error a line: "FILE:LINE: ...", and included files
   that are missing. The failed version may include files that the shown one does not. */
static void watch_broken(struct view *view)
{
    static const char include[] = "#include \"";
    char errors[SESSION_ERRORS], *rest = NULL;
    snprintf(errors, sizeof errors, "%s", view->shaders.errors);
    for (char *line = strtok_r(errors, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        size_t length = strcspn(line, ":");
        char *name = line[length] ? strstr(line + length + 1, include) : NULL;
        line[length] = '\0';
        watch_add(view->shaders.watch, line, view->shaders.saved_ns);
        if (!name)
            continue;
        name += strlen(include);
        name[strcspn(name, "\"")] = '\0';
        char *path = path_beside(line, name);
        if (path)
            watch_add(view->shaders.watch, path, view->shaders.saved_ns);
        free(path);
    }
}

void shaders_begin(struct view *view)
{
    if (!settings_compiles(&view->settings))
        return;
    view->shaders.watch = watch_create(window_wake);
    view->shaders.saved_ns = watch_now_ns();
    watch_files(view);
}

void shaders_end(struct view *view)
{
    watch_destroy(view->shaders.watch);
    shader_ref_drop(view->shaders.shown);
}

/* Shows colours, and says so, if the shader has no aov of the name in the settings. Nothing names
   it any more, so that pictures and lines for `whit render` can be drawn again. */
static void drop_aov(struct view *view)
{
    const struct shader_ref *shader = view->frame.shader;
    const char *aov = view->frame.settings.aov;
    if (!shader || !aov[0] || shader_ref_find_aov(shader, aov) != UINT32_MAX)
        return;
    if (strcmp(view->settings.aov, aov) == 0 &&
        settings_same_shader(&view->settings, &view->frame.settings)) {
        const char *nearest = text_nearest(aov, shader->info.aovs, shader->info.aov_count);
        view_say(view, "%s has no `//@ aov %s`%s%s%s", path_name(view->settings.shader), aov,
                 nearest ? "; did you mean `" : "", nearest ? nearest : "", nearest ? "`?" : "");
        log_warning(&view->log, "%s", view->toast);
        view->settings.aov[0] = '\0';
        view->dirty = true;
    }
    view->frame.settings.aov[0] = view->fallback.aov[0] = '\0';
}

/* Drops values of sliders that the file no longer has or takes, so that pictures and lines for
   `whit render` do not name them. */
static void keep_sliders(struct view *view)
{
    const struct shader_ref *shown = view->shaders.shown;
    if (!shown)
        return;
    whit_shader_keep_sliders(shown->shader, view->frame.settings.sliders);
    if (whit_shader_keep_sliders(shown->shader, view->settings.sliders))
        view->dirty = true;
}

void shaders_take(struct view *view)
{
    struct shaders *shaders = &view->shaders;
    drop_aov(view);
    if (shaders->shown == view->frame.shader)
        return;
    if (shaders->shown && view->frame.shader) {
        shaders->was_saved = strcmp(shaders->shown->settings.shader, view->settings.shader) == 0;
        shaders->before = shaders->shown->settings.shader_reload;
    }
    shader_ref_drop(shaders->shown);
    shaders->shown = shader_ref_take(view->frame.shader);
    shaders->errors[0] = shaders->line[0] = '\0';
    watch_files(view);
    keep_sliders(view);
}

bool shaders_set_before(const struct view *view, struct settings *settings)
{
    if (view->shaders.was_saved)
        settings->shader_reload = view->shaders.before;
    return view->shaders.was_saved;
}

bool shaders_refuse(struct view *view)
{
    struct shaders *shaders = &view->shaders;
    if (settings_same_shader(&view->settings, &view->fallback) || view->frame.number == 0)
        return false;
    snprintf(shaders->errors, sizeof shaders->errors, "%s", view_failure(view));
    shaders->errors_reload = view->settings.shader_reload;
    if (!whit_image_format_known(view->settings.shader, false))
        watch_broken(view);
    view_log_failure(view);
    return true;
}

/* ---- What a reload changed ---- */

/* Writes a number as "1,204". */
static void write_count(uint64_t count, char text[32])
{
    char digits[24];
    int length = snprintf(digits, sizeof digits, "%llu", (unsigned long long)count);
    for (int i = 0; i < length; ++i) {
        *text++ = digits[i];
        if ((length - i) % 3 == 1 && i + 1 < length)
            *text++ = ',';
    }
    *text = '\0';
}

void shaders_say(const struct engine_reload *reload, const struct shaders_wait *wait,
                 char line[SHADERS_LINE])
{
    const struct difference *difference = &reload->difference;
    char count[32];
    line[0] = '\0';
    if (reload->ms.count > 0)
        text_add(line, SHADERS_LINE, "%+.2f ms [%.2f, %.2f]", reload->ms.median, reload->ms.low,
                 reload->ms.high);
    else
        text_add(line, SHADERS_LINE, "time not measured: %s", reload->why);
    write_count(difference->other_colors, count);
    if (reload->compared && reload->has_colors)
        text_add(line, SHADERS_LINE, "  %s pixels other", count);
    if (reload->has_flip)
        text_add(line, SHADERS_LINE, "  FLIP %.3f", reload->flip);
    write_count(difference->other_ids, count);
    if (reload->compared)
        text_add(line, SHADERS_LINE, "  %s", difference->other_ids == 0 ? "ids equal" : "");
    if (reload->compared && difference->other_ids > 0)
        text_add(line, SHADERS_LINE, "%s ids other", count);
    if (wait->first_ms > 0.0)
        text_add(line, SHADERS_LINE, "  preview %.0f ms", wait->first_ms - wait->saved_ms);
    if (wait->whole_ms > 0.0)
        text_add(line, SHADERS_LINE, ", whole %.1f s", (wait->whole_ms - wait->saved_ms) * 1e-3);
}

/* Notes the time of the first call. */
static void note_moment(double *at_ms, uint64_t *count)
{
    if (*at_ms > 0.0)
        return;
    *at_ms = whit_clock_ms();
    ++*count;
}

void shaders_shown(struct view *view)
{
    struct shaders_wait *wait = &view->shaders.wait;
    struct shaders_counts *counts = &view->shaders.counts;
    const struct engine_frame *frame = &view->frame;
    if (!wait->goes_on)
        return;
    if (view->shaders.errors[0] && view->shaders.errors_reload == wait->asked.shader_reload)
        note_moment(&wait->error_ms, &counts->refused);
    if (frame->settings.shader_reload != wait->asked.shader_reload)
        return;
    note_moment(&wait->first_ms, &counts->first);
    if (frame->whole && settings_same(&frame->settings, &wait->asked))
        note_moment(&wait->whole_ms, &counts->whole);
}

/* Whether all pictures that the save asked for were shown, or will not be as settings changed. */
static bool is_shown(const struct view *view)
{
    const struct shaders_wait *wait = &view->shaders.wait;
    return wait->first_ms > 0.0 &&
           (wait->whole_ms > 0.0 || !settings_same(&wait->asked, &view->settings));
}

/* Whether the user has seen the picture for a moment. */
static bool is_seen(const struct shaders *shaders)
{
    return shaders->wait.first_ms > 0.0 &&
           whit_clock_ms() - fmax(shaders->wait.first_ms, shaders->wait.whole_ms) > SEEN_MS;
}

/* Whether the window has not told yet what the last save changed. */
static bool is_untold(const struct view *view)
{
    const struct shaders *shaders = &view->shaders;
    const struct engine_reload *reload = &view->status.reload;
    return shaders->reload != reload->number && shaders->wait.goes_on &&
           reload->settings.shader_reload == shaders->wait.asked.shader_reload;
}

static void tell(struct view *view, const struct engine_reload *reload)
{
    struct shaders *shaders = &view->shaders;
    const char *name = view->settings.shader[0] ? path_name(view->settings.shader) : "stages";
    shaders->reload = reload->number;
    shaders->wait.goes_on = false;
    shaders_say(reload, &shaders->wait, shaders->line);
    log_info(&view->log, "%s: %s", name, shaders->line);
    /* A message of the key that ended it stays. */
    if ((reload->ms.count > 0 && !reload->stopped) || !view->toast[0])
        view_say(view, "%s: %s", name, shaders->line);
}

void shaders_step(struct view *view)
{
    const struct engine_reload *reload = &view->status.reload;
    if (!is_untold(view))
        return;
    if (!reload->over && is_seen(&view->shaders))
        engine_measure_reload(view->engine);
    if (reload->over && is_shown(view))
        tell(view, reload);
}

void shaders_watch(struct view *view)
{
    struct shaders *shaders = &view->shaders;
    if (!watch_changed(shaders->watch))
        return;
    shaders->saved_ns = watch_now_ns();
    engine_stop_reload(view->engine);
    if (is_untold(view)) {
        struct engine_reload stopped = view->status.reload;
        if (!stopped.over)
            stopped.why = ENGINE_TURNS_STOPPED;
        tell(view, &stopped);
    }
    view->settings.shader_reload = ++view->reloads;
    shaders->wait = (struct shaders_wait){
        .goes_on = true, .saved_ms = whit_clock_ms(), .asked = view->settings};
    view->progress_ms = shaders->wait.saved_ms;
}

/* ---- Sliders ---- */

static void set_slider(struct view *view, const whit_slider *slider, const char *value)
{
    char pair[PAIR_BYTES], why[SETTING_WHY_BYTES];
    snprintf(pair, sizeof pair, "%s=%s", slider->name, value);
    if (!settings_read(settings_row("set"), pair, &view->settings, why))
        view_say(view, "--set%s", why);
    view->dirty = true; /* the engine is asked before the window is drawn again */
}

/* The value behind NAME= in the settings; "": there is none, so the file's own value counts. */
static void get_slider(const struct view *view, const whit_slider *slider, char value[PAIR_BYTES])
{
    const char *at = view->settings.sliders;
    size_t name = strlen(slider->name);
    value[0] = '\0';
    while (*at) {
        size_t length = strcspn(at, ",");
        if (length > name && at[name] == '=' && strncmp(at, slider->name, name) == 0)
            snprintf(value, PAIR_BYTES, "%.*s", (int)(length - name - 1), at + name + 1);
        at += length + (at[length] == ',');
    }
}

static void draw_number(struct view *view, const whit_slider *slider, const char *value)
{
    double number = (double)slider->value[0];
    char text[40];
    if (value[0])
        sscanf(value, "%lf", &number);
    if (!ui_slider(slider->name, &number, (double)slider->min, (double)slider->max, false))
        return;
    setting_write_float((float)number, text, sizeof text);
    set_slider(view, slider, text);
}

static void draw_toggle(struct view *view, const whit_slider *slider, const char *value)
{
    bool on = value[0] ? strcmp(value, "on") == 0 : slider->value[0] != 0.0f;
    if (ui_checkbox(slider->name, &on))
        set_slider(view, slider, on ? "on" : "off");
}

static void draw_words(struct view *view, const whit_slider *slider, const char *value)
{
    int at = (int)slider->value[0];
    for (uint32_t i = 0; i < slider->word_count; ++i)
        at = strcmp(slider->words[i], value) == 0 ? (int)i : at;
    if (ui_choice(slider->name, slider->words[at], slider->words, (int)slider->word_count, &at))
        set_slider(view, slider, slider->words[at]);
}

static void draw_color(struct view *view, const whit_slider *slider, const char *value)
{
    unsigned rgb[3];
    char text[16];
    float color[3];
    memcpy(color, slider->value, sizeof color);
    if (sscanf(value, "#%2x%2x%2x", &rgb[0], &rgb[1], &rgb[2]) == 3) {
        for (int i = 0; i < 3; ++i)
            color[i] = (float)rgb[i] / 255.0f;
    }
    if (!ui_color(slider->name, color))
        return;
    snprintf(text, sizeof text, "#%02x%02x%02x", (unsigned)(color[0] * 255.0f + 0.5f),
             (unsigned)(color[1] * 255.0f + 0.5f), (unsigned)(color[2] * 255.0f + 0.5f));
    /* While a field is typed into, ui_color reports a change at each drawing. */
    if (strcmp(text, value) != 0)
        set_slider(view, slider, text);
}

void shaders_draw(struct view *view)
{
    static void (*const draw[])(struct view *, const whit_slider *,
                                const char *) = {[WHIT_SLIDER_NUMBER] = draw_number,
                                                 [WHIT_SLIDER_COLOR] = draw_color,
                                                 [WHIT_SLIDER_TOGGLE] = draw_toggle,
                                                 [WHIT_SLIDER_CHOICE] = draw_words};
    const struct shader_ref *shown = view->shaders.shown;
    if (!shown || shown->info.slider_count == 0)
        return;
    if (ui_panel_begin("Shader", 0.0f, 0.0f, UI_PANEL_HOLD)) {
        char value[PAIR_BYTES];
        for (uint32_t i = 0; i < shown->info.slider_count; ++i) {
            const whit_slider *slider = &shown->info.sliders[i];
            get_slider(view, slider, value);
            draw[slider->kind](view, slider, value);
            if (slider->help[0])
                ui_text_dim("%s", slider->help);
        }
    }
    ui_panel_end();
}
