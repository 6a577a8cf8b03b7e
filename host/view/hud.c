#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "view/choices.h"
#include "view/hud.h"
#include "view/keys.h"
#include "view/overlay.h"
#include "view/pick.h"
#include "view/price_panel.h"
#include "view/scenes.h"
#include "view/view_private.h"

const char *const hud_names[HUD_COUNT] = {"off", "small", "full"};

/* Height of figures and a panel below them, and of a panel alone, pixels. */
static const float ROOM_FOR_BOTH = 400.0f, ROOM_FOR_PANEL = 220.0f;
/* A window of less width or height has one opened panel at a time. */
static const float ROOM_FOR_PANELS_X = 600.0f, ROOM_FOR_PANELS_Y = 440.0f;

void hud_quality(const struct view *view, char text[HUD_QUALITY_BYTES])
{
    const struct engine_frame *frame = &view->frame;
    char samples[32] = "adaptive samples";
    if (frame->samples > 0)
        snprintf(samples, sizeof samples, "%u sample%s", frame->samples,
                 frame->samples > 1 ? "s" : "");
    char bailout[32] = "";
    if (frame->bailout > frame->settings.picture.bailout)
        snprintf(bailout, sizeof bailout, ", bailout 1/%.0f", 1.0 / frame->bailout);
    if (frame->divisor > 1)
        snprintf(text, HUD_QUALITY_BYTES, "1/%u of the size, %s%s%s", frame->divisor, samples,
                 bailout, view->status.drawing ? ", on its way" : "");
    else
        snprintf(text, HUD_QUALITY_BYTES, "full size, %s%s", samples,
                 frame->whole ? "" : " as yet");
}

static void draw_quality(const struct view *view)
{
    char text[HUD_QUALITY_BYTES];
    bool preview = view->frame.divisor > 1 || !view->frame.whole;
    hud_quality(view, text);
    ui_text_color(preview ? UI_COLOR_WARNING : UI_COLOR_TEXT, "%s", text);
}

/* Whether all pixels are black; in other pictures the loop ends at the first one that is not. */
static bool is_black(const struct engine_frame *frame)
{
    for (size_t i = 0; i < (size_t)frame->width * frame->height; ++i) {
        const uint8_t *pixel = &frame->rgba[4 * i];
        if (pixel[0] || pixel[1] || pixel[2])
            return false;
    }
    return true;
}

static void draw_figures(const struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    if (frame->settings.aov[0] && frame->settings.paint == PAINT_COLOR)
        ui_text("aov %s", frame->settings.aov);
    const whit_stats *s = &frame->stats;
    double ms = engine_drawn_ms(s);
    char fps[24] = "still";
    if (view->rate.fps > 0.0 && view_is_moving(view))
        snprintf(fps, sizeof fps, "%.1f fps", view->rate.fps);
    ui_text("%9s  render %.2f ms", fps, ms);
    ui_text_beside(UI_COLOR_TEXT, " %.2f Mray/s",
                   ms > 0.0 ? (double)(whit_stats_rays(s) + s->rays_of_estimate) / ms * 1e-3 : 0.0);
    if (frame->scene->info.time_end_s > 0.0)
        ui_text("%s at %.2f of %.2f s", view->clock.playing ? "plays" : "stands",
                frame->settings.picture.time_s, frame->scene->info.time_end_s);
}

static void draw_names(const struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    const struct settings *s = &frame->settings;
    char builder[SETTING_VALUE_BYTES] = "no trees";
    if (s->trees.build != WHIT_BUILD_NONE)
        builder_write(&frame->accel.params, builder, sizeof builder);
    ui_text("%s, %s, %s", builder, value_word(values_traversal, (int)s->picture.traversal),
            value_word(values_numerics, (int)s->picture.numerics));
}

/* Shows the three materials that most hits of a shading kernel wear. */
static void draw_shares(const struct engine_frame *frame, uint32_t stage)
{
    const whit_stats *s = &frame->stats;
    for (uint32_t i = 0, shown = 0; i < s->share_count && shown < 3; ++i) {
        const whit_share *share = &s->shares[i];
        if (share->stage != stage || share->share < 0.01)
            continue;
        whit_material_info material;
        whit_scene_get_material(frame->scene->scene, share->material, &material);
        ui_text_dim("    %.0f %% of its hits: %s", 100.0 * share->share,
                    text_token(material.name).text);
        ++shown;
    }
}

