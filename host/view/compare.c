#include "view/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "view/view_private.h"

/* Half the width of the divider for the mouse, at 96 dots an inch. */
static const double GRIP_PIXELS = 6.0;

/* ---- Pairs of pictures ---- */

static const struct engine_frame *frame_of(const struct view *view, int side)
{
    return side == 0 ? &view->frame : &view->compare.other;
}

static bool same_kind(const struct view *view)
{
    bool costs = view->frame.settings.paint != PAINT_COLOR;
    return costs == (view->compare.frozen.paint != PAINT_COLOR);
}

/* False if the two pictures cannot be subtracted: one is missing, they show another view or another
   kind of values, or one is still smaller, so that every pixel would differ. */
static bool get_pair(const struct view *view, struct compare_pair *pair)
{
    const struct engine_frame *a = frame_of(view, 0), *b = frame_of(view, 1);
    if (view->compare.mode == COMPARE_OFF || !a->color || !b->color ||
        !settings_same_camera(&a->settings, &b->settings) || a->width != b->width ||
        a->height != b->height || !same_kind(view))
        return false;
    *pair = (struct compare_pair){.color = {a->color, b->color},
                                  .ids = {a->ids, b->ids},
                                  .numbers = {a->number, b->number},
                                  .whole = a->whole && b->whole,
                                  .uneven = (a->refined || b->refined) && a->samples != b->samples};
    return true;
}

static bool same_pair(const struct compare_pair *p, const struct compare_pair *q)
{
    return p->numbers[0] == q->numbers[0] && p->numbers[1] == q->numbers[1];
}

/* A job owns the images of its pair until it is done: their frames may be replaced meanwhile. */
static void share_images(struct compare_pair *pair)
{
    for (int i = 0; i < 2; ++i) {
        pair->color[i] = whit_image_share(pair->color[i]);
        pair->ids[i] = whit_image_share(pair->ids[i]);
    }
}

static void drop_images(struct compare_pair *pair)
{
    for (int i = 0; i < 2; ++i) {
        whit_image_destroy(pair->color[i]);
        whit_image_destroy(pair->ids[i]);
        pair->color[i] = pair->ids[i] = NULL;
    }
}

/* ---- Jobs ---- */

/* Writes |a - b| of the largest channel. */
static void subtract(const whit_image *a, const whit_image *b, float *out)
{
    whit_image_info info;
    whit_image_get_info(a, &info);
    const float *s = whit_image_floats(a), *t = whit_image_floats(b);
    uint32_t counted = info.channels < 3 ? info.channels : 3;
    for (size_t left = (size_t)info.width * info.height; left > 0; --left) {
        float max = 0.0f;
        for (uint32_t c = 0; c < counted; ++c) {
            float d = fabsf(s[c] - t[c]);
            max = d <= max || isnan(max) ? max : d; /* keeps NaN */
        }
        *out++ = max;
        s += info.channels;
        t += info.channels;
    }
}

/* A display can show no smaller difference of colours than this. The heat map's scale does not go
   below it, so that differences nobody could see are not made to look large. */
static const double STEP_SHOWN = 1.0 / 255.0;

static void run_heat(void *context)
{
    struct compare_job *job = context;
    struct compare_heat *heat = &job->heat;
    whit_image_info info;
    whit_image *values = NULL;
    whit_image_get_info(heat->pair.color[0], &info);
    heat->width = info.width;
    heat->height = info.height;
    size_t pixels = (size_t)heat->width * heat->height;
    float *numbers = malloc(pixels * sizeof *numbers);
    heat->rgba = malloc(pixels * sizeof *heat->rgba);
    heat->scale = heat->asked_scale;
    if (numbers && heat->rgba) {
        subtract(heat->pair.color[0], heat->pair.color[1], numbers);
        if (heat->scale <= 0.0 &&
            whit_image_create(heat->width, heat->height, 1, numbers, &values) == WHIT_OK)
            heat->scale = fmax(whit_image_heat_scale(values), info.channels < 3 ? 0.0 : STEP_SHOWN);
        palette_paint(job->palette, numbers, pixels, heat->scale > 0.0 ? heat->scale : 1.0,
                      heat->rgba);
    }
    whit_image_destroy(values);
    free(numbers);
    atomic_store(&job->done, true);
    window_wake(NULL);
}

static void run_figures(void *context)
{
    struct compare_job *job = context;
    struct compare_figures *figures = &job->figures;
    const struct compare_pair *pair = &figures->pair;
    whit_image_info info;
    whit_image_get_info(pair->color[0], &info);
    difference_measure(pair->color[0], pair->color[1], pair->ids[0], pair->ids[1],
                       &figures->difference);
    figures->has_flip =
        info.channels > 1 && difference_flip(pair->color[0], pair->color[1], &figures->flip_mean,
                                             &figures->flip_largest);
    figures->known = true;
    atomic_store(&job->done, true);
    window_wake(NULL);
}

