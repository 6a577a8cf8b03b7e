#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "view/overlay.h"
#include "view/pick.h"
#include "view/view_private.h"

/* By kind of ray: white, yellow, sky blue, orange (Okabe and Ito's colours). */
static const uint32_t kind_colors[WHIT_RAY_KINDS] = {0xFFFFFFFFu, 0xFF42E4F0u, 0xFFE9B456u,
                                                     0xFF009FE6u};
static const float PANEL_WIDTH = 612.0f; /* pixels at a scale of 1 */
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
    if (!view->camera_known)
        return;
    if (view->settings.paint != PAINT_COLOR) {
        view_say(view, "objects are framed in colours: press B");
        return;
    }
    view->focus = true;
    ask(view, view->input.x, view->input.y);
}

/* The bounds of an object in world space, at time 0. */
static void bounds_of(const whit_scene *scene, uint32_t instance, double lo[3], double hi[3])
{
    whit_instance_info object;
    whit_mesh_info mesh;
    whit_scene_get_instance(scene, instance, &object);
    whit_scene_get_mesh(scene, object.mesh, &mesh);
    for (int i = 0; i < 3; ++i) {
        const double *row = &object.object_to_world[4 * i];
        lo[i] = hi[i] = row[3];
        for (int k = 0; k < 3; ++k) {
            double a = row[k] * (double)mesh.lo[k], b = row[k] * (double)mesh.hi[k];
            lo[i] += fmin(a, b);
            hi[i] += fmax(a, b);
        }
    }
}

/* Whether an object is small enough to be framed: not a floor, nor the only object of a model, nor
   an object of an animated scene. */
static bool is_small(const struct view *view, const double lo[3], const double hi[3])
{
    double all = 0.0, own = 0.0;
    if (!view->scene || view->scene->info.time_end_s > 0.0)
        return false;
    for (int i = 0; i < 3; ++i) {
        double side = view->scene->info.objects_hi[i] - view->scene->info.objects_lo[i];
        all += side * side;
        own += (hi[i] - lo[i]) * (hi[i] - lo[i]);
    }
    return own > 0.0 && own < 0.8 * all;
}

/* Frames the object that a ray hit. If that is too large, looks at the point of the hit, from half
   the distance. */
static void frame_hit(struct view *view, const whit_probe_ray *ray)
{
    struct view_camera *camera = &view->camera;
    double point[3], lo[3], hi[3];
    if (ray->device.instance == WHIT_NONE) {
        view_say(view, "nothing is there to frame");
        return;
    }
    bounds_of(view->probe.scene->scene, ray->device.instance, lo, hi);
    if (is_small(view, lo, hi)) {
        camera_show(camera, lo, hi, view_aspect(view));
        view_moved(view);
        return;
    }
    for (int i = 0; i < 3; ++i)
        point[i] = (double)ray->point[i];
    camera_focus(camera, point);
    for (int i = 0; i < 3; ++i)
        camera->eye[i] = 0.5 * (camera->eye[i] + camera->target[i]);
    view_moved(view);
}

/* Frees the probe after its panel was closed, since it holds its scene, which may be large and not
   shown any more. */
static void let_go(struct view *view)
{
    struct engine_probe nothing = {.number = view->probe.number};
    if (view->picked)
        return;
    engine_probe_finish(&view->probe);
    view->probe = nothing;
}

/* Keeps the values of dbg(x) up to date: asks for the same pixel again when the picture is
   another. */
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
        frame_hit(view, &view->probe.report->rays[0]);
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

/* Number of values of a dbg(x) that the window shows; `whit probe` prints more of them. */
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
        ui_text_color(UI_COLOR_GOOD, "%s:%u", path_name(call->file), call->line);
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

/* Draws the values of dbg(x) in the user's functions. */
static void draw_calls(const whit_probe_report *r)
{
    for (uint32_t i = 0; i < r->call_count; ++i)
        draw_call(&r->calls[i]);
    if (r->call_count)
        ui_separator();
}

enum { RAY_COLUMNS = 7, CELL_BYTES = 160, NAME_MIN = 8 };
static const char *const ray_columns[RAY_COLUMNS] = {"ray",      "t  inst/prim", "ends", "weight",
                                                     "material", "twin",         "exact"};

/* A row of the table of rays: its texts and their colours. */
struct ray_row {
    char cells[RAY_COLUMNS][CELL_BYTES];
    uint32_t colors[RAY_COLUMNS];
};

