/* Refined pictures: each step draws as many samples as there are already, and takes the mean of
   both halves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "image/estimate.h"
#include "shader/program.h"

/* The picture of some of the samples, as means over them, and what drawing it took. */
struct part {
    struct image color;
    struct image cuts;                  /* WHIT_AOV_CUTS */
    struct image aovs[WHIT_LAYERS_MAX]; /* the shader's AOVs */
    uint32_t aov_count;                 /* 0 after whit_refine_begin, whose samples have no AOVs */
    whit_stats stats;
    double unshadowed; /* the part of the bail-out's bound that does not grow with cut weights */
};

struct whit_refine {
    whit_renderer *renderer; /* borrowed */
    whit_renderer_params params;
    whit_log log;
    uint32_t samples;
    bool cut;            /* some rays were cut, by depth or bail-out */
    bool radiance_known; /* cut_radiance was measured; needed if `cut` */
    double cut_radiance; /* assumed mean radiance of cut rays */
    struct part mean;    /* of all samples; its stats are sums */
    struct estimate estimate;
    struct image errors; /* by estimate_error, from 2 samples on */
    double error, error_of_cuts;
};

/* A bail-out larger than the weight of any ray that a material sends on, so that camera rays send
   none. It is no larger, because a bail-out also ends shadow rays: with this one those that add at
   most BAILOUT_ALL * BAILOUT_SHADOW_SHARE, a thousandth, of their light. */
static const double BAILOUT_ALL = 16.0;

_Static_assert(WHIT_SAMPLES_MAX == 1 << ESTIMATE_DOUBLINGS_MAX, "doublings that are kept");

whit_result whit_refine_create(whit_renderer *renderer, const whit_renderer_params *params,
                               whit_refine **out)
{
    *out = NULL;
    whit_result result = api_need_device(renderer);
    if (result != WHIT_OK)
        return result;
    if (shader_has(renderer->params.shader, WHIT_HOOK_POST))
        return API_FAIL(&renderer->log, WHIT_ERROR_USAGE,
                        "what `post` of the shader makes of the mean of samples is not the "
                        "mean of what it makes of them: such a picture is not refined");
    if (renderer->params.color_only)
        return API_FAIL(&renderer->log, WHIT_ERROR_USAGE,
                        "the renderer keeps colours alone (color_only), and errors are estimated "
                        "from more: its picture is not refined");
    whit_refine *refine = calloc(1, sizeof *refine);
    if (!refine)
        return API_FAIL(&renderer->log, WHIT_ERROR_MEMORY, "out of memory");
    refine->log = renderer->log;
    whit_refine_move(refine, renderer, params);
    result = params_check(&refine->log, &refine->params);
    if (result == WHIT_OK)
        result = whit_renderer_set_view(renderer, &refine->params);
    if (result == WHIT_OK)
        *out = refine;
    else
        whit_refine_destroy(refine);
    return result;
}

void whit_refine_move(whit_refine *refine, whit_renderer *renderer,
                      const whit_renderer_params *params)
{
    refine->renderer = renderer;
    refine->params = api_params(params);
    refine->params.sampling = (whit_sampling){.count = 1};
    refine->params.first_row = refine->params.row_count = 0; /* the whole picture */
}

static void part_finish(struct part *part)
{
    image_finish(&part->color);
    image_finish(&part->cuts);
    for (uint32_t i = 0; i < part->aov_count; ++i)
        image_finish(&part->aovs[i]);
}

void whit_refine_destroy(whit_refine *refine)
{
    if (!refine)
        return;
    part_finish(&refine->mean);
    estimate_finish(&refine->estimate);
    image_finish(&refine->errors);
    free(refine);
}

/* ---- Parts ---- */

static whit_result draw_part(const whit_refine *refine, uint32_t first, uint32_t count,
                             double bailout, struct part *part)
{
    whit_renderer_params params = refine->params;
    params.sampling = (whit_sampling){.first = first, .count = count};
    params.bailout = bailout;
    whit_result result = whit_renderer_set_view(refine->renderer, &params);
    if (result == WHIT_OK)
        result = whit_renderer_render(refine->renderer);
    if (result == WHIT_OK)
        result = renderer_read_color(refine->renderer->renderer, &part->color);
    if (result == WHIT_OK)
        result = renderer_read_cuts(refine->renderer->renderer, &part->cuts);
    uint32_t aovs = params.shader ? params.shader->aov_count : 0;
    for (; result == WHIT_OK && part->aov_count < aovs; part->aov_count++)
        result = renderer_read_aov(refine->renderer->renderer, part->aov_count,
                                   &part->aovs[part->aov_count]);
    if (result == WHIT_OK)
        whit_renderer_get_stats(refine->renderer, &part->stats);
    part->unshadowed = bailout_bound(refine->renderer->renderer, 0.0);
    return result;
}