/* Draws the rays and times of stages, scaled up from one tile in eight that had time stamps. */
static void draw_stages(const struct engine_frame *frame)
{
    const whit_stats *s = &frame->stats;
    for (int i = 0; i < WHIT_STAGES; ++i) {
        const whit_stage *stage = &s->stages[i];
        if (stage->rays && stage->ms >= 0.0)
            ui_text_dim("%s %.2f ms, %llu rays, %.0f ns a ray", stage->name, stage->ms,
                        (unsigned long long)stage->rays, stage->ms * 1e6 / (double)stage->rays);
        draw_shares(frame, (uint32_t)i);
    }
}

/* Draws the estimated error while the picture was refined, over the time of drawing. Both axes are
   logarithmic, so that it falls along a line. */
static void draw_estimates(const struct engine_frame *frame)
{
    const struct engine_estimate *all = frame->estimates;
    struct ui_point points[ENGINE_ESTIMATES_MAX];
    uint32_t count = frame->estimate_count;
    if (count == 0)
        return;
    const struct engine_estimate *last = &all[count - 1];
    ui_separator();
    ui_text("an RMSE of %.2g may be left after %.2f s", last->error, last->ms * 1e-3);
    double low = last->error, high = last->error;
    for (uint32_t i = 0; i < count; ++i) {
        low = fmin(low, all[i].error);
        high = fmax(high, all[i].error);
    }
    if (count < 2 || !(low > 0.0) || !(all[0].ms > 0.0))
        return;
    for (uint32_t i = 0; i < count; ++i)
        points[i] = (struct ui_point){.x = ui_log_place(all[i].ms, all[0].ms, last->ms),
                                      .y = ui_log_place(all[i].error, low, high),
                                      .color = 0xFFD0E090u,
                                      .radius = 2.0f,
                                      .joined = true};
    ui_plot_points(&(struct ui_plot){.width = 20.0f,
                                     .height = 4.0f,
                                     .line_color = 0xFFD0E090u,
                                     .points = points,
                                     .count = count});
    ui_text_dim("%.2g to %.2g from %u to %u samples, %.2f to %.2f s", all[0].error, last->error,
                all[0].samples, last->samples, all[0].ms * 1e-3, last->ms * 1e-3);
}

static void draw_more(const struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    const whit_scene_info *scene = &frame->scene->info;
    const whit_stats *s = &frame->stats;
    struct swapchain_info chain;
    swapchain_get_info(view->swapchain, &chain);
    ui_separator();
    ui_text("%u x %u of %u x %u, %s", frame->width, frame->height, chain.width, chain.height,
            chain.format);
    draw_estimates(frame);
    ui_separator();
    ui_text("%llu triangle%s, %llu ball%s, %u instance%s, %u light%s",
            (unsigned long long)scene->triangle_count, scene->triangle_count == 1 ? "" : "s",
            (unsigned long long)scene->sphere_count, scene->sphere_count == 1 ? "" : "s",
            scene->instance_count, scene->instance_count == 1 ? "" : "s", scene->light_count,
            scene->light_count == 1 ? "" : "s");
    ui_text("rays: %llu camera, %llu shadow, %llu reflected, %llu refracted",
            (unsigned long long)s->rays_primary, (unsigned long long)s->rays_shadow,
            (unsigned long long)s->rays_reflected, (unsigned long long)s->rays_refracted);
    if (s->rays_straight)
        ui_text("%llu straight on", (unsigned long long)s->rays_straight);
    if (s->rays_by_functions)
        ui_text("%llu by functions of the shader", (unsigned long long)s->rays_by_functions);
    if (s->rays_of_estimate)
        ui_text("%llu for the estimate of the error", (unsigned long long)s->rays_of_estimate);
    ui_text("cut: %llu by depth, %llu by bail-out", (unsigned long long)s->rays_cut_depth,
            (unsigned long long)s->rays_cut_bailout);
    draw_stages(frame);
    ui_text("trees %.1f ms, depth %u, %.1f MiB; kernel %u instructions, %.0f ms", frame->build_ms,
            frame->accel.depth, (double)frame->accel.bytes / 1048576.0, s->kernel_instructions,
            frame->compile_ms);
    ui_text("%s", frame->device.name);
    if (frame->visits >= 0.0)
        ui_text("%.1f visits a camera ray", frame->visits);
    ui_text_dim("present %.2f ms, over the picture %.2f ms, image after %.2f ms", chain.present_ms,
                chain.draw_ms, chain.wait_ms);
}