static void write_hit(const whit_probe_hit *hit, char cell[CELL_BYTES])
{
    if (hit->instance == WHIT_NONE)
        snprintf(cell, CELL_BYTES, "-");
    else
        snprintf(cell, CELL_BYTES, "%.7g  %u/%u", hit->t, hit->instance, hit->primitive);
}

/* Writes the hit of the twin or of exact arithmetic; "=": the same as the device's (the twin's: in
   every bit). */
static void write_other(const whit_probe_hit *hit, bool known, bool equal, struct ray_row *row,
                        int column)
{
    row->colors[column] = !known || equal ? UI_COLOR_DIM : UI_COLOR_ERROR;
    if (!known || equal)
        snprintf(row->cells[column], CELL_BYTES, "%s", known ? "=" : "?");
    else
        write_hit(hit, row->cells[column]);
}

/* Writes "6 shadow, lamp": so many rays to one light ended in the same way. */
static void write_kind(const whit_scene *scene, const whit_probe_ray *ray, uint32_t count,
                       char cell[CELL_BYTES])
{
    whit_light_info light = {0};
    char number[16] = "";
    if (ray->light != WHIT_NONE)
        whit_scene_get_light(scene, ray->light, &light);
    if (count > 1)
        snprintf(number, sizeof number, "%u ", count);
    snprintf(cell, CELL_BYTES, "%*s%s%s%s%.100s", (int)ray->generation, "", number,
             value_word(values_rays, (int)ray->kind), light.name ? ", " : "",
             light.name ? light.name : "");
}

/* Writes why a ray ended, and for a shadow ray where: "blocked by vase". */
static void write_end(const whit_scene *scene, const whit_probe_ray *ray, char cell[CELL_BYTES])
{
    whit_instance_info blocker = {0};
    if (ray->end == WHIT_PROBE_BLOCKED && ray->device.instance != WHIT_NONE)
        whit_scene_get_instance(scene, ray->device.instance, &blocker);
    bool named = blocker.name && blocker.name[0];
    snprintf(cell, CELL_BYTES, "%s%s%.100s", whit_probe_end_name(ray->end), named ? " by " : "",
             named ? blocker.name : "");
}

static void write_row(const struct view *view, const whit_probe_row *from, struct ray_row *row)
{
    const whit_scene *scene = view->probe.scene->scene;
    const whit_probe_ray *ray = &view->probe.report->rays[from->ray];
    const float *weight = ray->weight;
    whit_material_info material = {0};
    if (ray->material != WHIT_NONE)
        whit_scene_get_material(scene, ray->material, &material);
    for (int i = 0; i < RAY_COLUMNS; ++i)
        row->colors[i] = i == 0 ? kind_colors[ray->kind % WHIT_RAY_KINDS] : UI_COLOR_TEXT;
    write_kind(scene, ray, from->count, row->cells[0]);
    write_hit(&ray->device, row->cells[1]);
    write_end(scene, ray, row->cells[2]);
    if (weight[0] == weight[1] && weight[1] == weight[2])
        snprintf(row->cells[3], CELL_BYTES, "%.3f", (double)weight[0]);
    else
        snprintf(row->cells[3], CELL_BYTES, "%.2f %.2f %.2f", (double)weight[0], (double)weight[1],
                 (double)weight[2]);
    snprintf(row->cells[4], CELL_BYTES, "%.100s", material.name ? material.name : "");
    write_other(&ray->twin, true, ray->equal, row, 5);
    write_other(&ray->exact, ray->exact_known, ray->exact_equal, row, 6);
}

/* Chooses the widths of the columns in characters. Where the panel has no room for the longest
   texts, the columns with names get narrower, and wrap. */
static void choose_widths(const struct view *view, uint32_t shown, int widths[RAY_COLUMNS])
{
    static const int named[] = {0, 2, 4};
    int room = ui_characters_here(RAY_COLUMNS), sum = 0;
    for (int i = 0; i < RAY_COLUMNS; ++i)
        widths[i] = (int)strlen(ray_columns[i]);
    for (uint32_t k = 0; k < shown; ++k) {
        struct ray_row row;
        write_row(view, &view->probe.rows[k], &row);
        for (int i = 0; i < RAY_COLUMNS; ++i)
            widths[i] = (int)fmax(widths[i], (double)strlen(row.cells[i]));
    }
    for (int i = 0; i < RAY_COLUMNS; ++i)
        sum += widths[i];
    for (; sum > room; --sum) {
        int widest = named[0];
        for (int i = 1; i < 3; ++i)
            widest = widths[named[i]] > widths[widest] ? named[i] : widest;
        if (widths[widest] <= NAME_MIN)
            return;
        --widths[widest];
    }
}

