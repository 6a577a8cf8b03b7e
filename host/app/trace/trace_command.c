#include <stdlib.h>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/job.h"
#include "app/trace/ray_file.h"
#include "base/file.h"

/* Number of rays in memory at a time. */
enum { CHUNK = 1 << 20 };

static const struct setting_value values_on[] = {{"device", WHIT_TRACE_DEVICE, NULL},
                                                 {"cpu", WHIT_TRACE_CPU_FLOAT, NULL},
                                                 {"brute", WHIT_TRACE_CPU_BRUTE, NULL},
                                                 {0}};

struct trace {
    const char *rays_path, *output;
    uint32_t on; /* whit_trace_on */
    bool any;
    struct ray_file input;
    uint64_t done_count;
    double trace_ms;
    whit_ray *rays;
    whit_hit *hits;
    struct file_write file;
};

static const struct setting options[] = {
    {"input", 'i', "FILE", "rays: little-endian records: float origin[3], tmin, dir[3], tmax",
     SETTING_AT_NAME(struct trace, rays_path)},
    {"output", 'o', "FILE",
     "hits: little-endian records: float t (inf: miss), u, v;\n"
     "uint32 primitive (0xffffffff: miss), instance; float ng[3]",
     SETTING_AT_NAME(struct trace, output), .written = true},
    {"rays", 0, NULL, "is `--input` now", .kind = SETTING_GONE},
    {"any", 0, NULL, "any hit will do: only `primitive` says something",
     SETTING_AT_FLAG(struct trace, any)},
    {"on", 0, NULL,
     "where: Vulkan, its twin on the CPU, the twin without\n"
     "trees (device)",
     SETTING_AT_CHOICE(struct trace, on), .values = values_on},
    {0},
};

static whit_result trace_chunks(struct trace *trace, whit_renderer *renderer,
                                struct cli_progress *progress)
{
    for (;;) {
        uint64_t count;
        whit_result result = cli_cancel ? WHIT_ERROR_CANCELLED
                                        : ray_file_read(&trace->input, trace->rays, CHUNK, &count);
        if (result != WHIT_OK || count == 0)
            return result;
        result = job_still_wanted();
        if (result != WHIT_OK)
            return result;
        double start_ms = whit_clock_ms();
        result = whit_trace(renderer, (whit_trace_on)trace->on, trace->rays, count, trace->any,
                            trace->hits, NULL);
        trace->trace_ms += whit_clock_ms() - start_ms;
        if (result == WHIT_OK)
            result =
                file_write_append(&cli_log, &trace->file, trace->hits, count * sizeof(whit_hit));
        if (result != WHIT_OK)
            return result;
        trace->done_count += count;
        if (trace->input.ray_count)
            cli_progress_update(progress,
                                (double)trace->done_count / (double)trace->input.ray_count);
    }
}

static whit_result allocate(struct trace *trace)
{
    /* A small file touches only the first pages of these blocks. */
    trace->rays = malloc((size_t)CHUNK * sizeof *trace->rays);
    trace->hits = malloc((size_t)CHUNK * sizeof *trace->hits);
    return trace->rays && trace->hits ? WHIT_OK : cli_no_memory();
}

static whit_result prepare(struct job *job, struct trace *trace, whit_renderer **renderer)
{
    whit_renderer_params params = settings_picture(&job->settings);
    params.cancel = &cli_cancel;
    whit_result result = ray_file_open(trace->rays_path, &trace->input);
    if (result == WHIT_OK)
        result = allocate(trace);
    if (result == WHIT_OK && trace->on == WHIT_TRACE_DEVICE)
        job_begin_device(job);
    if (result == WHIT_OK)
        result = job_load(job);
    if (result == WHIT_OK) {
        job_print_notes(job, false);
        result = job_build(job);
    }
    if (result == WHIT_OK && trace->on == WHIT_TRACE_DEVICE)
        result = job_open_device(job);
    if (result == WHIT_OK)
        result = whit_renderer_create(job->device, job->accel, &params, renderer);
    return result;
}

static void say_done(const struct job *job, const struct trace *trace)
{
    if (job->settings.quiet)
        return;
    fprintf(stderr, "whit: %s: %llu rays in %.3f s (%.2f Mray/s)\n", cli_shown(trace->output),
            (unsigned long long)trace->done_count, trace->trace_ms * 1e-3,
            trace->trace_ms > 0.0 ? (double)trace->done_count / trace->trace_ms * 1e-3 : 0.0);
}

static int work(struct job *job, struct trace *trace)
{
    struct cli_progress progress;
    whit_renderer *renderer = NULL;
    int status = EXIT_FINE;
    whit_result result = prepare(job, trace, &renderer);
    cli_progress_init(&progress, job->settings.quiet);
    if (result == WHIT_OK)
        result = file_write_begin(&cli_log, trace->output, &trace->file);
    if (result == WHIT_OK) {
        result = trace_chunks(trace, renderer, &progress);
        if (result == WHIT_OK && cli_cancel)
            result = WHIT_ERROR_CANCELLED;
        if (result == WHIT_OK)
            cli_set_saving();
        result = file_write_end(&cli_log, &trace->file, result);
    }
    cli_progress_finish(&progress);
    if (result == WHIT_OK)
        say_done(job, trace);
    else
        status = cli_exit_of(result);
    if (status == EXIT_FINE)
        status = job_check_validation(job);
    whit_renderer_destroy(renderer);
    return status;
}

static bool check_request(struct cli_reader *reader, const struct job *job,
                          const struct trace *trace)
{
    if (!trace->rays_path)
        return cli_misuse(reader, "--input FILE is missing");
    if (!trace->output)
        return cli_misuse(reader, "-o FILE is missing: where should the hits go?");
    if (trace->on != WHIT_TRACE_DEVICE && settings_given(&job->settings, "device"))
        return cli_misuse(reader, "--device: --on %s takes no device",
                          value_word(values_on, (int)trace->on));
    return cli_no_dash(reader, "--input", trace->rays_path, "for a pipe give /dev/stdin") &&
           cli_check_output(reader, "-o", trace->output, "for a pipe give /dev/stdout");
}

/* The renderer only traces rays, so its picture is kept small. */
static void set_usual(struct settings *settings)
{
    settings->picture.width = settings->picture.height = 16;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    struct trace trace = {.on = WHIT_TRACE_DEVICE};
    job_init(&job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!job_read(&job, &reader, &trace, false) || !check_request(&reader, &job, &trace))
        return reader.status;
    job_start(&job);
    int status = work(&job, &trace);
    job_finish(&job);
    free(trace.rays);
    free(trace.hits);
    ray_file_close(&trace.input);
    return status;
}

const struct cli_command command_trace = {
    .name = "trace",
    .arguments = "SCENE --input FILE -o FILE [options]",
    .summary = "Traces a batch of rays and writes their hits.",
    .details =
        "Hits are those with tmin <= t <= tmax; directions need not be unit. `instance` and\n"
        "`primitive` are those of `whit scene --triangles`.\n",
    .options = options,
    .settings = IN_TRACE,
    .usual = set_usual,
    .run = run,
};
