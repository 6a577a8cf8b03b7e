/* Figures, the cheat sheet and messages over the picture. */
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "view/choices.h"
#include "view/view_private.h"

static const uint32_t COLOR_WARNING = 0xFF40C0FFu, COLOR_ERROR = 0xFF6070FFu,
                      COLOR_GOOD = 0xFFD0E090u;

static double traced_rays(const whit_stats *s)
{
    return (double)s->rays_primary + (double)s->rays_shadow + (double)s->rays_reflected +
           (double)s->rays_refracted;
}

/* "full size, 4 samples" */
static void draw_quality(const struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    char samples[32] = "adaptive samples";
    if (frame->samples > 0)
        snprintf(samples, sizeof samples, "%u sample%s", frame->samples,
                 frame->samples > 1 ? "s" : "");
    if (frame->divisor > 1)
        ui_text_color(COLOR_WARNING, "1/%u of the size, %s%s", frame->divisor, samples,
                      view->status.drawing ? ", on its way" : "");
    else if (!frame->whole)
        ui_text_color(COLOR_WARNING, "full size, %s as yet", samples);
    else
        ui_text("full size, %s", samples);
}

static void draw_figures(const struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    const whit_stats *s = &frame->stats;
    struct swapchain_info chain;
    swapchain_get_info(view->swapchain, &chain);
    double ms = engine_drawn_ms(s);
    char fps[24] = "still";
    if (view->rate.fps > 0.0 && view_is_moving(view, clock_ms()))
        snprintf(fps, sizeof fps, "%.1f fps", view->rate.fps);
    ui_text("%9s  render %.2f ms  present %.2f ms", fps, ms, chain.present_ms);
    ui_text("%.2f Mray/s", ms > 0.0 ? traced_rays(s) / ms * 1e-3 : 0.0);
    if (frame->settings.paint != VIEW_PAINT_COLOR && s->costs[WHIT_RAY_PRIMARY].rays > 0) {
        const whit_cost *c = &s->costs[WHIT_RAY_PRIMARY];
        ui_same_line(0);
        ui_text("  %.1f visits a camera ray",
                (double)(c->pairs + c->leaves + c->instances) / (double)c->rays);
    }
}

static void draw_names(const struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    const struct view_settings *s = &frame->settings;
    bool trees = s->trees.build != WHIT_BUILD_NONE;
    ui_text("%s, %s, %s", trees ? frame->accel.builder : "no trees",
            settings_traversal_name(s->picture.traversal),
            settings_numerics_name(s->picture.numerics));
}

static void draw_more(const struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    const whit_scene_info *scene = &frame->scene->info;
    const whit_stats *s = &frame->stats;
    struct swapchain_info chain;
    swapchain_get_info(view->swapchain, &chain);
    ui_separator();
    ui_text("%u x %u of %u x %u, %s %s", frame->width, frame->height, chain.width, chain.height,
            chain.format, chain.direct ? "written directly" : "copied");
    ui_text("%llu triangles, %llu balls, %u instances, %u lights",
            (unsigned long long)scene->triangle_count, (unsigned long long)scene->sphere_count,
            scene->instance_count, scene->light_count);
    ui_text("rays: %llu camera, %llu shadow, %llu reflected, %llu refracted",
            (unsigned long long)s->rays_primary, (unsigned long long)s->rays_shadow,
            (unsigned long long)s->rays_reflected, (unsigned long long)s->rays_refracted);
    ui_text("cut: %llu by depth, %llu by bail-out", (unsigned long long)s->rays_cut_depth,
            (unsigned long long)s->rays_cut_bailout);
    ui_text("trees %.1f ms, depth %u, %.1f MiB; kernel %u instructions, %.0f ms", frame->build_ms,
            frame->accel.depth, (double)frame->accel.bytes / 1048576.0, s->kernel_instructions,
            frame->compile_ms);
    ui_text("%s", frame->device.name);
    ui_text_dim("over the picture %.2f ms, image after %.2f ms", chain.draw_ms, chain.wait_ms);
}

/* "traversal distance -> sign", one change a line; then what that did. */
static void draw_change(const struct view *view)
{
    const struct engine_change *c = &view->status.change;
    if (c->number == 0)
        return;
    ui_separator();
    for (const char *at = c->what; *at;) {
        const char *end = strstr(at, ", ");
        int length = end ? (int)(end - at) : (int)strlen(at);
        ui_text("%.*s", length < 46 ? length : 46, at);
        at += length + (end ? 2 : 0);
    }
    ui_text("%.2f -> %.2f ms", c->before_ms, c->after_ms);
    ui_text_color(c->other_ids ? COLOR_WARNING : COLOR_GOOD, "%llu of %llu pixels changed",
                  (unsigned long long)c->other_ids, (unsigned long long)c->pixels);
    ui_same_line(0);
    ui_text("what they hit,");
    if (c->other_colors > 0)
        ui_text("%llu colours by up to %.3g, %.2g on average", (unsigned long long)c->other_colors,
                c->largest, c->mean);
    else
        ui_text("0 colours");
}

static void draw_hud(const struct view *view)
{
    if (view->hud == HUD_OFF || view->frame.number == 0)
        return;
    if (ui_panel_begin("figures", 0.0f, 0.0f, UI_PANEL_PLAIN)) {
        draw_figures(view);
        draw_names(view);
        draw_quality(view);
        if (view->hud == HUD_FULL)
            draw_more(view);
        draw_change(view);
    }
    ui_panel_end();
}

