#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/cost/cost_choice.h"
#include "app/render/recipe.h"
#include "app/render/render_command.h"
#include "app/render/resume.h"
#include "app/render/stats.h"
#include "base/file.h"
#include "base/path.h"
#include "base/text.h"

enum { CAMERA_NAMES_MAX = 4096 };

static const struct setting options[] = {
    {"output", 'o', "FILE", "the picture: .png (8 bits), .exr or .pfm (floats)",
     SETTING_AT_NAME(struct render_request, output), .written = true},
    {"ids", 0, "FILE.exr", "also write what each pixel hits: instance, primitive",
     SETTING_AT_NAME(struct render_request, ids), .written = true},
    {"frames", 0, "A-B",
     "frames A to B of the animation, into files with the\n"
     "number in place of ####: -o name.####.png",
     .kind = SETTING_OWN, .read = frames_read},
    {"cameras", 0, "FILE",
     "small pictures of many cameras, drawn together, into files with\n"
     "the number in place of ####; FILE: JSON, cameras in [ ] or one\n"
     "a line, as scene files have them",
     SETTING_AT_NAME(struct render_request, cameras.file)},
    {"distances", 0, "FILE",
     "of --cameras: also write how far away each pixel is, .exr or\n"
     ".pfm, with ####",
     SETTING_AT_NAME(struct render_request, cameras.distances), .written = true},
    {"tile", 0, "I/N",
     "tile I of N alone, rows over the whole width, with its place;\n"
     "`whit merge` puts tiles together, see docs/batch.md",
     .kind = SETTING_OWN, .read = part_read_tile},
    {"samples-part", 0, "I/N",
     "run I of N of the samples alone, as sums, in .exr or .pfm;\n"
     "N: a power of 4 that divides the samples",
     .kind = SETTING_OWN, .read = part_read_samples},
    {"resume", 0, NULL,
     "keep files that are finished, by their recipes, and draw the\n"
     "others; processes with the same files share them, see\n"
     "docs/batch.md",
     SETTING_AT_FLAG(struct render_request, resume)},
    {"thumbnail", 0, "N",
     "for file managers: N x N pixels, and a PNG whatever the\n"
     "picture is called; says errors only",
     SETTING_AT_COUNT(struct render_request, thumbnail), .min = 1, .max = 4096},
    {"refine", 0, "ERROR|MSms",
     "1, 2, 4, 8 ... samples, until by an estimate no more than an\n"
     "RMSE of ERROR is left, or as far as MS milliseconds go",
     .kind = SETTING_OWN, .read = refine_read},
    {"counters", 0, NULL, "--stats, as text unless told, with what traversals cost",
     SETTING_AT_FLAG(struct render_request, counters)},
    {"fresh", 0, NULL,
     "for --budget-ms and --max-error: measure anew what is kept\n"
     "with the scene",
     SETTING_AT_FLAG(struct render_request, fresh)},
    REPEAT_OPTIONS(struct render_request, repeat),
    {0},
};

const char *render_asks(const struct settings *settings, const struct render_request *request,
                        const char *first, const char *last)
{
    const struct {
        const char *option;
        bool given;
    } asks[] = {
        {"--camera", settings_given(settings, "camera")},
        {"--frames", request->frames.given},
        {"--tile", request->part.tiles},
        {"--samples-part", request->part.sets},
        {"--resume", request->resume},
        {"--shader", settings->shader[0]},
        {"--stages", settings->stages[0]},
        {"--aa adaptive", settings->picture.sampling.kind == WHIT_SAMPLING_ADAPTIVE},
        {"--view", settings->paint != PAINT_COLOR},
        {"--counters", request->counters},
        {"--edges", settings->edges != EDGES_OFF},
        {"--grid", settings->grid},
        {"--refine", refine_is_wanted(&request->refine)},
        {"--budget-ms", settings->budget_ms > 0.0},
        {"--max-error", settings->max_error > 0.0},
        {"--thumbnail", request->thumbnail},
    };
    size_t i = 0;
    while (strcmp(asks[i].option, first) != 0)
        ++i;
    while (!asks[i].given && strcmp(asks[i].option, last) != 0)
        ++i;
    return asks[i].given ? asks[i].option : NULL;
}

static bool can_write(const struct render_request *request, const char *name)
{
    char *first = request->frames.given ? frames_path(name, request->frames.first) : NULL;
    bool can = cli_can_write(first ? first : name);
    free(first);
    return can;
}

