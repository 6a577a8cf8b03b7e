/* Watertightness: rays from inside closed spheres to their vertices and edges must hit. So that the
   check is known to see leaks, it runs twice: with whit's traversal, and with the same file built
   with a * b + c contracted, which must leak. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/threads.h"
#include "peers.h"
#include "scene/shapes.h"
#include "twin/traverse.h"

#ifdef PEERS_CONTRACTED
/* host/twin/traverse.c under another name and other flags. */
void traverse_float_contracted(const struct accel *accel, uint32_t order, const struct gpu_ray *ray,
                               bool any, uint32_t skip_instance, uint32_t skip_primitive,
                               struct gpu_hit *hit, struct gpu_cost *cost, uint32_t *status);
#define TRAVERSE_CONTRACTED traverse_float_contracted
#else
#define TRAVERSE_CONTRACTED traverse_float /* never called */
#endif

enum { CHUNK = 16384, LEAK_THREADS = 2 };

/* A sphere of radius 2 with its middle at `middle`: moved by its vertices, or by an instance that
   is also turned and stretched. */
struct ball {
    const char *name;
    double middle[3];
    bool instanced;
};

static const struct ball balls[] = {
    {"offset 0", {0, 0, 0}, false},
    {"offset 10", {10, -10, 10}, false},
    {"offset 1e3", {1e3, 1e3, -1e3}, false},
    {"offset 1e5", {-1e5, 1e5, 1e5}, false},
    {"offset 148376, 1234, -223423", {148376, 1234, -223423}, false},
    {"turned instance, offset 0", {0, 0, 0}, true},
    {"turned instance, offset 1e3", {1e3, -1e3, 1e3}, true},
};

enum { BALLS = sizeof balls / sizeof *balls };

static struct affine placing(const struct ball *ball)
{
    const double turn[4] = {0.3, -0.5, 0.2, 0.8}, stretch[3] = {1.0, 1.25, 0.8};
    return affine_from_trs(ball->middle, turn, stretch);
}

static struct scene *ball_scene(const struct ball *ball)
{
    struct scene_mesh mesh = {0};
    struct scene *scene = scene_create(&peers_log, ball->name);
    if (!scene || shape_sphere(2.0, 40, 20, &mesh) != WHIT_OK)
        return scene;
    struct scene_instance instance = {.node = SCENE_NONE, .has_local = ball->instanced};
    if (ball->instanced)
        instance.local = placing(ball);
    for (size_t i = 0; !ball->instanced && i < 3 * (size_t)mesh.vertex_count; ++i)
        mesh.positions[i] = (float)((double)mesh.positions[i] + ball->middle[i % 3]);
    uint32_t triangles = mesh.triangle_count;
    instance.mesh = scene_add_mesh(scene, mesh);
    if (instance.mesh == SCENE_NONE || scene_add_instance(scene, instance) == SCENE_NONE ||
        scene_freeze(scene) != WHIT_OK || scene->triangle_total != triangles) {
        fprintf(stderr, "hits: %s: no closed sphere\n", ball->name);
        scene_destroy(scene);
        return NULL;
    }
    return scene;
}

struct hunt {
    const struct scene *scene;
    const struct accel *accel;
    struct scene_pose pose;
    const struct ball *ball;
    uint64_t seed, count;
    bool contracted;                    /* this machine can run that copy */
    uint64_t *leaks, *contracted_leaks; /* of each chunk */
    uint32_t *status;
};

/* A fourth of them starts level with the target on one or two axes, or nearly so: directions with
   zeros and with tiny components. */
static struct gpu_ray leaving_ray(const struct hunt *hunt, uint64_t i, uint64_t *state)
{
    double target[3], origin[3], length2;
    do {
        length2 = 0.0;
        for (int k = 0; k < 3; ++k) {
            origin[k] = random_signed(state);
            length2 += origin[k] * origin[k];
        }
    } while (length2 > 1.0);
    random_target(hunt->scene, &hunt->pose, state, target);
    for (int k = 0; k < 3; ++k)
        origin[k] = hunt->ball->middle[k] + origin[k];
    if (i % 4 == 0) {

        int axis = (int)(random_bits64(state) % 3);
        double nearly = i % 8 == 0 ? 0.0 : 1e-6 * random_signed(state);
        for (int k = 0; k < 3; ++k) {
            double middle = hunt->ball->middle[k];
            if (k == axis)
                origin[k] = middle - 0.25 * (target[k] - middle);
            else if (fabs(target[k] - middle) < 0.75)
                origin[k] = target[k] + nearly;
        }
    }
    return ray_to(origin, target);
}

