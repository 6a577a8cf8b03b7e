#include <string.h>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/merge/merge.h"
#include "app/render/recipe.h"
#include "base/path.h"
#include "base/platform.h"

struct merge_request {
    const char *output;
    bool json; /* --stats json */
    const char *paths[CLI_OTHERS_MAX + 1];
    uint32_t count;
};

static const struct setting_value values_stats[] = {{"json", 1, NULL}, {0}};
static const struct setting options[] = {
    {"output", 'o', "FILE", "the picture, of the parts' kind: .png, .exr or .pfm",
     SETTING_AT_NAME(struct merge_request, output), .written = true},
    {"stats", 0, NULL, "sums over all parts on standard output", .usual = "",
     SETTING_AT_EITHER(struct merge_request, json), .values = values_stats},
    {0},
};

static bool check_request(struct cli_reader *reader, struct merge_request *request)
{
    char extension[16];
    if (!reader->positional)
        return cli_misuse(reader, "parts of a picture are missing");
    request->paths[request->count++] = reader->positional;
    for (uint32_t i = 0; i < reader->other_count; ++i)
        request->paths[request->count++] = reader->others[i];
    if (!request->output)
        return cli_misuse(reader, "-o FILE is missing: where should the picture go?");
    path_extension(request->output, extension, sizeof extension);
    for (uint32_t i = 0; i < request->count; ++i) {
        if (!path_is(request->paths[i], extension))
            return cli_misuse(reader,
                              "%s and %s: the picture is a file of its parts' kind, which alone "
                              "has all that they hold",
                              request->paths[i], request->output);
    }
    if (!whit_image_format_known(request->output, false))
        return cli_misuse(reader, "%s: pictures are .png, .exr or .pfm", request->output);
    return cli_check_writable(reader, request->output);
}

static int print_stats(const struct merge *merge, const struct merge_request *request)
{
    const struct part_place *place = &merge->parts[0].place;
    json_t *root = document_root(), *picture = document_child(root, "picture");
    document_text(picture, "file", request->output);
    document_count(picture, "width", place->width);
    document_count(picture, "height", place->height);
    document_count(picture, "samples", place->samples);
    document_count(root, "parts", merge->count);
    document_count(root, "tiles", merge->tiles);
    document_count(root, "samples_parts", merge->sets);
    document_put(root, "rays", recipe_rays(&merge->stats));
    document_count(document_child(root, "memory"), "host_peak_bytes", platform_peak_memory_bytes());
    return cli_print_json(root);
}

static int work(const struct job *job, const struct merge_request *request)
{
    const char *folders[SETTING_FOLDERS_MAX];
    whit_load_params load = settings_load(&job->settings, folders);
    struct cli_progress progress;
    struct merge merge;
    load.cancel = &cli_cancel;
    cli_progress_init(&progress, job->settings.quiet);
    whit_result result = merge_read(&merge, request->paths, request->count, &load);
    if (result == WHIT_OK)
        result = merge_check(&merge);
    if (result == WHIT_OK)
        result = merge_write(&merge, request->output, &progress);
    cli_progress_finish(&progress);
    int status = cli_exit_of(result);
    if (status == EXIT_FINE && request->json)
        status = print_stats(&merge, request);
    else if (status == EXIT_FINE && !job->settings.quiet)
        fprintf(stderr, "whit: %s: %u x %u, of %u parts\n", cli_shown(request->output),
                merge.parts[0].place.width, merge.parts[0].place.height, merge.count);
    merge_finish(&merge);
    return status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    struct merge_request request = {0};
    job_init(&job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!cli_read(&reader, &request, &job.settings) || !check_request(&reader, &request))
        return reader.status;
    return work(&job, &request);
}

const struct cli_command command_merge = {
    .name = "merge",
    .arguments = "PART... -o FILE [options]",
    .summary = "Puts parts of a picture together, to the pixels of one run.",
    .details =
        "PART are the files of `whit render --tile` and `--samples-part`, in any order, or those\n"
        "of their --ids. All parts of one picture have to be there, each once. Memory is that of\n"
        "a tile.\n",
    .options = options,
    .settings = IN_MERGE,
    .others_max = CLI_OTHERS_MAX,
    .run = run,
};