static bool check_outputs(struct cli_reader *reader, const struct render_request *request)
{
    const char *distances = request->cameras.distances;
    if (!request->output)
        return cli_misuse(reader, "-o FILE is missing: where should the picture go?");
    if (!cli_no_dash(reader, "-o", request->output,
                     "pictures go to files, whose names say how: .png, .exr or .pfm") ||
        !cli_no_dash(reader, "--ids", request->ids, "identities go to a file, an .exr") ||
        !cli_no_dash(reader, "--distances", distances, "distances go to files"))
        return false;
    if (!request->thumbnail && !whit_image_format_known(request->output, false))
        return cli_misuse(reader, "%s: pictures are .png, .exr or .pfm", request->output);
    if (request->ids && !whit_image_format_known(request->ids, true))
        return cli_misuse(reader, "%s: hit identities are .exr", request->ids);
    if (distances && (path_is(distances, "png") || !whit_image_format_known(distances, false)))
        return cli_misuse(reader, "%s: distances are .exr or .pfm", distances);
    if (can_write(request, request->output) &&
        (!request->ids || can_write(request, request->ids)) &&
        (!distances || can_write(request, distances)))
        return true;
    reader->status = EXIT_USAGE;
    return false;
}

static whit_result check_own_camera(const char *text, const whit_camera *camera)
{
    if (memcmp(camera->eye, camera->target, sizeof camera->eye) == 0)
        return CLI_FAIL(WHIT_ERROR_USAGE, "--camera `%s`: eye and target are the same point", text);
    if (!(camera->fov_y_degrees > 0.0 && camera->fov_y_degrees < 180.0))
        return CLI_FAIL(WHIT_ERROR_USAGE,
                        "--camera `%s`: the angle must be between 0 and 180 degrees", text);
    return WHIT_OK;
}

static bool is_index(const char *text, uint32_t count)
{
    uint32_t index;
    const char *rest = text_number(text, UINT32_MAX, &index);
    return rest && !*rest && index < count;
}

static whit_result refuse_camera(const struct job *job, const char *wanted, uint32_t count)
{
    const char *names[CAMERA_NAMES_MAX];
    uint32_t max = count < CAMERA_NAMES_MAX ? count : CAMERA_NAMES_MAX;
    char list[512] = "";
    for (uint32_t i = 0; i < max; ++i) {
        whit_camera_info camera;
        whit_scene_get_camera(job->scene, i, &camera);
        names[i] = camera.name;
        if (i < 8)
            text_add(list, sizeof list, "%s%u `%.40s`", i ? ", " : "", i, camera.name);
        else if (i == 8)
            text_add(list, sizeof list, ", ...");
    }
    const char *nearest = text_nearest(wanted, names, max);
    if (nearest)
        cli_error("%s: there is no camera `%s`; did you mean `%s`?", job->settings.scene, wanted,
                  nearest);
    else
        cli_error("%s: there is no camera `%s`, only %s; or give ten numbers "
                  "ex,ey,ez,tx,ty,tz,ux,uy,uz,fov",
                  job->settings.scene, wanted, list);
    return WHIT_ERROR_USAGE;
}

whit_result render_check_camera(const struct job *job)
{
    const char *wanted = job->settings.camera;
    const whit_camera camera = camera_of_text(wanted);
    whit_scene_info scene;
    whit_scene_get_info(job->scene, &scene);
    if (!wanted[0] || is_index(wanted, scene.camera_count))
        return WHIT_OK;
    for (uint32_t i = 0; i < scene.camera_count; ++i) {
        whit_camera_info info;
        whit_scene_get_camera(job->scene, i, &info);
        if (strcmp(info.name, wanted) == 0)
            return WHIT_OK;
    }
    if (camera.own)
        return check_own_camera(wanted, &camera);
    return refuse_camera(job, wanted, scene.camera_count);
}

/* Whether the shader expects something of the picture: then another renderer is made when the
   picture is done. */
static bool expects_something(const whit_shader *shader)
{
    return job_shader_info(shader).expectation_count > 0;
}

/* Whether nothing but colours is read from the renderer. */
static bool wants_color_only(const struct job *job, const struct render_request *request)
{
    const whit_overlay overlay = settings_overlay(&job->settings);
    return !request->many && !request->ids && !request->keep_unread && !request->cameras.file &&
           !refine_is_wanted(&request->refine) && !overlay.edges_of_instances &&
           !overlay.edges_of_primitives && !expects_something(job->shader);
}

