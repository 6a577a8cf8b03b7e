/* A batch of rays of any length and bits: it is read as `whit trace` reads it; on the CPU every ray
   ends, and finds by tree what it finds without. */
#include "fuzz.h"

#include <math.h>
#include <string.h>

#include "app/cli.h"
#include "app/trace/ray_file.h"
#include "trees.h"
#include "twin/traverse.h"

enum { KIND_COUNT = FUZZ_SCENE_COUNT, BUILD_COUNT = 2, RAYS_MAX = 64, HITS_MAX = 64 };

static struct accel *accels[KIND_COUNT][BUILD_COUNT + 1];

static void prepare(void)
{
    static const uint32_t builds[BUILD_COUNT] = {0, 3};
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        struct scene *scene = fuzz_scene_make((enum fuzz_scene)kind);
        for (int i = 0; i <= BUILD_COUNT; i++) {
            whit_accel_params params = fuzz_tree_params(i < BUILD_COUNT ? builds[i] : 0);
            params.instances = i == BUILD_COUNT ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON;
            params.validate = true;
            fuzz_check(accel_create(&fuzz_log, scene, &params, &accels[kind][i]) == WHIT_OK,
                       "no trees");
        }
    }
}

/* One hit behind the other: each is farther, or the next one in the order of ties. */
static void check_sequence(const struct accel *accel, const struct gpu_ray *ray)
{
    struct gpu_hit hit, before;
    const struct traverse_params next = {.behind = &before};
    uint32_t status = 0;
    traverse_ray(accel, NULL, ray, &hit, NULL, &status);
    for (int i = 0; i < HITS_MAX && hit.primitive != HIT_NONE; i++) {
        before = hit;
        traverse_ray(accel, &next, ray, &hit, NULL, &status);
        fuzz_check(hit.primitive == HIT_NONE || hit.t >= before.t, "%a behind %a", (double)hit.t,
                   (double)before.t);
        fuzz_check(memcmp(&hit, &before, sizeof hit) != 0, "the same hit again, at %a",
                   (double)hit.t);
    }
    fuzz_check(status == 0, "status %#x", status);
}

/* Reads all rays of the file, and checks that a file which cannot be read is reported by one
   error. */
static uint64_t read_rays(const uint8_t *data, size_t size_bytes, whit_ray rays[RAYS_MAX])
{
    enum { PIECE = 5 };
    struct ray_file file;
    uint64_t count = 1, sum = 0;
    fuzz_log_clear();
    whit_result result = ray_file_open(fuzz_file("rays.bin", data, size_bytes), &file);
    while (result == WHIT_OK && count > 0 && sum + PIECE <= RAYS_MAX) {
        result = ray_file_read(&file, rays + sum, PIECE, &count);
        sum += count;
    }
    ray_file_close(&file);
    fuzz_check_errors(result, file.path);
    fuzz_check((result == WHIT_OK) == (size_bytes % sizeof *rays == 0), "%zu bytes: %d", size_bytes,
               (int)result);
    fuzz_check(memcmp(rays, data, sum * sizeof *rays) == 0, "other rays than in the file");
    return sum;
}

/* The first byte says where; the rest is a file of rays. */
static void run(const uint8_t *data, size_t size_bytes)
{
    if (size_bytes == 0)
        return;
    const struct accel *accel = accels[data[0] % KIND_COUNT][data[0] / KIND_COUNT % 3];
    whit_ray rays[RAYS_MAX];
    uint64_t count = read_rays(data + 1, size_bytes - 1, rays);
    for (uint64_t i = 0; i < count; i++) {
        struct gpu_ray ray;
        memcpy(&ray, &rays[i], sizeof ray);
        fuzz_check_ray(accel, &ray);
        check_sequence(accel, &ray);
    }
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(1) << 20};
