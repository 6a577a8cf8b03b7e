/* The window's thread: takes events, gives settings to the engine, and shows pictures. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/platform.h"
#include "kernels.h"
#include "view/pick.h"
#include "view/price_panel.h"
#include "view/prices.h"
#include "view/replay.h"
#include "view/scenes.h"
#include "view/view_private.h"

static const double MOVING_MS = 160.0; /* time after the last move until a whole picture is drawn */
static const double TOAST_MS = 4000.0;
static const double REST_MS = 1000.0; /* a pause that begins the count of the frame rate anew */
static const double PROGRESS_S = 0.1; /* time between looks at the engine's status */
/* Time between drawings of a progress bar: on a CPU device each takes time of the cores that
   draw. */
static const double PROGRESS_SHOWN_MS = 400.0;
static const double IDLE_S = 5.0;

double view_now_ms(const struct view *view)
{
    return view->time.turned ? view->time.now_ms : clock_ms() + view->time.ahead_ms;
}

void view_say(struct view *view, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(view->toast, sizeof view->toast, format, args);
    va_end(args);
    view->toast_until_ms = view_now_ms(view) + TOAST_MS;
    view->dirty = true;
}

static void saving_message(void *user, whit_log_level level, const char *message)
{
    struct view_saving *saving = user;
    if (level == WHIT_LOG_ERROR)
        snprintf(saving->error, sizeof saving->error, "%s", message);
    if (saving->next.fn)
        saving->next.fn(saving->next.user, level, message);
}

whit_log view_saving_begin(const struct view *view, struct view_saving *saving)
{
    *saving = (struct view_saving){.next = view->log};
    return (whit_log){saving_message, saving, view->log.level};
}

void view_say_saved(struct view *view, const struct view_saving *saving, const char *path,
                    bool saved)
{
    if (saved)
        view_say(view, "saved as %s", path);
    else if (saving->error[0])
        view_say(view, "%s", saving->error);
    else
        view_say(view, "%s could not be saved", path);
}

const char *view_error(const struct view *view)
{
    if (view->shaders.errors[0])
        return view->shaders.errors;
    return view->refused[0] ? view->refused : view->status.error;
}

const char *view_failure(const struct view *view)
{
    return view->status.errors[0] ? view->status.errors : view->status.error;
}

void view_log_failure(const struct view *view)
{
    for (const char *at = view_failure(view); *at;) {
        int length = (int)strcspn(at, "\n");
        log_error(&view->log, "%.*s", length, at);
        at += length + (at[length] == '\n');
    }
}

/* The window is drawn again with the picture of the new camera. */
void view_moved(struct view *view)
{
    camera_to_text(&view->camera, view->settings.camera, sizeof view->settings.camera);
    view->file_camera = -1;
    view->moved_ms = view_now_ms(view);
    view->unasked = true;
}

bool view_bounds(const struct view *view, double lo[3], double hi[3])
{
    if (!view->scene)
        return false;
    memcpy(lo, view->scene->info.home_lo, 3 * sizeof *lo);
    memcpy(hi, view->scene->info.home_hi, 3 * sizeof *hi);
    return lo[0] <= hi[0];
}

double view_aspect(const struct view *view)
{
    const whit_renderer_params *p = &view->settings.picture;
    return p->height > 0 ? (double)p->width / p->height : 1.0;
}

/* ---- Pictures ---- */

static void count_picture(struct view *view)
{
    struct view_rate *rate = &view->rate;
    const uint32_t max = sizeof rate->shown_ms / sizeof *rate->shown_ms;
    double now_ms = view_now_ms(view);
    if (rate->count > 0 && now_ms - rate->shown_ms[(rate->count - 1) % max] > REST_MS)
        rate->count = 0;
    rate->shown_ms[rate->count++ % max] = now_ms;
    uint32_t n = rate->count < max ? rate->count : max;
    double first_ms = rate->shown_ms[(rate->count - n) % max];
    rate->fps = n > 1 && now_ms > first_ms ? 1e3 * (n - 1) / (now_ms - first_ms) : 0.0;
}