static void start(struct compare_job *job, const struct compare_pair *pair,
                  void (*fn)(void *context))
{
    atomic_store(&job->done, false);
    job->pair = *pair;
    share_images(&job->pair);
    job->thread = thread_start(fn, job);
    if (!job->thread)
        drop_images(&job->pair);
}

static bool reap(struct compare *compare, enum compare_work work)
{
    struct compare_job *job = &compare->jobs[work];
    if (!job->thread || !atomic_load(&job->done))
        return false;
    thread_join(job->thread);
    job->thread = NULL;
    drop_images(&job->pair);
    return true;
}

static void take_heat(struct compare *compare)
{
    struct compare_job *job = &compare->jobs[COMPARE_HEAT];
    if (!reap(compare, COMPARE_HEAT))
        return;
    free(compare->heat.rgba);
    compare->heat = job->heat;
    job->heat = (struct compare_heat){0};
    compare->stale = true;
}

static bool wants_heat(const struct compare *compare, const struct compare_pair *pair)
{
    return compare->mode == COMPARE_DIFFERENCE &&
           (!same_pair(&compare->heat.pair, pair) || compare->heat.asked_scale != compare->scale);
}

static bool wants_figures(const struct compare *compare, const struct compare_pair *pair)
{
    return compare->mode != COMPARE_OFF && pair->whole && !pair->uneven &&
           !(compare->figures.known && same_pair(&compare->figures.pair, pair));
}

static void run_jobs(struct view *view)
{
    struct compare *compare = &view->compare;
    struct compare_pair pair;
    take_heat(compare);
    if (reap(compare, COMPARE_FIGURES)) {
        compare->figures = compare->jobs[COMPARE_FIGURES].figures;
        view->dirty = true;
    }
    if (!get_pair(view, &pair))
        return;
    struct compare_job *heat = &compare->jobs[COMPARE_HEAT];
    struct compare_job *figures = &compare->jobs[COMPARE_FIGURES];
    if (!heat->thread && wants_heat(compare, &pair)) {
        heat->palette = &view->palette;
        heat->heat = (struct compare_heat){.pair = pair, .asked_scale = compare->scale};
        start(heat, &pair, run_heat);
    }
    if (!figures->thread && wants_figures(compare, &pair)) {
        figures->figures = (struct compare_figures){.pair = pair};
        for (int i = 0; i < 2; ++i)
            figures->figures.ms[i] = engine_drawn_ms(&frame_of(view, i)->stats);
        start(figures, &pair, run_figures);
    }
}

bool compare_is_still(const struct view *view)
{
    const struct compare *compare = &view->compare;
    struct compare_pair pair;
    return !compare->stale && !compare->jobs[COMPARE_HEAT].thread &&
           !compare->jobs[COMPARE_FIGURES].thread &&
           (!get_pair(view, &pair) ||
            !(wants_heat(compare, &pair) || wants_figures(compare, &pair)));
}

/* ---- The picture ---- */

static bool make_room(struct compare *compare, uint32_t width, uint32_t height)
{
    uint8_t *mixed = realloc(compare->mixed, (size_t)width * height * 4);
    if (!mixed)
        return false;
    compare->mixed = mixed;
    compare->mixed_width = width;
    compare->mixed_height = height;
    return true;
}

/* Copies columns [left, right) of a picture, stretched to width x height. */
static void copy_part(const struct engine_frame *frame, uint32_t left, uint32_t right,
                      uint32_t width, uint32_t height, uint8_t *to)
{
    for (uint32_t y = 0; y < height; ++y) {
        const uint8_t *from = frame->rgba + (size_t)(y * frame->height / height) * frame->width * 4;
        uint8_t *row = to + (size_t)y * width * 4;
        if (frame->width == width) {
            memcpy(row + (size_t)left * 4, from + (size_t)left * 4, (size_t)(right - left) * 4);
            continue;
        }
        for (uint32_t x = left; x < right; ++x)
            memcpy(row + (size_t)x * 4, from + (size_t)(x * frame->width / width) * 4, 4);
    }
}

