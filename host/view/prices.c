#include "view/prices.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/platform.h"
#include "base/threads.h"
#include "view/window.h"

enum { REFERENCE_SAMPLES = 16, EFFECT_PIXELS_MAX = 128 * 96, EFFECT_ROUNDS = 9 };

struct prices {
    pthread_mutex_t lock;
    struct thread *thread;
    struct prices_params params; /* holds a reference to its scene */
    volatile bool cancel;
    /* Under the lock. */
    bool news;
    struct prices_state state; /* owns its report */
    struct price_strip strip;
    struct effect_price effects[EFFECTS_MAX];
};

static void tell(void *user, double done, double seconds_left, const char *what)
{
    struct prices *prices = user;
    pthread_mutex_lock(&prices->lock);
    prices->news = true;
    prices->state.done = done;
    prices->state.seconds_left = seconds_left;
    snprintf(prices->state.what, sizeof prices->state.what, "%s", what);
    pthread_mutex_unlock(&prices->lock);
    window_wake(NULL);
}

static void on_message(void *user, whit_log_level level, const char *message)
{
    struct prices *prices = user;
    if (level != WHIT_LOG_ERROR)
        return;
    pthread_mutex_lock(&prices->lock);
    snprintf(prices->state.what, sizeof prices->state.what, "%s", message);
    pthread_mutex_unlock(&prices->lock);
}

static whit_result measure(struct prices *prices, const whit_log *log, whit_device *device,
                           whit_accel *accel, struct cost_report **report)
{
    struct cost_request request = {
        .device = device,
        .scene = prices->params.scene->scene,
        .accel = accel,
        .settings = &prices->params.settings,
        .cancel = &prices->cancel,
        .knobs = prices->params.knobs,
        .seconds = prices->params.seconds,
        .samples_max = REFERENCE_SAMPLES,
        .progress = tell,
        .progress_user = prices,
        .log = log,
    };
    if (prices->params.strip)
        cost_strip_ask(&request);
    whit_result result = cost_measure(&request, report);
    if (*report && prices->params.strip) {
        price_strip_init(&prices->strip, *report);
        cost_report_drop_pictures(*report); /* frees memory, as the panel may stay open for long */
    }
    return result;
}

static void note_effect(void *user, uint32_t index, const struct cost_effect *effect)
{
    struct prices *prices = user;
    if (!effect->priced || index >= EFFECTS_MAX)
        return;
    pthread_mutex_lock(&prices->lock);
    prices->effects[index] =
        (struct effect_price){.known = true,
                              .before_ms = effect->price.usual_ms[effect->clock].median,
                              .after_ms = effect->price.setting_ms[effect->clock].median,
                              .other_colors = effect->error.differing_pixels,
                              .pixels = effect->error.pixel_count};
    pthread_mutex_unlock(&prices->lock);
}

static whit_result begin_effect(void *user, double done, const char *name)
{
    struct prices *prices = user;
    tell(user, done, 0.0, name);
    return prices->cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
}

/* The picture of the settings with one sample, at most EFFECT_PIXELS_MAX pixels large, so that
   measuring takes little time. */
static whit_renderer_params small_picture(const struct prices *prices)
{
    whit_renderer_params params = settings_picture(&prices->params.settings);
    uint32_t width = params.width, height = params.height;
    for (uint32_t by = 2; (uint64_t)params.width * params.height > EFFECT_PIXELS_MAX; ++by) {
        params.width = (width + by - 1) / by;
        params.height = (height + by - 1) / by;
    }
    params.sampling.count = 1;
    params.sampling.kind = WHIT_SAMPLING_FIXED;
    params.count = false;
    params.cancel = &prices->cancel;
    return params;
}

/* Measures the effects that the kernel has; removing others would change nothing. */
static whit_result measure_effects(struct prices *prices, const whit_log *log, whit_device *device,
                                   whit_accel *accel)
{
    const whit_renderer_params params = small_picture(prices);
    struct cost_effects effects = {.scene = prices->params.scene->scene,
                                   .device = device,
                                   .accel = accel,
                                   .params = &params,
                                   .rounds = EFFECT_ROUNDS,
                                   .log = log,
                                   .begin = begin_effect,
                                   .found = note_effect,
                                   .user = prices};
    whit_result result = whit_renderer_create(device, accel, &params, &effects.usual);
    if (result == WHIT_OK)
        result = whit_renderer_render(effects.usual);
    if (result == WHIT_OK)
        result = cost_effects_measure(&effects);
    whit_renderer_destroy(effects.usual);
    return result;
}

static void run(void *context)
{
    struct prices *prices = context;
    const struct settings *settings = &prices->params.settings;
    const whit_log log = {on_message, prices, WHIT_LOG_ERROR};
    const whit_device_params params = settings_device(settings);
    whit_device *device = NULL;
    whit_accel *accel = NULL;
    struct cost_report *report = NULL;
    tell(prices, 0.0, prices->params.seconds, "building trees");
    whit_result result = whit_accel_create(prices->params.scene->scene, &settings->trees, &accel);
    if (result == WHIT_OK)
        result = whit_device_create(&params, &log, &device);
    if (result == WHIT_OK)
        result = prices->params.effects ? measure_effects(prices, &log, device, accel)
                                        : measure(prices, &log, device, accel, &report);
    whit_device_destroy(device);
    whit_accel_destroy(accel);
    platform_trim_heaps();
    pthread_mutex_lock(&prices->lock);
    prices->state.report = report;
    prices->state.finished = prices->news = true;
    if (result != WHIT_OK && !report && !prices->state.what[0])
        snprintf(prices->state.what, sizeof prices->state.what, "it could not be measured");
    pthread_mutex_unlock(&prices->lock);
    window_wake(NULL);
}

struct prices *prices_start(const struct prices_params *params)
{
    struct prices *prices = calloc(1, sizeof *prices);
    if (!prices)
        return NULL;
    prices->params = *params;
    /* Prices are those of colours, not of cost views. */
    prices->params.settings.paint = PAINT_COLOR;
    prices->params.scene = scene_ref_take(params->scene);
    prices->state.strip = &prices->strip;
    prices->state.settings = &prices->params.settings;
    pthread_mutex_init(&prices->lock, NULL);
    prices->thread = thread_start(run, prices);
    if (prices->thread)
        return prices;
    prices_stop(prices);
    return NULL;
}

void prices_cancel(struct prices *prices)
{
    prices->cancel = true;
}

void prices_stop(struct prices *prices)
{
    if (!prices)
        return;
    prices->cancel = true;
    thread_join(prices->thread);
    cost_report_destroy(prices->state.report);
    price_strip_finish(&prices->strip);
    scene_ref_drop(prices->params.scene);
    pthread_mutex_destroy(&prices->lock);
    free(prices);
}

bool prices_have_news(struct prices *prices)
{
    if (!prices)
        return false;
    pthread_mutex_lock(&prices->lock);
    bool news = prices->news;
    prices->news = false;
    pthread_mutex_unlock(&prices->lock);
    return news;
}

bool prices_are_still(struct prices *prices)
{
    struct prices_state state = {.finished = true};
    if (prices)
        prices_get_state(prices, &state);
    return state.finished;
}

void prices_get_effect(struct prices *prices, uint32_t effect, struct effect_price *price)
{
    pthread_mutex_lock(&prices->lock);
    *price = prices->effects[effect];
    pthread_mutex_unlock(&prices->lock);
}

void prices_get_state(struct prices *prices, struct prices_state *state)
{
    pthread_mutex_lock(&prices->lock);
    *state = prices->state;
    pthread_mutex_unlock(&prices->lock);
}
