/* A pixel: what is there, and the rays that made its colour. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "view/overlay.h"
#include "view/pick.h"
#include "view/view_private.h"

static const uint32_t COLOR_DIFFERS = 0xFF6070FFu, COLOR_NAME = 0xFFD0E090u;
/* By kind of ray: white, yellow, sky blue, orange (Okabe and Ito's colours). */
static const uint32_t kind_colors[WHIT_RAY_KINDS] = {0xFFFFFFFFu, 0xFF42E4F0u, 0xFFE9B456u,
                                                     0xFF009FE6u};
enum { RAYS_SHOWN = 400, ROWS_AT_FIRST = 7, LINES_AT_FIRST = 9, VALUES_SHOWN = 3 };

static void ask(struct view *view, double x, double y)
{
    const whit_renderer_params *p = &view->settings.picture;
    view->pick_x = x;
    view->pick_y = y;
    if (x >= 0.0 && y >= 0.0 && x < p->width && y < p->height)
        engine_ask_probe(view->engine, (uint32_t)x, (uint32_t)y);
}

void pick_at(struct view *view, double x, double y)
{
    if (view->settings.paint != PAINT_COLOR) {
        view_say(view, "pixels are explained in colours: press B");
        return;
    }
    view->picked = true;
    ask(view, x, y);
}

void pick_focus(struct view *view)
{
    if (!view->camera_known || view->settings.paint != PAINT_COLOR)
        return;
    view->focus = true;
    ask(view, view->input.x, view->input.y);
}

static void look_at(struct view *view, const whit_probe_ray *ray)
{
    double point[3];
    for (int i = 0; i < 3; ++i)
        point[i] = (double)ray->point[i];
    if (ray->device.instance == WHIT_NONE) {
        view_say(view, "nothing is there to look at");
        return;
    }
    camera_focus(&view->camera, point);
    view_moved(view);
}

/* Frees the probe of a panel that was closed: it holds its scene, which may be a large one that was
   left. */
static void let_go(struct view *view)
{
    struct engine_probe nothing = {.number = view->probe.number};
    if (view->picked)
        return;
    engine_probe_finish(&view->probe);
    view->probe = nothing;
}

/* What dbg(x) is follows the picture: of another one the same pixel is asked for once more. */
static void follow(struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    const whit_probe_report *r = view->probe.report;
    bool tells = (r && r->call_count) || (frame->shader && frame->shader->info.dbg_count);
    if (!view->picked || !tells || !frame->whole || frame->settings.paint != PAINT_COLOR ||
        view->probe.number == 0 || view->pick_frame == frame->number ||
        settings_same_pixels(&frame->settings, &view->probe.settings))
        return;
    view->pick_frame = frame->number;
    ask(view, view->pick_x, view->pick_y);
}

void pick_take(struct view *view)
{
    follow(view);
    if (!engine_take_probe(view->engine, &view->probe)) {
        let_go(view);
        return;
    }
    view->dirty = true;
    if (view->focus && view->probe.report && view->probe.report->ray_count > 0)
        look_at(view, &view->probe.report->rays[0]);
    view->focus = false;
}

/* ---- Panel ---- */

static void draw_place(const struct view *view)
{
    const struct engine_probe *probe = &view->probe;
    const whit_probe_report *r = probe->report;
    const whit_probe_ray *first = &r->rays[0];
    whit_instance_info instance = {0};
    whit_material_info material = {0};
    ui_text("pixel %u,%u   colour %.5g %.5g %.5g", r->x, r->y, (double)r->color[0],
            (double)r->color[1], (double)r->color[2]);
    if (first->device.instance == WHIT_NONE) {
        ui_text("nothing: the environment");
        return;
    }
    whit_scene_get_instance(probe->scene->scene, first->device.instance, &instance);
    ui_text("instance %u %s, primitive %u", first->device.instance,
            instance.name ? instance.name : "", first->device.primitive);
    if (first->material != WHIT_NONE) {
        whit_scene_get_material(probe->scene->scene, first->material, &material);
        ui_text("material %s", material.name ? material.name : "");
        if (material.file) {
            ui_same_line(0);
            ui_text_dim("%s:%u", path_name(material.file), material.line);
        }
    }
    ui_text("position %.6g %.6g %.6g", (double)first->point[0], (double)first->point[1],
            (double)first->point[2]);
    ui_text("normal   %.4f %.4f %.4f   depth %.6g", (double)first->normal[0],
            (double)first->normal[1], (double)first->normal[2], first->device.t);
}

