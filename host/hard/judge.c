/* Judges the hits that the levels of numerics find for hard rays, by exact arithmetic. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"
#include "base/array.h"
#include "base/hash.h"
#include "base/threads.h"
#include "hard/judge.h"
#include "oracle/oracle.h"
#include "twin/ray.h"
#include "twin/traverse.h"

enum { CHUNK = 1024 };

static uint64_t chunk_end(uint32_t chunk, uint64_t count)
{
    uint64_t end = ((uint64_t)chunk + 1) * CHUNK;
    return end < count ? end : count;
}

/* A run over rays in chunks, by several threads. */
struct run {
    const struct hard_scene *hard;
    const struct hard_ray *rays;
    uint64_t count;
    uint32_t numerics;
    struct rational_hit *exact;
    struct gpu_hit *hits;
    const struct hard_judgement *judgement;
    struct part {
        whit_result result;
        whit_tally tally;
    } * parts; /* one for each chunk */
    whit_tally tally;
};

/* Calls `fn` for all chunks, which fill in their parts, and adds up the tallies. */
static whit_result run_chunks(struct run *run, uint32_t thread_count,
                              void (*fn)(void *context, uint32_t index), const char *failure)
{
    uint32_t chunks = (uint32_t)((run->count + CHUNK - 1) / CHUNK);
    run->parts = array_alloc_zeroed(chunks, sizeof *run->parts);
    whit_result result = run->parts ? WHIT_OK : WHIT_ERROR_MEMORY;
    if (run->parts)
        threads_for(thread_count, chunks, fn, run);
    for (uint32_t i = 0; result == WHIT_OK && i < chunks; ++i) {
        result = run->parts[i].result;
        hard_add_tally(&run->tally, &run->parts[i].tally);
    }
    free(run->parts);
    if (result != WHIT_OK)
        log_error(&run->hard->scene->log, "%s: %s: %s", run->hard->scene->name, failure,
                  whit_result_name(result));
    return result;
}

/* ---- Exact and twin ---- */

static void exact_chunk(void *context, uint32_t chunk)
{
    struct run *run = context;
    struct rational *rational = rational_create(run->hard->accel);
    run->parts[chunk].result = rational ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint64_t i = (uint64_t)chunk * CHUNK; rational && i < chunk_end(chunk, run->count); ++i)
        rational_trace(rational, &run->rays[i].ray, NULL, &run->exact[i]);
    rational_destroy(rational);
}

static void twin_chunk(void *context, uint32_t chunk)
{
    struct run *run = context;
    const struct traverse_params params = {.numerics = run->numerics};
    uint32_t status = 0;
    for (uint64_t i = (uint64_t)chunk * CHUNK; i < chunk_end(chunk, run->count); ++i)
        traverse_ray(run->hard->accel, &params, &run->rays[i].ray, &run->hits[i], NULL, &status);
    run->parts[chunk].result = status ? WHIT_ERROR_STATUS : WHIT_OK;
}

whit_result hard_trace_exact(const struct hard_scene *hard, const struct hard_ray *rays,
                             uint64_t count, uint32_t thread_count, struct rational_hit *exact)
{
    struct run run = {.hard = hard, .rays = rays, .count = count, .exact = exact};
    return run_chunks(&run, thread_count, exact_chunk, "no hits by exact arithmetic");
}

whit_result hard_trace_twin(const struct hard_scene *hard, uint32_t numerics,
                            const struct hard_ray *rays, uint64_t count, uint32_t thread_count,
                            struct gpu_hit *hits)
{
    struct run run = {
        .hard = hard, .rays = rays, .count = count, .numerics = numerics, .hits = hits};
    return run_chunks(&run, thread_count, twin_chunk, "no hits on the CPU");
}

/* ---- One ray ---- */

/* Relative offset from a ray to its neighbours, larger than float errors: the shear and the edge
   functions round coordinates relative to the origin some 8 times, by 2^-24 each. */
#define BESIDE 0x1p-19

/* Two unit vectors perpendicular to the direction and to each other. */
static void across(const double dir[3], double first[3], double second[3])
{
    int min = 0;
    double axis[3] = {0, 0, 0};
    for (int k = 1; k < 3; ++k)
        if (fabs(dir[k]) < fabs(dir[min]))
            min = k;
    axis[min] = 1.0;
    double3_cross(dir, axis, first);
    double3_unit(first);
    double3_cross(dir, first, second);
    double3_unit(second);
}

/* Whether eight neighbouring rays hit too: then the ray passes through the inside of a surface and
   not along its outline. They are neighbours in the instance's object space: where its transform
   stretches, those in the world may meet almost the same points. */
