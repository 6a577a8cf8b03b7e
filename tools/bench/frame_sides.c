#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/frame_rays.h"
#include "bench/frame_sides.h"
#include "bench/process.h"
#include "whit/whit_program.h"

static whit_renderer_params params_of(const struct frame *frame)
{
    return (whit_renderer_params){
        .width = frame->width,
        .height = frame->height,
        .depth = frame->depth,
        .bailout = strtod(frame->bailout, NULL),
        .light_samples = 16,
        .cancel = &cli_cancel,
    };
}

static whit_numerics level_of(enum frame_side side)
{
    return side == FRAME_FAST    ? WHIT_NUMERICS_FAST
           : side == FRAME_EXACT ? WHIT_NUMERICS_EXACT
                                 : WHIT_NUMERICS_WATERTIGHT;
}

/* Finds out whether whit draws the picture with packets where it chooses by itself. */
static whit_result find_packets(struct frame *frame, enum frame_side side)
{
    whit_renderer_params params = params_of(frame);
    whit_renderer *renderer = NULL;
    whit_stats stats;
    params.numerics = level_of(side);
    whit_result result =
        whit_renderer_create(frame->bench->device, frame->loaded.accel, &params, &renderer);
    if (result != WHIT_OK)
        return result;
    whit_renderer_get_stats(renderer, &stats);
    frame->packets[side] = stats.packets;
    whit_renderer_destroy(renderer);
    return WHIT_OK;
}

whit_result frame_prepare(struct frame *frame)
{
    static const enum frame_side levels[] = {FRAME_WHIT, FRAME_FAST, FRAME_EXACT};
    const whit_renderer_params params = params_of(frame);
    whit_result result = bench_load_trees(frame->path, &frame->loaded);
    for (size_t i = 0; result == WHIT_OK && i < sizeof levels / sizeof *levels; ++i)
        result = find_packets(frame, levels[i]);
    frame->packets[FRAME_AGAINST] = frame->packets[FRAME_WHIT];
    if (result == WHIT_OK)
        result = whit_reference_create(frame->loaded.accel, &params, 0, &frame->reference);
    return result;
}

void frame_finish(struct frame *frame)
{
    peer_end(&frame->peer);
    whit_reference_destroy(frame->reference);
    bench_unload(&frame->loaded);
}

/* ---- Programs ---- */

/* Runs a process. On a CPU device its time is processor time; the work of other devices shows only
   in wall clock time. */
static whit_result run_process(const struct frame *frame, struct process *process, double *ms)
{
    struct process_times times = {0};
    whit_result result = process_run(process, &times);
    *ms = frame->bench->is_cpu ? times.cpu_ms : times.clock_ms;
    return result;
}

static double now_ms(const struct frame *frame)
{
    return frame->bench->is_cpu ? whit_clock_cpu_ms() : whit_clock_ms();
}

static whit_result run_whit(const struct frame *frame, enum frame_side side, uint32_t width,
                            uint32_t height, double *ms)
{
    bool is_other = side == FRAME_AGAINST;
    const char *program = is_other ? frame->peers->against : frame->bench->whit;
    char size[32], depth[16];
    struct process process = {
        .program = program, .folder = frame->bench->folder, .err = "whit.err"};
    snprintf(size, sizeof size, "%ux%u", width, height);
    snprintf(depth, sizeof depth, "%u", frame->depth);
    process_add(&process, is_other ? program : "whit", "render", frame->path, "-o", "whit.pfm",
                "--size", size, "--aa", "1", "--depth", depth, "--bailout", frame->bailout,
                "--light-samples", "16", "--quiet", NULL);
    if (side == FRAME_FAST || side == FRAME_EXACT)
        process_add(&process, "--numerics", side == FRAME_FAST ? "fast" : "exact", NULL);
    /* The small picture gets the kernels that the large one has by whit's own choice, which another
       whit is taken to share, so that the time before the first ray cancels out. */
    if (width == frame->small_width && (!is_other || frame->peers->against_chooses))
        process_add(&process, "--packets", frame->packets[side] ? "on" : "off", "--classes", "many",
                    NULL);
    process_add_device(&process, frame->bench);
    if (frame->bench->ask.settings.no_cache)
        process_add(&process, "--no-cache", NULL);
    return run_process(frame, &process, ms);
}

