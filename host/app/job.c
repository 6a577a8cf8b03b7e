#include "app/job.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/cache.h"

enum { NOTES_SHOWN = 20 };

void job_init(struct job *job, const struct cli_command *command)
{
    *job = (struct job){.settings = settings_usual(), .start_ms = whit_clock_ms()};
    job->keeps_axes = (command->settings & (IN_TRACE | IN_BVH | IN_HARD)) != 0;
    if (command->usual)
        command->usual(&job->settings);
}

static bool take_scene(struct job *job, struct cli_reader *reader, bool optional)
{
    const char *scene = reader->positional ? reader->positional : "";
    if (!reader->positional && !optional)
        return cli_misuse(reader, "a scene is missing");
    if (strlen(scene) >= sizeof job->settings.scene) {
        cli_error("%s: the path is too long", scene);
        reader->status = EXIT_USAGE;
        return false;
    }
    memcpy(job->settings.scene, scene, strlen(scene) + 1);
    return true;
}

bool job_read(struct job *job, struct cli_reader *reader, void *own, bool optional)
{
    return cli_read(reader, own, &job->settings) && job_check(job, reader, optional);
}

bool job_check(struct job *job, struct cli_reader *reader, bool optional)
{
    char why[SETTING_WHY_BYTES];
    if (!take_scene(job, reader, optional))
        return false;
    if (!settings_check(&job->settings, why))
        return cli_misuse(reader, "%s", why);
    bool other = reader->command->settings & (IN_RENDER | IN_VIEW); /* which have more uses of it */
    return other || !settings_given(&job->settings, "fps") ||
           settings_given(&job->settings, "frame") || cli_misuse(reader, "--fps is for --frame");
}

/* Whether the environment chooses drivers, or makes one of them do without hardware. */
static bool drivers_are_chosen(void)
{
    static const char *const names[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES",
                                        "VK_ADD_DRIVER_FILES", "VK_LOADER_DRIVERS_SELECT",
                                        "RADV_FORCE_FAMILY"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        if (getenv(names[i]))
            return true;
    }
    return false;
}