static whit_result show_split(struct view *view)
{
    struct compare *compare = &view->compare;
    const struct engine_frame *a = frame_of(view, 0), *b = frame_of(view, 1);
    uint32_t width = a->width > b->width ? a->width : b->width;
    uint32_t height = a->height > b->height ? a->height : b->height;
    uint32_t divider = (uint32_t)(compare->divider * width + 0.5);
    if (!make_room(compare, width, height))
        return WHIT_ERROR_MEMORY;
    copy_part(a, 0, divider, width, height, compare->mixed);
    copy_part(b, divider, width, width, height, compare->mixed);
    return swapchain_set_picture(view->swapchain, compare->mixed, width, height);
}

bool compare_subtracts(const struct view *view)
{
    const struct compare *compare = &view->compare;
    return compare->mode == COMPARE_DIFFERENCE && compare->heat.rgba && same_kind(view);
}

static whit_result show(struct view *view)
{
    const struct compare *compare = &view->compare;
    const struct compare_heat *heat = &compare->heat;
    const struct engine_frame *frame = &view->frame;
    view->picture_set = true;
    view->dirty = true;
    if (compare->mode == COMPARE_SPLIT && compare->other.rgba)
        return show_split(view);
    if (compare_subtracts(view))
        return swapchain_set_picture(view->swapchain, (const uint8_t *)heat->rgba, heat->width,
                                     heat->height);
    return swapchain_set_picture(view->swapchain, frame->rgba, frame->width, frame->height);
}

/* Replaces B's picture by `next`, whose number is never lower, as newer pictures have higher
   ones. */
static void replace_other(struct compare *compare, struct engine_frame *next)
{
    engine_frame_inherit(&compare->other, next);
    engine_frame_finish(&compare->other);
    compare->other = *next;
    compare->stale = true;
}

/* Takes B's newest picture, unless an older B or its kernel has drawn it. */
static void take_other(struct view *view)
{
    struct compare *compare = &view->compare;
    struct engine_frame next = {.number = compare->other.number};
    if (compare->mode == COMPARE_OFF || !engine_take(view->engine, true, &next))
        return;
    struct settings settings = next.settings;
    settings_set_camera(&settings, &compare->frozen);
    if (settings_same(&settings, &compare->frozen))
        replace_other(compare, &next);
    else
        engine_frame_finish(&next);
}

whit_result compare_step(struct view *view)
{
    struct compare *compare = &view->compare;
    take_other(view);
    run_jobs(view);
    if (!compare->stale || !view->frame.rgba)
        return WHIT_OK;
    compare->stale = false;
    return show(view);
}

void compare_set(struct view *view, enum compare_mode mode)
{
    struct compare *compare = &view->compare;
    if (compare->mode == COMPARE_OFF && mode != COMPARE_OFF) {
        compare->frozen = view->settings;
        bool before = shaders_set_before(view, &compare->frozen);
        compare->divider = 0.5;
        compare->figures.known = false;
        free(compare->heat.rgba);
        compare->heat = (struct compare_heat){0};
        engine_ask_other(view->engine, &compare->frozen);
        view_say(view, before
                           ? "B is the shader before it was saved last; I ends it, U subtracts them"
                           : "B stays as it is now; what you change is A. I ends it, U subtracts "
                             "them");
    }
    if (mode == COMPARE_OFF) {
        engine_ask_other(view->engine, NULL);
        replace_other(compare, &(struct engine_frame){.number = compare->other.number});
    }
    compare->mode = mode;
    compare->dragging = false;
    compare->stale = true;
    view->dirty = true;
}

/* ---- The divider ---- */

static bool is_on_divider(const struct view *view, double x)
{
    double at = view->compare.divider * view->settings.picture.width;
    return view->compare.mode == COMPARE_SPLIT &&
           fabs(x - at) <= GRIP_PIXELS * (double)ui_scale(view->ui);
}

bool compare_event(struct view *view, const struct view_event *event)
{
    struct compare *compare = &view->compare;
    double width = view->settings.picture.width;
    if (event->kind == EVENT_MOVE && compare->dragging && width > 0.0) {
        compare->divider = fmin(fmax(event->x / width, 0.0), 1.0);
        compare->stale = true;
        return true;
    }
    if (event->kind != EVENT_BUTTON || event->button != 0)
        return false;
    bool was = compare->dragging;
    compare->dragging = event->down && is_on_divider(view, view->input.x);
    return was || compare->dragging;
}

void compare_finish(struct compare *compare)
{
    for (int i = 0; i < COMPARE_WORKS; ++i) {
        thread_join(compare->jobs[i].thread);
        drop_images(&compare->jobs[i].pair);
    }
    free(compare->jobs[COMPARE_HEAT].heat.rgba);
    free(compare->heat.rgba);
    free(compare->mixed);
    engine_frame_finish(&compare->other);
    *compare = (struct compare){0};
}
