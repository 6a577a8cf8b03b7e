/* Mray/s of whit's ray kernel, side by side with Embree (robust, single rays) on the same rays.

       bench_trace SCENE [--runs N] [--device D] [--load-path storage|texel] [--size WxH]
                   [--leaf N] [--bins K] [--traversal-cost C]

   Three sets of rays: primary (camera of the scene, in 8x8 blocks), shadow (from the hits to a
   point light above, any hit), diffuse (cosine bounces from the hits, closest hit). Runs are
   interleaved; printed are medians, and the spread as the half-width of the middle half. `cpu2` is
   what two undisturbed cores would do: 2 x rays / CPU seconds. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "base/threads.h"
#include "load/load.h"
#include "render/render.h"

#ifdef BENCH_EMBREE
#include <embree3/rtcore.h>
#endif

enum { RUNS_MAX = 99, CHUNK = 4096, SETS = 3 };

struct rays {
    const char *name;
    struct gpu_ray *rays;
    uint64_t count;
    bool any;
};

struct sample {
    double wall_ms, cpu_ms;
};

struct series {
    const char *name;
    struct sample runs[RUNS_MAX];
    double hits;
};

static void print_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == WHIT_LOG_ERROR ? "error: " : "", message);
}

static const struct log bench_log = {.fn = print_message, .level = WHIT_LOG_WARNING};

static void fail(const char *what)
{
    fprintf(stderr, "bench_trace: %s\n", what);
    exit(1);
}

/* ---- Rays ---- */

static uint32_t random_next(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static double random_unit(uint32_t *state)
{
    return random_next(state) / 4294967296.0;
}

/* A 3/4 view of the bounds, as scene_freeze gives scenes without a camera. */
static void primary_rays(const struct scene_pose *pose, uint32_t width, uint32_t height,
                         struct rays *out)
{
    double eye[3], center[3], radius2 = 0.0;
    for (int i = 0; i < 3; ++i) {
        center[i] = 0.5 * (pose->lo[i] + pose->hi[i]);
        double half = 0.5 * (pose->hi[i] - pose->lo[i]);
        radius2 += half * half;
    }
    double radius = sqrt(radius2), away[3] = {0.45, 0.35, 0.82};
    for (int i = 0; i < 3; ++i)
        eye[i] = center[i] + away[i] * radius * 1.55;
    double f[3], r[3], u[3], length = 0.0;
    for (int i = 0; i < 3; ++i)
        f[i] = center[i] - eye[i], length += f[i] * f[i];
    for (int i = 0; i < 3; ++i)
        f[i] /= sqrt(length);
    r[0] = -f[2], r[1] = 0.0, r[2] = f[0];
    length = sqrt(r[0] * r[0] + r[2] * r[2]);
    r[0] /= length, r[2] /= length;
    u[0] = r[1] * f[2] - r[2] * f[1], u[1] = r[2] * f[0] - r[0] * f[2];
    u[2] = r[0] * f[1] - r[1] * f[0];
    double scale = tan(0.5 * 40.0 * 3.14159265358979 / 180.0);
    out->count = (uint64_t)width * height;
    out->rays = array_alloc(out->count, sizeof *out->rays);
    if (!out->rays)
        fail("out of memory");
    uint64_t n = 0;
    for (uint32_t by = 0; by < height; by += 8)
        for (uint32_t bx = 0; bx < width; bx += 8)
            for (uint32_t i = 0; i < 64; ++i) {
                uint32_t x = bx + ((i & 3) | ((i >> 1) & 4)),
                         y = by + (((i >> 2) & 1) | ((i >> 3) & 6));
                if (x >= width || y >= height)
                    continue;
                double px = ((x + 0.5) / width * 2.0 - 1.0) * scale * width / height;
                double py = (1.0 - (y + 0.5) / height * 2.0) * scale;
                struct gpu_ray *ray = &out->rays[n++];
                *ray = (struct gpu_ray){.t_max = INFINITY};
                for (int k = 0; k < 3; ++k) {
                    ray->origin[k] = (float)eye[k];
                    ray->dir[k] = (float)(f[k] + px * r[k] + py * u[k]);
                }
            }
    out->count = n;
}

static void bounce(const struct gpu_ray *ray, const struct gpu_hit *hit, uint32_t *state,
                   struct gpu_ray *out)
{
    double n[3] = {(double)hit->ng_x, (double)hit->ng_y, (double)hit->ng_z};
    double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), facing = 0.0;
    for (int i = 0; i < 3; ++i)
        n[i] /= size, facing += n[i] * (double)ray->dir[i];
    double z = 2.0 * random_unit(state) - 1.0, phi = 6.283185307179586 * random_unit(state);
    double s = sqrt(1.0 - z * z), d[3] = {s * cos(phi), s * sin(phi), z};
    *out = (struct gpu_ray){.t_max = INFINITY};
    for (int i = 0; i < 3; ++i) {
        double side = facing > 0.0 ? -n[i] : n[i];
        double p = (double)ray->origin[i] + (double)hit->t * (double)ray->dir[i];
        out->origin[i] = (float)(p + side * 1e-4 * (double)hit->t);
        out->dir[i] = (float)(side + 0.999 * d[i]);
    }
}

