/* Creates and destroys references; renders pictures row by row, and ray trees of pixels. */
#include <float.h>
#include <stdlib.h>

#include "accel/pose.h"
#include "base/array.h"
#include "base/clock.h"
#include "base/color.h"
#include "base/threads.h"
#include "oracle/nearest.h"
#include "reference/tree.h"
#include "scene/pose.h"

enum { LIGHT_SAMPLES_DEFAULT = 16, BAND_ROWS = 16, BAND_ROWS_OF_THREAD = 4 };

static whit_result check_params(const whit_log *log, const struct scene *scene,
                                whit_renderer_params *params)
{
    if (params->sampling.kind == WHIT_SAMPLING_ADAPTIVE || params->effects_removed ||
        params->shader)
        return log_usage(
            log, "a reference picture has all effects, as many samples in every pixel, and no "
                 "functions of users");
    if (scene->pictures_dropped)
        return log_usage(log, "%s: its textures were dropped, no reference can be made from it",
                         scene->name);
    return params_check(log, params);
}

static bool has_alpha(const struct scene_texture *t)
{
    size_t count = (size_t)t->width * t->height;
    for (size_t i = 0; i < count; ++i) {
        if (t->rgba[4 * i + 3] != 255)
            return true;
    }
    return false;
}

/* Makes the mipmap levels of all textures that materials use. False: memory ran out. */
static bool make_levels(struct reference *r)
{
    const struct scene *scene = r->scene;
    r->levels = array_alloc_zeroed(scene->texture_count, sizeof *r->levels);
    mipmap_pieces(r->level_pieces);
    if (!r->levels || r->params.picture.minification != WHIT_MINIFICATION_MIPMAP)
        return r->levels != NULL;
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        for (int slot = 0; slot < SCENE_SLOT_COUNT; ++slot) {
            uint32_t texture = scene->materials[i].textures[slot].texture;
            enum mipmap_kind kind = mipmap_kind_of(&scene->materials[i], (enum scene_slot)slot);
            if (texture == SCENE_NONE || kind == MIPMAP_NONE || r->levels[texture][kind])
                continue;
            const struct scene_texture *t = &scene->textures[texture];
            r->levels[texture][kind] = mipmap_make(t->rgba, t->width, t->height, kind);
            if (!r->levels[texture][kind] && mipmap_levels(t->width, t->height) > 0)
                return false;
        }
    }
    return true;
}

static bool fill_tables(struct reference *r)
{
    const struct scene *scene = r->scene;
    r->placings = array_alloc(r->pose.instance_count, sizeof *r->placings);
    r->alphas = array_alloc(scene->texture_count, sizeof *r->alphas);
    r->light_ends = array_alloc(r->pose.light_count, sizeof *r->light_ends);
    if (!r->placings || !r->alphas || !r->light_ends)
        return false;
    for (uint32_t i = 0; i < r->pose.light_count; ++i)
        r->light_ends[i] = accel_light_end(r->accel, &r->pose, &r->pose.lights[i]);
    for (uint32_t i = 0; i < r->pose.instance_count; ++i) {
        r->placings[i].forward = r->pose.instances[i];
        if (!affine_invert(&r->pose.instances[i], &r->placings[i].inverse))
            r->placings[i].inverse = affine_identity(); /* never: poses have no such matrix */
    }
    for (uint32_t i = 0; i < scene->texture_count; ++i)
        r->alphas[i] = has_alpha(&scene->textures[i]);
    for (int i = 0; i < 256; ++i)
        r->linear[i] = linear_from_srgb(i / 255.0);
    return make_levels(r) && environment_resample(&scene->environment, &r->sky_size, &r->sky);
}

static whit_result create_parts(struct reference *r)
{
    whit_renderer_params *params = &r->params.picture;
    whit_result result = scene_pose_init(r->scene, params->time_s, &r->pose);
    if (result == WHIT_OK)
        result = accel_pose(r->accel, &r->pose);
    if (result == WHIT_OK)
        result = media_view(&r->log, r->accel, &r->pose, &params->camera, params->width,
                            params->height, &r->frame, &r->camera);
    if (result == WHIT_OK && !fill_tables(r)) {
        log_error(&r->log, "out of memory for the reference");
        result = WHIT_ERROR_MEMORY;
    }
    r->light_samples = params->light_samples ? params->light_samples : LIGHT_SAMPLES_DEFAULT;
    r->bailout = params->bailout > 0.0 ? params->bailout : DBL_MIN;
    return result;
}

