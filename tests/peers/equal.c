/* The same hits and the same pictures, bit for bit, whatever builds the trees and whatever order
   they are walked in:
       equal [--rays N] [--size N] [--every N] [--device D] SCENE...
   Hits are traced with every builder and every order. Pictures are drawn with every N-th of these
   pairs, each builder among them where N is 3: a driver takes long to compile a picture's kernel.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "load/load.h"
#include "peers.h"
#include "render/render.h"
#include "scene/pose.h"

struct options {
    uint64_t rays;
    uint32_t size;  /* of pictures: width; 0: none */
    uint32_t every; /* one picture for so many pairs of a builder and an order */
    const char *device;
};

struct builder {
    const char *name;
    whit_accel_params params;
};

static const struct builder builders[] = {
    {"binned", {.build = WHIT_BUILD_BINNED}},
    {"binned:7, leaves of 15",
     {.build = WHIT_BUILD_BINNED,
      .bins = 7,
      .leaf_limit = 15,
      .instance_build = WHIT_BUILD_MEDIAN}},
    {"median", {.build = WHIT_BUILD_MEDIAN, .instance_build = WHIT_BUILD_MEDIAN}},
    {"sweep", {.build = WHIT_BUILD_SWEEP}},
    {"spatial", {.build = WHIT_BUILD_SPATIAL}},
    {"median+opt",
     {.build = WHIT_BUILD_MEDIAN, .optimize = true, .instance_build = WHIT_BUILD_MEDIAN}},
    {"binned+opt", {.build = WHIT_BUILD_BINNED, .optimize = true}},
    {"sweep+opt", {.build = WHIT_BUILD_SWEEP, .optimize = true}},
    {"spatial+opt",
     {.build = WHIT_BUILD_SPATIAL, .optimize = true, .instance_build = WHIT_BUILD_MEDIAN}},
};
enum { BUILDERS = sizeof builders / sizeof builders[0], ORDERS = 3 };
static const char *const orders[ORDERS] = {
    [ORDER_DISTANCE] = "distance", [ORDER_SIGN] = "sign", [ORDER_BASIC] = "basic"};

/* The hits and the picture of one way to trace a scene. */
struct answer {
    struct gpu_hit *closest, *any;
    struct image color, ids;
};

struct bench {
    const struct options *options;
    const char *path;
    struct scene *scene;
    struct scene_pose pose;
    struct device *device;
    struct gpu_ray *rays;
    struct answer reference, other;
    uint64_t hits_wrong, any_wrong, pictures_wrong, pictures, configurations;
};

static bool answer_init(struct answer *answer, uint64_t rays)
{
    answer->closest = array_alloc(rays, sizeof *answer->closest);
    answer->any = array_alloc(rays, sizeof *answer->any);
    return answer->closest && answer->any;
}

static void answer_finish(struct answer *answer)
{
    free(answer->closest);
    free(answer->any);
    image_finish(&answer->color);
    image_finish(&answer->ids);
}

static bool draw(struct renderer *renderer, struct answer *out)
{
    return renderer_render(renderer) == WHIT_OK &&
           renderer_read_color(renderer, &out->color) == WHIT_OK &&
           renderer_read_ids(renderer, &out->ids) == WHIT_OK;
}

static bool trace(const struct bench *bench, struct accel *accel, uint32_t order, bool picture,
                  struct answer *out)
{
    uint32_t size = bench->options->size ? bench->options->size : 8;
    const whit_renderer_params params = {
        .width = size, .height = (size * 3 + 3) / 4, .depth = 5, .traversal = order};
    struct renderer *renderer = NULL;
    uint64_t n = bench->options->rays;
    image_finish(&out->color);
    image_finish(&out->ids);
    bool done = renderer_create(&peers_log, bench->device, accel, &params, &renderer) == WHIT_OK &&
                renderer_trace(renderer, bench->rays, n, false, out->closest, NULL) == WHIT_OK &&
                renderer_trace(renderer, bench->rays, n, true, out->any, NULL) == WHIT_OK &&
                (!picture || draw(renderer, out));
    renderer_destroy(renderer);
    return done;
}

/* Differing pixels, by all bits of colour and ids. */
static uint64_t pictures_differ(const struct answer *a, const struct answer *b)
{
    uint64_t differ = 0, pixels = (uint64_t)b->color.width * b->color.height; /* 0: not drawn */
    for (uint64_t i = 0; i < pixels; ++i)
        differ += memcmp(&a->color.pixels[4 * i], &b->color.pixels[4 * i], 16) != 0 ||
                  memcmp(&a->ids.words[2 * i], &b->ids.words[2 * i], 8) != 0;
    return differ;
}

static void print_ray(const struct bench *bench, uint64_t i)
{
    const struct gpu_ray *r = &bench->rays[i];
    const struct gpu_hit *a = &bench->reference.closest[i], *b = &bench->other.closest[i];
    printf("    ray %" PRIu64 " (%a,%a,%a) (%a,%a,%a): t %.9g %u/%u, here t %.9g %u/%u\n", i,
           (double)r->origin[0], (double)r->origin[1], (double)r->origin[2], (double)r->dir[0],
           (double)r->dir[1], (double)r->dir[2], (double)a->t, a->instance, a->primitive,
           (double)b->t, b->instance, b->primitive);
}