whit_result render_create(const struct job *job, const struct render_request *request,
                          struct frames_progress *progress, whit_renderer **renderer)
{
    whit_renderer_params params = job_picture(job);
    params.many_pictures = request->frames.given || request->many;
    params.keep_unread = request->keep_unread;
    params.color_only = wants_color_only(job, request);
    params.progress = frames_progress_update;
    params.progress_user = progress;
    params.count |= request->counters;
    part_take(&request->part, &params);
    if (refine_is_wanted(&request->refine)) /* the number of samples for which kernels are chosen */
        params.sampling.count = REFINE_SAMPLES_USUAL;
    whit_result result = whit_renderer_create(job->device, job->accel, &params, renderer);
    /* The renderer's time limit starts at its creation. */
    return result == WHIT_OK ? job_still_wanted() : result;
}

/* `ids`: NULL where the renderer has them. */
static whit_result save_ids(whit_renderer *renderer, whit_image *ids, const char *path,
                            const struct recipe *recipe)
{
    if (cli_cancel)
        return WHIT_ERROR_CANCELLED;
    whit_image *image = whit_image_share(ids);
    whit_result result = image ? WHIT_OK : whit_renderer_image(renderer, WHIT_AOV_IDS, &image);
    if (result == WHIT_OK)
        result = whit_image_save(image, path, recipe->texts, recipe->count, &cli_log);
    whit_image_destroy(image);
    return result;
}

/* Saves a PNG whatever the name of the file and without texts: file managers choose names of their
   own and add texts of their own. */
static whit_result save_thumbnail(const whit_image *image, const char *path)
{
    uint8_t *data = NULL;
    size_t size_bytes;
    whit_result result = whit_image_encode_png(image, NULL, 0, &cli_log, &data, &size_bytes);
    if (result == WHIT_OK)
        result = file_write_whole(&cli_log, path, data, size_bytes);
    whit_memory_destroy(data);
    return result;
}

static whit_result save_colors(whit_renderer *renderer, const struct settings *settings,
                               const struct render_request *request, whit_image *image,
                               const struct drawn_images *images, const struct recipe *recipe)
{
    const struct layers *layers = &images->layers;
    whit_overlay overlay = settings_overlay(settings);
    overlay.ids = images->ids ? whit_image_words(images->ids) : NULL;
    whit_result result = whit_renderer_draw_over(renderer, &overlay, image);
    if (result == WHIT_OK)
        result = request->thumbnail
                     ? save_thumbnail(image, request->output)
                     : whit_image_save_layers(image, layers->items, layers->count, request->output,
                                              recipe->texts, recipe->count, &cli_log);
    return result;
}

static whit_result save_own_colors(whit_renderer *renderer, const struct settings *settings,
                                   const struct render_request *request,
                                   const struct drawn_images *images, const struct recipe *recipe)
{
    whit_image *image;
    whit_result result = whit_renderer_borrow_color(renderer, &image);
    if (result == WHIT_OK && request->part.sets) /* sums in place of means over its samples */
        part_scale((float)(settings->picture.sampling.count / request->part.sets), image);
    if (result == WHIT_OK)
        result = save_colors(renderer, settings, request, image, images, recipe);
    whit_image_destroy(image);
    return result;
}

static whit_result save_view(whit_renderer *renderer, const struct settings *settings,
                             const char *output, struct recipe *recipe)
{
    whit_image *image;
    struct view_figures figures;
    whit_result result = view_image(renderer, settings, output, &figures, &image);
    if (result != WHIT_OK)
        return result;
    recipe_add_view(recipe, settings, &figures);
    result = whit_image_save(image, output, recipe->texts, recipe->count, &cli_log);
    whit_image_destroy(image);
    return result;
}

/* Whether the picture's file holds images of the shader's aovs, beside the colour or (--aov) in its
   place. */
static bool keeps_layers(const struct settings *settings, const struct render_request *request)
{
    bool beside = path_is(request->output, "exr") && !request->thumbnail;
    return settings->paint == PAINT_COLOR && (settings->aov[0] || beside);
}

