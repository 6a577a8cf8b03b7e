/* hard RAYS: the rays of `whit hard` at edges and vertices from inside closed spheres, at offsets
   0, 1e3 and 1e5, by whit's levels, on the device and by its twin, and by Embree as it comes and
   ROBUST, all beside exact arithmetic. Fails where a level breaks its promise, where the device's
   hits are not the twin's bit for bit, or where `fast` leaks nothing: then the rays are no test. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "device/device.h"
#include "hard/judge.h"
#include "hard/mesh.h"
#include "hard/rays.h"
#include "peers.h"
#include "render/render.h"

enum { PIECE = 1 << 18, CHUNK = 4096, THREADS = 2 };
enum { FAST, WATERTIGHT, EXACT, EMBREE, EMBREE_ROBUST, TRACERS };

static const char *const names[TRACERS] = {"fast", "watertight", "exact", "Embree",
                                           "Embree ROBUST"};
static const uint32_t levels[] = {NUMERICS_FAST, NUMERICS_WATERTIGHT, NUMERICS_EXACT};

struct bench {
    struct hard_scene hard;
    struct embree *embree[2]; /* as it comes, robust; NULL: not installed */
    struct hard_ray *rays;
    struct rational_hit *exact;
    struct gpu_hit *hits, *device_hits;
    struct gpu_ray *device_rays;
    struct device *device;
    struct renderer *renderers[EXACT + 1];
    uint64_t differing[EXACT + 1]; /* hits of the device and of the twin */
    uint64_t count;                /* rays in memory */
    const struct embree *asked;
    whit_tally tallies[TRACERS];
};

static void embree_chunk(void *user, uint32_t chunk)
{
    const struct bench *bench = user;
    uint64_t first = (uint64_t)chunk * CHUNK;
    uint64_t end = first + CHUNK < bench->count ? first + CHUNK : bench->count;
    for (uint64_t i = first; i < end; ++i)
        embree_trace(bench->asked, &bench->rays[i].ray, &bench->hits[i]);
}

static uint32_t chunks_of(uint64_t count)
{
    return (uint32_t)((count + CHUNK - 1) / CHUNK);
}

/* Embree's ids are those of geometries, which are instances, and of triangles. */
static void count_embree(struct bench *bench, int tracer)
{
    whit_tally *tally = &bench->tallies[tracer];
    bench->asked = bench->embree[tracer - EMBREE];
    threads_for(THREADS, chunks_of(bench->count), embree_chunk, bench);
    for (uint64_t i = 0; i < bench->count; ++i) {
        const struct gpu_hit *hit = &bench->hits[i];
        bool hits = bench->exact[i].primitive != HIT_NONE, met = hit->primitive != HIT_NONE;
        ++tally->rays;
        tally->misses += hits && !met;
        tally->other_ids += hits && met && hit->primitive != bench->exact[i].primitive;
    }
}

static bool count_level(struct bench *bench, int tracer)
{
    const struct hard_judgement judgement = {.hard = &bench->hard,
                                             .rays = bench->rays,
                                             .exact = bench->exact,
                                             .hits = bench->hits,
                                             .numerics = levels[tracer],
                                             .count = bench->count};
    whit_tally *sum = &bench->tallies[tracer], tally;
    for (uint64_t i = 0; i < bench->count; ++i)
        bench->device_rays[i] = bench->rays[i].ray;
    if (renderer_trace(bench->renderers[tracer], bench->device_rays, bench->count, false,
                       bench->device_hits, NULL) != WHIT_OK)
        return false;
    if (hard_trace_twin(&bench->hard, levels[tracer], bench->rays, bench->count, THREADS,
                        bench->hits) != WHIT_OK ||
        hard_judge(&judgement, THREADS, &tally) != WHIT_OK)
        return false;
    bench->differing[tracer] += hard_count_differing(bench->hits, bench->device_hits, bench->count);
    hard_add_tally(sum, &tally);
    return true;
}

static bool shoot(struct bench *bench, uint64_t seed, uint64_t ray_count)
{
    for (uint64_t first = 0; first < ray_count; first += PIECE) {
        bench->count = ray_count - first < PIECE ? ray_count - first : PIECE;
        for (uint64_t i = 0; i < bench->count; ++i)
            bench->rays[i] = hard_ray_make(&bench->hard, bench->hard.rays, seed, first + i);
        if (hard_trace_exact(&bench->hard, bench->rays, bench->count, THREADS, bench->exact) !=
            WHIT_OK)
            return false;
        for (int tracer = FAST; tracer <= EXACT; ++tracer)
            if (!count_level(bench, tracer))
                return false;
        for (int tracer = EMBREE; tracer < TRACERS; ++tracer)
            if (bench->embree[tracer - EMBREE])
                count_embree(bench, tracer);
    }
    return true;
}