static void draw_tree(const struct view *view)
{
    const struct engine_probe *probe = &view->probe;
    uint32_t shown = probe->row_count < RAYS_SHOWN ? probe->row_count : RAYS_SHOWN;
    int widths[RAY_COLUMNS];
    choose_widths(view, shown, widths);
    if (ui_table_begin("rays", RAY_COLUMNS)) {
        ui_table_columns(ray_columns, widths, RAY_COLUMNS);
        for (uint32_t i = 0; i < shown; ++i) {
            struct ray_row row;
            write_row(view, &probe->rows[i], &row);
            for (int k = 0; k < RAY_COLUMNS; ++k)
                ui_cell(row.colors[k], row.cells[k]);
        }
        ui_table_end();
    }
    if (shown < probe->row_count || probe->report->dropped > 0)
        ui_text_dim("`whit probe` lists the other rays");
}

static bool has_moved_on(const struct view *view)
{
    return !settings_same_place(&view->probe.settings, &view->settings);
}

/* Puts the panel beside the pixel if there is room, else above or below it, as high as possible. */
static struct pick_place place_panel(const struct view *view, const whit_probe_report *r,
                                     float height)
{
    const whit_renderer_params *p = &view->settings.picture;
    float scale = ui_scale(view->ui), margin = 24.0f;
    float left = (float)r->x / scale, right = ((float)p->width - (float)r->x) / scale;
    float above = (float)r->y / scale, below = ((float)p->height - (float)r->y) / scale;
    struct pick_place place = {.x = left < right ? 1.0f : 0.0f, .y = 1.0f, .height = height};
    if (fmaxf(left, right) >= PANEL_WIDTH + margin)
        return place;
    place.y = above < below ? 1.0f : 0.0f;
    place.height = fminf(height, fmaxf(above, below) - margin);
    return place;
}

/* Draws the number of rays, and whether their twins on the CPU hit the same. */
static void draw_count(const whit_probe_report *r, double ms)
{
    char same[48] = "the CPU finds the same hits";
    if (r->differing)
        snprintf(same, sizeof same, "the CPU finds other hits for %u", r->differing);
    ui_text_color(r->differing ? UI_COLOR_ERROR : UI_COLOR_GOOD, "%u ray%s in %.0f ms; %s",
                  r->ray_count, r->ray_count == 1 ? "" : "s", ms, same);
}

static void draw_panel(struct view *view)
{
    const whit_probe_report *r = view->probe.report;
    uint32_t count = view->probe.row_count;
    uint32_t lines = count_lines(r);
    float rows = (float)(count < ROWS_AT_FIRST ? count : ROWS_AT_FIRST) +
                 (float)(lines < LINES_AT_FIRST ? lines : LINES_AT_FIRST);
    const struct pick_place place = place_panel(view, r, 192.0f + 17.0f * rows);
    const struct pick_place *was = &view->pick_place;
    bool moves = place.x != was->x || place.y != was->y || place.height < was->height;
    view->pick_place = place;
    if (ui_window_begin("Pixel", place.x, place.y, PANEL_WIDTH, place.height, moves,
                        &view->picked)) {
        char why[WHIT_PROBE_WHY_BYTES];
        whit_probe_why(r, view->probe.scene->scene, why, sizeof why);
        draw_place(view);
        ui_paragraph(why);
        ui_separator();
        draw_calls(r);
        draw_count(r, view->probe.ms);
        if (has_moved_on(view))
            ui_text_dim("of a picture before this one");
        draw_tree(view);
    }
    ui_panel_end();
}

/* ---- In the scene ---- */

/* The length at which a ray is drawn, in t. Rays that miss, and rays to far lights, are drawn at
   twice the distance from camera to target. */
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
    ui_keep_free(x, y, 8.0f);
    ui_rectangle(x - 5.0f, y - 5.0f, x + 5.0f, y + 5.0f, 0xFF000000u);
    ui_rectangle(x - 4.0f, y - 4.0f, x + 4.0f, y + 4.0f, 0xFFFFFFFFu);
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