whit_result render_save(const struct job *job, const struct render_request *request,
                        whit_renderer *renderer, struct drawn_images *images,
                        const whit_stats *stats)
{
    struct layers *layers = &images->layers;
    const struct settings *settings = &job->settings;
    struct recipe recipe;
    whit_device_info device;
    bool held;
    whit_result result = whit_renderer_check_expectations(renderer, &held);
    if (result == WHIT_OK && !held)
        result = WHIT_ERROR_FAILED;
    if (result != WHIT_OK)
        return result;
    whit_device_get_info(job->device, &device);
    if (!recipe_init(&recipe, settings, job->scene, job->shader, &device, stats, request->output,
                     NULL))
        return WHIT_ERROR_MEMORY;
    recipe_add_part(&recipe, &request->part, settings);
    if (request->ids)
        result = save_ids(renderer, images->ids, request->ids, &recipe);
    if (result == WHIT_OK && cli_cancel)
        result = WHIT_ERROR_CANCELLED;
    if (result == WHIT_OK && !images->color && keeps_layers(settings, request))
        result = layers_read(job->shader, renderer, NULL, layers);
    if (!keeps_layers(settings, request))
        layers_finish(layers);
    if (result == WHIT_OK && settings->paint != PAINT_COLOR)
        result = save_view(renderer, settings, request->output, &recipe);
    else if (result == WHIT_OK && settings->aov[0])
        result = layers_save(layers, settings->aov, request->output, &recipe);
    else if (result == WHIT_OK)
        result = images->color
                     ? save_colors(renderer, settings, request, images->color, images, &recipe)
                     : save_own_colors(renderer, settings, request, images, &recipe);
    if (result == WHIT_OK && part_is_given(&request->part) && path_is(request->output, "pfm"))
        result = part_save_beside(request->output, &recipe);
    recipe_finish(&recipe);
    return result;
}

/* Makes what the job lacks: scene, trees, device. */
static whit_result make_missing(struct job *job, const struct render_request *request)
{
    bool loads = !job->scene, opens = !job->device;
    if (opens)
        job_begin_device(job);
    whit_result result = loads ? job_load(job) : job_take_scene(job);
    if (result == WHIT_OK)
        result = render_check_camera(job);
    if (result == WHIT_OK && loads)
        job_print_notes(job, true);
    if (result == WHIT_OK && !job->accel)
        result = job_build(job);
    if (result != WHIT_OK || !opens)
        return result;
    result = job_open_device(job);
    if (result == WHIT_OK && request->many)
        whit_device_keep_kernels(job->device);
    return result;
}

static whit_result retarget(const struct job *job, const struct render_request *request,
                            whit_renderer *renderer)
{
    whit_renderer_params params = job_picture(job);
    part_take(&request->part, &params);
    return whit_renderer_set_view(renderer, &params);
}

whit_result render_prepare(struct job *job, const struct render_request *request,
                           struct frames_progress *progress, whit_renderer **renderer)
{
    whit_result result = job->shader ? WHIT_OK : job_load_shader(job);
    if (result == WHIT_OK && (!layers_check(job) || !part_check_shader(job, request)))
        result = WHIT_ERROR_USAGE;
    if (result == WHIT_OK)
        result = make_missing(job, request);
    if (result != WHIT_OK)
        return result;
    if (*renderer)
        return retarget(job, request, *renderer);
    bool chooses = job->settings.budget_ms > 0.0 || job->settings.max_error > 0.0;
    result = chooses ? render_choose(job, request, progress, renderer)
                     : render_create(job, request, progress, renderer);
    if (result == WHIT_OK && !request->scene_stays && !expects_something(job->shader))
        whit_scene_drop_pictures(job->scene);
    return result;
}

static bool is_told(const struct job *job)
{
    return !job->settings.quiet && job->settings.stats == STATS_NONE;
}

static void say_done(const struct job *job, const struct render_request *request,
                     double predicted_ms, const whit_stats *stats)
{
    const struct frames *frames = &request->frames;
    char about[128] = "", part[64];
    whit_device_info device;
    whit_device_get_info(job->device, &device);
    if (frames->given)
        snprintf(about, sizeof about, "%s %u to %u, ", request->cameras.file ? "views" : "frames",
                 frames->first, frames->last);
    if (part_is_given(&request->part))
        text_add(about, sizeof about, "%s of ", part_name(&request->part, part));
    if (is_told(job))
        fprintf(stderr, "whit: %s: %s%u x %u, rendered in %.2f s (%.2f Mray/s) on %s\n",
                cli_shown(request->output), about, job->settings.picture.width,
                job->settings.picture.height, stats->render_ms * 1e-3, stats->mrays_per_s,
                cli_shown(device.name));
    double budget_ms = job->settings.budget_ms;
    bool late = stats->render_ms > budget_ms && stats->render_ms > predicted_ms;
    if (budget_ms > 0.0 && !job->settings.quiet)
        cli_note("it took %.1f of %.6g ms%s", stats->render_ms, budget_ms,
                 late ? ": more than predicted; --fresh measures anew" : "");
}