/* Makes `image` the mean of two images with equal numbers of samples, by the operations of
   resolve.comp. */
static void add_half(struct image *image, const struct image *half)
{
    size_t count = (size_t)image->width * image->height * image->channels;
    for (size_t i = 0; i < count; ++i)
        image->pixels[i] = 0.5f * (image->pixels[i] + half->pixels[i]);
}

static bool is_any_cut(const struct image *cuts)
{
    size_t count = (size_t)cuts->width * cuts->height * 2;
    for (size_t i = 0; i < count; ++i) {
        if (cuts->pixels[i] > 0.0f)
            return true;
    }
    return false;
}

/* ---- Steps ---- */

/* Starts with the first part, whose images it takes over. */
static whit_result begin(whit_refine *refine, uint32_t samples, struct part *part)
{
    struct image *color = &part->color;
    whit_result result = estimate_init(&refine->estimate, color->width, color->height);
    if (result == WHIT_OK)
        result =
            image_init_logged(&refine->log, &refine->errors, color->width, color->height, 1, false);
    if (result != WHIT_OK) {
        estimate_finish(&refine->estimate);
        return result;
    }
    refine->mean = *part;
    *part = (struct part){0};
    refine->samples = samples;
    refine->cut = is_any_cut(&refine->mean.cuts);
    return WHIT_OK;
}

whit_result whit_refine_begin(whit_refine *refine, uint32_t samples, const float *color,
                              const float *cuts)
{
    const whit_renderer_params *params = &refine->params;
    struct part part = {0};
    if (refine->samples > 0 || samples == 0)
        return API_FAIL(&refine->log, WHIT_ERROR_USAGE,
                        "a picture can be refined from its first sample on, and once");
    if (samples > WHIT_SAMPLES_MAX)
        return API_FAIL(&refine->log, WHIT_ERROR_USAGE, "%u samples to begin with: at most %d",
                        samples, WHIT_SAMPLES_MAX);
    size_t pixels = (size_t)params->width * params->height;
    if (pixels == 0)
        return API_FAIL(&refine->log, WHIT_ERROR_USAGE, "the picture has no size to begin with");
    whit_result result =
        image_init_logged(&refine->log, &part.color, params->width, params->height, 4, false);
    if (result == WHIT_OK)
        result =
            image_init_logged(&refine->log, &part.cuts, params->width, params->height, 2, false);
    if (result == WHIT_OK) {
        memcpy(part.color.pixels, color, pixels * 4 * sizeof *color);
        memcpy(part.cuts.pixels, cuts, pixels * 2 * sizeof *cuts);
        result = begin(refine, samples, &part);
    }
    part_finish(&part);
    return result;
}

static void add_part(whit_refine *refine, const struct part *part)
{
    const struct image *const halves[2] = {&refine->mean.color, &part->color};
    estimate_note_change(&refine->estimate, halves, refine->samples);
    add_half(&refine->mean.color, &part->color);
    add_half(&refine->mean.cuts, &part->cuts);
    for (uint32_t i = 0; i < refine->mean.aov_count; ++i)
        add_half(&refine->mean.aovs[i], &part->aovs[i]);
    whit_stats_add(&part->stats, &refine->mean.stats);
    refine->mean.unshadowed = part->unshadowed;
    refine->samples *= 2;
}

static void take_radiance(whit_refine *refine, const struct part *part)
{
    refine->cut_radiance = estimate_cut_radiance(&refine->mean.color, &part->color, &part->cuts);
    refine->radiance_known = true;
    refine->mean.stats.render_ms += part->stats.render_ms;
    if (refine->mean.stats.render_device_ms >= 0.0 && part->stats.render_device_ms >= 0.0)
        refine->mean.stats.render_device_ms += part->stats.render_device_ms;
    refine->mean.stats.rays_of_estimate = whit_stats_rays(&part->stats);
    api_set_rate(&refine->mean.stats);
}

static bool is_last(const whit_refine *refine)
{
    return refine->samples > WHIT_SAMPLES_MAX / 2;
}

