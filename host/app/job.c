#include "app/job.h"

#include <string.h>

#include "app/cache.h"

enum { NOTES_SHOWN = 20, FRAMES_MAX = 1000000000 };

const struct setting_value job_stats_values[] = {
    {"text", JOB_STATS_TEXT, NULL}, {"json", JOB_STATS_JSON, NULL}, {0}};

void job_init(struct job *job)
{
    *job = (struct job){.fps = 24.0, .start_ms = whit_clock_ms()};
}

static void read_load_path(struct job *job, struct cli_reader *reader)
{
    int choice;
    if (cli_choice(reader, &choice))
        job->load_path = choice ? value_word(values_load_path, choice) : NULL;
}

/* Of trees; false when `id` is something else. */
static bool tree_option(struct job *job, struct cli_reader *reader, int id)
{
    int choice;
    switch (id) {
    case JOB_BUILD:
        job->has_build = job_read_build(reader, reader->value, &job->build);
        return true;
    case JOB_NO_TREES:
        job->no_trees = true;
        return true;
    case JOB_LEAF:
        cli_unsigned(reader, 1, 15, &job->leaf_limit);
        return true;
    case JOB_INSTANCES:
        if (cli_choice(reader, &choice))
            job->instances = (whit_instances)choice;
        return true;
    case JOB_INSTANCE_BUILD:
        if (cli_choice(reader, &choice))
            job->instance_build = (whit_build)choice;
        return true;
    case JOB_INSTANCE_UPDATE:
        if (cli_choice(reader, &choice))
            job->instance_refit = choice != 0;
        return true;
    case JOB_TRAVERSAL:
        if (cli_choice(reader, &choice))
            job->traversal = (whit_traversal)choice;
        return true;
    case JOB_NUMERICS:
        if (cli_choice(reader, &choice))
            job->numerics = (whit_numerics)choice;
        return true;
    case JOB_LOAD_PATH:
        read_load_path(job, reader);
        return true;
    case JOB_THREADS:
        cli_unsigned(reader, 0, 1024, &job->threads);
        return true;
    default:
        return false;
    }
}

static void read_allowed(struct job *job, struct cli_reader *reader)
{
    if (!reader->value[0] || job->allowed_count == JOB_ALLOWED_MOST)
        cli_misuse(reader, "--allow-path takes a folder, %d times at most", JOB_ALLOWED_MOST);
    else
        job->allowed[job->allowed_count++] = reader->value;
}

bool job_option(struct job *job, struct cli_reader *reader, int id)
{
    if (tree_option(job, reader, id))
        return true;
    switch (id) {
    case JOB_DEVICE:
        if (!reader->value[0])
            cli_misuse(reader, "--device needs a name or a number");
        job->device_name = reader->value;
        return true;
    case JOB_NO_CACHE:
        job->no_cache = true;
        return true;
    case JOB_TIME:
        job->has_time = cli_number(reader, -1e6, 1e6, &job->time_s);
        return true;
    case JOB_FRAME:
        job->has_frame = cli_unsigned(reader, 0, FRAMES_MAX, &job->frame);
        return true;
    case JOB_FPS:
        cli_number(reader, 1e-3, 1e6, &job->fps);
        return true;
    case JOB_TEXTURE_LIMIT:
        cli_unsigned(reader, 1, 16384, &job->texture_limit);
        return true;
    case JOB_MEMORY_LIMIT:
        cli_bytes(reader, &job->memory_limit);
        return true;
    case JOB_ALLOW_PATH:
        read_allowed(job, reader);
        return true;
    case JOB_IMPORT_LIMIT:
        cli_number(reader, 1e-3, 1e6, &job->import_limit_s);
        return true;
    case JOB_REQUIRE_SANDBOX:
        job->require_sandbox = true;
        return true;
    case JOB_VALIDATION:
        job->validation = true;
        return true;
    case JOB_TIME_LIMIT:
        cli_number(reader, 1e-3, 1e6, &job->time_limit_s);
        return true;
    case JOB_STATS:
        cli_choice_unsigned(reader, &job->stats);
        return true;
    case 'q':
        job->quiet = true;
        return true;
    default:
        return false;
    }
}

static bool check_trees(const struct job *job, struct cli_reader *reader)
{
    if (job->no_trees && job->has_build)
        return cli_misuse(reader, "--no-bvh and --build: either there are trees or there are none");
    if (job->no_trees && job->leaf_limit)
        return cli_misuse(reader, "--no-bvh and --leaf: without trees there are no leaves");
    return true;
}

