#include <stdlib.h>

#include "app/commands.h"
#include "app/ray_file.h"

enum trace_id { ID_RAYS = JOB_ID_END, ID_ANY, ID_ON };

/* Rays in memory at a time. */
enum { CHUNK = 1 << 20 };

static const struct setting_value values_on[] = {{"device", WHIT_TRACE_DEVICE, NULL},
                                                 {"cpu", WHIT_TRACE_CPU_FLOAT, NULL},
                                                 {"brute", WHIT_TRACE_CPU_BRUTE, NULL},
                                                 {0}};

static const struct cli_option options[] = {
    {ID_RAYS, "rays", "FILE", "little-endian records: float origin[3], tmin, dir[3], tmax", NULL},
    {'o', "output", "FILE",
     "little-endian records: float t (inf: miss), u, v;\n"
     "uint32 primitive (0xffffffff: miss), instance; float ng[3]",
     NULL},
    {ID_ANY, "any", NULL, "any hit will do: only `primitive` says something", NULL},
    {ID_ON, "on", NULL,
     "where: Vulkan, its twin on the CPU, the twin without\n"
     "trees (device)",
     values_on},
    JOB_OPTION_TIME,
    JOB_OPTION_DEVICE,
    JOB_OPTION_TREES,
    JOB_OPTION_FOREIGN,
    {JOB_TIME_LIMIT, "time-limit", "S", "give up after S seconds, with exit code 5", NULL},
    {JOB_VALIDATION, "validation", NULL, "run with the Vulkan validation layers", NULL},
    {'q', "quiet", NULL, "no notes, no progress, only errors", NULL},
    {0},
};

struct trace {
    const char *rays_path, *output;
    uint32_t on; /* whit_trace_on */
    bool any;
    struct ray_file input;
    uint64_t done_count;
    double trace_ms;
    whit_ray *rays;
    whit_hit *hits;
    whit_file *file;
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
        if (cli_time_over()) {
            cli_error("the time limit has passed");
            return WHIT_ERROR_TIME_LIMIT;
        }
        double start_ms = whit_clock_ms();
        result = whit_trace(renderer, (whit_trace_on)trace->on, trace->rays, count, trace->any,
                            trace->hits, NULL);
        trace->trace_ms += whit_clock_ms() - start_ms;
        if (result == WHIT_OK)
            result = whit_file_append(trace->file, trace->hits, count * sizeof(whit_hit));
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
    /* A small file needs no large blocks. */
    trace->rays = malloc((size_t)CHUNK * sizeof *trace->rays);
    trace->hits = malloc((size_t)CHUNK * sizeof *trace->hits);
    if (trace->rays && trace->hits)
        return WHIT_OK;
    cli_error("out of memory");
    return WHIT_ERROR_MEMORY;
}

static whit_result prepare(struct job *job, struct trace *trace, whit_renderer **renderer)
{
    const whit_renderer_params params = {
        .width = 16,
        .height = 16,
        .time_s = job->time_s,
        .cancel = &cli_cancel,
        .load_path = job->load_path,
        .traversal = job->traversal,
        .numerics = job->numerics,
    };
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
    if (job->quiet)
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
    cli_progress_init(&progress, job->quiet);
    if (result == WHIT_OK)
        result = whit_file_begin(trace->output, &cli_log, &trace->file);
    if (result == WHIT_OK) {
        result = trace_chunks(trace, renderer, &progress);
        if (result == WHIT_OK && cli_cancel)
            result = WHIT_ERROR_CANCELLED;
        if (result == WHIT_OK) {
            cli_set_saving();
            result = whit_file_commit(trace->file);
        } else {
            whit_file_abandon(trace->file);
        }
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

static bool check_request(struct cli_reader *reader, const struct trace *trace)
{
    if (!trace->rays_path)
        return cli_misuse(reader, "--rays FILE is missing");
    if (!trace->output)
        return cli_misuse(reader, "-o FILE is missing: where should the hits go?");
    if (!cli_no_dash(reader, "--rays", trace->rays_path, "for a pipe give /dev/stdin") ||
        !cli_no_dash(reader, "-o", trace->output, "for a pipe give /dev/stdout"))
        return false;
    if (cli_can_write(trace->output))
        return true;
    reader->status = EXIT_USAGE;
    return false;
}

static void read_option(struct cli_reader *reader, int id, struct job *job, struct trace *trace)
{
    if (id == ID_RAYS)
        trace->rays_path = reader->value;
    else if (id == 'o')
        trace->output = reader->value;
    else if (id == ID_ANY)
        trace->any = true;
    else if (id == ID_ON)
        cli_choice_unsigned(reader, &trace->on);
    else
        job_option(job, reader, id);
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    struct trace trace = {.on = WHIT_TRACE_DEVICE};
    job_init(&job);
    cli_reader_init(&reader, command, argc, argv);
    for (int id; (id = cli_next(&reader)) != 0;)
        read_option(&reader, id, &job, &trace);
    if (!job_options_done(&job, &reader) || !check_request(&reader, &trace))
        return reader.status;
    int status = work(&job, &trace);
    job_finish(&job);
    free(trace.rays);
    free(trace.hits);
    ray_file_close(&trace.input);
    return status;
}

const struct cli_command command_trace = {
    .name = "trace",
    .arguments = "SCENE --rays FILE -o FILE [options]",
    .summary = "Traces a batch of rays and writes their hits.",
    .details =
        "Hits are those with tmin <= t <= tmax; directions need not be unit. `instance` and\n"
        "`primitive` are those of `whit scene --triangles`.\n",
    .options = options,
    .run = run,
};
