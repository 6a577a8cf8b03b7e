/* whit's hits beside those of others, on the same rays:

       hits SCENE [--rays N] [--seed S] [--list N] [--device D]

   The device against the float twin in C, bit for bit; the twin against the oracle in double; both
   against Embree (robust), where it was built in. N rays of each kind (rays.c). Exit status 1 when
   the device and the twin differ anywhere, or when the twin and the oracle disagree where the
   oracle's error bounds say that they may not. On a GPU, whose division may be off by 2.5 ulp, bits
   are counted only. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "load/load.h"
#include "oracle/oracle.h"
#include "peers.h"
#include "render/render.h"
#include "scene/pose.h"
#include "twin/traverse.h"

enum { CHUNK = 4096, HITS_THREADS = 2 };

/* How an answer compares with the oracle's. */
enum agreement {
    AGREE,
    AGREE_TIE,   /* other ids, as near: both hits are right */
    AGREE_BOUND, /* other ids, but within the float test's error bound */
    DISAGREE,
    AGREEMENTS
};

struct options {
    const char *path, *device;
    uint64_t rays, seed, list;
};

/* ---- One ray ---- */

static bool same_ids(const struct gpu_hit *a, const struct gpu_hit *b)
{
    return a->primitive == b->primitive && (a->primitive == HIT_NONE || a->instance == b->instance);
}

static enum agreement judge_ids(const struct gpu_hit *hit, const struct oracle_hit *exact)
{
    const struct gpu_hit right = {.primitive = exact->primitive, .instance = exact->instance};
    if (same_ids(hit, &right))
        return AGREE;
    bool both = hit->primitive != HIT_NONE && exact->primitive != HIT_NONE;
    if (both && exact->second_t == exact->t)
        return AGREE_TIE;
    return fabs(exact->edge_margin) < 1.0 ? AGREE_BOUND : DISAGREE;
}

static double t_difference(const struct gpu_hit *hit, const struct oracle_hit *exact)
{
    return fabs((double)hit->t - exact->t);
}

/* ---- One set of rays ---- */

struct tally {
    uint64_t hits, device_differs, device_wrong, any_differs;
    uint64_t oracle[AGREEMENTS], t_outside;
    uint64_t embree_differs, embree[AGREEMENTS];
    uint64_t doubtful; /* rays whose answer the float test may not be sure of */
    uint64_t over_8_ulp;
    double ulp_largest, bound_largest, margin_largest; /* the last one where ids differ */
    uint32_t status;
};

struct comparison {
    const struct accel *accel;
    const struct embree *embree;
    const struct gpu_ray *rays;
    const struct gpu_hit *device, *any;
    uint64_t count;
    uint8_t *oracle_differs, *embree_differs; /* 1 + enum agreement; 0: same ids */
    struct tally *chunks;
};

static void compare_t(const struct gpu_hit *twin, const struct oracle_hit *exact,
                      struct tally *tally)
{
    double off = t_difference(twin, exact), ulp = off / (fabs(exact->t) * 0x1p-23);
    if (off == 0.0)
        return;
    tally->ulp_largest = fmax(tally->ulp_largest, ulp);
    tally->over_8_ulp += ulp > 8.0;
    tally->bound_largest = fmax(tally->bound_largest, off / exact->t_error);
    tally->t_outside += !(off <= exact->t_error);
}

static void compare_embree(const struct comparison *c, uint64_t i, const struct gpu_hit *twin,
                           const struct oracle_hit *exact, struct tally *tally)
{
    struct gpu_hit peer;
    embree_trace(c->embree, &c->rays[i], &peer);
    if (same_ids(&peer, twin))
        return;
    enum agreement agreement = judge_ids(&peer, exact);
    ++tally->embree_differs;
    ++tally->embree[agreement];
    c->embree_differs[i] = (uint8_t)(1 + agreement);
}