struct settings view_drawn(const struct view *view, const struct settings *settings)
{
    struct settings drawn = *settings;
    if (view->frame.refined && settings_same(&view->frame.settings, settings))
        drawn.picture.sampling.count = view->frame.samples;
    return drawn;
}

void view_line(const struct view *view, char line[VIEW_LINE])
{
    const struct settings drawn = view_drawn(view, scenes_shown(view));
    settings_write_render(&drawn, SETTINGS_LINE, "picture.png", line, VIEW_LINE);
}

/* Replaces `auto` in the settings by the exposure and the camera that were chosen for it. */
static void take_choices(struct view *view, const struct engine_frame *frame)
{
    settings_expose(&view->settings, &frame->scene->info);
    if (strcmp(view->settings.camera, "auto") == 0)
        memcpy(view->settings.camera, frame->settings.camera, sizeof view->settings.camera);
}

static void take_frame(struct view *view)
{
    struct engine_frame *frame = &view->frame, next = {.number = view->frame.number};
    if (!engine_take(view->engine, false, &next))
        return;
    engine_frame_inherit(frame, &next);
    engine_frame_finish(frame);
    *frame = next;
    bool other_scene = view->scene != frame->scene;
    scene_ref_drop(view->scene);
    view->scene = scene_ref_take(frame->scene);
    view->fallback = frame->settings;
    if (settings_same_scene(&frame->settings, &view->settings))
        take_choices(view, frame);
    if (other_scene)
        scenes_show(view);
    shaders_take(view);
    /* A scene that is read again, or turned, may have other cameras, and cameras move with time. */
    bool other_camera = other_scene || frame->settings.picture.time_s != view->camera_time_s;
    if ((!view->camera_known || (other_camera && view->file_camera >= 0)) &&
        settings_same_scene(&frame->settings, &view->settings))
        view_learn_camera(view);
    count_picture(view);
    view->compare.stale = true;
}

bool view_go_back(struct view *view)
{
    struct settings back = view->fallback;
    if (!settings_same_scene(&view->settings, &view->fallback))
        return false;
    settings_set_camera(&back, &view->settings);
    if (settings_same_kernel(&back, &view->settings))
        return false;
    view->settings = back;
    view->dirty = true;
    return true;
}

/* After a failed request, goes back to the settings of the picture. Without a picture the viewer
   ends. */
static whit_result take_failure(struct view *view)
{
    bool told = shaders_refuse(view);
    if (scenes_refuse(view))
        return WHIT_OK;
    if (view_go_back(view)) {
        if (!told)
            view_say(view, "%s", view->status.error);
        return WHIT_OK;
    }
    if (view->frame.number > 0)
        return WHIT_OK;
    view_log_failure(view);
    return view->status.result;
}

/* Whether the window is minimised, so that nothing has to be drawn. */
static bool is_hidden(const struct view *view)
{
    struct swapchain_info info;
    swapchain_get_info(view->swapchain, &info);
    return info.width == 0 && view->frame.number > 0;
}

static bool is_progress_due(struct view *view)
{
    double now_ms = whit_clock_ms();
    bool slow = view->status.stage != SESSION_DONE || view->status.drawing_ms > SLOW_MS;
    if (!slow || now_ms - view->progress_ms < PROGRESS_SHOWN_MS)
        return false;
    view->progress_ms = now_ms;
    return true;
}

static whit_result take_status(struct view *view)
{
    struct engine_status old = view->status;
    engine_get_status(view->engine, &view->status);
    /* After a save of the shader the window is not drawn only to show that the engine begins
       something: drawing takes cores from the compiler. While the picture moves, the next one
       comes soon. */
    bool tells = !view->shaders.wait.goes_on;
    bool other_stage = old.stage != view->status.stage;
    bool other_drawing = old.drawing != view->status.drawing && !view_is_moving(view);
    if ((other_stage && (tells || view->status.stage == SESSION_DONE)) ||
        (other_drawing && (tells || old.drawing)) || strcmp(old.error, view->status.error) != 0 ||
        old.change.number != view->status.change.number ||
        old.change.over != view->status.change.over ||
        old.reload.over != view->status.reload.over || is_progress_due(view))
        view->dirty = true;
    /* While hidden the engine is asked for nothing: a failure belongs to an older request. */
    return view->status.failed && !is_hidden(view) ? take_failure(view) : WHIT_OK;
}