static whit_result run_pov(const struct frame *frame, uint32_t width, uint32_t height, double *ms)
{
    char home[BENCH_PATH + 8], input[64], wide[32], high[32], threads[32];
    struct process process = {
        .program = "env", .folder = frame->bench->folder, .out = "pov.out", .err = "pov.err"};
    snprintf(home, sizeof home, "HOME=%s", frame->bench->folder);
    snprintf(input, sizeof input, "+I%s.pov", frame->name);
    snprintf(wide, sizeof wide, "+W%u", width);
    snprintf(high, sizeof high, "+H%u", height);
    snprintf(threads, sizeof threads, "+WT%ld", sysconf(_SC_NPROCESSORS_ONLN));
    process_add(&process, "povray", home, "povray", input, "+Opov.ppm", "+FP16", wide, high, "-A",
                "-D", "File_Gamma=1.0", "-GA", threads, NULL);
    return run_process(frame, &process, ms);
}

static whit_result run_reference(const struct frame *frame, double *ms)
{
    whit_image *color = NULL;
    double before = now_ms(frame);
    whit_result result = whit_reference_render(frame->reference, &color, NULL);
    *ms = now_ms(frame) - before;
    whit_image_destroy(color);
    return result;
}

/* ---- Turns ---- */

static whit_result draw(struct frame *frame, enum frame_side side, double *ms)
{
    if (side == FRAME_REFERENCE)
        return run_reference(frame, ms);
    if (side == FRAME_EMBREE)
        return frame_trace_rays(frame, ms);
    double small = 0.0;
    uint32_t width = frame->small_width, height = frame->small_height;
    whit_result result = side == FRAME_POV ? run_pov(frame, frame->width, frame->height, ms)
                                           : run_whit(frame, side, frame->width, frame->height, ms);
    if (result == WHIT_OK && width)
        result = side == FRAME_POV ? run_pov(frame, width, height, &small)
                                   : run_whit(frame, side, width, height, &small);
    *ms -= small;
    return result;
}

/* Round 0 only fills caches; quick benches count it too. */
static whit_result run_side(void *user, uint32_t index, uint32_t round)
{
    struct frame *frame = user;
    enum frame_side side = frame->sides[index];
    double ms = 0.0;
    whit_result result = draw(frame, side, &ms);
    if (result == WHIT_OK && (round > 0 || frame->bench->ask.quick))
        sample_add(&frame->ms[side], ms);
    return cli_cancel ? WHIT_ERROR_CANCELLED : result;
}

whit_result frame_run(struct frame *frame)
{
    uint32_t rounds = frame->bench->ask.runs + (frame->bench->ask.quick ? 0 : 1);
    return sample_in_turns(frame->side_count, rounds, run_side, frame);
}

/* ---- Memory ---- */

static whit_result device_bytes(const struct frame *frame, const whit_renderer_params *params,
                                uint64_t *bytes)
{
    whit_renderer *renderer = NULL;
    whit_stats stats = {0};
    whit_result result =
        whit_renderer_create(frame->bench->device, frame->loaded.accel, params, &renderer);
    if (result == WHIT_OK) {
        result = whit_renderer_render(renderer);
        whit_renderer_get_stats(renderer, &stats);
    }
    whit_renderer_destroy(renderer);
    *bytes = stats.device_bytes;
    return result;
}

whit_result frame_memory(const struct frame *frame, double *megabytes)
{
    const whit_renderer_params whole = params_of(frame);
    whit_renderer_params min = whole;
    uint64_t with = 0, without = 0;
    min.width = min.height = 16;
    min.depth = 0;
    min.shadows = WHIT_SHADOWS_NONE;
    whit_result result = device_bytes(frame, &whole, &with);
    if (result == WHIT_OK)
        result = device_bytes(frame, &min, &without);
    /* A pixel takes 24 bytes: its colour and two ids. The small picture has 256 pixels. */
    double pixels = 24.0 * ((double)frame->width * frame->height - 256.0);
    *megabytes = ((double)with - (double)without - pixels) * 1e-6;
    return result;
}
