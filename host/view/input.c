#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "view/input.h"
#include "view/keys.h"
#include "view/pick.h"
#include "view/scenes.h"
#include "view/view_private.h"

static const double ORBIT_RADIANS = 3.14159265358979; /* by a drag across the window's height */
static const double ZOOM_NOTCH = 0.85;
static const double FLY_A_SECOND = 0.8; /* multiples of the distance to the target */
static const double CLICK_PIXELS = 4.0; /* a shorter move is a click, not a drag */
static const double STEP_MAX_S = 0.25;  /* most time that one step of moving covers */

/* ---- Keys ---- */

/* Whether the key moves the camera, and does nothing else. */
static bool flies(const struct view_event *event)
{
    return !(event->mods & EVENT_CTRL) && event->key < 128 && event->key &&
           strchr("WASDQE", event->key);
}

static void on_key(struct view *view, const struct view_event *event)
{
    bool held = event->down && view->input.down[event->key];
    view->input.down[event->key] = event->down;
    ui_key_event(view->ui, event->key, event->down);
    view->dirty |= ui_has_keys(view->ui);
    if (!event->down || ui_has_keys(view->ui) || flies(event))
        return;
    if (key_act(view, event->key, event->mods, held))
        view->dirty = true;
}

static bool fly(struct view *view, double seconds)
{
    const bool *down = view->input.down;
    if (!view->camera_known || down[KEY_CTRL] || ui_has_keys(view->ui))
        return false;
    double step = FLY_A_SECOND * seconds * (down[KEY_SHIFT] ? 4.0 : 1.0);
    double right = (down['D'] - down['A']) * step, up = (down['E'] - down['Q']) * step;
    double forward = (down['W'] - down['S']) * step;
    if (right == 0.0 && up == 0.0 && forward == 0.0)
        return false;
    camera_fly(&view->camera, right, up, forward);
    view_moved(view);
    return true;
}

/* ---- Mouse ---- */

static void drag(struct view *view, double dx, double dy)
{
    double height = view->settings.picture.height > 0 ? view->settings.picture.height : 1.0;
    double right = dx / height, down = dy / height;
    const struct view_input *input = &view->input;
    bool pans = input->buttons[2] || (input->buttons[0] && input->down[KEY_SHIFT]);
    if (!view->camera_known || !(input->buttons[0] || input->buttons[1] || input->buttons[2]))
        return;
    if (pans) {
        double tall = 2.0 * tan(view->camera.fov_y_degrees * 0.008726646259971648);
        camera_fly(&view->camera, -right * tall, down * tall, 0.0);
    } else if (input->buttons[1]) {
        camera_turn(&view->camera, right * ORBIT_RADIANS * 0.5, -down * ORBIT_RADIANS * 0.5);
    } else {
        camera_orbit(&view->camera, right * ORBIT_RADIANS, -down * ORBIT_RADIANS);
    }
    view_moved(view);
}

static void on_move(struct view *view, const struct view_event *event)
{
    struct view_input *input = &view->input;
    double dx = event->x - input->x, dy = event->y - input->y;
    bool held = input->buttons[0] || input->buttons[1] || input->buttons[2];
    input->x = event->x;
    input->y = event->y;
    ui_mouse(view->ui, (float)event->x, (float)event->y);
    if (compare_event(view, event))
        return;
    if (held && !input->dragged) {
        dx = event->x - input->press_x;
        dy = event->y - input->press_y;
        input->dragged = hypot(dx, dy) >= CLICK_PIXELS;
    }
    if (held && input->dragged)
        drag(view, dx, dy);
    if (!held)
        view->dirty = true; /* the item under the mouse may be highlighted */
}

static void on_button(struct view *view, const struct view_event *event)
{
    struct view_input *input = &view->input;
    ui_button_event(view->ui, event->button, event->down);
    view->dirty = true;
    if (event->down && ui_has_mouse(view->ui))
        return;
    if (compare_event(view, event))
        return;
    bool was_down = input->buttons[event->button];
    input->buttons[event->button] = event->down;
    if (event->down) {
        input->press_x = input->x;
        input->press_y = input->y;
        input->dragged = false;
    } else if (was_down && !input->dragged && event->button == 0) {
        pick_at(view, input->x, input->y);
    }
}

static void on_wheel(struct view *view, const struct view_event *event)
{
    ui_wheel(view->ui, (float)event->x, (float)event->y);
    view->dirty = true;
    if (ui_has_mouse(view->ui) || !view->camera_known)
        return;
    camera_zoom(&view->camera, pow(ZOOM_NOTCH, event->y));
    view_moved(view);
}

static void on_size(struct view *view, const struct view_event *event)
{
    if (event->width > 0 && event->height > 0 && view->swapchain) {
        view->settings.picture.width = event->width;
        view->settings.picture.height = event->height;
    }
    view->resized = true;
    view->dirty = true;
}

void input_event(struct view *view, const struct view_event *event)
{
    view->measure.input_ms = clock_ms();
    if (event->kind != EVENT_REFRESH)
        engine_stop_reload(view->engine);
    switch (event->kind) {
    case EVENT_KEY:
        on_key(view, event);
        break;
    case EVENT_CHAR:
        ui_character(view->ui, event->code);
        view->dirty |= ui_has_keys(view->ui); /* a text field takes it when it is drawn */
        break;
    case EVENT_BUTTON:
        on_button(view, event);
        break;
    case EVENT_MOVE:
        on_move(view, event);
        break;
    case EVENT_WHEEL:
        on_wheel(view, event);
        break;
    case EVENT_SIZE:
        on_size(view, event);
        break;
    case EVENT_DROP:
        view_open(view, event->path);
        break;
    case EVENT_CLOSE:
        view->quit = true;
        break;
    default:
        view->dirty = true;
        break;
    }
}

/* ---- Time ---- */

static bool play(struct view *view, double now_ms)
{
    struct view_clock *clock = &view->clock;
    double *time_s = &view->settings.picture.time_s;
    double passed_s = fmin((now_ms - clock->last_ms) * 1e-3, STEP_MAX_S);
    clock->last_ms = now_ms;
    if (!view_plays(view))
        return false;
    double end_s = view->scene->info.time_end_s;
    *time_s += passed_s * clock->speed;
    if (*time_s > end_s || *time_s < 0.0) {
        clock->playing = !clock->once;
        *time_s =
            clock->once ? (*time_s < 0.0 ? 0.0 : end_s) : *time_s - end_s * floor(*time_s / end_s);
    }
    view->dirty = true;
    return true;
}

bool input_step(struct view *view, double now_ms)
{
    struct view_input *input = &view->input;
    double seconds = fmin((now_ms - input->step_ms) * 1e-3, STEP_MAX_S);
    input->step_ms = now_ms;
    bool flew = fly(view, seconds), played = play(view, now_ms);
    return flew || played;
}
