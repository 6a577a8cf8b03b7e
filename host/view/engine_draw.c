#include <math.h>
#include <stdlib.h>

#include "view/engine_draw.h"
#include "view/engine_private.h"
#include "view/palette.h"
#include "whit/whit_program.h"

enum { ADAPTIVE_TIMES = 2 }; /* expected samples a pixel, as a multiple of the least */
static const double BUDGET_DEFAULT_MS = 1000.0 / 30.0;
/* A picture takes 1.0 to 1.4 times as long in steps (1280x720: 34k 1.4, default 1.15, whitted 1.03
   on an AMD EPYC, 1.3, 1.1 and 1.02 on a Xeon). One of up to AT_ONCE_MS is drawn without them,
   if something is shown already; one of up to VERSION_AT_ONCE_MS after the first step of a new
   version of a shader. */
static const double AT_ONCE_MS = 600.0, VERSION_AT_ONCE_MS = 1300.0, STEPS_TAKE = 1.1;
/* The bailout of small pictures while the camera moves: the rays that it cuts are hardly seen
   in enlarged pixels. At 213x120 default takes 0.82 of the time, with an RMSE of 0.0015. */
static const double MOVING_BAILOUT = 1.0 / 64.0;

static uint32_t samples_of(const struct settings *settings)
{
    const whit_renderer_params *p = &settings->picture;
    if (settings->paint != PAINT_COLOR)
        return 1;
    return (p->sampling.kind == WHIT_SAMPLING_ADAPTIVE ? ADAPTIVE_TIMES : 1) *
           (p->sampling.count ? p->sampling.count : 1);
}

static double pixels_of(const struct settings *settings)
{
    return (double)settings->picture.width * settings->picture.height;
}

void engine_note_time(struct engine_lane *lane, const struct engine_frame *frame)
{
    double samples = frame->samples > 0 ? frame->samples : samples_of(&frame->settings);
    pace_note(&lane->pace, frame->divisor, frame->moving,
              frame->draw_ms / (samples * pixels_of(&frame->settings)));
}

static uint32_t choose_divisor(const struct engine *engine, struct engine_lane *lane)
{
    double budget_ms =
        engine->params.budget_ms > 0.0 ? engine->params.budget_ms : BUDGET_DEFAULT_MS;
    bool compiles_beside =
        engine->job && lane->session && lane->session->device_info.kind == WHIT_DEVICE_CPU;
    if (engine->lanes[1].wanted || compiles_beside)
        budget_ms *= 0.5; /* two pictures share it, or a picture and the driver's compiler */
    return pace_divisor(&lane->pace, budget_ms / pixels_of(&lane->settings));
}

/* The spacing of the first step: not coarser than what is shown of the same picture, or than what
   can be drawn in the time of a quick one. 0: no steps. */
static uint32_t choose_step(const struct engine_lane *lane, bool first, uint32_t divisor)
{
    uint32_t spacing = 8, finest = first ? divisor : lane->shown / 2;
    if (lane->moving || lane->settings.paint != PAINT_COLOR)
        return 0; /* steps exist for colours and aovs alone */
    double whole_ms = lane->pace.ms[0] * pixels_of(&lane->settings) * samples_of(&lane->settings);
    double at_once_ms = lane->previewed ? VERSION_AT_ONCE_MS : AT_ONCE_MS;
    if (!first && whole_ms > 0.0 && whole_ms <= at_once_ms)
        return 0; /* quick enough, and something is shown already */
    if (first && whole_ms <= 0.0)
        return spacing;
    while (spacing > 1 && spacing / 2 >= finest)
        spacing /= 2;
    return spacing > 1 ? spacing : 0;
}

/* Whether the next picture will have the same pixels as the one that is shown. */
static bool looks_same(const struct engine_lane *lane)
{
    return lane->frames > 0 && lane->quality == ENGINE_WHOLE &&
           settings_same_pixels(&lane->last, &lane->settings);
}