static void secondary_rays(const struct rays *primary, const struct gpu_hit *hits,
                           const struct scene_pose *pose, struct rays *shadow, struct rays *diffuse)
{
    shadow->rays = array_alloc(primary->count, sizeof *shadow->rays);
    diffuse->rays = array_alloc(primary->count, sizeof *diffuse->rays);
    if (!shadow->rays || !diffuse->rays)
        fail("out of memory");
    uint32_t state = 12345;
    for (uint64_t i = 0; i < primary->count; ++i) {
        if (hits[i].primitive == HIT_NONE)
            continue;
        struct gpu_ray *ray = &diffuse->rays[diffuse->count++];
        bounce(&primary->rays[i], &hits[i], &state, ray);
        struct gpu_ray *to_light = &shadow->rays[shadow->count++];
        *to_light = *ray;
        to_light->t_max = 1.0f;
        const double where[3] = {0.7, 1.8, 0.6};
        for (int k = 0; k < 3; ++k) {
            double light = pose->lo[k] + where[k] * (pose->hi[k] - pose->lo[k]);
            to_light->dir[k] = (float)(light - (double)ray->origin[k]);
        }
    }
}

/* ---- Embree ---- */

#ifdef BENCH_EMBREE
struct embree {
    RTCDevice device;
    RTCScene scene;
    const struct rays *rays;
    struct gpu_hit *hits;
};

static void embree_build(struct embree *embree, const struct scene *scene,
                         const struct scene_pose *pose)
{
    embree->device = rtcNewDevice("threads=2");
    embree->scene = rtcNewScene(embree->device);
    rtcSetSceneFlags(embree->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree->scene, RTC_BUILD_QUALITY_MEDIUM);
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        RTCGeometry geometry = rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        float *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                   RTC_FORMAT_FLOAT3, 12, mesh->vertex_count);
        uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                    RTC_FORMAT_UINT3, 12, mesh->triangle_count);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const float *p = &mesh->positions[3 * (size_t)v];
            double at[3] = {(double)p[0], (double)p[1], (double)p[2]};
            affine_point(&pose->instances[i], at, at);
            for (int k = 0; k < 3; ++k)
                positions[3 * (size_t)v + (size_t)k] = (float)at[k];
        }
        memcpy(indices, mesh->indices, 12 * (size_t)mesh->triangle_count);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(embree->scene, geometry, i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(embree->scene);
}