/* Of a dbg(x); `whit probe` tells more of them. */
static uint32_t values_shown(const whit_probe_call *call)
{
    return call->value_count < VALUES_SHOWN ? call->value_count : VALUES_SHOWN;
}

static uint32_t count_lines(const whit_probe_report *r)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->call_count; ++i) {
        uint32_t shown = values_shown(&r->calls[i]);
        count += shown + (r->calls[i].count > shown || shown == 0);
    }
    return count;
}

static void draw_call(const whit_probe_call *call)
{
    char text[4 * 24];
    uint32_t shown = values_shown(call);
    for (uint32_t i = 0; i < shown; ++i) {
        whit_probe_value_text(&call->values[i], 6, text, sizeof text);
        ui_text_color(COLOR_NAME, "%s:%u", path_name(call->file), call->line);
        ui_same_line(0);
        ui_text("%s = %s", call->text, text);
        if (call->values[i].generation) {
            ui_same_line(0);
            ui_text_dim("bounce %u", call->values[i].generation);
        }
    }
    if (call->count > shown)
        ui_text_dim("%s:%u %s, %u times more", path_name(call->file), call->line, call->text,
                    call->count - shown);
    else if (!call->count)
        ui_text_dim("%s:%u %s was not reached", path_name(call->file), call->line, call->text);
}

/* What dbg(x) of the user's functions was. */
static void draw_calls(const whit_probe_report *r)
{
    for (uint32_t i = 0; i < r->call_count; ++i)
        draw_call(&r->calls[i]);
    if (r->call_count)
        ui_separator();
}

static void draw_hit(const whit_probe_hit *hit)
{
    if (hit->instance == WHIT_NONE)
        ui_text("-");
    else
        ui_text("%.7g  %u/%u", hit->t, hit->instance, hit->primitive);
}

/* "=": the same hit; of the twin: by every bit. */
static void draw_other(const whit_probe_hit *hit, bool known, bool equal)
{
    if (!known || equal)
        ui_text_dim("%s", known ? "=" : "?");
    else
        ui_text_color(COLOR_DIFFERS, "%.7g  %u/%u", hit->t, hit->instance, hit->primitive);
}

/* "6 shadow": so many ended alike. */
static void draw_kind(const whit_probe_ray *ray, uint32_t count)
{
    const char *kind = value_word(values_rays, (int)ray->kind);
    uint32_t color = kind_colors[ray->kind % WHIT_RAY_KINDS];
    if (count > 1)
        ui_text_color(color, "%*s%u %s", (int)ray->generation, "", count, kind);
    else
        ui_text_color(color, "%*s%s", (int)ray->generation, "", kind);
}

static void draw_row(const struct view *view, const whit_probe_row *row)
{
    const whit_probe_ray *ray = &view->probe.report->rays[row->ray];
    whit_material_info material = {0};
    if (ray->material != WHIT_NONE)
        whit_scene_get_material(view->probe.scene->scene, ray->material, &material);
    ui_table_next();
    draw_kind(ray, row->count);
    ui_table_next();
    draw_hit(&ray->device);
    ui_table_next();
    ui_text("%s", whit_probe_end_name(ray->end));
    ui_table_next();
    if (ray->weight[0] == ray->weight[1] && ray->weight[1] == ray->weight[2])
        ui_text("%.3f", (double)ray->weight[0]);
    else
        ui_text("%.2f %.2f %.2f", (double)ray->weight[0], (double)ray->weight[1],
                (double)ray->weight[2]);
    ui_table_next();
    ui_text("%.16s", material.name ? material.name : "");
    ui_table_next();
    draw_other(&ray->twin, true, ray->equal);
    ui_table_next();
    draw_other(&ray->exact, ray->exact_known, ray->exact_equal);
}

static void draw_tree(const struct view *view)
{
    static const char *const columns[] = {"ray",      "t  inst/prim", "ends", "weight",
                                          "material", "twin",         "exact"};
    const struct engine_probe *probe = &view->probe;
    uint32_t shown = probe->row_count < RAYS_SHOWN ? probe->row_count : RAYS_SHOWN;
    if (ui_table_begin("rays", 7)) {
        ui_table_header(columns, 7);
        for (uint32_t i = 0; i < shown; ++i)
            draw_row(view, &probe->rows[i]);
        ui_table_end();
    }
    if (shown < probe->row_count || probe->report->dropped > 0)
        ui_text_dim("`whit probe` lists the other rays");
}

