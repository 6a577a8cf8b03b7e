/* Drawing over the picture while A and B are compared: the divider, names and figures. */
#include <stdio.h>
#include <string.h>

#include "view/choices.h"
#include "view/view_private.h"

enum { NAMES_MAX = 4 }; /* lines of a name */
static const uint32_t COLORS[2] = {0xFF60C8FFu, 0xFFFFC880u};

/* Draws "A  traversal sign", with a line for each setting that differs from the other side's. */
static void draw_name(const struct view *view, int side)
{
    struct choice_change changes[CHOICE_CHANGES_MAX];
    const struct engine_frame *b = &view->compare.other;
    const struct settings *other = b->rgba ? &b->settings : &view->compare.frozen;
    uint32_t count = choice_changes(&view->frame.settings, other, changes);
    if (ui_panel_begin(side ? "name B" : "name A", (float)side, 1.0f, UI_PANEL_PLAIN)) {
        ui_text_color(COLORS[side], side ? "B" : "A");
        ui_same_line(3);
        if (count == 0)
            ui_text(side ? "as it was" : "the same as B");
        for (uint32_t i = 0; i < count && i < NAMES_MAX; ++i) {
            if (i > 0) {
                ui_text(" ");
                ui_same_line(3);
            }
            ui_text("%s %.40s", changes[i].name, side ? changes[i].b : changes[i].a);
        }
        if (count > NAMES_MAX)
            ui_text_dim("and %u more", count - NAMES_MAX);
        if (side == 1 && !b->rgba)
            ui_text_dim("not drawn yet");
    }
    ui_panel_end();
}

static void draw_divider(const struct view *view, uint32_t width, uint32_t height)
{
    float x = (float)(view->compare.divider * width), middle = 0.5f * (float)height;
    float grip = 14.0f * ui_scale(view->ui);
    bool held = view->compare.dragging;
    ui_line(x, 0.0f, x, (float)height, 0xC0000000u, 3.0f);
    ui_line(x, 0.0f, x, (float)height, held ? 0xFFFFFFFFu : 0xFFD0D0D0u, 1.0f);
    ui_line(x, middle - grip, x, middle + grip, held ? 0xFFFFFFFFu : 0xFFD0D0D0u, 5.0f);
}

static void draw_difference(const struct compare_figures *figures)
{
    const struct difference *d = &figures->difference;
    ui_text("A %.2f ms, B %.2f ms, one picture each", figures->ms[0], figures->ms[1]);
    if (d->other_ids == 0 && d->other_colors == 0) {
        ui_text_color(UI_COLOR_GOOD, "identical");
        return;
    }
    ui_text_color(d->other_ids ? UI_COLOR_WARNING : UI_COLOR_GOOD, "%llu of %llu pixels",
                  (unsigned long long)d->other_ids, (unsigned long long)d->pixels);
    ui_text("hit something else,");
    ui_text("%llu %s differ", (unsigned long long)d->other_colors,
            figures->has_flip ? "colours" : "numbers");
    if (d->other_colors > 0) {
        ui_text("by at most %.3g,", d->largest);
        ui_text("on average %.2g%s", d->mean, figures->has_flip ? ", linear RGB" : "");
    }
    if (figures->has_flip)
        ui_text("FLIP %.3g, at most %.2g", figures->flip_mean, figures->flip_largest);
}

static void draw_figures(const struct view *view)
{
    const struct compare *compare = &view->compare;
    const struct engine_frame *a = &view->frame, *b = &compare->other;
    bool costs[2] = {a->settings.paint != PAINT_COLOR, compare->frozen.paint != PAINT_COLOR};
    bool fresh = compare->figures.pair.numbers[0] == a->number &&
                 compare->figures.pair.numbers[1] == b->number;
    if (ui_panel_begin("A and B", 1.0f, 0.0f, UI_PANEL_PLAIN)) {
        if (b->rgba && costs[0] != costs[1]) {
            ui_text("one shows costs,");
            ui_text("one colours: there");
            ui_text("is no difference");
        } else if (compare->figures.known) {
            draw_difference(&compare->figures);
        }
        if (!fresh && costs[0] == costs[1])
            ui_text_dim(compare->figures.known ? "of the last whole pictures"
                                               : "figures once both are whole");
    }
    ui_panel_end();
}

void compare_draw(struct view *view)
{
    const struct compare *compare = &view->compare;
    struct swapchain_info chain;
    if (compare->mode == COMPARE_OFF || view->frame.number == 0)
        return;
    swapchain_get_info(view->swapchain, &chain);
    if (compare->mode == COMPARE_SPLIT)
        draw_divider(view, chain.width, chain.height);
    if (view->hud == HUD_OFF)
        return;
    if (compare->mode == COMPARE_DIFFERENCE && compare_subtracts(view)) {
        char title[96];
        snprintf(title, sizeof title, "|A - B|, largest channel%s",
                 compare->scale > 0.0 ? "" : ", scale by the picture");
        palette_legend(&view->palette, "legend A - B", title, compare->heat.scale);
    }
    draw_name(view, 0);
    draw_name(view, 1);
    draw_figures(view);
}