void engine_plan(const struct engine *engine, struct engine_lane *lane, struct engine_task *task)
{
    uint32_t divisor = choose_divisor(engine, lane);
    uint32_t samples = samples_of(&lane->settings);
    bool first = lane->drawn != lane->asked || lane->stale;
    bool color = lane->settings.paint == PAINT_COLOR;
    enum engine_quality quality = first ? ENGINE_QUICK : lane->quality + 1;
    if (quality == ENGINE_QUICK && (divisor == 1 || (color && !lane->moving)))
        quality = ENGINE_FULL; /* all pixels fit the budget, or come in steps */
    if (quality == ENGINE_FULL && (samples == 1 || (first && looks_same(lane))))
        quality = ENGINE_WHOLE; /* the picture has one sample, or would not look different */
    if (lane->moving && quality == ENGINE_WHOLE && samples > 1)
        quality = ENGINE_FULL;
    task->quality = quality;
    task->divisor = quality == ENGINE_QUICK ? divisor : 1;
    if (!(first && looks_same(lane)) && (first || lane->quality == ENGINE_QUICK))
        task->step_spacing = choose_step(lane, first, divisor);
    task->brief = first;
    task->finishes = first && (task->divisor > 1 || task->step_spacing > 0 || divisor == 1);
    task->moving = lane->moving;
    task->asked_ms = lane->asked_ms;
}

static whit_result paint_costs(const struct engine_task *task, struct engine_frame *frame)
{
    const struct settings *settings = &task->settings;
    whit_view view = (whit_view)(settings->paint - PAINT_DEPTH);
    whit_result result = whit_renderer_cost_image(
        task->session->renderer, view, (whit_ray_kind)settings->paint_rays, &frame->color);
    if (result != WHIT_OK)
        return result;
    frame->scale =
        settings->paint_scale > 0.0 ? settings->paint_scale : whit_image_heat_scale(frame->color);
    return palette_heat(frame->color, frame->scale, frame->rgba);
}

/* Keeps a copy of the picture, to which samples can be added, and draws edges and grid over it. */
static whit_result draw_over(whit_renderer *renderer, const whit_overlay *overlay,
                             struct engine_frame *frame)
{
    if (!overlay->grid && !overlay->edges_of_instances && !overlay->edges_of_primitives)
        return WHIT_OK;
    whit_result result = whit_image_create(frame->width, frame->height, 4,
                                           whit_image_floats(frame->color), &frame->plain);
    return result == WHIT_OK ? whit_renderer_draw_over(renderer, overlay, frame->color) : result;
}

/* Paints colours, or the aov that is shown in place of them. */
static whit_result paint_colors(const struct engine_task *task, struct engine_frame *frame)
{
    const whit_overlay overlay = settings_overlay(&task->settings);
    whit_renderer *renderer = task->session->renderer;
    uint32_t aov = shader_ref_find_aov(frame->shader, frame->settings.aov);
    whit_result result = whit_renderer_image(
        renderer, aov == UINT32_MAX ? WHIT_AOV_COLOR : (whit_aov)(WHIT_AOV_SHADER + aov),
        &frame->color);
    if (result == WHIT_OK && aov == UINT32_MAX)
        result = draw_over(renderer, &overlay, frame);
    if (result == WHIT_OK)
        whit_image_display_bytes(frame->color, frame->rgba);
    return result;
}

/* Whether samples may be added to this picture later. */
static bool is_begun(const struct engine_task *task)
{
    bool whole = task->quality == ENGINE_WHOLE && engine_refines(&task->settings);
    return whole || (task->quality == ENGINE_FULL && engine_doubles(&task->settings));
}