static void embree_chunk(void *user, uint32_t index)
{
    const struct embree *embree = user;
    uint64_t end = ((uint64_t)index + 1) * CHUNK;
    if (end > embree->rays->count)
        end = embree->rays->count;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (uint64_t i = (uint64_t)index * CHUNK; i < end; ++i) {
        const struct gpu_ray *ray = &embree->rays->rays[i];
        struct RTCRayHit query = {
            .ray = {.org_x = ray->origin[0],
                    .org_y = ray->origin[1],
                    .org_z = ray->origin[2],
                    .tnear = ray->t_min,
                    .dir_x = ray->dir[0],
                    .dir_y = ray->dir[1],
                    .dir_z = ray->dir[2],
                    .tfar = ray->t_max,
                    .mask = 0xffffffffu},
            .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .primID = RTC_INVALID_GEOMETRY_ID}};
        struct gpu_hit *hit = &embree->hits[i];
        if (embree->rays->any) {
            rtcOccluded1(embree->scene, &context, &query.ray);
            hit->primitive = query.ray.tfar < 0.0f ? 0 : HIT_NONE;
        } else {
            rtcIntersect1(embree->scene, &context, &query);
            hit->primitive = query.hit.primID;
            hit->instance = query.hit.geomID;
            hit->t = query.ray.tfar;
        }
    }
}
#endif

/* ---- Measurement ---- */

