#include "app/check/draw.h"

#include <stdlib.h>
#include <string.h>

#include "app/check/describe.h"
#include "app/render/render_command.h"
#include "base/array.h"

struct studio_tree {
    struct settings settings;
    whit_accel *accel;
};
struct studio_scene {
    struct settings settings;
    whit_scene *scene;
    struct studio_tree *trees;
    uint32_t tree_count, tree_capacity;
};

/* ---- The device ---- */

static bool any_compiles(const struct studio *studio)
{
    for (uint32_t i = 0; i < studio->suite->count; ++i) {
        if (studio->wanted[i] && settings_compiles(studio->suite->cases[i].settings))
            return true;
    }
    return false;
}

whit_result studio_open(struct studio *studio, enum golden_kind kind, const struct settings *common,
                        const struct suite *suite, const bool *wanted, const whit_log *log)
{
    *studio =
        (struct studio){.suite = suite, .wanted = wanted, .job = {.settings = *common, .log = log}};
    whit_result result = WHIT_OK;
    if (kind == GOLDEN_OF_REFERENCE)
        return WHIT_OK;
    /* The compiler's process is forked with the memory that this one has now. */
    if (any_compiles(studio))
        result = job_begin_compiler(&studio->job, log);
    if (result == WHIT_OK)
        result = job_open_device(&studio->job);
    if (studio->job.device)
        whit_device_keep_kernels(studio->job.device);
    return result;
}

/* ---- What cases share ---- */

static void finish_scene(struct studio_scene *scene)
{
    for (uint32_t i = 0; i < scene->tree_count; ++i)
        whit_accel_destroy(scene->trees[i].accel);
    free(scene->trees);
    whit_scene_destroy(scene->scene);
}

static void drop_renderer(struct studio *studio)
{
    whit_renderer_destroy(studio->renderer);
    studio->renderer = NULL;
}

static bool is_needed(const struct studio *studio, const struct settings *settings, uint32_t from)
{
    uint32_t first = studio->backwards ? 0 : from;
    uint32_t end = studio->backwards ? from + 1 : studio->suite->count;
    for (uint32_t i = first; i < end; ++i) {
        if (studio->wanted[i] && settings_same_scene(settings, studio->suite->cases[i].settings))
            return true;
    }
    return false;
}

/* Frees scenes that neither case `from` nor a later one uses. */
static void drop_scenes(struct studio *studio, uint32_t from)
{
    for (uint32_t i = studio->scene_count; i-- > 0;) {
        struct studio_scene *scene = &studio->scenes[i];
        if (is_needed(studio, &scene->settings, from))
            continue;
        if (studio->renderer && settings_same_scene(&scene->settings, &studio->drawn_as))
            drop_renderer(studio);
        finish_scene(scene);
        *scene = studio->scenes[--studio->scene_count];
    }
}

/* Gives the job its scene, which is loaded unless an earlier case did so. */
static whit_result take_scene(struct studio *studio, struct job *job, struct studio_scene **out)
{
    for (uint32_t i = 0; i < studio->scene_count; ++i) {
        *out = &studio->scenes[i];
        job->scene = (*out)->scene;
        if (settings_same_scene(&(*out)->settings, &job->settings))
            return job_take_scene(job);
    }
    struct studio_scene scene = {.settings = job->settings};
    job->scene = NULL;
    whit_result result = job_load(job);
    scene.scene = job->scene;
    if (result == WHIT_OK)
        job_print_notes(job, false);
    if (scene.scene &&
        !ARRAY_PUSH(studio->scenes, studio->scene_count, studio->scene_capacity, scene)) {
        finish_scene(&scene);
        return cli_no_memory();
    }
    *out = scene.scene ? &studio->scenes[studio->scene_count - 1] : NULL;
    return result;
}

/* Gives the job trees over its scene, which are built unless an earlier case did so. */
static whit_result take_trees(struct job *job, struct studio_scene *scene)
{
    for (uint32_t i = 0; i < scene->tree_count; ++i) {
        job->accel = scene->trees[i].accel;
        if (settings_same_trees(&scene->trees[i].settings, &job->settings))
            return WHIT_OK;
    }
    job->accel = NULL;
    whit_result result = job_build(job);
    struct studio_tree tree = {job->settings, job->accel};
    if (!tree.accel || ARRAY_PUSH(scene->trees, scene->tree_count, scene->tree_capacity, tree))
        return result;
    whit_accel_destroy(tree.accel);
    return cli_no_memory();
}

