#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/bvh/study_rays.h"
#include "bench/rays_batch.h"
#include "whit/whit_program.h"

const char *const rays_kind_names[RAYS_KINDS] = {"camera", "shadow", "bounce"};
static const char *const ways[] = {"single", "packets", "stream"};

/* ---- Rays ---- */

/* Shuffles by the Fisher-Yates algorithm. */
static void shuffle(whit_ray *rays, uint64_t count)
{
    for (uint64_t i = count; i > 1; --i) {
        uint64_t j = (uint64_t)(study_random(i) * (double)i);
        whit_ray kept = rays[i - 1];
        rays[i - 1] = rays[j];
        rays[j] = kept;
    }
}

/* Makes rays of a kind in tiles: all camera rays, or one for each hit of these. The light is above
   one corner of the scene's box. */
static uint64_t make_rays(const struct model *model, enum rays_kind kind, whit_ray *rays)
{
    static const double where[3] = {0.7, 1.8, 0.6};
    const whit_scene_info *info = &model->loaded.info;
    double light[3], size = study_scene_size(model->loaded.scene);
    for (int k = 0; k < 3; ++k)
        light[k] = (double)(float)(info->lo[k] + where[k] * (info->hi[k] - info->lo[k]));
    uint64_t count = 0;
    for (uint32_t i = 0; i < model->camera.count; ++i) {
        const whit_ray *ray = &model->camera.rays[i];
        const whit_hit *hit = &model->hits[i];
        if (kind == RAYS_CAMERA)
            rays[count++] = *ray;
        else if (hit->primitive != WHIT_NONE)
            rays[count++] = kind == RAYS_SHADOW ? study_light_ray(light, ray, hit)
                                                : study_bounce_ray(ray, hit, i, size);
    }
    return count;
}

/* ---- Sides ---- */

static double thread_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* The time from rays in device memory to hits in device memory. On a CPU device it is the processor
   time of all threads but this one, which only copies rays and hits while the driver computes in
   threads of its own. On other devices it is the device's time. */
static whit_result trace_here(struct model *model, double *ms)
{
    double all = whit_clock_cpu_ms(), own = thread_ms();
    whit_result result = whit_trace(model->renderer, WHIT_TRACE_DEVICE, model->rays, model->count,
                                    model->batch->any, model->traced, NULL);
    *ms = model->bench->is_cpu ? whit_clock_cpu_ms() - all - (thread_ms() - own)
                               : whit_trace_device_ms(model->renderer);
    return result;
}

static enum peer_kind peer_of(enum rays_side side)
{
    return side == RAYS_PIPELINE ? PEER_PIPELINE : PEER_EMBREE;
}

static whit_result trace_by_peer(struct model *model, enum rays_side side, double ms[2])
{
    bool back = side >= RAYS_BACK;
    const char *way =
        side == RAYS_PIPELINE ? ways[0] : ways[side - (back ? RAYS_BACK : RAYS_SINGLE)];
    return peer_trace(&model->peers[peer_of(side)], way, back, model->batch->coherent, ms);
}

/* Round 0 is a warm-up. */
static whit_result run_side(void *user, uint32_t number, uint32_t round)
{
    struct model *model = user;
    enum rays_side side = (enum rays_side)number;
    double ms[2] = {0.0}; /* processor time, wall clock */
    if (side != RAYS_WHIT && !model->has_peer[peer_of(side)])
        return WHIT_OK;
    whit_result result = side == RAYS_WHIT ? trace_here(model, ms) : trace_by_peer(model, side, ms);
    double time_ms = side == RAYS_WHIT || model->bench->is_cpu ? ms[0] : ms[1];
    if (result == WHIT_OK && round > 0 && time_ms >= 0.0)
        sample_add(&model->batch->sides[side], time_ms);
    return result == WHIT_OK && side == RAYS_WHIT ? bench_step(model->bench) : result;
}

const struct sample_runs *batch_quicker(const struct batch *batch, enum rays_side side)
{
    if (side == RAYS_PIPELINE)
        return &batch->sides[side];
    const struct sample_runs *forth = &batch->sides[side],
                             *back = &batch->sides[side - RAYS_SINGLE + RAYS_BACK];
    return batch->any && back->count && sample_of(back).median < sample_of(forth).median ? back
                                                                                         : forth;
}

static whit_result run_sides(struct model *model, const char *file)
{
    whit_result result =
        bench_write(model->bench, file, model->rays, (size_t)model->count * sizeof(whit_ray));
    for (int kind = 0; result == WHIT_OK && kind < PEER_KINDS; ++kind)
        if (model->has_peer[kind])
            result = peer_rays(&model->peers[kind], file, model->batch->any);
    if (result == WHIT_OK)
        result = sample_in_turns(model->batch->any ? RAYS_SIDES : RAYS_BACK,
                                 model->bench->ask.runs + 1, run_side, model);
    return result;
}

