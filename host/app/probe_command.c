#include "app/probe.h"

#include <ctype.h>
#include <stdlib.h>

#include "app/cache.h"

enum probe_id { ID_PIXEL = PICTURE_ID_END, ID_JSON, ID_RAYS };

enum { RAYS_MOST = 16383 };

static const struct cli_option options[] = {
    {ID_PIXEL, "pixel", "X,Y", "which one, from 0,0 at the upper left", NULL},
    {ID_JSON, "json", "FILE", "also write all of it as JSON", NULL},
    {ID_RAYS, "rays", "N", "most rays that are recorded, 1 to 16383 (16383)", NULL},
    PICTURE_OPTION_PLACE,
    JOB_OPTION_TIME,
    PICTURE_OPTION_SHADING,
    JOB_OPTION_DEVICE,
    JOB_OPTION_TREES,
    JOB_OPTION_LOADING,
    {JOB_TIME_LIMIT, "time-limit", "S", "give up after S seconds, with exit code 5", NULL},
    {JOB_VALIDATION, "validation", NULL, "run with the Vulkan validation layers", NULL},
    {'q', "quiet", NULL, "no notes, no progress, only errors", NULL},
    {0},
};

static bool read_coordinate(const char **text, char end, uint32_t *out)
{
    char *after;
    if (!isdigit((unsigned char)**text))
        return false;
    unsigned long value = strtoul(*text, &after, 10);
    *out = value < UINT32_MAX ? (uint32_t)value : UINT32_MAX;
    *text = after + 1;
    return *after == end;
}

static void read_pixel(struct cli_reader *reader, struct probe *probe)
{
    const char *text = reader->value;
    probe->has_pixel =
        read_coordinate(&text, ',', &probe->x) && read_coordinate(&text, '\0', &probe->y);
    if (!probe->has_pixel)
        cli_misuse(reader, "--pixel `%s`: two numbers X,Y are needed, such as 320,240",
                   reader->value);
}

static void read_option(struct cli_reader *reader, int id, struct probe *probe)
{
    if (id == ID_PIXEL)
        read_pixel(reader, probe);
    else if (id == ID_JSON)
        probe->json_path = reader->value;
    else if (id == ID_RAYS)
        cli_unsigned(reader, 1, RAYS_MOST, &probe->most_rays);
    else if (!picture_option(reader, id, &probe->request))
        job_option(&probe->job, reader, id);
}

static bool check_request(struct cli_reader *reader, const struct probe *probe)
{
    const struct picture *picture = &probe->request.picture;
    if (!probe->has_pixel)
        return cli_misuse(reader, "--pixel X,Y is missing: which pixel?");
    if (probe->x >= picture->width || probe->y >= picture->height)
        return cli_misuse(reader,
                          "--pixel %u,%u: outside of the picture of %u x %u pixels, which are 0,0 "
                          "to %u,%u; --size asks for another one",
                          probe->x, probe->y, picture->width, picture->height, picture->width - 1,
                          picture->height - 1);
    if (picture->adaptive > 0.0)
        return cli_misuse(reader, "--aa adaptive: how many samples a pixel gets is a matter of its "
                                  "neighbours; say 4, 16 or 64");
    if (!cli_no_dash(reader, "--json", probe->json_path, "for a pipe give /dev/stdout"))
        return false;
    if (!probe->json_path || cli_can_write(probe->json_path))
        return true;
    reader->status = EXIT_USAGE;
    return false;
}

static whit_result find_out(struct probe *probe)
{
    struct frames_progress progress = {.count = 1};
    whit_renderer *renderer = NULL;
    cli_progress_init(&progress.bar, true);
    whit_result result = render_prepare(&probe->job, &probe->request, &progress, &renderer);
    if (result == WHIT_OK)
        result = whit_probe(renderer, probe->x, probe->y, probe->most_rays, &probe->report);
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
    int status = probe_print(probe);
    const whit_probe_report *report = probe->report;
    if (report->dropped)
        cli_warning("%u of %u rays had no room and are not shown: --rays", report->dropped,
                    report->ray_count + report->dropped);
    if (status == EXIT_FINE && report->differing && probe->job.numerics != WHIT_NUMERICS_FAST) {
        cli_error("the device and its twin differ in %u of %u rays", report->differing,
                  report->ray_count);
        status = EXIT_DIFFERS;
    }
    return status == EXIT_FINE ? job_check_validation(&probe->job) : status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct probe probe = {.request = picture_request_default()};
    job_init(&probe.job);
    cache_plain_code(); /* kernels for the rays of one pixel */
    cli_reader_init(&reader, command, argc, argv);
    for (int id; (id = cli_next(&reader)) != 0;)
        read_option(&reader, id, &probe);
    if (!job_options_done(&probe.job, &reader) || !check_request(&reader, &probe))
        return reader.status;
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
        "Exit code 1 when device and twin differ, but at --numerics fast.\n",
    .options = options,
    .run = run,
};