/* ---- The window ---- */

static whit_result fit_window(struct view *view)
{
    uint32_t width, height;
    struct swapchain_info info;
    window_pixels(view->window, &width, &height);
    whit_result result = swapchain_resize(view->swapchain, width, height);
    swapchain_get_info(view->swapchain, &info);
    whit_renderer_params *picture = &view->settings.picture;
    if (result == WHIT_OK && info.width > 0 &&
        (picture->width != info.width || picture->height != info.height)) {
        picture->width = info.width;
        picture->height = info.height;
        view->dirty = true; /* so that a picture of the new size is asked for */
    }
    return result;
}

static whit_result keep_shot(struct view *view)
{
    struct swapchain_info info;
    whit_image *image = NULL;
    swapchain_get_info(view->swapchain, &info);
    size_t bytes = (size_t)info.width * info.height * 4;
    uint8_t *rgba = malloc(bytes);
    whit_result result = rgba ? swapchain_read(view->swapchain, rgba, bytes) : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK)
        result = whit_image_create_display(info.width, info.height, rgba, &image);
    if (result == WHIT_OK)
        result = whit_image_save(image, view->shot, NULL, 0, &view->log);
    whit_image_destroy(image);
    free(rgba);
    view->shot[0] = '\0';
    return result;
}

static whit_result draw_window(struct view *view)
{
    struct swapchain_info info;
    bool shown = false, keep = view->shot[0] != '\0', settles = view->unsettled && !view->dirty;
    double now_ms = view_now_ms(view);
    swapchain_get_info(view->swapchain, &info);
    view->dirty = view->unsettled = false;
    if (info.stale || info.width == 0 || view->resized) {
        view->resized = false;
        whit_result result = fit_window(view);
        swapchain_get_info(view->swapchain, &info);
        if (result == WHIT_OK && info.width > 0) {
            view->compare.stale = true; /* the picture has to be set again */
            result = compare_step(view);
        }
        if (result == WHIT_OK && info.width == 0 && keep)
            return log_failure(&view->log, WHIT_ERROR_OUTPUT, "%s: the window has no pixels now",
                               view->shot);
        if (result != WHIT_OK || info.width == 0)
            return result;
    }
    if (!ui_begin(view->ui, info.width, info.height, (now_ms - view->drawn_ms) * 1e-3, settles))
        return log_failure(&view->log, WHIT_ERROR_MEMORY,
                           "out of memory for the figures of the window");
    const struct settings before = view->settings;
    hud_draw(view);
    view->dirty |=
        !settings_same(&before, &view->settings); /* changed by mouse: the engine has to be asked */
    if (ui_end(view->ui))
        platform_trim_heaps();
    view->unsettled = ui_wants_again(view->ui);
    keep = keep && !view->unsettled; /* a shot is taken once panels have found their sizes */
    view->drawn_ms = now_ms;
    whit_result result = swapchain_show(view->swapchain, ui_draw, view->ui, keep, &shown);
    if (result == WHIT_OK)
        result = ui_result(view->ui);
    if (result == WHIT_OK && !shown)
        view->dirty = true;
    if (result == WHIT_OK && shown && view->picture_set) {
        ++view->shown;
        measure_shown(view);
        shaders_shown(view);
        engine_note_shown(view->engine, view->frame.number);
    }
    return result == WHIT_OK && shown && keep ? keep_shot(view) : result;
}

/* ---- The loop ---- */

bool view_plays(const struct view *view)
{
    return view->clock.playing && view->scene && view->scene->info.time_end_s > 0.0;
}

bool view_is_stale(const struct view *view)
{
    return view->dirty || view->unsettled;
}