static whit_result draw_one(struct job *job, const struct render_request *request,
                            whit_renderer *renderer, struct frames_progress *progress,
                            struct drawn_images *images, struct sequence *sequence)
{
    *images = (struct drawn_images){0};
    if (refine_is_wanted(&request->refine))
        return refine_render(job, request, renderer, progress, images, sequence);
    whit_result result = whit_renderer_render(renderer);
    if (result == WHIT_OK)
        whit_renderer_get_stats(renderer, &sequence->stats);
    return result;
}

static whit_result draw_and_save(struct job *job, const struct render_request *request,
                                 whit_renderer *renderer, struct frames_progress *progress,
                                 struct sequence *sequence)
{
    struct drawn_images images;
    whit_result result = draw_one(job, request, renderer, progress, &images, sequence);
    cli_progress_finish(&progress->bar);
    if (result != WHIT_OK)
        return result;
    double start_ms = whit_clock_ms();
    if (!cli_cancel)
        cli_set_saving();
    result = render_save(job, request, renderer, &images, &sequence->stats);
    sequence->save_ms = whit_clock_ms() - start_ms;
    drawn_images_finish(&images);
    return result;
}

static whit_result render_one(struct job *job, const struct render_request *request,
                              whit_renderer *renderer, struct frames_progress *progress,
                              struct sequence *sequence)
{
    enum resume_state state = RESUME_OTHERS;
    struct lock lock = {0};
    whit_result result = WHIT_OK;
    if (!request->resume)
        return draw_and_save(job, request, renderer, progress, sequence);
    while (result == WHIT_OK && state == RESUME_OTHERS) {
        result = resume_begin(job, request, &state, &lock);
        if (request->leaves)
            break;
        if (result == WHIT_OK && state == RESUME_OTHERS)
            result = resume_wait();
    }
    if (result == WHIT_OK && state == RESUME_DRAW)
        result = draw_and_save(job, request, renderer, progress, sequence);
    lock_give_back(&lock);
    sequence->kept = result == WHIT_OK && state == RESUME_KEPT;
    sequence->left = result == WHIT_OK && state == RESUME_OTHERS;
    if (sequence->kept || sequence->left)
        whit_renderer_get_stats(renderer, &sequence->stats);
    return result;
}

/* Prints how many frames were written when a sequence ends early. After an interrupt the signal
   handler prints it. */
static void say_written(const struct job *job, const struct render_request *request,
                        const struct frames_progress *progress, const struct sequence *sequence)
{
    if (cli_cancel || job->settings.quiet)
        return;
    cli_note("%u of %u %s were written", sequence->written + sequence->kept, progress->count,
             request->cameras.file ? "views" : "frames");
    cli_say_next();
}

int render_draw(struct job *job, const struct render_request *request, whit_renderer *renderer,
                struct frames_progress *progress, struct sequence *sequence)
{
    const struct frames *frames = &request->frames;
    const struct refined *refined = &sequence->refined;
    progress->count = frames->last - frames->first + 1;
    progress->done = 0;
    whit_result result = request->cameras.file
                             ? cameras_render(job, request, renderer, progress, sequence)
                         : frames->given ? frames_render(job, request, renderer, progress, sequence)
                                         : render_one(job, request, renderer, progress, sequence);
    cli_progress_finish(&progress->bar);
    if (result != WHIT_OK) {
        int failed = cli_exit_of(result);
        if (frames->given)
            say_written(job, request, progress, sequence);
        return failed;
    }
    if (sequence->left)
        return EXIT_FINE;
    if (!sequence->kept || sequence->written)
        say_done(job, request, progress->predicted_ms, &sequence->stats);
    if (sequence->kept && is_told(job))
        cli_note("%s: %u finished picture%s kept", request->output, sequence->kept,
                 sequence->kept == 1 ? " was" : "s were");
    int status = stats_print(job, request, renderer, sequence);
    bool missed = refined->now.samples && !refined->reached;
    if (refined->now.samples && (missed || is_told(job)))
        refine_say(&request->refine, refined);
    if (missed && status == EXIT_FINE)
        status = EXIT_DIFFERS;
    return status == EXIT_FINE ? job_check_validation(job) : status;
}