bool job_options_done(struct job *job, struct cli_reader *reader)
{
    if (reader->status >= 0)
        return false;
    if (!reader->positional)
        return cli_misuse(reader, "a scene is missing");
    if (job->has_time && job->has_frame)
        return cli_misuse(reader, "--time and --frame are two ways to say the same");
    if (!check_trees(job, reader))
        return false;
    if (job->has_frame)
        job->time_s = (double)job->frame / job->fps;
    job->scene_path = reader->positional;
    if (!reader->where) /* else there are threads already */
        cache_prepare(job->no_cache);
    cli_limit_time(job->time_limit_s);
    return true;
}

whit_load_params job_load_params(const struct job *job)
{
    return (whit_load_params){
        .time_limit_s =
            job->time_limit_s > 0.0 && job->time_limit_s < 60.0 ? cli_time_left_s() : 0.0,
        .memory_limit_bytes = job->memory_limit,
        .texture_limit = job->texture_limit,
        .cancel = &cli_cancel,
        .import_limit_s = job->import_limit_s,
        .require_sandbox = job->require_sandbox,
        .allowed_folders = job->allowed,
        .allowed_count = job->allowed_count,
    };
}

whit_result job_load(struct job *job)
{
    const whit_load_params params = job_load_params(job);
    double start_ms = whit_clock_ms();
    whit_result result = whit_scene_load(job->scene_path, &params, &cli_log_errors, &job->scene);
    job->load_ms = whit_clock_ms() - start_ms;
    return result == WHIT_OK && cli_cancel ? WHIT_ERROR_CANCELLED : result;
}

void job_print_notes(const struct job *job, bool all)
{
    whit_scene_info info;
    uint32_t wanted = 0;
    whit_scene_get_info(job->scene, &info);
    for (uint32_t i = 0; !job->quiet && i < info.note_count; ++i) {
        whit_note_info note;
        whit_scene_get_note(job->scene, i, &note);
        if ((!all && !note.warning) || ++wanted > NOTES_SHOWN)
            continue;
        if (note.warning)
            cli_warning("%s", note.text);
        else
            cli_note("%s", note.text);
    }
    if (wanted > NOTES_SHOWN)
        cli_note("and %u more; `whit scene` lists them", wanted - NOTES_SHOWN);
}

whit_result job_still_wanted(void)
{
    if (cli_cancel)
        return WHIT_ERROR_CANCELLED;
    if (!cli_time_over())
        return WHIT_OK;
    cli_error("the time limit has passed");
    return WHIT_ERROR_TIME_LIMIT;
}

whit_accel_params job_accel_params(const struct job *job)
{
    return (whit_accel_params){
        .build = job->no_trees ? WHIT_BUILD_NONE : job->build.build,
        .optimize = job->build.optimize,
        .bins = job->build.bins,
        .leaf_limit = job->leaf_limit,
        .spatial_alpha = job->build.alpha,
        .spatial_budget = job->build.budget,
        .threads = job->threads,
        .instance_build = job->instance_build,
        .instance_refit = job->instance_refit,
        .instances = job->instances,
    };
}

whit_result job_build(struct job *job)
{
    const whit_accel_params params = job_accel_params(job);
    whit_result result = job_still_wanted();
    if (result != WHIT_OK)
        return result;
    double start_ms = whit_clock_ms();
    result = whit_accel_create(job->scene, &params, &job->accel);
    job->accel_ms = whit_clock_ms() - start_ms;
    return result == WHIT_OK ? job_still_wanted() : result;
}

static whit_device_params device_params(const struct job *job)
{
    return (whit_device_params){.selector = job->device_name, .validation = job->validation};
}

void job_begin_device(struct job *job)
{
    const whit_device_params params = device_params(job);
    job->opening = whit_device_open_begin(&params, &cli_log);
}

whit_result job_open_device(struct job *job)
{
    const whit_device_params params = device_params(job);
    double start_ms = whit_clock_ms();
    whit_result result = job->opening ? whit_device_open_end(job->opening, &job->device)
                                      : whit_device_create(&params, &cli_log, &job->device);
    job->opening = NULL;
    job->device_ms = whit_clock_ms() - start_ms;
    return result == WHIT_OK ? job_still_wanted() : result;
}

int job_check_validation(const struct job *job)
{
    uint32_t messages = job->device ? whit_device_validation_messages(job->device) : 0;
    if (messages == 0)
        return EXIT_FINE;
    cli_error("the validation layers had %u messages", messages);
    return EXIT_DIFFERS;
}

void job_finish(struct job *job)
{
    whit_device_open_abandon(job->opening);
    whit_device_destroy(job->device);
    whit_accel_destroy(job->accel);
    whit_scene_destroy(job->scene);
}