void job_start(const struct job *job)
{
    cache_prepare(job->settings.no_cache);
    /* Mesa's drivers find hardware by the nodes in this folder. Where it is missing the Vulkan
       loader does not open them, which would take some 10 ms. */
    if (!drivers_are_chosen() && access("/dev/dri", F_OK) != 0)
        (void)setenv("VK_LOADER_DRIVERS_DISABLE", "*intel*,*radeon*,*virtio*", 0);
    cli_limit_time(job->settings.time_limit_s);
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

whit_result job_begin_compiler(struct job *job, const whit_log *log)
{
    const struct settings *settings = &job->settings;
    const whit_shader_limits limits = {.cpu_s = settings->load.import_limit_s,
                                       .memory_bytes = settings->load.memory_limit_bytes / 2,
                                       .require_sandbox = settings->load.require_sandbox,
                                       .cancel = &cli_cancel};
    return whit_shader_compiler_create(&limits, log, &job->compiler);
}

static const char *text_or_null(const char *text)
{
    return text[0] ? text : NULL;
}

whit_result job_load_shader(struct job *job)
{
    const struct settings *settings = &job->settings;
    if (!settings_compiles(settings))
        return WHIT_OK;
    whit_result result = job->compiler ? WHIT_OK : job_begin_compiler(job, &cli_log);
    if (result == WHIT_OK)
        result =
            whit_shader_load_stages(job->compiler, text_or_null(settings->shader),
                                    text_or_null(settings->stages), settings->trust, &job->shader);
    return result == WHIT_OK ? job_still_wanted() : result;
}

whit_result job_take_scene(struct job *job)
{
    whit_scene_info info;
    whit_scene_get_info(job->scene, &info);
    if (job->recipe_hash && job->recipe_hash != info.hash)
        cli_warning("%s is not as it was when the picture was made, and so may be what is drawn",
                    job->settings.scene);
    settings_expose(&job->settings, &info);
    whit_result result = settings_choose_camera(&job->settings, job->scene);
    return result == WHIT_OK && cli_cancel ? WHIT_ERROR_CANCELLED : result;
}

whit_result job_load(struct job *job)
{
    const char *folders[SETTING_FOLDERS_MAX];
    whit_load_params params = settings_load(&job->settings, folders);
    double limit_s = job->settings.time_limit_s, start_ms = whit_clock_ms();
    params.time_limit_s = limit_s > 0.0 && limit_s < 60.0 ? cli_time_left_s() : 0.0;
    params.cancel = &cli_cancel;
    /* Rays, boxes and triangles are printed in the file's own coordinates, so `--up auto` must not
       turn the model. */
    if (job->keeps_axes && !settings_given(&job->settings, "up"))
        params.up = WHIT_UP_Y;
    whit_result result =
        whit_scene_load(job->settings.scene, &params, &cli_log_errors, &job->scene);
    job->load_ms = whit_clock_ms() - start_ms;
    return result == WHIT_OK ? job_take_scene(job) : result;
}

void job_print_notes(const struct job *job, bool all)
{
    if (!job->settings.quiet)
        job_print_scene_notes(job->scene, all);
}

void job_print_scene_notes(const whit_scene *scene, bool all)
{
    whit_scene_info info;
    uint32_t wanted = 0;
    whit_scene_get_info(scene, &info);
    for (uint32_t i = 0; i < info.note_count; ++i) {
        whit_note_info note;
        whit_scene_get_note(scene, i, &note);
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

whit_result job_build(struct job *job)
{
    whit_result result = job_still_wanted();
    if (result != WHIT_OK)
        return result;
    double start_ms = whit_clock_ms();
    result = whit_accel_create(job->scene, &job->settings.trees, &job->accel);
    job->accel_ms = whit_clock_ms() - start_ms;
    return result == WHIT_OK ? job_still_wanted() : result;
}

bool job_any_device(void)
{
    whit_device_info *infos = NULL;
    uint32_t count = 0;
    bool usable = false;
    if (whit_device_list(NULL, &infos, &count) != WHIT_OK)
        return false;
    for (uint32_t i = 0; i < count; ++i)
        usable |= infos[i].usable;
    whit_memory_destroy(infos);
    return usable;
}

static const whit_log *log_of(const struct job *job)
{
    return job->log ? job->log : &cli_log;
}

void job_begin_device(struct job *job)
{
    const whit_device_params params = settings_device(&job->settings);
    job->opening = whit_device_open_begin(&params, log_of(job));
}

whit_result job_open_device(struct job *job)
{
    const whit_device_params params = settings_device(&job->settings);
    double start_ms = whit_clock_ms();
    whit_result result = job->opening ? whit_device_open_end(job->opening, &job->device)
                                      : whit_device_create(&params, log_of(job), &job->device);
    job->opening = NULL;
    job->device_ms = whit_clock_ms() - start_ms;
    return result == WHIT_OK ? job_still_wanted() : result;
}

whit_renderer_params job_picture(const struct job *job)
{
    whit_renderer_params params = settings_picture(&job->settings);
    params.shader = job->shader;
    params.time_stages = job->settings.stats != STATS_NONE;
    params.cancel = &cli_cancel;
    params.time_limit_s = cli_time_left_s();
    return params;
}

whit_shader_info job_shader_info(const whit_shader *shader)
{
    whit_shader_info info = {0};
    if (shader)
        whit_shader_get_info(shader, &info);
    return info;
}

uint32_t job_functions(const whit_shader_info *shader, const char *names[WHIT_HOOKS])
{
    uint32_t count = 0;
    for (unsigned i = 0; i < WHIT_HOOKS; ++i) {
        if (shader->hooks >> i & 1)
            names[count++] = whit_hook_name((whit_hook)i);
    }
    return count;
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
    whit_shader_destroy(job->shader);
    whit_shader_compiler_destroy(job->compiler);
}