static whit_result read_picture(const struct engine_task *task, struct engine_frame *frame)
{
    whit_renderer *renderer = task->session->renderer;
    whit_result result = WHIT_OK;
    frame->rgba = malloc((size_t)frame->width * frame->height * 4);
    if (!frame->rgba)
        return WHIT_ERROR_MEMORY;
    result =
        task->settings.paint != PAINT_COLOR ? paint_costs(task, frame) : paint_colors(task, frame);
    if (result == WHIT_OK && task->divisor == 1)
        result = whit_renderer_image(renderer, WHIT_AOV_IDS, &frame->ids);
    if (result == WHIT_OK && is_begun(task))
        result = whit_renderer_image(renderer, WHIT_AOV_CUTS, &frame->cuts);
    return result;
}

static whit_result read_boxes(const struct engine_task *task, struct engine_frame *frame)
{
    const struct settings *s = &task->settings;
    uint64_t count = 0;
    if (s->boxes == BOXES_OFF)
        return WHIT_OK;
    whit_result result =
        whit_accel_boxes(task->session->accel, s->picture.time_s, s->boxes == BOXES_INSTANCES,
                         s->boxes_level, ENGINE_BOXES_MAX, &frame->boxes, &count);
    frame->boxes_total = count;
    return result;
}

/* Number of camera rays whose visits are counted on the CPU, which takes some 3 ms for a whole
   picture. */
enum { VISITS_MOVING = 512, VISITS_WHOLE = 4096 };

/* Gives the visits that the kernel counted, or else the float mirror. */
static whit_result count_visits(const struct engine_task *task, struct engine_frame *frame)
{
    const whit_stats *stats = &frame->stats;
    whit_cost cost = stats->costs[WHIT_RAY_PRIMARY];
    uint32_t pixels = task->quality == ENGINE_WHOLE ? VISITS_WHOLE : VISITS_MOVING;
    whit_result result = WHIT_OK;
    frame->visits = -1.0;
    if (cost.rays == 0)
        result = whit_renderer_sample_costs(task->session->renderer, pixels, &cost);
    if (result != WHIT_OK || cost.rays == 0)
        return result;
    frame->visits = (double)(cost.inner_nodes + cost.leaves + cost.instances) / (double)cost.rays;
    frame->visits_rays = cost.rays;
    return WHIT_OK;
}

/* The parameters of the picture. They borrow the camera's text from session->settings. */
static whit_renderer_params task_params(const struct engine_task *task)
{
    struct session *session = task->session;
    session->settings = task->settings;
    whit_renderer_params params = session_picture(session);
    params.width = (params.width + task->divisor - 1) / task->divisor;
    params.height = (params.height + task->divisor - 1) / task->divisor;
    bool counts = task->settings.paint != PAINT_COLOR;
    if (task->quality != ENGINE_WHOLE || counts) {
        params.sampling.count = 1;
        params.sampling.kind = WHIT_SAMPLING_FIXED;
    }
    if (task->quality == ENGINE_QUICK && task->divisor > 1 && !counts)
        params.bailout = fmax(params.bailout, MOVING_BAILOUT);
    /* A kernel that is still to be made would hold up a moving picture. */
    params.few_pixels = task->moving;
    params.step_spacing = task->step_spacing;
    params.step_aov =
        shader_ref_find_aov(session->shader, session->settings.aov) + 1; /* 0: no such aov */
    return params;
}

/* A frame of the task, without pixels. */
static struct engine_frame begin_frame(const struct engine_task *task, uint32_t width,
                                       uint32_t height)
{
    const struct session *session = task->session;
    return (struct engine_frame){
        .settings = task->settings,
        .scene = scene_ref_take(session->scene),
        .shader = shader_ref_take(session->shader),
        .width = width,
        .height = height,
        .divisor = task->divisor,
        .bailout = session->settings.picture.bailout,
        .samples = 1,
        .moving = task->moving,
        .asked_ms = task->asked_ms,
        .accel = session->accel_info,
        .device = session->device_info,
        .build_ms = session->build_ms,
        .compile_ms = session->compile_ms,
        .made = session->made,
        .visits = -1.0,
    };
}