static uint64_t count_hits(const struct gpu_hit *hits, uint64_t count)
{
    uint64_t sum = 0;
    for (uint64_t i = 0; i < count; ++i)
        sum += hits[i].primitive != HIT_NONE;
    return sum;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void median(const struct series *series, int runs, bool cpu, double *middle, double *spread)
{
    double values[RUNS_MAX];
    for (int i = 0; i < runs; ++i)
        values[i] = cpu ? series->runs[i].cpu_ms : series->runs[i].wall_ms;
    qsort(values, (size_t)runs, sizeof *values, compare_doubles);
    *middle = values[runs / 2];
    *spread = 0.5 * (values[3 * runs / 4] - values[runs / 4]);
}

static double print_series(const char *set, const struct series *series, int runs, uint64_t count)
{
    double wall, wall_spread, cpu, cpu_spread;
    median(series, runs, false, &wall, &wall_spread);
    median(series, runs, true, &cpu, &cpu_spread);
    printf("%-8s %-16s %8.2f ms +- %5.2f   %7.2f Mray/s   cpu2 %7.2f Mray/s   %5.1f %% hit\n", set,
           series->name, wall, wall_spread, (double)count / wall * 1e-3,
           2.0 * (double)count / cpu * 1e-3, 100.0 * series->hits / (double)count);
    return cpu;
}

int main(int argc, char **argv)
{
    const char *path = NULL, *selector = NULL;
    int runs = 7;
    uint32_t width = 1280, height = 720;
    struct render_params params = {.width = 64, .height = 64};
    struct accel_params accel_params = {0};
    for (int i = 1; i < argc; ++i) {
        if (strcmp(argv[i], "--runs") == 0 && i + 1 < argc)
            runs = atoi(argv[++i]);
        else if (strcmp(argv[i], "--device") == 0 && i + 1 < argc)
            selector = argv[++i];
        else if (strcmp(argv[i], "--load-path") == 0 && i + 1 < argc)
            params.load_path =
                strcmp(argv[++i], "storage") == 0 ? RENDER_LOAD_STORAGE : RENDER_LOAD_TEXEL;
        else if (strcmp(argv[i], "--size") == 0 && i + 1 < argc)
            sscanf(argv[++i], "%ux%u", &width, &height);
        else if (strcmp(argv[i], "--leaf") == 0 && i + 1 < argc)
            accel_params.mesh.leaf_limit = (uint32_t)atoi(argv[++i]);
        else if (strcmp(argv[i], "--bins") == 0 && i + 1 < argc)
            accel_params.mesh.bins = (uint32_t)atoi(argv[++i]);
        else if (strcmp(argv[i], "--traversal-cost") == 0 && i + 1 < argc)
            accel_params.mesh.traversal_cost = (float)atof(argv[++i]);
        else
            path = argv[i];
    }
    if (!path || runs < 1 || runs > RUNS_MAX || width > 16384 || height > 16384)
        fail("usage: bench_trace SCENE [--runs N] [--device D] [--load-path P] [--size WxH]");
    struct scene *scene;
    struct accel *accel;
    struct device *device;
    struct renderer *renderer;
    struct scene_pose pose;
    const struct device_params device_params = {.selector = selector};
    if (load_scene(&bench_log, path, NULL, &scene) != WHIT_OK ||
        accel_create(&bench_log, scene, &accel_params, &accel) != WHIT_OK ||
        scene_pose_init(scene, 0.0, &pose) != WHIT_OK ||
        device_create(&bench_log, &device_params, &device) != WHIT_OK ||
        renderer_create(&bench_log, device, accel, &params, &renderer) != WHIT_OK)
        return 1;
    struct rays sets[SETS] = {
        {"primary", NULL, 0, false}, {"shadow", NULL, 0, true}, {"diffuse", NULL, 0, false}};
    primary_rays(&pose, width, height, &sets[0]);
    struct gpu_hit *hits = array_alloc_zeroed(sets[0].count, sizeof *hits);
    if (!hits ||
        renderer_trace(renderer, sets[0].rays, sets[0].count, false, hits, NULL) != WHIT_OK)
        return 1;
    secondary_rays(&sets[0], hits, &pose, &sets[1], &sets[2]);
    const struct device_info *info = device_get_info(device);
    printf("%s: %llu triangles, build %.1f ms, SAH %.2f, depth %u; %s (%s); %d runs\n", path,
           (unsigned long long)scene->triangle_total, accel->build_ms, accel->meshes[0].sah_cost,
           accel->mesh_depth, info->name, info->driver, runs);
#ifdef BENCH_EMBREE
    struct embree embree = {.hits = hits};
    embree_build(&embree, scene, &pose);
#endif
    for (int s = 0; s < SETS; ++s) {
        static struct series whit;
        whit = (struct series){.name = "whit watertight"};
#ifdef BENCH_EMBREE
        static struct series peer;
        peer = (struct series){.name = "Embree robust 1"};
#endif
        for (int run = -1; run < runs; ++run) { /* -1: warm-up */
            int at = run < 0 ? 0 : run;
            double wall = clock_ms(), cpu = clock_cpu_ms();
            if (renderer_trace(renderer, sets[s].rays, sets[s].count, sets[s].any, hits, NULL) !=
                WHIT_OK)
                return 1;
            whit.runs[at] = (struct sample){clock_ms() - wall, clock_cpu_ms() - cpu};
            whit.hits = (double)count_hits(hits, sets[s].count);
#ifdef BENCH_EMBREE
            embree.rays = &sets[s];
            wall = clock_ms(), cpu = clock_cpu_ms();
            threads_for(2, (uint32_t)((sets[s].count + CHUNK - 1) / CHUNK), embree_chunk, &embree);
            peer.runs[at] = (struct sample){clock_ms() - wall, clock_cpu_ms() - cpu};
            peer.hits = (double)count_hits(hits, sets[s].count);
#endif
        }
        double own = print_series(sets[s].name, &whit, runs, sets[s].count);
#ifdef BENCH_EMBREE
        double other = print_series(sets[s].name, &peer, runs, sets[s].count);
        printf("%-8s whit : Embree by CPU time  %.3f\n", sets[s].name, other / own);
#else
        (void)own;
        printf("%-8s Embree is not installed: skipped\n", sets[s].name);
#endif
    }
#ifdef BENCH_EMBREE
    rtcReleaseScene(embree.scene);
    rtcReleaseDevice(embree.device);
#endif
    for (int s = 0; s < SETS; ++s)
        free(sets[s].rays);
    free(hits);
    renderer_destroy(renderer);
    device_destroy(device);
    scene_pose_finish(&pose);
    accel_destroy(accel);
    scene_destroy(scene);
    return 0;
}