/* Compiles the case's functions, unless those of the case before, drawn or not, are the same. */
static whit_result take_shader(struct studio *studio, struct job *job)
{
    bool same = settings_same_shader(&studio->drawn_as, &job->settings) &&
                (studio->job.shader || !settings_compiles(&job->settings));
    if (!same) {
        studio->drawn_as = job->settings;
        drop_renderer(studio);
        whit_shader_destroy(studio->job.shader);
        studio->job.shader = NULL;
        job->compiler = studio->job.compiler;
        job->shader = NULL;
        whit_result result = job_load_shader(job);
        studio->job.shader = job->shader;
        if (result != WHIT_OK)
            return result;
    }
    job->shader = studio->job.shader;
    return layers_check(job) ? WHIT_OK : WHIT_ERROR_USAGE;
}

/* ---- A picture ---- */

/* WHIT_ERROR_USAGE, with a message, where the job has no device and its settings ask for something
   that the reference cannot draw. */
static whit_result reference_check(const struct job *job)
{
    const struct settings *settings = &job->settings;
    const whit_overlay over = settings_overlay(settings);
    const struct {
        bool asked;
        const char *option;
    } refused[] = {
        {settings->shader[0], "--shader"},
        {settings->paint != PAINT_COLOR, "--view"},
        {over.grid, "--grid"},
        {over.edges_of_instances || over.edges_of_primitives, "--edges"},
        {settings->picture.sampling.kind == WHIT_SAMPLING_ADAPTIVE, "--aa adaptive"},
        {settings->picture.effects_removed, "--effects without some"},
    };
    for (size_t i = 0; !job->device && i < sizeof refused / sizeof *refused; ++i) {
        if (!refused[i].asked)
            continue;
        return CLI_FAIL(WHIT_ERROR_USAGE, "%s: the reference does not draw it, a device does",
                        refused[i].option);
    }
    return WHIT_OK;
}

/* Makes a renderer, which the caller owns, for the drawing's job and params, or the drawing's
   reference where the job has no device. */
static whit_result make(struct drawing *drawing, whit_renderer **renderer)
{
    const struct job *job = &drawing->job;
    return job->device
               ? whit_renderer_create(job->device, job->accel, &drawing->params, renderer)
               : whit_reference_create(job->accel, &drawing->params, 0, &drawing->reference);
}

/* Gives the drawing a renderer: that of the case before where it has the same kernels, else a new
   one. */
static whit_result make_renderer(struct studio *studio, struct drawing *drawing, bool counts)
{
    const struct job *job = &drawing->job;
    drawing->params = job_picture(job);
    drawing->params.count |= counts;
    bool same = studio->renderer && studio->counted == drawing->params.count &&
                settings_same_kernel(&studio->drawn_as, &job->settings);
    whit_result result;
    if (same) {
        result = whit_renderer_set_view(studio->renderer, &drawing->params);
    } else {
        drop_renderer(studio);
        result = make(drawing, &studio->renderer);
    }
    studio->counted = drawing->params.count;
    studio->drawn_as = job->settings;
    drawing->renderer = studio->renderer;
    return result;
}

/* Reads what the case paints: costs as numbers, an aov of the shader, or colours with overlays. */
static whit_result read_color(struct drawing *drawing)
{
    const struct settings *settings = &drawing->job.settings;
    const whit_shader_info info = job_shader_info(settings->aov[0] ? drawing->job.shader : NULL);
    whit_aov aov = WHIT_AOV_COLOR;
    if (settings->paint != PAINT_COLOR)
        return whit_renderer_cost_image(drawing->renderer,
                                        (whit_view)(settings->paint - PAINT_DEPTH),
                                        (whit_ray_kind)settings->paint_rays, &drawing->color);
    for (uint32_t i = 0; i < info.aov_count; ++i) {
        if (strcmp(info.aovs[i], settings->aov) == 0)
            aov = (whit_aov)(WHIT_AOV_SHADER + i);
    }
    whit_result result = whit_renderer_image(drawing->renderer, aov, &drawing->color);
    const whit_overlay overlay = settings_overlay(settings);
    return result == WHIT_OK && aov == WHIT_AOV_COLOR
               ? whit_renderer_draw_over(drawing->renderer, &overlay, drawing->color)
               : result;
}

static whit_result check_expected(struct drawing *drawing)
{
    bool held;
    whit_result result = whit_renderer_check_expectations(drawing->renderer, &held);
    return result == WHIT_OK && !held ? WHIT_ERROR_FAILED : result;
}

static whit_result render_by_reference(struct drawing *drawing)
{
    whit_result result = whit_reference_render(drawing->reference, &drawing->color, &drawing->ids);
    whit_reference_get_stats(drawing->reference, &drawing->stats);
    return result;
}