static void hunt_chunk(void *user, uint32_t index)
{
    const struct hunt *hunt = user;
    uint64_t begin = (uint64_t)index * CHUNK, state = hunt->seed * 1000003 + index;
    uint64_t end = begin + CHUNK < hunt->count ? begin + CHUNK : hunt->count;
    for (uint64_t i = begin; i < end; ++i) {
        struct gpu_ray ray = leaving_ray(hunt, i, &state);
        struct gpu_hit hit;
        traverse_float(hunt->accel, ORDER_DISTANCE, &ray, false, HIT_NONE, HIT_NONE, &hit, NULL,
                       &hunt->status[index]);
        hunt->leaks[index] += hit.primitive == HIT_NONE;
        if (!hunt->contracted)
            continue;
        TRAVERSE_CONTRACTED(hunt->accel, ORDER_DISTANCE, &ray, false, HIT_NONE, HIT_NONE, &hit,
                            NULL, &hunt->status[index]);
        hunt->contracted_leaks[index] += hit.primitive == HIT_NONE;
    }
}

static bool has_contracted(void)
{
#if !defined(PEERS_CONTRACTED)
    return false;
#elif defined(__x86_64__)
    return __builtin_cpu_supports("fma");
#else
    return true;
#endif
}

static bool ball_hunt(const struct ball *ball, uint64_t count, uint64_t seed, uint64_t *leaks,
                      uint64_t *contracted_leaks)
{
    uint32_t chunk_count = (uint32_t)((count + CHUNK - 1) / CHUNK), status = 0;
    struct scene *scene = ball_scene(ball);
    struct accel *accel = NULL;
    struct hunt hunt = {
        .scene = scene, .ball = ball, .seed = seed, .count = count, .contracted = has_contracted()};
    hunt.leaks = array_alloc_zeroed(2 * (size_t)chunk_count, sizeof *hunt.leaks);
    hunt.status = array_alloc_zeroed(chunk_count, sizeof *hunt.status);
    bool ready = scene && hunt.leaks && hunt.status &&
                 scene_pose_init(scene, 0.0, &hunt.pose) == WHIT_OK &&
                 accel_create(&peers_log, scene, NULL, &accel) == WHIT_OK;
    if (ready) {
        hunt.accel = accel;
        hunt.contracted_leaks = hunt.leaks + chunk_count;
        threads_for(LEAK_THREADS, chunk_count, hunt_chunk, &hunt);
        for (uint32_t i = 0; i < chunk_count; ++i) {
            *leaks += hunt.leaks[i];
            *contracted_leaks += hunt.contracted_leaks[i];
            status |= hunt.status[i];
        }
    }
    scene_pose_finish(&hunt.pose);
    accel_destroy(accel);
    scene_destroy(scene);
    free(hunt.leaks);
    free(hunt.status);
    return ready && status == 0;
}

int leaks_count(uint64_t ray_count, uint64_t seed)
{
    uint64_t all = 0, all_contracted = 0;
    bool contracted = has_contracted();
    printf("%-32s%12s%12s%16s\n", "closed sphere, from inside", "rays", "leaks", "if contracted");
    for (int i = 0; i < BALLS; ++i) {
        uint64_t leaks = 0, contracted_leaks = 0;
        if (!ball_hunt(&balls[i], ray_count, seed, &leaks, &contracted_leaks))
            return 1;
        printf("%-32s%12llu%12llu", balls[i].name, (unsigned long long)ray_count,
               (unsigned long long)leaks);
        if (contracted)
            printf("%16llu\n", (unsigned long long)contracted_leaks);
        else
            printf("%16s\n", "not tried");
        all += leaks;
        all_contracted += contracted_leaks;
    }
    if (all > 0)
        printf("FAILED: rays left a closed surface\n");
    if (contracted && all_contracted == 0)
        printf("FAILED: this check does not see the leaks of a contracted build\n");
    return all > 0 || (contracted && all_contracted == 0);
}