static bool is_surrounded(struct rational *rational, const struct gpu_instance *instance,
                          const struct gpu_ray *ray)
{
    struct gpu_ray local = accel_local_ray(instance, ray);
    const double dir[3] = {(double)local.dir[0], (double)local.dir[1], (double)local.dir[2]};
    double first[3], second[3], length = sqrt(double3_dot(dir, dir));
    across(dir, first, second);
    for (int i = 0; i < 9; ++i) {
        struct gpu_ray beside = *ray;
        struct rational_hit hit;
        float step[3];
        for (int k = 0; k < 3; ++k)
            step[k] = (float)(BESIDE * length * ((i % 3 - 1) * first[k] + (i / 3 - 1) * second[k]));
        struct vec3 moved = accel_rotate_rows(instance->forward0, instance->forward1,
                                              instance->forward2, vec3_load(step));
        vec3_store(beside.dir, vec3_add(vec3_load(ray->dir), moved));
        rational_trace(rational, &beside, NULL, &hit);
        if (hit.primitive == HIT_NONE)
            return false;
    }
    return true;
}

/* Whether the triangle that was hit has an open edge; spheres have no edges. */
static bool touches_open_edge(const struct hard_judgement *j, const struct rational_hit *hit)
{
    uint32_t mesh = j->hard->scene->instances[hit->instance].mesh;
    return j->hard->scene->meshes[mesh].sphere_count == 0 &&
           j->hard->topology.open[j->hard->topology.first[mesh] + hit->primitive];
}

/* Whether the hit is so near the ray's origin that rounding may put it before or behind the
   origin. */
static bool starts_there(const struct hard_scene *hard, const struct gpu_ray *ray, float t)
{
    double size = 0.0, dir = 0.0;
    for (int k = 0; k < 3; ++k) {
        size = fmax(size, hard->pose.hi[k] - hard->pose.lo[k]);
        dir = fmax(dir, fabs((double)ray->dir[k]));
    }
    return (double)t * dir <= BESIDE * size;
}

/* Whether the ray starts in the plane of the triangle within float errors. Then floats do not tell
   on which side it starts, and a ray along the plane may cross it far from its origin. */
static bool starts_in_plane(const struct hard_scene *hard, const struct gpu_ray *ray,
                            const struct rational_hit *hit)
{
    const struct scene_mesh *mesh =
        &hard->scene->meshes[hard->scene->instances[hit->instance].mesh];
    struct gpu_ray local = accel_local_ray(&hard->accel->instances[hit->instance], ray);
    double corners[3][3], e1[3], e2[3], normal[3], reach = 0.0;
    if (mesh->sphere_count > 0)
        return false;
    scene_mesh_corners(mesh, hit->primitive, corners);
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 3; ++i) {
            corners[i][k] -= (double)local.origin[k];
            reach = fmax(reach, fabs(corners[i][k]));
        }
        e1[k] = corners[1][k] - corners[0][k];
        e2[k] = corners[2][k] - corners[0][k];
    }
    double3_cross(e1, e2, normal);
    return fabs(double3_dot(corners[0], normal)) <=
           BESIDE * reach * sqrt(double3_dot(normal, normal));
}

static bool is_leak(const struct hard_judgement *j, struct rational *rational, uint64_t i)
{
    const struct gpu_ray *ray = &j->rays[i].ray;
    return j->hard->truth == HARD_MUST_HIT ||
           (!starts_there(j->hard, ray, j->exact[i].t) &&
            !starts_in_plane(j->hard, ray, &j->exact[i]) && !touches_open_edge(j, &j->exact[i]) &&
            is_surrounded(rational, &j->hard->accel->instances[j->exact[i].instance], ray));
}

static bool is_sure(const struct hard_judgement *j, uint64_t i)
{
    struct oracle_hit oracle;
    if (j->numerics == NUMERICS_EXACT)
        return true;
    oracle_trace(j->hard->accel, &j->rays[i].ray, false, &oracle);
    return fabs(oracle.edge_margin) >= 1.0;
}

double hard_ulps_between(float a, float b)
{
    int32_t x, y;
    memcpy(&x, &a, sizeof x);
    memcpy(&y, &b, sizeof y);
    int64_t p = x < 0 ? INT32_MIN - (int64_t)x : x, q = y < 0 ? INT32_MIN - (int64_t)y : y;
    return (double)(p < q ? q - p : p - q);
}

bool hard_goes_far(const struct gpu_ray *ray, float t)
{
    float origin = 0.0f, dir = 0.0f;
    for (int k = 0; k < 3; ++k) {
        origin = fmaxf(origin, fabsf(ray->origin[k]));
        dir = fmaxf(dir, fabsf(ray->dir[k]));
    }
    return t * dir > 0x1p-20f * origin;
}

/* Hits whose t differ by at most this share are at the same place up to rounding. Exact hits are at
   different places where their t differ by more than four times this share. */
#define TOGETHER 0x1p-18f

static bool is_together(float t, float next, float share)
{
    return fabsf(next - t) <= share * fabsf(t);
}