/* Draws the parts of `text`, which `between` separates, each on a line of its own, of which it
   draws at most `most` bytes. */
static void draw_parts(const char *text, const char *between, int most)
{
    for (const char *at = text; *at;) {
        const char *end = strstr(at, between);
        int length = end ? (int)(end - at) : (int)strlen(at);
        ui_text("%.*s", length < most ? length : most, at);
        at += length + (end ? (int)strlen(between) : 0);
    }
}

/* Draws how drawing time changed, in per cent of the time before, with its confidence interval. */
static void draw_change_ms(const struct engine_change *c)
{
    double share = c->before_ms > 0.0 ? 100.0 / c->before_ms : 0.0;
    double low = c->ms.low * share, high = c->ms.high * share;
    if (c->ms.count == 0)
        ui_text("%.2f -> %.2f ms, of one picture each", c->before_ms, c->after_ms);
    else if (low <= 0.0 && high >= 0.0)
        ui_text("no measurable difference, %+.1f to %+.1f %%", low, high);
    else
        ui_text("%.2f -> %.2f ms, %+.1f %% [%+.1f, %+.1f]", c->before_ms, c->after_ms,
                c->ms.median * share, low, high);
}

/* Draws "traversal distance -> sign", one change a line, then its effects. */
static void draw_change(const struct view *view)
{
    const struct engine_change *c = &view->status.change;
    if (c->number == 0 || !settings_same(&c->settings, &view->settings))
        return;
    ui_separator();
    draw_parts(c->what, ", ", 46);
    if (view->shaders.line[0]) {
        draw_parts(view->shaders.line, "  ", (int)sizeof view->shaders.line);
        return;
    }
    draw_change_ms(c);
    if (c->difference.other_ids == 0 && c->difference.other_colors == 0) {
        bool exposes = strstr(c->what, "exposure ") != NULL;
        ui_text_color(UI_COLOR_GOOD, !c->has_colors ? "same hits"
                                     : exposes      ? "same radiance, displayed by another exposure"
                                                    : "same picture");
        return;
    }
    ui_text_color(c->difference.other_ids ? UI_COLOR_WARNING : UI_COLOR_GOOD,
                  "%llu of %llu pixels changed", (unsigned long long)c->difference.other_ids,
                  (unsigned long long)c->difference.pixels);
    ui_text_beside(UI_COLOR_TEXT, "what they hit,");
    if (c->difference.other_colors > 0)
        ui_text("%llu colours, linear RGB by at most %.3g, on average %.2g",
                (unsigned long long)c->difference.other_colors, c->difference.largest,
                c->difference.mean);
    else if (c->has_colors)
        ui_text("0 colours");
}

/* Whether the window is too low for figures and a panel. */
static bool is_low(const struct view *view)
{
    float height = (float)view->settings.picture.height, scale = ui_scale(view->ui);
    return view->crowd.low || height < ROOM_FOR_BOTH * scale ||
           height - ui_panel_height("figures") < ROOM_FOR_PANEL * scale;
}

static bool holds_panel(const struct view *view)
{
    return view->panels.settings || view->panels.effects;
}

static void draw_hud(const struct view *view)
{
    bool costs = view->frame.settings.paint != PAINT_COLOR;
    bool busy = costs || view->compare.mode != COMPARE_OFF;
    if (view->hud == HUD_OFF || view->frame.number == 0 || (is_low(view) && holds_panel(view)))
        return;
    if (ui_panel_begin("figures", 0.0f, 0.0f,
                       view->hud == HUD_FULL && !view->open ? UI_PANEL_STAYS : UI_PANEL_PLAIN)) {
        draw_figures(view);
        draw_names(view);
        draw_quality(view);
        if (view->frame.whole && view->frame.settings.paint == PAINT_COLOR &&
            is_black(&view->frame))
            ui_text_color(UI_COLOR_WARNING, "all of it is black: Tab has `light` and `exposure`");
        if (view->hud == HUD_FULL)
            draw_more(view);
        wish_draw(view);
        if (!(is_low(view) && busy))
            draw_change(view);
    }
    ui_panel_end();
}

