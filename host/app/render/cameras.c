#include "app/render/cameras.h"

#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/render/recipe.h"
#include "app/render/render_command.h"

enum { PIXELS_AT_ONCE = 1 << 22 };

/* ---- Options ---- */

bool cameras_check(struct cli_reader *reader, const struct job *job, struct render_request *request)
{
    struct cameras *cameras = &request->cameras;
    if (!cameras->file)
        return !cameras->distances ||
               cli_misuse(reader, "--distances is for the views of --cameras");
    const char *other = render_asks(&job->settings, request, "--camera", "--thumbnail");
    if (other)
        return cli_misuse(reader, "--cameras and %s do not go together", other);
    whit_result result = whit_cameras_load(cameras->file, &cli_log, &cameras->all, &cameras->count);
    reader->status = result == WHIT_OK ? reader->status : cli_exit_of(result);
    request->frames = (struct frames){.given = true, .last = cameras->count - 1};
    return result == WHIT_OK;
}

void cameras_finish(struct cameras *cameras)
{
    whit_memory_destroy(cameras->all);
    *cameras = (struct cameras){0};
}

/* ---- Files ---- */

static json_t *camera_document(const whit_camera *camera)
{
    json_t *object = document_object();
    document_numbers(object, "eye", camera->eye, 3);
    document_numbers(object, "target", camera->target, 3);
    document_numbers(object, "up", camera->up, 3);
    if (camera->kind == WHIT_CAMERA_PANORAMA)
        document_flag(object, "panorama", true);
    else if (camera->kind == WHIT_CAMERA_ORTHOGRAPHIC)
        document_number(object, "height", camera->height);
    else
        document_number(object, "fov", camera->fov_y_degrees);
    if (camera->lens_radius > 0.0)
        document_number(object, "lens", camera->lens_radius);
    if (camera->lens_radius > 0.0 && camera->focus_distance > 0.0)
        document_number(object, "focus", camera->focus_distance);
    return object;
}

/* Images of all views that were drawn together, one below the other; the files of a view are cut
   out of them. */
struct drawn {
    whit_image *color, *ids, *distances;
};

/* Saves the rows of a view in the image `all` to a file whose name has the view's number. */
static whit_result save_rows(const whit_image *all, uint32_t row, uint32_t height,
                             const char *pattern, uint32_t number, const struct recipe *recipe)
{
    whit_log log = cli_log;
    whit_image *image = NULL;
    char *path = frames_path(pattern, number);
    whit_result result = path ? whit_image_rows(all, row, height, &image) : WHIT_ERROR_MEMORY;
    log.level = WHIT_LOG_ERROR; /* no warning that some distances are infinite */
    if (result == WHIT_OK)
        result = whit_image_save(image, path, recipe->texts, recipe->count, &log);
    else
        cli_error("out of memory");
    whit_image_destroy(image);
    free(path);
    return result;
}

/* Saves the files of view `number` of the file of cameras, which is number `at` among those drawn
   together. */
static whit_result save_view(const struct job *job, const struct render_request *request,
                             const struct drawn *drawn, uint32_t at, uint32_t number)
{
    const struct cameras *cameras = &request->cameras;
    uint32_t height = job->settings.picture.height;
    struct settings settings = job->settings;
    struct recipe recipe;
    whit_device_info device;
    whit_device_get_info(job->device, &device);
    bool named = settings_name_camera(&settings, &cameras->all[number]);
    json_t *camera = named ? NULL : camera_document(&cameras->all[number]);
    if (!recipe_init(&recipe, &settings, job->scene, NULL, &device, NULL, request->output, camera))
        return WHIT_ERROR_MEMORY;
    whit_result result = WHIT_OK;
    if (request->ids)
        result = save_rows(drawn->ids, at * height, height, request->ids, number, &recipe);
    if (result == WHIT_OK && cameras->distances)
        result =
            save_rows(drawn->distances, at * height, height, cameras->distances, number, &recipe);
    if (result == WHIT_OK)
        result = save_rows(drawn->color, at * height, height, request->output, number, &recipe);
    recipe_finish(&recipe);
    return result;
}

/* ---- Drawing ---- */

static whit_result read_drawn(whit_renderer *renderer, const struct render_request *request,
                              struct drawn *drawn)
{
    whit_result result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &drawn->color);
    if (result == WHIT_OK && request->ids)
        result = whit_renderer_image(renderer, WHIT_AOV_IDS, &drawn->ids);
    if (result == WHIT_OK && request->cameras.distances)
        result = whit_renderer_image(renderer, WHIT_AOV_DISTANCES, &drawn->distances);
    return result;
}

/* Draws and saves `count` views from `first` on. */
static whit_result draw_some(const struct job *job, const struct render_request *request,
                             whit_renderer *renderer, uint32_t first, uint32_t count,
                             struct sequence *sequence)
{
    struct drawn drawn = {0};
    whit_stats stats;
    whit_result result = whit_renderer_render_views(renderer, request->cameras.all + first, count);
    if (result == WHIT_OK)
        result = read_drawn(renderer, request, &drawn);
    double start_ms = whit_clock_ms();
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        result = job_still_wanted();
        if (result == WHIT_OK)
            result = save_view(job, request, &drawn, i, first + i);
        sequence->written += result == WHIT_OK;
        cli_set_written(sequence->written, request->cameras.count);
    }
    sequence->save_ms += whit_clock_ms() - start_ms;
    whit_renderer_get_stats(renderer, &stats);
    whit_stats_add(&stats, &sequence->stats);
    whit_image_destroy(drawn.color);
    whit_image_destroy(drawn.ids);
    whit_image_destroy(drawn.distances);
    return result;
}

whit_result cameras_render(const struct job *job, const struct render_request *request,
                           whit_renderer *renderer, struct frames_progress *progress,
                           struct sequence *sequence)
{
    const whit_renderer_params *picture = &job->settings.picture;
    uint32_t left = request->cameras.count, pixels = picture->width * picture->height;
    uint32_t most = pixels < PIXELS_AT_ONCE ? PIXELS_AT_ONCE / pixels : 1;
    whit_result result = WHIT_OK;
    whit_renderer_get_stats(renderer, &sequence->stats);
    sequence->stats.render_device_ms = sequence->stats.bailout_bound = 0.0;
    for (uint32_t first = 0; result == WHIT_OK && left > 0; first += progress->parts) {
        progress->done = first;
        progress->parts = left < most ? left : most;
        left -= progress->parts;
        result = draw_some(job, request, renderer, first, progress->parts, sequence);
        if (result != WHIT_OK && result != WHIT_ERROR_CANCELLED)
            cli_note("%s: views %u to %u", request->cameras.file, first,
                     first + progress->parts - 1);
    }
    progress->parts = 0;
    return result;
}