static void compare(struct bench *bench, const char *builder, uint32_t order)
{
    const struct answer *a = &bench->reference, *b = &bench->other;
    uint64_t hits = 0, any = 0;
    for (uint64_t i = 0; i < bench->options->rays; ++i) {
        bool differs = memcmp(&a->closest[i], &b->closest[i], sizeof a->closest[i]) != 0;
        if (differs && ++hits <= 3)
            print_ray(bench, i);
        any += (b->any[i].primitive == HIT_NONE) != (a->closest[i].primitive == HIT_NONE);
    }
    uint64_t pixels = pictures_differ(a, b);
    if (hits || any || pixels)
        printf("  %s, %s: %" PRIu64 " hits, %" PRIu64 " any-hits, %" PRIu64 " pixels differ\n",
               builder, orders[order], hits, any, pixels);
    bench->hits_wrong += hits;
    bench->any_wrong += any;
    bench->pictures_wrong += pixels != 0;
    bench->pictures += b->color.width > 0;
    ++bench->configurations;
}

static bool run_builder(struct bench *bench, uint32_t index)
{
    const struct builder *builder = &builders[index];
    bool reference = index == 0;
    whit_accel_params params = builder->params;
    params.validate = true;
    struct accel *accel = NULL;
    bool done = accel_create(&peers_log, bench->scene, &params, &accel) == WHIT_OK;
    for (uint32_t order = 0; done && order < ORDERS; ++order) {
        bool picture = (index + order) % bench->options->every == 0;
        if (reference && order == ORDER_DISTANCE)
            done = trace(bench, accel, order, true, &bench->reference);
        done = done && trace(bench, accel, order, picture, &bench->other);
        if (done)
            compare(bench, builder->name, order);
    }
    accel_destroy(accel);
    return done;
}

static bool run_scene(struct bench *bench)
{
    uint64_t n = bench->options->rays, third = n / RAYS_KINDS;
    bool done = load_scene(&peers_log, bench->path, NULL, &bench->scene) == WHIT_OK &&
                scene_pose_init(bench->scene, 0.0, &bench->pose) == WHIT_OK;
    bench->rays = array_alloc(n, sizeof *bench->rays);
    done =
        done && bench->rays && answer_init(&bench->reference, n) && answer_init(&bench->other, n);
    for (uint64_t kind = 0; done && kind < RAYS_KINDS; ++kind)
        rays_fill((enum ray_kind)kind, bench->scene, &bench->pose, 1, bench->rays + kind * third,
                  kind + 1 < RAYS_KINDS ? third : n - kind * third);
    for (uint32_t i = 0; done && i < BUILDERS; ++i)
        done = run_builder(bench, i);
    return done;
}

static bool check_scene(const struct options *options, struct device *device, const char *path)
{
    struct bench bench = {.options = options, .path = path, .device = device};
    bool done = run_scene(&bench);
    const char *name = strrchr(path, '/');
    if (done)
        printf("%-20s %8" PRIu64 " triangles, %" PRIu64 " rays x %" PRIu64 " ways: %" PRIu64
               " hits differ, %" PRIu64 " any-hits, %" PRIu64 " of %" PRIu64 " pictures\n",
               name ? name + 1 : path, bench.scene->triangle_total, options->rays,
               bench.configurations, bench.hits_wrong, bench.any_wrong, bench.pictures_wrong,
               bench.pictures);
    fflush(stdout);
    answer_finish(&bench.reference);
    answer_finish(&bench.other);
    free(bench.rays);
    scene_pose_finish(&bench.pose);
    scene_destroy(bench.scene);
    return done && bench.hits_wrong + bench.any_wrong + bench.pictures_wrong == 0;
}

int main(int argc, char **argv)
{
    struct options options = {.rays = 1000000, .size = 96, .every = 1};
    int first = 1;
    for (; first + 1 < argc && argv[first][0] == '-'; first += 2) {
        if (strcmp(argv[first], "--rays") == 0)
            options.rays = strtoull(argv[first + 1], NULL, 10);
        else if (strcmp(argv[first], "--size") == 0)
            options.size = (uint32_t)strtoul(argv[first + 1], NULL, 10);
        else if (strcmp(argv[first], "--every") == 0)
            options.every = (uint32_t)strtoul(argv[first + 1], NULL, 10);
        else if (strcmp(argv[first], "--device") == 0)
            options.device = argv[first + 1];
        else
            break;
    }
    if (first >= argc || argv[first][0] == '-' || options.rays < RAYS_KINDS || options.every == 0) {
        fprintf(stderr, "usage: equal [--rays N] [--size N] [--every N] [--device D] SCENE...\n");
        return 2;
    }
    struct device *device = NULL;
    const whit_device_params params = {.selector = options.device};
    if (device_create(&peers_log, &params, NULL, &device) != WHIT_OK)
        return 3;
    device_keep_pipelines(device);
    bool good = true;
    for (int i = first; i < argc; ++i)
        good = check_scene(&options, device, argv[i]) && good;
    device_destroy(device);
    puts(good ? "all equal" : "FAILED: hits or pictures differ");
    return good ? 0 : 1;
}