whit_result reference_create(const whit_log *log, struct accel *accel,
                             const struct reference_params *params, struct reference **out)
{
    *out = NULL;
    struct reference *r = calloc(1, sizeof *r);
    if (!r)
        return log_failure(log, WHIT_ERROR_MEMORY, "out of memory for the reference");
    r->log = log_or_silence(log);
    r->accel = accel;
    r->scene = accel->scene;
    r->params = *params;
    whit_result result = check_params(log, r->scene, &r->params.picture);
    if (result == WHIT_OK)
        result = create_parts(r);
    if (result != WHIT_OK) {
        reference_destroy(r);
        return result;
    }
    *out = r;
    return WHIT_OK;
}

void reference_destroy(struct reference *r)
{
    if (!r)
        return;
    scene_pose_finish(&r->pose);
    for (uint32_t i = 0; r->levels && i < r->scene->texture_count; ++i) {
        for (int kind = 0; kind <= MIPMAP_COVER; ++kind)
            free(r->levels[i][kind]);
    }
    free(r->levels);
    free(r->placings);
    free(r->alphas);
    free(r->sky);
    free(r->light_ends);
    free(r);
}

/* ---- Pictures ---- */

struct job {
    const struct reference *reference;
    struct image *color, *ids;
    struct tracer *rows; /* a tracer for each row of the band, with its statistics */
    uint32_t first_row;
};

static bool stopped(const struct reference *r)
{
    return r->params.picture.cancel && *r->params.picture.cancel;
}

static void draw_pixel(const struct job *job, struct tracer *tracer, uint32_t x, uint32_t y)
{
    const whit_renderer_params *params = &job->reference->params.picture;
    size_t pixel = (size_t)y * params->width + x;
    struct dvec3 sum = d3_all(0.0),
                 partial[SEQUENCE_BITS + 1]; /* sums of 2^i samples, as in resolve.comp */
    for (uint32_t i = 0; i < params->sampling.count; ++i) {
        struct hit first = {.primitive = HIT_NONE, .instance = HIT_NONE};
        tracer->sample = params->sampling.first + i;
        sum = tree_trace(tracer, x, y, &first);
        uint32_t level = 0;
        bool last = i + 1 == params->sampling.count;
        for (; last ? i >> level : i >> level & 1u; ++level)
            if (i >> level & 1u)
                sum = d3_add(partial[level], sum);
        partial[level] = sum;
        if (i == 0 && job->ids) {
            job->ids->words[2 * pixel] = first.instance;
            job->ids->words[2 * pixel + 1] = first.primitive;
        }
    }
    sum = d3_scale(sum, 1.0 / params->sampling.count);
    float *out = &job->color->pixels[4 * pixel];
    out[0] = (float)sum.x;
    out[1] = (float)sum.y;
    out[2] = (float)sum.z;
    out[3] = 1.0f;
}

static void draw_row(void *user, uint32_t index)
{
    struct job *job = user;
    struct tracer tracer = {.reference = job->reference};
    for (uint32_t x = 0; x < job->reference->params.picture.width; ++x) {
        if (tracer.lacks_memory || stopped(job->reference))
            break;
        draw_pixel(job, &tracer, x, job->first_row + index);
    }
    tree_finish(&tracer);
    job->rows[index] = tracer;
}

static void add_rays(const struct tracer *from, whit_stats *to)
{
    to->rays_primary += from->rays[RAY_PRIMARY];
    to->rays_shadow += from->rays[RAY_SHADOW];
    to->rays_reflected += from->rays[RAY_REFLECTED];
    to->rays_refracted += from->rays[RAY_REFRACTED];
    to->rays_straight += from->rays[REFERENCE_STRAIGHT];
    to->rays_cut_depth += from->cut_depth;
    to->rays_cut_bailout += from->cut_bailout;
}