/* 0: every level kept its promise, and `fast` leaked. */
static int print_rows(const struct bench *bench, double offset)
{
    int failed = 0;
    for (int tracer = FAST; tracer < TRACERS; ++tracer) {
        const whit_tally *t = &bench->tallies[tracer];
        char wrong[24] = "-", differing[24] = "-";
        if (t->rays == 0) {
            printf("%-8g%-16s%12s\n", offset, names[tracer], "not installed");
            continue;
        }
        if (tracer <= EXACT) {
            snprintf(wrong, sizeof wrong, "%llu", (unsigned long long)t->wrong);
            snprintf(differing, sizeof differing, "%llu",
                     (unsigned long long)bench->differing[tracer]);
            failed |= !hard_promise_kept(levels[tracer], true, t) || bench->differing[tracer] > 0;
        }
        printf("%-8g%-16s%12llu%12llu%13.2e%16llu%10s%12s\n", offset, names[tracer],
               (unsigned long long)t->rays, (unsigned long long)t->misses,
               (double)t->misses / (double)t->rays, (unsigned long long)t->other_ids, wrong,
               differing);
    }
    if (bench->tallies[FAST].misses == 0) {
        printf("FAILED: `fast` leaks nothing: these rays test nothing\n");
        failed = 1;
    }
    return failed;
}

static int run_case(struct bench *bench, const struct hard_case *hard, uint64_t seed,
                    uint64_t ray_count)
{
    memset(bench->tallies, 0, sizeof bench->tallies);
    if (hard_scene_init(&peers_log, hard, &bench->hard) != WHIT_OK)
        return 1;
    int failed = 0;
    for (int i = 0; i < 2; ++i)
        bench->embree[i] = embree_create(bench->hard.scene, &bench->hard.pose, i == 1);
    for (int tracer = FAST; tracer <= EXACT && !failed; ++tracer) {
        const whit_renderer_params params = {
            .width = 16, .height = 16, .numerics = levels[tracer], .trace_rays = PIECE};
        failed = renderer_create(&peers_log, bench->device, bench->hard.accel, &params,
                                 &bench->renderers[tracer]) != WHIT_OK;
    }
    if (!failed)
        failed = !shoot(bench, seed, ray_count) || print_rows(bench, hard->offset);
    for (int tracer = FAST; tracer <= EXACT; ++tracer) {
        renderer_destroy(bench->renderers[tracer]);
        bench->renderers[tracer] = NULL;
        bench->differing[tracer] = 0;
    }
    for (int i = 0; i < 2; ++i)
        embree_destroy(bench->embree[i]);
    hard_scene_finish(&bench->hard);
    return failed;
}

int main(int argc, char **argv)
{
    uint64_t ray_count = argc == 2 ? strtoull(argv[1], NULL, 10) : 0;
    struct bench bench = {.count = 0};
    uint32_t case_count;
    int failed = 0, done = 0;
    const struct hard_case *cases = hard_cases(&case_count);
    bench.rays = array_alloc(PIECE, sizeof *bench.rays);
    bench.exact = array_alloc(PIECE, sizeof *bench.exact);
    bench.hits = array_alloc(PIECE, sizeof *bench.hits);
    bench.device_hits = array_alloc(PIECE, sizeof *bench.device_hits);
    bench.device_rays = array_alloc(PIECE, sizeof *bench.device_rays);
    if (ray_count == 0 || !bench.rays || !bench.exact || !bench.hits || !bench.device_hits ||
        !bench.device_rays) {
        fprintf(stderr, "usage: hard RAYS\n");
        return 2;
    }
    if (device_create(&peers_log, NULL, NULL, &bench.device) != WHIT_OK)
        return 3;
    device_keep_pipelines(bench.device);
    printf("device: %s, %s\n", device_get_info(bench.device)->name,
           device_get_info(bench.device)->driver);
    printf("%-8s%-16s%12s%12s%13s%16s%10s%12s\n", "offset", "tracer", "rays", "misses", "of rays",
           "other triangle", "wrong", "not twin's");
    for (uint32_t i = 0; i < case_count; ++i) {
        const struct hard_case *hard = &cases[i];
        if (hard->mesh != HARD_SPHERE || hard->rays != HARD_AIMED || hard->instanced ||
            hard->offset > 1e5)
            continue;
        failed |= run_case(&bench, hard, i + 1, ray_count);
        ++done;
    }
    free(bench.rays);
    free(bench.exact);
    free(bench.hits);
    free(bench.device_hits);
    free(bench.device_rays);
    failed |= device_validation_messages(bench.device) > 0;
    device_destroy(bench.device);
    if (failed || done == 0)
        printf("FAILED\n");
    return failed || done == 0;
}