static int work(struct job *job, const struct render_request *request)
{
    struct frames_progress progress = {.count = 1};
    whit_renderer *renderer = NULL;
    struct sequence sequence = {0};
    int status;
    cli_progress_init(&progress.bar, job->settings.quiet);
    whit_result result = render_prepare(job, request, &progress, &renderer);
    progress.bar.start_ms = whit_clock_ms();
    /* Nothing tells before the end how many pixels of adaptive samples get more. */
    bool foretold = !job->settings.quiet && progress.predicted_ms <= job->settings.budget_ms &&
                    job->settings.picture.sampling.kind == WHIT_SAMPLING_FIXED;
    progress.budget_ms = foretold ? job->settings.budget_ms : 0.0;
    progress.renderer = renderer;
    if (result == WHIT_OK) {
        status = render_draw(job, request, renderer, &progress, &sequence);
    } else {
        cli_progress_finish(&progress.bar);
        status = cli_exit_of(result);
    }
    sequence_finish(&sequence);
    whit_renderer_destroy(renderer);
    return status;
}

static bool check_choice(struct cli_reader *reader, const struct settings *settings,
                         const struct render_request *request)
{
    bool other =
        request->frames.given || request->ids || settings->paint != PAINT_COLOR || settings->aov[0];
    if (request->thumbnail && other)
        return cli_misuse(reader, "--thumbnail is for one picture of colours");
    const char *chosen = render_asks(settings, request, "--budget-ms", "--max-error");
    if (request->fresh && !chosen)
        return cli_misuse(reader, "--fresh goes with --budget-ms or --max-error");
    return !request->frames.given || !chosen ||
           cli_misuse(reader, "%s is for one picture of colours", chosen);
}

/* Reads the options first and the scene after them, because a picture may be given in its place. */
static bool read_all(struct job *job, struct cli_reader *reader, struct render_request *request,
                     int argc, char **argv)
{
    if (!cli_read(reader, request, &job->settings))
        return false;
    if (request->thumbnail && settings_given(&job->settings, "size"))
        return cli_misuse(reader, "--thumbnail has the size already: leave out --size");
    if (repeat_picture(reader, &request->repeat)) {
        struct part_place place;
        if (!repeat_read(job, reader, request, &request->repeat, argc, argv))
            return false;
        if (job->recipe_part[0] && !part_is_given(&request->part) &&
            part_of_line(job->recipe_part, &place))
            request->part = place.part;
        return true;
    }
    return job_check(job, reader, false);
}

bool render_read(struct job *job, struct cli_reader *reader, struct render_request *request,
                 int argc, char **argv)
{
    if (!read_all(job, reader, request, argc, argv) || !cameras_check(reader, job, request) ||
        !frames_check(reader, job, request) || !check_choice(reader, &job->settings, request) ||
        !refine_check(reader, job, request) || !part_check(reader, job, request) ||
        !resume_check(reader, job, request) || !check_outputs(reader, request))
        return false;
    if (request->thumbnail) {
        job->settings.picture.width = job->settings.picture.height = request->thumbnail;
        job->settings.quiet = true;
    }
    if (request->counters && job->settings.stats == STATS_NONE)
        job->settings.stats = STATS_TEXT;
    if (request->frames.given && !request->cameras.file)
        job->settings.picture.time_s = (double)request->frames.first / job->settings.fps;
    return true;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    struct render_request request = {0};
    job_init(&job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!render_read(&job, &reader, &request, argc, argv)) {
        cameras_finish(&request.cameras);
        return reader.status;
    }
    if (resume_leaves_files(&request) && !job.settings.quiet)
        resume_keep_line(request.resume, argc, argv);
    job_start(&job);
    int status = work(&job, &request);
    job_finish(&job);
    cameras_finish(&request.cameras);
    return status;
}

const struct cli_command command_render = {
    .name = "render",
    .arguments = "SCENE -o FILE [options]",
    .summary =
        "Renders a scene (.json) or a model (.obj .gltf .glb .ply .stl .fbx .dae .3mf .off).",
    .details =
        "Defaults are in brackets. The picture carries its recipe: PNG text, EXR attributes.\n"
        "Exit codes: 0 fine, 1 a promise failed, 2 bad usage or input, 3 no device,\n"
        "5 time limit, 130 interrupted.\n",
    .options = options,
    .settings = IN_RENDER,
    .run = run,
};