whit_result engine_draw_step(const struct engine_task *task, const whit_step *step,
                             struct engine_frame *frame)
{
    const whit_renderer_params params = settings_picture(&task->settings);
    *frame = begin_frame(task, step->width, step->height);
    frame->divisor = step->spacing;
    frame->rgba = malloc((size_t)step->width * step->height * 4);
    if (!frame->rgba)
        return WHIT_ERROR_MEMORY;
    whit_result result = whit_image_create(step->width, step->height, 4, step->rgba, &frame->color);
    if (result == WHIT_OK) {
        if (shader_ref_find_aov(frame->shader, frame->settings.aov) == UINT32_MAX)
            whit_image_display_as(frame->color, &params);
        whit_image_display_bytes(frame->color, frame->rgba);
        whit_renderer_get_stats(task->session->renderer, &frame->stats);
    }
    return result;
}

static whit_result draw_as(struct session *session, const whit_renderer_params *params)
{
    whit_result result = whit_renderer_set_view(session->renderer, params);
    return result == WHIT_OK ? whit_renderer_render(session->renderer) : result;
}

whit_result engine_draw_again(const struct engine_task *task, whit_stats *stats)
{
    whit_renderer_params params = task_params(task);
    params.time_stages = false; /* time stamps take time */
    whit_result result = draw_as(task->session, &params);
    if (result == WHIT_OK)
        whit_renderer_get_stats(task->session->renderer, stats);
    return result;
}

/* Draws all samples of the task in one picture. */
static whit_result draw_all(const struct engine_task *task, const whit_renderer_params *params,
                            struct engine_frame *frame)
{
    whit_result result = draw_as(task->session, params);
    if (result == WHIT_OK)
        result = read_picture(task, frame);
    if (result == WHIT_OK)
        whit_renderer_get_stats(task->session->renderer, &frame->stats);
    return result;
}

whit_result engine_draw(const struct engine_task *task, struct engine_frame *frame)
{
    struct session *session = task->session;
    whit_renderer_params params = task_params(task);
    *frame = begin_frame(task, params.width, params.height);
    frame->bailout = params.bailout;
    if (params.sampling.count > 1)
        frame->samples = params.sampling.count;
    if (params.sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        frame->samples = 0;
    frame->whole = task->quality == ENGINE_WHOLE;
    params.reuse_rays = true;
    session->step = engine_show_step;
    session->step_user = (void *)task;
    double start_ms = whit_clock_ms();
    whit_result result =
        task->refine ? engine_refine_whole(task, frame) : draw_all(task, &params, frame);
    session->step = NULL;
    if (result == WHIT_OK)
        result = read_boxes(task, frame);
    if (result == WHIT_OK)
        result = count_visits(task, frame);
    for (uint32_t i = 0; i < 64 && whit_effect_name(i); ++i)
        frame->effects |= (uint64_t)whit_renderer_compiles(session->renderer, i) << i;
    frame->kernels = whit_device_kernels_made(session->device);
    /* If rays are reused, render_ms is still the time of tracing them. */
    frame->draw_ms = fmax(whit_clock_ms() - start_ms, frame->stats.render_ms);
    if (task->step_spacing > 0)
        frame->draw_ms /= STEPS_TAKE;
    return result;
}

void engine_frame_inherit(struct engine_frame *before, struct engine_frame *refined)
{
    if (!refined->refined || refined->ids)
        return;
    refined->ids = before->ids;
    refined->boxes = before->boxes;
    before->ids = NULL;
    before->boxes = NULL;
}

void engine_frame_finish(struct engine_frame *frame)
{
    whit_image_destroy(frame->color);
    whit_image_destroy(frame->plain);
    whit_image_destroy(frame->ids);
    whit_image_destroy(frame->cuts);
    free(frame->rgba);
    whit_memory_destroy(frame->boxes);
    scene_ref_drop(frame->scene);
    shader_ref_drop(frame->shader);
    *frame = (struct engine_frame){0};
}