/* The cheat sheet has groups of three cells (keys, what they do, state), one or two groups across
   the window; widths in characters. */
enum { SHEET_CELLS = 3, SHEET_KEYS = 12, SHEET_NAME = 23, SHEET_STATE = 22, SHEET_STATE_MIN = 11 };

static int lay_out_sheet(int widths[2 * SHEET_CELLS])
{
    const int min = SHEET_KEYS + 16 + SHEET_STATE_MIN;
    int groups = ui_characters(2 * SHEET_CELLS) >= 2 * min ? 2 : 1;
    int room = ui_characters(groups * SHEET_CELLS) / groups - SHEET_KEYS;
    int state = room - SHEET_NAME;
    state = state < SHEET_STATE_MIN ? SHEET_STATE_MIN : state < SHEET_STATE ? state : SHEET_STATE;
    int name = room - state < SHEET_NAME ? room - state : SHEET_NAME;
    for (int i = 0; i < groups; ++i) {
        widths[i * SHEET_CELLS] = SHEET_KEYS;
        widths[i * SHEET_CELLS + 1] = name;
        widths[i * SHEET_CELLS + 2] = state;
    }
    return groups;
}

static void draw_key(const struct view *view, const struct key_binding *key)
{
    char state[SETTING_TEXT_BYTES] = "";
    if (key)
        key_state(view, key, state, sizeof state);
    ui_cell(UI_COLOR_GOOD, key ? key->keys : "");
    ui_cell(UI_COLOR_TEXT, !key ? "" : key->title ? key->title : key->name);
    ui_cell(0xFFA0A0A0u, state);
}

static void draw_keys(const struct view *view)
{
    const struct key_binding *rows[KEYS_MAX];
    uint32_t count, told = 0;
    int widths[2 * SHEET_CELLS], groups = lay_out_sheet(widths);
    const struct key_binding *keys = key_bindings(&count);
    for (uint32_t i = 0; i < count; ++i) {
        if (keys[i].keys)
            rows[told++] = &keys[i];
    }
    if (!ui_table_begin("keys", groups * SHEET_CELLS))
        return;
    ui_table_columns(NULL, widths, groups * SHEET_CELLS);
    uint32_t high = (told + (uint32_t)groups - 1) / (uint32_t)groups;
    for (uint32_t i = 0; i < high; ++i) {
        for (uint32_t at = i; at < high * (uint32_t)groups; at += high)
            draw_key(view, at < told ? rows[at] : NULL);
    }
    ui_table_end();
}

static void draw_help(struct view *view)
{
    static const char *const mouse[][2] = {
        {"left", "drag: around; click: what is there"},
        {"right", "drag: look"},
        {"middle", "drag, or Shift and left: aside"},
        {"wheel", "nearer"},
        {"W A S D Q E", "fly; with Shift faster"},
        {"Shift", "with Y Z 7 8 / V N J K O T M: one back"},
        {"drop", "open a file; a .view: its settings; .hdr, .exr: a sky"},
    };
    const int widths[2] = {SHEET_KEYS,
                           ui_characters(2) - SHEET_KEYS < 38 ? ui_characters(2) - SHEET_KEYS : 38};
    if (!view->help)
        return;
    if (ui_panel_begin("Keys", 0.5f, 0.0f, UI_PANEL_HOLD)) {
        if (ui_table_begin("mouse", 2)) {
            ui_table_columns(NULL, widths, 2);
            for (size_t i = 0; i < sizeof mouse / sizeof *mouse; ++i) {
                ui_cell(UI_COLOR_GOOD, mouse[i][0]);
                ui_cell(UI_COLOR_TEXT, mouse[i][1]);
            }
            ui_table_end();
        }
        draw_keys(view);
    }
    ui_panel_end();
}