static void compare_ray(const struct comparison *c, uint64_t i, struct tally *tally)
{
    struct gpu_hit twin;
    struct oracle_hit exact;
    traverse_ray(c->accel, NULL, &c->rays[i], &twin, NULL, &tally->status);
    oracle_trace(c->accel, &c->rays[i], false, &exact);
    tally->hits += twin.primitive != HIT_NONE;
    tally->device_differs += memcmp(&twin, &c->device[i], sizeof twin) != 0;
    tally->device_wrong += judge_ids(&c->device[i], &exact) == DISAGREE;
    tally->any_differs += (c->any[i].primitive == HIT_NONE) != (twin.primitive == HIT_NONE);
    tally->doubtful += fabs(exact.edge_margin) < 1.0;
    enum agreement agreement = judge_ids(&twin, &exact);
    ++tally->oracle[agreement];
    if (agreement != AGREE) {
        c->oracle_differs[i] = (uint8_t)(1 + agreement);
        tally->margin_largest = fmax(tally->margin_largest, fabs(exact.edge_margin));
    } else if (twin.primitive != HIT_NONE) {
        compare_t(&twin, &exact, tally);
    }
    if (c->embree)
        compare_embree(c, i, &twin, &exact, tally);
}

static void compare_chunk(void *user, uint32_t index)
{
    const struct comparison *c = user;
    uint64_t begin = (uint64_t)index * CHUNK;
    uint64_t end = begin + CHUNK < c->count ? begin + CHUNK : c->count;
    for (uint64_t i = begin; i < end; ++i)
        compare_ray(c, i, &c->chunks[index]);
}

static void tally_add(struct tally *sum, const struct tally *part)
{
    sum->hits += part->hits;
    sum->device_differs += part->device_differs;
    sum->device_wrong += part->device_wrong;
    sum->any_differs += part->any_differs;
    for (int i = 0; i < AGREEMENTS; ++i) {
        sum->oracle[i] += part->oracle[i];
        sum->embree[i] += part->embree[i];
    }
    sum->t_outside += part->t_outside;
    sum->embree_differs += part->embree_differs;
    sum->doubtful += part->doubtful;
    sum->over_8_ulp += part->over_8_ulp;
    sum->ulp_largest = fmax(sum->ulp_largest, part->ulp_largest);
    sum->bound_largest = fmax(sum->bound_largest, part->bound_largest);
    sum->margin_largest = fmax(sum->margin_largest, part->margin_largest);
    sum->status |= part->status;
}

/* ---- Lists ---- */

static const char *const kind_names[RAYS_KINDS] = {"primary", "random", "aimed"};

static void print_hit(const char *who, uint32_t instance, uint32_t primitive, double t)
{
    if (primitive == HIT_NONE)
        printf("    %-7s miss\n", who);
    else
        printf("    %-7s %u:%u  t %.17g\n", who, instance, primitive, t);
}

static void print_ray(const struct comparison *c, uint64_t i, const char *what)
{
    const struct gpu_ray *ray = &c->rays[i];
    struct gpu_hit twin, peer;
    struct oracle_hit exact;
    uint32_t status = 0;
    traverse_ray(c->accel, NULL, ray, &twin, NULL, &status);
    oracle_trace(c->accel, ray, false, &exact);
    printf("  %s: ray %llu from %.9g %.9g %.9g along %.9g %.9g %.9g\n", what, (unsigned long long)i,
           (double)ray->origin[0], (double)ray->origin[1], (double)ray->origin[2],
           (double)ray->dir[0], (double)ray->dir[1], (double)ray->dir[2]);
    print_hit("whit", twin.instance, twin.primitive, (double)twin.t);
    if (c->embree) {
        embree_trace(c->embree, ray, &peer);
        print_hit("Embree", peer.instance, peer.primitive, (double)peer.t);
    }
    print_hit("oracle", exact.instance, exact.primitive, exact.t);
    printf("    margin %.3g, next hit %.17g\n", exact.edge_margin, exact.second_t);
}

/* Prints the answers that are wrong first, then those that are explained. */
static void print_list(const struct comparison *c, const uint8_t *differs, const char *who,
                       const char *const names[AGREEMENTS], uint64_t limit)
{
    for (int agreement = DISAGREE; agreement >= AGREE; --agreement) {
        for (uint64_t i = 0; i < c->count && limit > 0; ++i) {
            char what[80];
            if (differs[i] != 1 + agreement)
                continue;
            snprintf(what, sizeof what, "%s unlike twin, %s", who, names[agreement]);
            print_ray(c, i, what);
            --limit;
        }
    }
}

static void print_lists(const struct comparison *c, enum ray_kind kind, uint64_t limit)
{
    static const char *const of_oracle[AGREEMENTS] = {"", "tie", "within the error bound",
                                                      "not explained"};
    static const char *const of_embree[AGREEMENTS] = {"oracle's answer is Embree's", "tie",
                                                      "within whit's error bound",
                                                      "oracle sure of the twin's answer"};
    if (limit == 0)
        return;
    printf("%s rays:\n", kind_names[kind]);
    print_list(c, c->oracle_differs, "oracle", of_oracle, limit);
    print_list(c, c->embree_differs, "Embree", of_embree, limit);
}