/* Whether an error can be estimated: only after samples were doubled. */
static bool is_told(const whit_refine *refine)
{
    return refine->estimate.doublings > 0;
}

whit_result whit_refine_step(whit_refine *refine)
{
    struct part part = {0};
    uint32_t samples = refine->samples;
    bool radiance = refine->cut && !refine->radiance_known;
    if (is_last(refine))
        return API_FAIL(&refine->log, WHIT_ERROR_USAGE, "a pixel has no more than %d samples",
                        WHIT_SAMPLES_MAX);
    whit_result result =
        radiance ? draw_part(refine, 0, 1, BAILOUT_ALL, &part)
                 : draw_part(refine, samples, samples ? samples : 1, refine->params.bailout, &part);
    if (result == WHIT_OK && radiance)
        take_radiance(refine, &part);
    else if (result == WHIT_OK && samples == 0)
        result = begin(refine, 1, &part);
    else if (result == WHIT_OK)
        add_part(refine, &part);
    part_finish(&part);
    if (result != WHIT_OK)
        return result;
    refine->cut = is_any_cut(&refine->mean.cuts);
    if (is_told(refine))
        refine->error =
            estimate_error(&refine->estimate, &refine->mean.color, &refine->mean.cuts,
                           refine->cut_radiance, &refine->errors, &refine->error_of_cuts);
    return WHIT_OK;
}

/* ---- Results ---- */

void whit_refine_get_info(const whit_refine *refine, whit_refine_info *info)
{
    *info = (whit_refine_info){.samples = refine->samples,
                               .error = is_told(refine) ? refine->error : -1.0,
                               .error_of_cuts = is_told(refine) ? refine->error_of_cuts : -1.0,
                               .cut_radiance = refine->cut_radiance,
                               .last = is_last(refine)};
}

static whit_result copy(const whit_refine *refine, const struct image *from, whit_image **out)
{
    whit_result result =
        whit_image_create(from->width, from->height, from->channels, from->pixels, out);
    if (result != WHIT_OK)
        log_error(&refine->log, "out of memory");
    return result;
}

whit_result whit_refine_image(const whit_refine *refine, whit_image **out)
{
    *out = NULL;
    if (refine->samples == 0)
        return API_FAIL(&refine->log, WHIT_ERROR_USAGE, "no picture was rendered yet");
    whit_result result = copy(refine, &refine->mean.color, out);
    if (result == WHIT_OK)
        whit_image_display_as(*out, &refine->params);
    return result;
}

whit_result whit_refine_aov(const whit_refine *refine, uint32_t index, whit_image **out)
{
    *out = NULL;
    if (index < refine->mean.aov_count)
        return copy(refine, &refine->mean.aovs[index], out);
    return API_FAIL(&refine->log, WHIT_ERROR_USAGE,
                    "there is no function %u of the shader in all samples", index);
}

whit_result whit_refine_error_image(const whit_refine *refine, whit_image **out)
{
    *out = NULL;
    if (!is_told(refine))
        return API_FAIL(&refine->log, WHIT_ERROR_USAGE,
                        "an error can be told once samples were doubled");
    return copy(refine, &refine->errors, out);
}

static double largest(const struct image *cuts, size_t channel)
{
    float max = 0.0f;
    size_t count = (size_t)cuts->width * cuts->height;
    for (size_t i = 0; i < count; ++i)
        max = fmaxf(max, cuts->pixels[2 * i + channel]);
    return (double)max;
}

/* Sets the largest cut weights anew, from the mean of all samples: the sums over steps are too
   large, since each step may have its largest weight in another pixel. */
void whit_refine_get_stats(const whit_refine *refine, whit_stats *stats)
{
    *stats = refine->mean.stats;
    if (refine->samples == 0)
        return;
    double bailout = largest(&refine->mean.cuts, 1), unshadowed = refine->mean.unshadowed;
    if (stats->bailout_bound > 0.0 && stats->weight_cut_bailout > 0.0)
        stats->bailout_bound =
            unshadowed + (stats->bailout_bound - unshadowed) * bailout / stats->weight_cut_bailout;
    stats->weight_cut_bailout = bailout;
    stats->weight_cut_depth = largest(&refine->mean.cuts, 0);
    memset(stats->pixels_by_samples, 0, sizeof stats->pixels_by_samples);
    uint32_t level = 0;
    while (1u << (2 * level) < refine->samples)
        ++level;
    stats->pixels_by_samples[level] =
        (uint64_t)refine->mean.color.width * refine->mean.color.height;
}