/* ---- Hits ---- */

static void compare_hits(const struct model *model, const whit_hit *theirs,
                         struct agreement *agreement)
{
    double size = study_scene_size(model->loaded.scene);
    for (uint64_t i = 0; i < model->count; ++i) {
        const whit_hit *a = &model->traced[i], *b = &theirs[i];
        const float *d = model->rays[i].dir;
        bool met = a->primitive != WHIT_NONE;
        ++agreement->rays;
        agreement->one_alone += met != (b->primitive != WHIT_NONE);
        if (model->batch->any || !met || b->primitive == WHIT_NONE)
            continue;
        double length = sqrt((double)(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
        double apart = fabs((double)a->t - (double)b->t) * length;
        agreement->other_ids += a->primitive != b->primitive || a->instance != b->instance;
        agreement->other_t += apart > 1e-4 * (double)a->t * length + 1e-6 * size;
    }
}

static whit_result read_hits(const char *path, whit_hit *hits, uint64_t count)
{
    FILE *from = fopen(path, "rb");
    bool whole = from && fread(hits, sizeof *hits, (size_t)count, from) == count;
    if (from)
        fclose(from);
    if (whole)
        return WHIT_OK;
    return CLI_FAIL(WHIT_ERROR_INPUT, "%s: cannot read", path);
}

/* Lets a peer write its hits to a file, and compares them. */
static whit_result compare_peer(struct model *model, struct peer *peer, const char *file,
                                struct agreement *agreement)
{
    char path[BENCH_PATH];
    double ms[2];
    whit_hit *theirs = malloc((size_t)(model->count + 1) * sizeof *theirs);
    if (!theirs)
        return WHIT_ERROR_MEMORY;
    whit_result result = peer_trace(peer, ways[0], false, false, ms);
    if (result == WHIT_OK)
        result = peer_hits(peer, file);
    bench_file(model->bench, file, path);
    if (result == WHIT_OK)
        result = read_hits(path, theirs, model->count);
    if (result == WHIT_OK)
        compare_hits(model, theirs, agreement);
    free(theirs);
    return result;
}

whit_result batch_run(struct model *model, struct batch *batch, enum rays_kind kind, bool shuffled,
                      struct agreement agreement[PEER_KINDS])
{
    static const char *const ends[] = {"rays", "whit.hits", "embree.hits", "pipeline.hits"};
    enum { FILES = sizeof ends / sizeof *ends };
    char files[FILES][96], path[BENCH_PATH];
    for (int i = 0; i < FILES; ++i)
        snprintf(files[i], sizeof files[i], "%s-%s%s.%s", model->name, rays_kind_names[kind],
                 shuffled ? "-shuffled" : "", ends[i]);
    model->batch = batch;
    batch->any = kind == RAYS_SHADOW;
    batch->coherent = kind != RAYS_BOUNCE && !shuffled;
    model->count = make_rays(model, kind, model->rays);
    if (shuffled)
        shuffle(model->rays, model->count);
    whit_result result = run_sides(model, files[0]);
    if (result == WHIT_OK)
        result = bench_write(model->bench, files[1], model->traced,
                             (size_t)model->count * sizeof(whit_hit));
    for (int peer = 0; result == WHIT_OK && peer < PEER_KINDS; ++peer)
        if (model->has_peer[peer])
            result = compare_peer(model, &model->peers[peer], files[2 + peer], &agreement[peer]);
    for (int i = 0; i < FILES && !model->bench->ask.keep; ++i) {
        bench_file(model->bench, files[i], path);
        remove(path);
    }
    return result;
}

whit_result batch_count(struct model *model, struct visits *visits)
{
    const whit_renderer_params params = {.width = 16,
                                         .height = 16,
                                         .cancel = &cli_cancel,
                                         .packets = WHIT_PACKETS_ON,
                                         .count = true};
    whit_renderer *renderer;
    whit_result result =
        whit_renderer_create(model->bench->device, model->loaded.accel, &params, &renderer);
    if (result != WHIT_OK)
        return result;
    result = whit_trace(renderer, WHIT_TRACE_DEVICE, model->rays, model->count, model->batch->any,
                        model->traced, &visits->together);
    if (result == WHIT_OK)
        result = whit_trace(renderer, WHIT_TRACE_CPU_FLOAT, model->rays, model->count,
                            model->batch->any, model->traced, &visits->alone);
    whit_renderer_destroy(renderer);
    return result;
}