static bool has_moved_on(const struct view *view)
{
    return !settings_same_place(&view->probe.settings, &view->settings);
}

static void draw_panel(struct view *view)
{
    const whit_probe_report *r = view->probe.report;
    uint32_t count = view->probe.row_count;
    uint32_t lines = count_lines(r);
    float rows = (float)(count < ROWS_AT_FIRST ? count : ROWS_AT_FIRST) +
                 (float)(lines < LINES_AT_FIRST ? lines : LINES_AT_FIRST);
    /* Never over the pixel, where there is room beside it. */
    float side = 2 * r->x < view->settings.picture.width ? 1.0f : 0.0f;
    bool moves = side != view->pick_side;
    view->pick_side = side;
    if (ui_window_begin("Pixel", side, 1.0f, 590.0f, 192.0f + 17.0f * rows, moves, &view->picked)) {
        char why[WHIT_PROBE_WHY_BYTES];
        whit_probe_why(r, view->probe.scene->scene, why, sizeof why);
        draw_place(view);
        ui_paragraph(why);
        ui_separator();
        draw_calls(r);
        ui_text_color(r->differing ? COLOR_DIFFERS : COLOR_NAME,
                      "%u ray%s, the twin differs at %u; %.0f ms", r->ray_count,
                      r->ray_count == 1 ? "" : "s", r->differing, view->probe.ms);
        if (has_moved_on(view))
            ui_text_dim("of a picture before this one");
        draw_tree(view);
    }
    ui_panel_end();
}

/* ---- In the scene ---- */

/* Rays that miss, and lights far off, are drawn for as far as the camera is from its target. */
static double drawn_length(const struct view *view, const whit_probe_ray *ray)
{
    double t = ray->device.t, longest = 0.0, length = 0.0;
    for (int i = 0; i < 3; ++i) {
        double d = view->camera.target[i] - view->camera.eye[i], r = (double)ray->ray.dir[i];
        longest += d * d;
        length += r * r;
    }
    double max = length > 0.0 ? 2.0 * sqrt(longest / length) : 0.0;
    if (ray->kind == WHIT_RAY_SHADOW && !isfinite(t))
        t = (double)ray->ray.t_max;
    return isfinite(t) && t < max ? t : max;
}

static void draw_rays(const struct view *view)
{
    const whit_probe_report *r = view->probe.report;
    for (uint32_t i = 0; i < r->ray_count && i < RAYS_SHOWN; ++i) {
        const whit_probe_ray *ray = &r->rays[i];
        double a[3], b[3], t = drawn_length(view, ray);
        bool traced = ray->end != WHIT_PROBE_DEPTH && ray->end != WHIT_PROBE_BAILOUT;
        for (int k = 0; k < 3; ++k) {
            a[k] = (double)ray->ray.origin[k];
            b[k] = a[k] + t * (double)ray->ray.dir[k];
        }
        uint32_t color = kind_colors[ray->kind % WHIT_RAY_KINDS];
        if (ray->end == WHIT_PROBE_BLOCKED)
            color = (color & 0x00FFFFFFu) | 0x60000000u;
        if (traced)
            overlay_line(view, a, b, color, ray->kind == WHIT_RAY_SHADOW ? 1.0f : 2.0f);
    }
}

static void mark_pixel(const struct view *view)
{
    const whit_probe_report *r = view->probe.report;
    float x = (float)r->x + 0.5f, y = (float)r->y + 0.5f;
    if (has_moved_on(view))
        return;
    ui_rectangle(x - 5.0f, y - 5.0f, x + 5.0f, y + 5.0f, 0xFF000000u, false);
    ui_rectangle(x - 4.0f, y - 4.0f, x + 4.0f, y + 4.0f, 0xFFFFFFFFu, false);
}

void pick_draw(struct view *view)
{
    bool has_rays = view->probe.report && view->probe.report->ray_count > 0;
    if (!view->picked || !has_rays)
        return;
    if (settings_same_scene(&view->probe.settings, &view->settings) && overlay_is_possible(view))
        draw_rays(view);
    mark_pixel(view);
    draw_panel(view);
}
