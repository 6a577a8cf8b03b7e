#include "app/probe/probe_output.h"

#include "app/arguments.h"
#include "app/cache.h"
#include "app/commands.h"
#include "app/render/render_command.h"
#include "base/text.h"

enum { RAYS_MAX = 16383 };

static bool read_pixel(const struct setting *setting, const char *value, void *record, char *why)
{
    struct probe *probe = record;
    const char *rest = text_number(value, UINT32_MAX, &probe->x);
    (void)setting;
    rest = rest && *rest == ',' ? text_number(rest + 1, UINT32_MAX, &probe->y) : NULL;
    probe->has_pixel = rest && !*rest;
    return probe->has_pixel ||
           setting_refuse(why, " `%s`: two numbers X,Y are needed, such as 320,240", value);
}

static const struct setting options[] = {
    {"pixel", 0, "X,Y", "which one, from 0,0 at the upper left", .kind = SETTING_OWN,
     .read = read_pixel},
    {"json", 0, "FILE", "also write all of it as JSON", SETTING_AT_NAME(struct probe, json_path),
     .written = true},
    {"rays", 0, "N", "most rays that are recorded, 1 to 16383 (16383)",
     SETTING_AT_COUNT(struct probe, max_rays), .min = 1, .max = RAYS_MAX},
    {0},
};

static bool check_request(struct cli_reader *reader, const struct probe *probe)
{
    const whit_renderer_params *picture = &probe->job.settings.picture;
    if (!probe->has_pixel)
        return cli_misuse(reader, "--pixel X,Y is missing: which pixel?");
    if (probe->x >= picture->width || probe->y >= picture->height)
        return cli_misuse(reader,
                          "--pixel %u,%u: outside of the picture of %u x %u pixels, which are 0,0 "
                          "to %u,%u; --size asks for another one",
                          probe->x, probe->y, picture->width, picture->height, picture->width - 1,
                          picture->height - 1);
    if (picture->sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        return cli_misuse(reader, "--aa adaptive: how many samples a pixel gets is a matter of its "
                                  "neighbours; say 4, 16 or 64");
    return cli_check_output(reader, "--json", probe->json_path, "for a pipe give /dev/stdout");
}

static whit_result find_out(struct probe *probe)
{
    const struct render_request request = {.keep_unread = true};
    struct frames_progress progress = {.count = 1};
    whit_renderer *renderer = NULL;
    cli_progress_init(&progress.bar, true);
    whit_result result = render_prepare(&probe->job, &request, &progress, &renderer);
    if (result == WHIT_OK)
        result = whit_probe(renderer, probe->x, probe->y, probe->max_rays, &probe->report);
    whit_renderer_destroy(renderer);
    return result == WHIT_OK ? job_still_wanted() : result;
}

static int work(struct probe *probe)
{
    whit_result result = find_out(probe);
    if (result == WHIT_OK && probe->json_path)
        result = probe_save_json(probe);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    int status = cli_is_piped(probe->json_path) ? EXIT_FINE : probe_print(probe);
    const whit_probe_report *report = probe->report;
    if (report->dropped)
        cli_warning("%u of %u rays had no room and are not shown: --rays", report->dropped,
                    report->ray_count + report->dropped);
    if (status == EXIT_FINE && report->differing &&
        probe->job.settings.picture.numerics != WHIT_NUMERICS_FAST) {
        cli_error("the device and its twin differ in %u of %u rays", report->differing,
                  report->ray_count);
        status = EXIT_DIFFERS;
    }
    return status == EXIT_FINE ? job_check_validation(&probe->job) : status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct probe probe = {.report = NULL};
    job_init(&probe.job, command);
    cache_plain_code(); /* kernels for the rays of one pixel */
    cli_reader_init(&reader, command, argc, argv);
    if (!job_read(&probe.job, &reader, &probe, false) || !check_request(&reader, &probe))
        return reader.status;
    job_start(&probe.job);
    int status = work(&probe);
    whit_probe_report_destroy(probe.report);
    job_finish(&probe.job);
    return status;
}

const struct cli_command command_probe = {
    .name = "probe",
    .arguments = "SCENE --pixel X,Y [options]",
    .summary = "Explains a pixel: what is there, and every ray that gave it its colour.",
    .details =
        "The picture is that of `whit render` with the same options; the rays are those of the\n"
        "pixel's first sample, as the device traced them, each below the one it comes from. "
        "Beside\n"
        "what the device met stands what its twin on the CPU says (`=`: the same, to the last "
        "bit)\n"
        "and what exact arithmetic says (`=`: the same primitive, and t to float; `-`: not "
        "known).\n"
        "A cut-out that let a ray pass is taken from the device.\n"
        "With --shader both say where rays end that the device sent with these functions; rays "
        "that\n"
        "functions trace themselves are in no row. Each dbg(x) of theirs is told with what x "
        "was.\n"
        "Exit code 1 when device and twin differ, but at --numerics fast.\n",
    .options = options,
    .settings = IN_PROBE,
    .run = run,
};
