#include "app/arguments.h"
#include "app/commands.h"
#include "app/scene/listing.h"

struct scene_request {
    const char *triangles; /* NULL: none */
    bool json, all, effects, kernels;
};

static const struct setting options[] = {
    {"json", 0, NULL, "everything as JSON", SETTING_AT_FLAG(struct scene_request, json)},
    {"all", 0, NULL, "list every item, not only the first of each kind",
     SETTING_AT_FLAG(struct scene_request, all)},
    {"triangles", 0, "FILE",
     "write every world-space triangle: little-endian records\n"
     "float v[9]; uint32 instance; uint32 primitive",
     SETTING_AT_NAME(struct scene_request, triangles), .written = true},
    {"effects", 0, NULL,
     "what each effect costs, measured on the device: times\n"
     "with and without it in turns, and what the picture\n"
     "would lose",
     SETTING_AT_FLAG(struct scene_request, effects)},
    {"kernels", 0, NULL,
     "the kernels of such a picture, what they take to make,\n"
     "and what the device's driver tells of them: subgroup\n"
     "size, registers and the like",
     SETTING_AT_FLAG(struct scene_request, kernels)},
    {0},
};

static int work(struct job *job, const struct scene_request *request)
{
    whit_scene_info info;
    job->keeps_axes = request->triangles != NULL;
    whit_result result = job_load_shader(job);
    if (result == WHIT_OK)
        result = job_load(job);
    if (result == WHIT_OK && request->triangles)
        result = triangles_write(job->scene, job->settings.picture.time_s, request->triangles);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    if (request->effects)
        return effect_report_run(job, request->json);
    if (request->kernels)
        return kernels_run(job, request->json);
    whit_scene_get_info(job->scene, &info);
    if (job->settings.picture.time_s != 0.0 && info.channel_count > 0 && !request->triangles &&
        !job->settings.quiet)
        cli_note("places are listed as they are at 0 s: --time is for --triangles, --effects and "
                 "--kernels");
    if (request->json)
        return listing_print_json(job, &info);
    return job->settings.quiet ? EXIT_FINE : listing_print_text(job, &info, request->all);
}

/* Whether an option was given that only matters for pictures, not for the list of what is in the
   scene. */
static bool is_for_picture(const struct settings *settings)
{
    static const char *const names[] = {"size",     "camera", "aa",          "depth",
                                        "numerics", "shader", "minification"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        if (settings_given(settings, names[i]))
            return true;
    }
    return false;
}

static void set_usual(struct settings *settings)
{
    settings->picture.width = 320;
    settings->picture.height = 240;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    struct scene_request request = {0};
    job_init(&job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!job_read(&job, &reader, &request, false) ||
        !cli_no_dash(&reader, "--triangles", request.triangles, "for a pipe give /dev/stdout"))
        return reader.status;
    if (is_for_picture(&job.settings) && !request.effects && !request.kernels)
        return CLI_MISUSE(
            &reader,
            "--size, --camera, --aa, --depth, --numerics, --minification and --shader are for the "
            "pictures of --effects and --kernels");
    if (request.effects && request.kernels)
        return CLI_MISUSE(&reader, "--effects and --kernels are two listings: give one of them");
    if (request.triangles && !cli_can_write(request.triangles))
        return EXIT_USAGE;
    job_start(&job);
    int status = work(&job, &request);
    job_finish(&job);
    return status;
}

const struct cli_command command_scene = {
    .name = "scene",
    .arguments = "SCENE [options]",
    .summary = "Lists what is in a scene, what is wrong with it, and the effects it calls for.",
    .details =
        "--size, --camera, --aa, --depth, --numerics, --minification and --shader are for the\n"
        "pictures of --effects and --kernels.\n",
    .options = options,
    .settings = IN_SCENE,
    .usual = set_usual,
    .run = run,
};