double view_stands_ms(const struct view *view)
{
    return view->moved_ms + MOVING_MS;
}

bool view_is_moving(const struct view *view)
{
    return view_now_ms(view) < view_stands_ms(view) || view_plays(view);
}

static double wait_seconds(struct view *view, bool goes_on)
{
    double wait = IDLE_S, now_ms = view_now_ms(view);
    if (view_is_stale(view) || goes_on)
        return 0.0;
    if (now_ms < view_stands_ms(view))
        wait = fmin(wait, (view_stands_ms(view) - now_ms) * 1e-3);
    if (view->toast[0])
        wait = fmin(wait, fmax(view->toast_until_ms - now_ms, 0.0) * 1e-3);
    if (view->status.stage != SESSION_DONE || view->status.drawing)
        wait = fmin(wait, PROGRESS_S);
    wait = fmin(wait, replay_wait_s(view));
    return wait > 0.0 ? wait + 1e-3 : 0.0;
}

static bool is_over(const struct view *view)
{
    const struct view_params *params = view->params;
    return view->quit || (params->cancel && *params->cancel) || replay_is_over(view) ||
           (params->frames > 0 && view->shown >= params->frames);
}

static void take_events(struct view *view)
{
    struct view_event event;
    while (window_next(view->window, &event)) {
        bool by_mouse =
            event.kind == EVENT_MOVE || event.kind == EVENT_BUTTON || event.kind == EVENT_WHEEL;
        if (view->replay && by_mouse)
            continue; /* between a replay's press and release it would move the pointer away */
        if (!view->replay)
            record_event(view, &event);
        input_event(view, &event);
    }
}

static void ask(struct view *view)
{
    if (view->settings.picture.width > 0 && !is_hidden(view))
        engine_ask(view->engine, &view->settings, view_is_moving(view));
    view->unasked = false;
    engine_time_stages(view->engine, view->hud == HUD_FULL);
    /* Refining takes all cores, so measurements in the background come first. Replays ask for it
       themselves. */
    bool rests = prices_are_still(view->prices) && prices_are_still(view->panels.measured) &&
                 wish_is_still(view);
    if (!view->params->replay)
        engine_set_rest(view->engine, rests && view->settings.refines, rests);
    if (!prices_are_still(view->prices) || !prices_are_still(view->panels.measured))
        engine_stop_reload(view->engine);
}

/* One drawing presses the button and the next releases it. In between the engine is asked for what
   the press may have changed, and nothing happens that may move the item. */
static whit_result draw_click(struct view *view)
{
    whit_result result = draw_window(view);
    ask(view);
    return result == WHIT_OK ? draw_window(view) : result;
}

static whit_result step(struct view *view)
{
    bool goes_on = input_step(view, view_now_ms(view));
    window_wait(view->window, wait_seconds(view, goes_on));
    take_events(view);
    replay_step(view);
    scenes_watch(view);
    shaders_watch(view);
    if (view->toast[0] && view_now_ms(view) >= view->toast_until_ms) {
        view->toast[0] = '\0';
        view->dirty = true;
    }
    ask(view);
    if (goes_on)
        engine_wait(view->engine, 50.0);
    take_frame(view);
    whit_result result = compare_step(view);
    if (result == WHIT_OK)
        result = take_status(view);
    pick_take(view);
    view->dirty |= prices_have_news(view->prices);
    view->dirty |= prices_have_news(view->panels.measured);
    prices_part(view);
    wish_step(view);
    panels_step(view);
    shaders_step(view);
    ask(view); /* settings that failed may have been undone */
    if (view->params->frames > 0 && view->picture_set)
        view->dirty = true; /* draws on until params->frames pictures were shown */
    if (result == WHIT_OK && view_is_stale(view))
        result = draw_window(view);
    return result == WHIT_OK && replay_choose(view) ? draw_click(view) : result;
}