/* ---- The table ---- */

static void print_row(const char *name, const double value[RAYS_KINDS], bool whole)
{
    printf("%-44s", name);
    for (int kind = 0; kind < RAYS_KINDS; ++kind)
        printf(whole ? "%12.0f" : "%12.3g", value[kind]);
    putchar('\n');
}

#define PRINT_ROW(name, whole, expression)                                                         \
    do {                                                                                           \
        double values[RAYS_KINDS];                                                                 \
        for (int kind = 0; kind < RAYS_KINDS; ++kind) {                                            \
            const struct tally *t = &tallies[kind];                                                \
            values[kind] = (double)(expression);                                                   \
        }                                                                                          \
        print_row(name, values, whole);                                                            \
    } while (0)

static void print_table(const struct tally tallies[RAYS_KINDS], uint64_t rays, bool has_embree)
{
    printf("%-44s", "");
    for (int kind = 0; kind < RAYS_KINDS; ++kind)
        printf("%12s", kind_names[kind]);
    putchar('\n');
    PRINT_ROW("rays", true, t ? rays : 0);
    PRINT_ROW("hits", true, t->hits);
    PRINT_ROW("device unlike twin, any bit", true, t->device_differs);
    PRINT_ROW("  its ids not explained by the oracle", true, t->device_wrong);
    PRINT_ROW("device, any-hit unlike closest", true, t->any_differs);
    PRINT_ROW("another answer is within the error bound", true, t->doubtful);
    PRINT_ROW("oracle unlike twin: exact tie", true, t->oracle[AGREE_TIE]);
    PRINT_ROW("oracle unlike twin: within the error bound", true, t->oracle[AGREE_BOUND]);
    PRINT_ROW("oracle unlike twin: not explained", true, t->oracle[DISAGREE]);
    PRINT_ROW("  largest margin of these, in error bounds", false, t->margin_largest);
    PRINT_ROW("ids equal: largest |dt|/t, ulp (2^-23)", false, t->ulp_largest);
    PRINT_ROW("  |dt|/t over 8 ulp, rays", true, t->over_8_ulp);
    PRINT_ROW("  largest |dt| / its bound", false, t->bound_largest);
    PRINT_ROW("  |dt| over its bound, rays", true, t->t_outside);
    if (!has_embree) {
        printf("Embree is not built in: not compared\n");
        return;
    }
    PRINT_ROW("Embree unlike twin", true, t->embree_differs);
    PRINT_ROW("  exact tie", true, t->embree[AGREE_TIE]);
    PRINT_ROW("  within whit's error bound", true, t->embree[AGREE_BOUND]);
    PRINT_ROW("  oracle sure of the twin's answer", true, t->embree[DISAGREE]);
    PRINT_ROW("  oracle's answer is Embree's", true, t->embree[AGREE]);
}

/* `exact`: the device's arithmetic is IEEE's, so that bits must be equal. */
static bool tally_is_good(const struct tally *t, bool exact)
{
    return (t->device_differs == 0 || !exact) && t->device_wrong == 0 && t->any_differs == 0 &&
           t->oracle[DISAGREE] == 0 && t->t_outside == 0 && t->status == 0;
}

/* ---- One scene ---- */

struct bench {
    struct scene *scene;
    struct scene_pose pose;
    struct accel *accel;
    struct device *device;
    struct renderer *renderer;
    struct embree *embree;
};

static bool bench_open(struct bench *bench, const struct options *options)
{
    const whit_device_params device_params = {.selector = options->device};
    const whit_renderer_params render_params = {.width = 16, .height = 16};
    bool ready = load_scene(&peers_log, options->path, NULL, &bench->scene) == WHIT_OK;
    if (ready && bench->scene->sphere_total > 0) {
        fprintf(stderr, "%s: spheres are not held against Embree's\n", options->path);
        return false;
    }
    ready = ready && scene_pose_init(bench->scene, 0.0, &bench->pose) == WHIT_OK &&
            accel_create(&peers_log, bench->scene, NULL, &bench->accel) == WHIT_OK &&
            device_create(&peers_log, &device_params, NULL, &bench->device) == WHIT_OK &&
            renderer_create(&peers_log, bench->device, bench->accel, &render_params,
                            &bench->renderer) == WHIT_OK;
    if (ready)
        bench->embree = embree_create(bench->scene, &bench->pose, true);
    return ready;
}