/* Writes "drawing 35 %, 2 s left", at the speed so far. */
static void say_drawing(const struct engine_status *status, char *text, size_t bytes)
{
    double part = (double)status->part, left_s = status->drawing_ms * 1e-3 * (1.0 / part - 1.0);
    if (part < 0.05)
        snprintf(text, bytes, "drawing %.0f %%", part * 1e2);
    else
        snprintf(text, bytes, "drawing %.0f %%, %.*f s left", part * 1e2, left_s < 9.95, left_s);
}

/* Draws the panel for what takes long: a session being made, or a picture being drawn. */
static void draw_work(const struct view *view)
{
    const struct engine_status *status = &view->status;
    bool making = status->stage != SESSION_DONE;
    bool stops = view->frame.number > 0 && !settings_same_kernel(&view->fallback, &view->settings);
    if (!making && status->drawing_ms < SLOW_MS)
        return;
    if (ui_panel_begin("work", 0.5f, 1.0f, UI_PANEL_PLAIN)) {
        char text[96];
        if (making)
            snprintf(text, sizeof text, "%s %.1f s", session_stage_name(status->stage),
                     status->stage_ms * 1e-3);
        else
            say_drawing(status, text, sizeof text);
        ui_progress(making ? (float)((double)status->stage + 0.5) / (float)SESSION_DONE
                           : status->part,
                    text);
        if (stops && status->stage_ms > SLOW_MS)
            ui_text_dim("Escape: as it was");
    }
    ui_panel_end();
}

/* Number of lines that a text takes when it is wrapped at the window's right end. */
static float lines_of(const struct view *view, const char *text)
{
    float width, height;
    ui_text_size(text, &width, &height);
    return 1.0f + floorf(width / fmaxf((float)view->settings.picture.width - 2.0f * height, 1.0f));
}

/* Draws as many errors as fit into half of the window, one a line, and the number of the others. */
static void draw_errors(struct view *view)
{
    float width, height, room;
    uint32_t drawn = 0, left = 0;
    char line[2 * ENGINE_MESSAGE];
    ui_text_size("A", &width, &height);
    room = 0.5f * (float)view->settings.picture.height / height - 1.0f;
    for (const char *at = view_error(view); *at;) {
        size_t length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        room -= lines_of(view, line);
        if (left == 0 && (drawn == 0 || room >= 0.0f)) {
            ui_text_color(UI_COLOR_ERROR, "%s", line);
            ++drawn;
        } else {
            ++left;
        }
        at += length + (at[length] == '\n');
    }
    if (left > 0)
        ui_text_color(UI_COLOR_ERROR, "and %u more, told on the terminal", left);
    view->shaders.errors_drawn = drawn;
}

static void draw_messages(struct view *view)
{
    bool toast = view->toast[0] != '\0', error = view_error(view)[0] != '\0';
    bool hint = view->hint && view->params->hint;
    view->shaders.errors_drawn = 0;
    if (!toast && !error && !hint)
        return;
    if (ui_panel_begin("messages", 0.0f, 1.0f, error ? UI_PANEL_STAYS : UI_PANEL_PLAIN)) {
        if (error)
            draw_errors(view);
        if (toast)
            ui_text_color(UI_COLOR_TEXT, "%s", view->toast);
        if (hint)
            ui_text_color(UI_COLOR_GOOD, "%s", view->params->hint);
    }
    ui_panel_end();
}

/* Asks once for each folder; the picture is drawn without its files meanwhile. */
static void draw_question(struct view *view)
{
    const char *folder = scenes_question(view);
    if (!folder)
        return;
    if (ui_panel_begin("Files elsewhere", 0.5f, 0.0f, UI_PANEL_HOLD)) {
        ui_text("The scene names files outside of its folder, in");
        ui_text_color(UI_COLOR_WARNING, "%s", folder);
        ui_text("May it read what is there?");
        bool allow = ui_button("allow");
        ui_same_line(0);
        if (ui_button("go on without") || allow)
            scenes_answer(view, allow);
    }
    ui_panel_end();
}