static void draw_help(struct view *view)
{
    uint32_t count;
    const struct key_binding *keys = key_bindings(&count);
    if (!view->help)
        return;
    bool narrow = (float)view->settings.picture.width < 800.0f * ui_scale(view->ui);
    int name_most = narrow ? 19 : 40, state_most = narrow ? 12 : 28;
    if (ui_panel_begin("Keys", 0.5f, 0.0f, UI_PANEL_HOLD)) {
        if (ui_table_begin("keys", 6)) {
            uint32_t rows = (count + 1) / 2;
            for (uint32_t i = 0; i < 2 * rows; ++i) {
                uint32_t at = i / 2 + (i % 2) * rows;
                char state[VIEW_TEXT] = "";
                if (at < count && keys[at].state)
                    keys[at].state(view, state, sizeof state);
                ui_table_next();
                ui_text_color(COLOR_GOOD, "%s", at < count ? keys[at].keys : "");
                ui_table_next();
                ui_text("%.*s", name_most, at < count ? keys[at].name : "");
                ui_table_next();
                ui_text_dim("%.*s", state_most, state);
            }
            ui_table_end();
        }
        ui_text("left drag: around   right drag: look, with WASD QE fly   middle drag: aside");
        ui_text("wheel: nearer   click: what is there   drop a file: open it, a .view load it");
    }
    ui_panel_end();
}

static void draw_work(const struct view *view)
{
    const struct engine_status *status = &view->status;
    if (status->stage == SESSION_DONE)
        return;
    if (ui_panel_begin("work", 0.5f, 1.0f, UI_PANEL_PLAIN)) {
        char text[96];
        snprintf(text, sizeof text, "%s %.1f s", session_stage_name(status->stage),
                 status->stage_ms * 1e-3);
        ui_progress((float)((double)status->stage + 0.5) / (float)SESSION_DONE, text);
    }
    ui_panel_end();
}

static void draw_messages(const struct view *view)
{
    bool toast = view->toast[0] != '\0', error = view->status.error[0] != '\0';
    bool hint = view->hint && view->params->hint;
    if (!toast && !error && !hint)
        return;
    if (ui_panel_begin("messages", 0.0f, 1.0f, (enum ui_panel)(UI_PANEL_PLAIN | UI_PANEL_WIDE))) {
        if (error)
            ui_text_color(COLOR_ERROR, "%s", view->status.error);
        if (toast)
            ui_text_color(0xFFFFFFFFu, "%s", view->toast);
        if (hint)
            ui_text_color(COLOR_GOOD, "%s", view->params->hint);
    }
    ui_panel_end();
}

static void draw_boxes(const struct view *view)
{
    static const char *const trees[] = {"", "mesh trees", "instance tree"};
    const struct engine_frame *frame = &view->frame;
    const struct view_settings *s = &frame->settings;
    if (s->boxes == VIEW_BOXES_OFF)
        return;
    overlay_boxes(view);
    if (ui_panel_begin("boxes", 1.0f, 0.0f, UI_PANEL_PLAIN)) {
        ui_text("%s, level %u", trees[s->boxes], s->boxes_level);
        ui_text("%llu boxes%s", (unsigned long long)frame->boxes_total,
                frame->boxes_total > ENGINE_BOXES_MOST ? ", the first 8192 are drawn" : "");
        ui_text_color(0xFFFFC060u, "inner nodes");
        ui_same_line(0);
        ui_text_color(0xFF20A0FFu, "leaves, also from above");
        if (!overlay_is_possible(view))
            ui_text_color(COLOR_WARNING, "not drawn: the camera is not perspective");
    }
    ui_panel_end();
}

/* Of the window's picture, and of B's where that stands beside it. */
static void draw_legends(const struct view *view)
{
    const struct compare *compare = &view->compare;
    for (int side = 0; side < (compare->mode == COMPARE_SPLIT ? 2 : 1); ++side) {
        const struct engine_frame *frame = side ? &compare->other : &view->frame;
        char rays[64], title[160];
        if (view->hud == HUD_OFF || !frame->rgba || frame->settings.paint == VIEW_PAINT_COLOR ||
            compare->mode == COMPARE_DIFFERENCE)
            continue;
        choice_say(&frame->settings, CHOICE_VIEW_RAYS, rays, sizeof rays);
        snprintf(title, sizeof title, "%s%s of %s rays%s",
                 compare->mode != COMPARE_SPLIT ? ""
                 : side                         ? "B: "
                                                : "A: ",
                 settings_paint_title(frame->settings.paint), rays,
                 frame->settings.paint_scale > 0.0 ? "" : ", scale by the picture");
        palette_legend(&view->palette, side ? "legend B" : "legend A", title, frame->scale);
    }
}

/* What comes first stays where it is; what comes later gives way. */
void hud_draw(struct view *view)
{
    if (view->help) {
        draw_messages(view);
        draw_help(view);
        return;
    }
    pick_draw(view);
    compare_draw(view);
    draw_legends(view);
    draw_messages(view);
    draw_work(view);
    draw_boxes(view);
    draw_hud(view);
    price_draw(view);
    panels_draw(view);
}