static void bench_close(struct bench *bench)
{
    embree_destroy(bench->embree);
    renderer_destroy(bench->renderer);
    device_destroy(bench->device);
    accel_destroy(bench->accel);
    scene_pose_finish(&bench->pose);
    scene_destroy(bench->scene);
}

static bool compare_kind(const struct bench *bench, const struct options *options,
                         enum ray_kind kind, struct tally *sum)
{
    uint64_t n = options->rays;
    uint32_t chunk_count = (uint32_t)((n + CHUNK - 1) / CHUNK);
    struct gpu_ray *rays = array_alloc(n, sizeof *rays);
    struct gpu_hit *hits = array_alloc(n, sizeof *hits), *any = array_alloc(n, sizeof *any);
    uint8_t *differs = array_alloc_zeroed(2 * n, 1);
    struct tally *chunks = array_alloc_zeroed(chunk_count, sizeof *chunks);
    bool done = rays && hits && any && differs && chunks;
    if (done)
        rays_fill(kind, bench->scene, &bench->pose, options->seed, rays, n);
    done = done && renderer_trace(bench->renderer, rays, n, false, hits, NULL) == WHIT_OK &&
           renderer_trace(bench->renderer, rays, n, true, any, NULL) == WHIT_OK;
    if (done) {
        struct comparison c = {bench->accel, bench->embree, rays,  hits, any, n,
                               differs,      differs + n,   chunks};
        threads_for(HITS_THREADS, chunk_count, compare_chunk, &c);
        for (uint32_t i = 0; i < chunk_count; ++i)
            tally_add(sum, &chunks[i]);
        print_lists(&c, kind, options->list);
    }
    free(rays);
    free(hits);
    free(any);
    free(differs);
    free(chunks);
    return done;
}

static int compare_scene(const struct options *options)
{
    struct bench bench = {0};
    struct tally tallies[RAYS_KINDS] = {{0}};
    bool good = bench_open(&bench, options), done = good, exact = true;
    if (good) {
        const char *name = strrchr(options->path, '/');
        const whit_device_info *info = device_get_info(bench.device);
        exact = info->kind == WHIT_DEVICE_CPU;
        printf("%s: %llu triangles, %u instances; %s\n", name ? name + 1 : options->path,
               (unsigned long long)bench.scene->triangle_total, bench.accel->instance_count,
               info->name);
    }
    for (int kind = 0; done && kind < RAYS_KINDS; ++kind) {
        done = compare_kind(&bench, options, (enum ray_kind)kind, &tallies[kind]);
        good = good && done && tally_is_good(&tallies[kind], exact);
    }
    if (done)
        print_table(tallies, options->rays, bench.embree != NULL);
    if (done && !good)
        printf("FAILED: whit's hits are not what they should be\n");
    bench_close(&bench);
    return good ? 0 : 1;
}

static bool parse_count(const char *text, uint64_t *out)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value >= 0.0 && value <= 1e9))
        return false;
    *out = (uint64_t)value;
    return true;
}

static bool parse_options(int argc, char **argv, struct options *out)
{
    *out = (struct options){.rays = 1000000, .seed = 1};
    for (int i = 1; i < argc; ++i) {
        const struct {
            const char *name;
            uint64_t *value;
        } counts[] = {{"--rays", &out->rays}, {"--seed", &out->seed}, {"--list", &out->list}};
        size_t k = 0;
        while (k < 3 && strcmp(argv[i], counts[k].name) != 0)
            ++k;
        bool more = i + 1 < argc;
        if (k < 3 && more && parse_count(argv[i + 1], counts[k].value))
            ++i;
        else if (strcmp(argv[i], "--device") == 0 && more)
            out->device = argv[++i];
        else if (argv[i][0] != '-' && !out->path)
            out->path = argv[i];
        else
            return false;
    }
    return out->rays > 0 && out->path != NULL;
}

int main(int argc, char **argv)
{
    struct options options;
    if (!parse_options(argc, argv, &options)) {
        fprintf(stderr, "usage: hits SCENE [--rays N] [--seed S] [--list N] [--device D]\n");
        return 1;
    }
    return compare_scene(&options);
}