/* Whether a second primitive is hit at the same place where exact arithmetic finds none. It is
   traced by the twin, whose bits are compared with the device elsewhere. */
static bool is_double(const struct hard_judgement *j, struct rational *rational, uint64_t i,
                      uint32_t *status)
{
    const struct gpu_hit *hit = &j->hits[i];
    const struct rational_hit own = {.primitive = hit->primitive, .instance = hit->instance};
    const struct rational_query query = {.own = &own};
    const struct traverse_params params = {.numerics = j->numerics, .own = hit};
    struct gpu_hit next;
    struct rational_hit exact;
    traverse_ray(j->hard->accel, &params, &j->rays[i].ray, &next, NULL, status);
    if (next.primitive == HIT_NONE || !is_together(hit->t, next.t, TOGETHER))
        return false;
    rational_trace(rational, &j->rays[i].ray, &query, &exact);
    return exact.primitive == HIT_NONE || !is_together(hit->t, exact.t, 4.0f * TOGETHER);
}

static void judge_ray(const struct hard_judgement *j, struct rational *rational, uint64_t i,
                      whit_tally *tally, uint32_t *status)
{
    const struct rational_hit *exact = &j->exact[i];
    const struct gpu_hit *hit = &j->hits[i];
    bool hits = exact->primitive != HIT_NONE, met = hit->primitive != HIT_NONE;
    ++tally->rays;
    bool same = hit->primitive == exact->primitive && hit->instance == exact->instance;
    tally->hits += hits;
    tally->misses += hits && !met;
    tally->leaks += hits && !met && is_leak(j, rational, i);
    tally->false_hits += !hits && met;
    tally->other_ids += hits && met && !same;
    tally->wrong += !same && is_sure(j, i);
    tally->self_hits +=
        met && (j->hard->truth == HARD_MUST_MISS ||
                (hit->primitive == j->rays[i].primitive && hit->instance == j->rays[i].instance));
    if (!met)
        return;
    if (same) {
        tally->wrong_keys += hit->t != exact->t;
        if (hard_goes_far(&j->rays[i].ray, exact->t))
            tally->ulp_max = fmax(tally->ulp_max, hard_ulps_between(hit->t, exact->t));
    }
    tally->double_hits += is_double(j, rational, i, status);
}

/* ---- All of them ---- */

static void judge_chunk(void *context, uint32_t chunk)
{
    struct run *run = context;
    struct part *part = &run->parts[chunk];
    struct rational *rational = rational_create(run->hard->accel);
    uint32_t status = 0;
    for (uint64_t i = (uint64_t)chunk * CHUNK; rational && i < chunk_end(chunk, run->count); ++i)
        judge_ray(run->judgement, rational, i, &part->tally, &status);
    part->result = !rational ? WHIT_ERROR_MEMORY : status ? WHIT_ERROR_STATUS : WHIT_OK;
    rational_destroy(rational);
}

void hard_add_tally(whit_tally *sum, const whit_tally *more)
{
    sum->rays += more->rays;
    sum->hits += more->hits;
    sum->misses += more->misses;
    sum->leaks += more->leaks;
    sum->false_hits += more->false_hits;
    sum->other_ids += more->other_ids;
    sum->wrong_keys += more->wrong_keys;
    sum->wrong += more->wrong;
    sum->double_hits += more->double_hits;
    sum->self_hits += more->self_hits;
    sum->ulp_max = fmax(sum->ulp_max, more->ulp_max);
}

whit_result hard_judge(const struct hard_judgement *judgement, uint32_t thread_count,
                       whit_tally *tally)
{
    struct run run = {.hard = judgement->hard, .count = judgement->count, .judgement = judgement};
    whit_result result = run_chunks(&run, thread_count, judge_chunk, "hits could not be judged");
    *tally = run.tally;
    return result;
}

uint64_t hard_count_differing(const struct gpu_hit *a, const struct gpu_hit *b, uint64_t count)
{
    uint64_t differing = 0;
    for (uint64_t i = 0; i < count; ++i)
        differing += memcmp(&a[i], &b[i], sizeof a[i]) != 0;
    return differing;
}

uint64_t hard_hash(uint64_t value, const struct rational_hit *exact, uint64_t count)
{
    for (uint64_t i = 0; i < count; ++i) {
        const uint32_t ids[2] = {exact[i].instance, exact[i].primitive};
        value = hash_bytes(value, ids, sizeof ids);
    }
    return value;
}

bool hard_promise_kept(uint32_t numerics, bool promised, const whit_tally *tally)
{
    if (numerics == NUMERICS_FAST)
        return true;
    if (numerics == NUMERICS_EXACT)
        return tally->misses == 0 && tally->false_hits == 0 && tally->other_ids == 0 &&
               tally->wrong_keys == 0;
    return tally->wrong == 0 && (!promised || tally->leaks == 0);
}