static whit_result tracer_result(const struct reference *r, const struct tracer *tracer)
{
    if (tracer->lacks_memory)
        return log_failure(&r->log, WHIT_ERROR_MEMORY, "out of memory for the rays of a pixel");
    if (tracer->too_many_media)
        return log_failure(&r->log, WHIT_ERROR_STATUS, "a ray is in more than %u media at once",
                           MEDIA_MAX);
    return WHIT_OK;
}

/* Draws all rows, band by band; between bands the caller's thread reports progress. */
static whit_result draw_bands(struct job *job, uint32_t band_rows, double start_ms,
                              whit_stats *stats)
{
    const struct reference *r = job->reference;
    const whit_renderer_params *params = &r->params.picture;
    whit_result result = WHIT_OK;
    for (uint32_t y = 0; result == WHIT_OK && y < params->height; y += band_rows) {
        uint32_t rows = params->height - y < band_rows ? params->height - y : band_rows;
        job->first_row = y;
        threads_for(r->params.thread_count, rows, draw_row, job);
        for (uint32_t i = 0; result == WHIT_OK && i < rows; ++i) {
            result = tracer_result(r, &job->rows[i]);
            add_rays(&job->rows[i], stats);
        }
        if (result == WHIT_OK && stopped(r))
            result = WHIT_ERROR_CANCELLED;
        if (result == WHIT_OK && params->time_limit_s > 0.0 &&
            clock_ms() - start_ms > 1000.0 * params->time_limit_s)
            result = WHIT_ERROR_TIME_LIMIT;
        if (result == WHIT_OK && params->progress)
            params->progress(params->progress_user, (double)(y + rows) / params->height);
    }
    return result;
}

whit_result reference_render(const struct reference *r, struct image *color, struct image *ids,
                             whit_stats *stats)
{
    const whit_renderer_params *params = &r->params.picture;
    double start_ms = clock_ms();
    uint32_t threads = r->params.thread_count ? r->params.thread_count : threads_available();
    uint32_t band_rows =
        threads > BAND_ROWS / BAND_ROWS_OF_THREAD ? threads * BAND_ROWS_OF_THREAD : BAND_ROWS;
    *stats = (whit_stats){0};
    *color = (struct image){0};
    if (ids)
        *ids = (struct image){0};
    struct job job = {.reference = r, .color = color, .ids = ids};
    whit_result result = accel_pose_again(r->accel, &r->pose);
    if (result == WHIT_OK && !(job.rows = array_alloc_zeroed(band_rows, sizeof *job.rows))) {
        log_error(&r->log, "out of memory for the reference");
        result = WHIT_ERROR_MEMORY;
    }
    if (result == WHIT_OK)
        result = image_init_logged(&r->log, color, params->width, params->height, 4, false);
    if (result == WHIT_OK && ids)
        result = image_init_logged(&r->log, ids, params->width, params->height, 2, true);
    if (result == WHIT_OK)
        result = draw_bands(&job, band_rows, start_ms, stats);
    free(job.rows);
    stats->render_ms = clock_ms() - start_ms;
    if (result != WHIT_OK) {
        image_finish(color);
        image_finish(ids);
    }
    return result;
}

whit_result reference_ray_tree(const struct reference *r, uint32_t x, uint32_t y, uint32_t sample,
                               struct reference_ray **rays, uint32_t *count)
{
    const whit_renderer_params *params = &r->params.picture;
    struct tracer tracer = {.reference = r, .sample = sample, .records = true};
    struct hit first;
    *rays = NULL;
    *count = 0;
    if (x >= params->width || y >= params->height || sample >= params->sampling.count)
        return log_usage(&r->log,
                         "pixel %u,%u, sample %u: the picture has %ux%u pixels of %u samples", x, y,
                         sample, params->width, params->height, params->sampling.count);
    whit_result result = accel_pose_again(r->accel, &r->pose);
    if (result != WHIT_OK)
        return result;
    tree_trace(&tracer, x, y, &first);
    result = tracer_result(r, &tracer);
    if (result == WHIT_OK) {
        *rays = tracer.nodes;
        *count = tracer.node_count;
        tracer.nodes = NULL;
    }
    tree_finish(&tracer);
    return result;
}