/* Replays use Dear ImGui's own font, which is the same on every machine. */
static whit_result open_ui(struct view *view)
{
    uint8_t *font = NULL;
    size_t font_bytes = 0;
    float scale =
        view->params->ui_scale > 0.0f ? view->params->ui_scale : window_scale(view->window);
    if (!view->params->replay)
        (void)font_load(&font, &font_bytes);
    whit_result result = ui_create(view->swapchain, scale, font, font_bytes, &view->ui);
    free(font);
    return result;
}

static whit_result open_device(struct view *view)
{
    const whit_device_params params = settings_device(&view->settings);
    const struct swapchain_params chain = {
        .vsync = !view->params->no_vsync,
    };
    whit_result result =
        device_create(&view->log, &params, window_surface(view->window), &view->device);
    if (result == WHIT_OK)
        result = swapchain_create(view->device, &chain, &view->swapchain);
    if (result == WHIT_OK)
        result = fit_window(view);
    return result == WHIT_OK ? open_ui(view) : result;
}

/* The engine is started before the window's device is created: both take a while. */
static whit_result open_all(struct view *view)
{
    const struct view_params *params = view->params;
    const whit_renderer_params *picture = &params->settings.picture;
    const struct window_params window = {.title = "whit",
                                         .width = picture->width,
                                         .height = picture->height,
                                         .fullscreen = params->fullscreen};
    const struct engine_params engine = {
        .refine = !params->replay && params->settings.refines,
        .times = !params->replay,
        .budget_ms = 1e3 / params->settings.fps_goal,
        .wake = window_wake,
        .compiler = params->compiler,
        .log = view->log,
    };
    whit_result result = palette_init(&view->palette);
    if (result == WHIT_OK)
        result = replay_open(view);
    if (result == WHIT_OK)
        result = window_create(&view->log, &window, &view->window);
    if (result == WHIT_OK)
        result = engine_create(&engine, &view->engine);
    if (result == WHIT_OK) {
        engine_ask(view->engine, &view->settings, false);
        result = open_device(view);
    }
    return result;
}

/* Whether a thread is making a session, which a driver may not let it stop for minutes. */
static bool is_making_session(const struct view *view)
{
    struct engine_status status;
    engine_get_status(view->engine, &status);
    return status.stage_ms > 0.0;
}

/* Gives `result`, or where it is fine an error of the record. */
static whit_result close_all(struct view *view, whit_result result, uint32_t *validation)
{
    scenes_end(view);
    shaders_end(view);
    whit_result recorded = replay_close(view);
    bool fine = result == WHIT_OK && recorded == WHIT_OK;
    if (fine && view->params->end && is_making_session(view))
        view->params->end();
    prices_stop(view->prices);
    prices_stop(view->panels.measured);
    for (uint32_t i = 0; i < LEAVING_MAX; ++i)
        prices_stop(view->leaving[i]);
    wish_finish(view);
    *validation = engine_destroy(view->engine);
    compare_finish(&view->compare);
    engine_frame_finish(&view->frame);
    engine_probe_finish(&view->probe);
    scene_ref_drop(view->scene);
    ui_destroy(view->ui);
    swapchain_destroy(view->swapchain);
    *validation += view->device ? device_validation_messages(view->device) : 0;
    device_destroy(view->device);
    window_destroy(view->window);
    return result == WHIT_OK ? recorded : result;
}

whit_result view_run(const struct view_params *params, const whit_log *log, uint32_t *validation)
{
    struct view *view = calloc(1, sizeof *view);
    if (!view)
        return WHIT_ERROR_MEMORY;
    platform_share_heaps();
    view->log = *log;
    view->params = params;
    view->settings = params->settings;
    view->hud = HUD_SMALL;
    view->hint = params->hint != NULL;
    view->clock.speed = 1.0;
    view->moved_ms = view->escape_ms = -1e9;
    view->time.turned = params->replay != NULL;
    measure_begin(view);
    wish_begin(view);
    view->dirty = true;
    scenes_begin(view);
    shaders_begin(view);
    whit_result result = open_all(view);
    while (result == WHIT_OK && !is_over(view))
        result = step(view);
    result = close_all(view, result, validation);
    free(view);
    return result;
}