static void draw_boxes(const struct view *view)
{
    static const char *const trees[] = {"", "mesh trees", "instance tree"};
    const struct engine_frame *frame = &view->frame;
    const struct settings *s = &frame->settings;
    if (s->boxes == BOXES_OFF)
        return;
    overlay_boxes(view);
    if (ui_panel_begin("boxes", 1.0f, 0.0f, UI_PANEL_PLAIN)) {
        ui_text("%s, level %u", trees[s->boxes], s->boxes_level);
        ui_text("%llu box%s%s", (unsigned long long)frame->boxes_total,
                frame->boxes_total == 1 ? "" : "es",
                frame->boxes_total > ENGINE_BOXES_MAX ? ", the first 8192 are drawn" : "");
        ui_text_color(0xFFFFC060u, "inner nodes");
        ui_same_line(0);
        ui_text_color(0xFF20A0FFu, "leaves, also from above");
        if (!overlay_is_possible(view))
            ui_text_color(UI_COLOR_WARNING, "not drawn: the camera is not perspective");
    }
    ui_panel_end();
}

/* Draws the legend of the window's picture, and of picture B if that is beside it. */
static void draw_legends(const struct view *view)
{
    const struct compare *compare = &view->compare;
    for (int side = 0; side < (compare->mode == COMPARE_SPLIT ? 2 : 1); ++side) {
        const struct engine_frame *frame = side ? &compare->other : &view->frame;
        char title[160];
        if (view->hud == HUD_OFF || !frame->rgba || frame->settings.paint == PAINT_COLOR ||
            compare->mode == COMPARE_DIFFERENCE)
            continue;
        snprintf(title, sizeof title, "%s%s of %s rays%s",
                 compare->mode != COMPARE_SPLIT ? ""
                 : side                         ? "B: "
                                                : "A: ",
                 value_title(values_view, (int)frame->settings.paint),
                 value_word(values_rays, (int)frame->settings.paint_rays),
                 frame->settings.paint_scale > 0.0 ? "" : ", scale by the picture");
        palette_legend(&view->palette, side ? "legend B" : "legend A", title, frame->scale);
    }
}

/* The opened panels of the window, as bits. Settings and effects close each other. */
enum { OPEN_PANELS = 1, OPEN_PIXEL = 2, OPEN_PRICES = 4 };

/* Leaves only the panel that was opened last in a window without room for more. */
static void leave_one_open(struct view *view)
{
    const whit_renderer_params *p = &view->settings.picture;
    float scale = ui_scale(view->ui);
    bool small =
        (float)p->width < ROOM_FOR_PANELS_X * scale || (float)p->height < ROOM_FOR_PANELS_Y * scale;
    unsigned open = (holds_panel(view) ? OPEN_PANELS : 0u) | (view->picked ? OPEN_PIXEL : 0u) |
                    (view->prices_open ? OPEN_PRICES : 0u);
    unsigned opened = open & ~view->open;
    if (small && opened && open != opened) {
        if (open & ~opened & OPEN_PIXEL)
            view->picked = false;
        if (open & ~opened & OPEN_PRICES)
            price_switch(view);
        if (open & ~opened & OPEN_PANELS) {
            view->panels.settings = false;
            if (view->panels.effects)
                panels_switch_effects(view);
        }
        open = opened;
    }
    view->open = open;
}

/* Figures that left no room for an opened panel stay away until something else is asked for. */
static void note_crowd(struct view *view)
{
    const whit_renderer_params *p = &view->settings.picture;
    const struct view_crowd now = {ui_is_crowded(view->ui), view->open, (uint32_t)view->hud,
                                   p->width, p->height};
    struct view_crowd *was = &view->crowd;
    bool same = was->open == now.open && was->hud == now.hud && was->width == now.width &&
                was->height == now.height;
    bool low = same ? was->low || now.low : now.low;
    if (!same)
        ui_forget_panel("figures"); /* others may be as high as there is room for */
    view->dirty |= !same || (low && !was->low);
    *was = now;
    was->low = low;
}

/* In order of importance: a panel that comes later gives way to earlier ones, or is left out. */
void hud_draw(struct view *view)
{
    leave_one_open(view);
    if (view->help) {
        draw_messages(view);
        draw_help(view);
        return;
    }
    draw_question(view);
    pick_draw(view);
    price_draw(view);
    draw_messages(view);
    if (is_low(view))
        panels_draw(view);
    draw_work(view);
    draw_hud(view);
    compare_draw(view);
    draw_legends(view);
    draw_boxes(view);
    if (!is_low(view))
        panels_draw(view);
    note_crowd(view);
}