static whit_result render_by_device(struct drawing *drawing)
{
    whit_result result = whit_renderer_render(drawing->renderer);
    if (result == WHIT_OK)
        result = check_expected(drawing);
    if (result != WHIT_OK)
        return result;
    whit_renderer_get_stats(drawing->renderer, &drawing->stats);
    result = read_color(drawing);
    return result == WHIT_OK ? whit_renderer_image(drawing->renderer, WHIT_AOV_IDS, &drawing->ids)
                             : result;
}

/* Renders, reads what the drawing's settings ask for, and hashes it. */
static whit_result render(struct drawing *drawing)
{
    whit_result result =
        drawing->reference ? render_by_reference(drawing) : render_by_device(drawing);
    if (result != WHIT_OK)
        return result;
    drawing->color_hash = drawing_hash_floats(drawing->color);
    drawing->ids_hash = drawing_hash_ids(drawing->ids);
    return WHIT_OK;
}

bool drawing_same(const struct drawing *a, const struct drawing *b)
{
    return a->color_hash == b->color_hash && a->ids_hash == b->ids_hash;
}

struct settings studio_settings(const struct studio *studio, const struct check_case *item)
{
    const struct settings *common = &studio->job.settings;
    struct settings settings = *item->settings;
    memcpy(settings.device, common->device, sizeof settings.device);
    settings.load.require_sandbox = common->load.require_sandbox;
    settings.validation = common->validation;
    settings.no_cache = common->no_cache;
    settings.time_limit_s = common->time_limit_s;
    settings.quiet = common->quiet;
    return settings;
}

struct job studio_input(const struct studio *studio, const struct check_case *item,
                        const struct drawing *drawing)
{
    return (struct job){.settings = studio_settings(studio, item),
                        .scene = drawing->job.scene,
                        .shader = drawing->job.shader,
                        .device = studio->job.device};
}

whit_result studio_draw(struct studio *studio, uint32_t index, bool counts, struct drawing *drawing)
{
    struct studio_scene *scene;
    *drawing = (struct drawing){
        .job = {.settings = studio_settings(studio, &studio->suite->cases[index])}};
    struct job *job = &drawing->job;
    job->device = studio->job.device;
    drop_scenes(studio, index);
    whit_result result = reference_check(job);
    if (result == WHIT_OK)
        result = take_shader(studio, job);
    if (result == WHIT_OK)
        result = take_scene(studio, job, &scene);
    if (result == WHIT_OK)
        result = render_check_camera(job);
    if (result == WHIT_OK)
        result = take_trees(job, scene);
    if (result == WHIT_OK)
        result = make_renderer(studio, drawing, counts);
    if (result == WHIT_OK)
        result = render(drawing);
    if (result != WHIT_OK)
        drop_renderer(studio);
    return result == WHIT_OK ? job_still_wanted() : result;
}

void drawing_finish(struct drawing *drawing)
{
    whit_image_destroy(drawing->color);
    whit_image_destroy(drawing->ids);
    whit_reference_destroy(drawing->reference);
    *drawing = (struct drawing){.renderer = NULL};
}

/* ---- Other pictures ---- */

whit_result trial_draw(struct drawing *drawing, const struct job *input)
{
    struct job *job = &drawing->job;
    *drawing = (struct drawing){.job = *input};
    whit_result result = reference_check(job);
    if (result == WHIT_OK)
        result = job_take_scene(job);
    if (result == WHIT_OK)
        result = render_check_camera(job);
    if (result == WHIT_OK)
        result = job_build(job);
    if (result == WHIT_OK) {
        drawing->params = job_picture(job);
        result = make(drawing, &drawing->renderer);
    }
    if (result == WHIT_OK)
        result = render(drawing);
    return result == WHIT_OK ? job_still_wanted() : result;
}

void trial_finish(struct drawing *drawing)
{
    whit_accel *accel = drawing->job.accel;
    whit_renderer_destroy(drawing->renderer);
    drawing_finish(drawing);
    whit_accel_destroy(accel);
}

bool trial_ends_all(whit_result result)
{
    return result == WHIT_ERROR_NO_DEVICE || result == WHIT_ERROR_DEVICE ||
           result == WHIT_ERROR_MEMORY || result == WHIT_ERROR_TIME_LIMIT ||
           result == WHIT_ERROR_CANCELLED;
}

void studio_forget(struct studio *studio)
{
    drop_renderer(studio);
    whit_shader_destroy(studio->job.shader);
    studio->job.shader = NULL;
    while (studio->scene_count > 0)
        finish_scene(&studio->scenes[--studio->scene_count]);
}

void studio_close(struct studio *studio)
{
    studio_forget(studio);
    free(studio->scenes);
    job_finish(&studio->job);
}
