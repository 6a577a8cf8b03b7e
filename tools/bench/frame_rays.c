/* Lists the rays of a picture, by the reference, for Embree to trace. */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/vec.h"
#include "bench/frame_rays.h"

static const char closest_name[] = "closest.rays", shadow_name[] = "shadow.rays";

struct own_ray {
    uint32_t light; /* 0 for rays that are not shadow rays */
    whit_ray ray;
};
struct own_rays {
    struct own_ray *rays;
    uint32_t count, capacity;
};

/* Makes a ray: shadow rays end at their light, other rays do not end. */
static whit_ray ray_of(const struct frame *frame, const whit_probe_ray *from)
{
    bool shadow = from->kind == WHIT_RAY_SHADOW;
    const double *lo = frame->loaded.info.lo, *hi = frame->loaded.info.hi;
    double size = fmax(hi[0] - lo[0], fmax(hi[1] - lo[1], hi[2] - lo[2])), length = size;
    if (shadow) {
        whit_light_info light;
        whit_scene_get_light(frame->loaded.scene, from->light, &light);
        const float *o = from->ray.origin;
        length = light.kind == WHIT_LIGHT_DIRECTIONAL
                     ? 2.0 * size
                     : double3_distance(light.position, (const double[]){o[0], o[1], o[2]});
    }
    whit_ray ray = {.t_min = from->kind == WHIT_RAY_PRIMARY ? 0.0f : 1e-4f,
                    .t_max = shadow ? 1.0f - 1e-4f : INFINITY};
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = from->ray.origin[k];
        ray.dir[k] = (float)((double)from->ray.dir[k] * length);
    }
    return ray;
}

static whit_result take_pixel(struct frame *frame, uint32_t x, uint32_t y, struct own_rays *closest,
                              struct own_rays *shadow)
{
    whit_probe_ray *rays;
    uint32_t count;
    whit_result result = whit_reference_rays(frame->reference, x, y, 0, &rays, &count);
    if (result != WHIT_OK)
        return result;
    bool room = true;
    for (uint32_t i = 0; room && i < count; ++i) {
        if (rays[i].end == WHIT_PROBE_DEPTH || rays[i].end == WHIT_PROBE_BAILOUT)
            continue;
        bool is_shadow = rays[i].kind == WHIT_RAY_SHADOW;
        struct own_rays *to = is_shadow ? shadow : closest;
        const struct own_ray ray = {is_shadow ? rays[i].light : 0, ray_of(frame, &rays[i])};
        room = ARRAY_PUSH(to->rays, to->count, to->capacity, ray);
    }
    whit_memory_destroy(rays);
    return !room ? WHIT_ERROR_MEMORY : cli_cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
}

/* Writes the rays sorted by light, as a renderer would trace them. */
static whit_result write_rays(const struct frame *frame, const char *name,
                              const struct own_rays *rays)
{
    uint32_t count = 0;
    whit_ray *plain = array_alloc(rays->count, sizeof *plain);
    if (!plain)
        return WHIT_ERROR_MEMORY;
    for (uint32_t light = 0; count < rays->count; ++light)
        for (uint32_t i = 0; i < rays->count; ++i)
            if (rays->rays[i].light == light)
                plain[count++] = rays->rays[i].ray;
    whit_result result = bench_write(frame->bench, name, plain, count * sizeof *plain);
    free(plain);
    return result;
}

whit_result frame_prepare_rays(struct frame *frame)
{
    struct own_rays closest = {0}, shadow = {0};
    whit_result result = WHIT_OK;
    for (uint32_t y = 0; result == WHIT_OK && y < frame->height; y += 8) {
        for (uint32_t x = 0; result == WHIT_OK && x < frame->width; x += 8) {
            for (uint32_t i = 0; result == WHIT_OK && i < 64; ++i)
                if (x + i % 8 < frame->width && y + i / 8 < frame->height)
                    result = take_pixel(frame, x + i % 8, y + i / 8, &closest, &shadow);
        }
    }
    if (result == WHIT_OK)
        result = write_rays(frame, closest_name, &closest);
    if (result == WHIT_OK)
        result = write_rays(frame, shadow_name, &shadow);
    free(closest.rays);
    free(shadow.rays);
    return result == WHIT_OK ? peer_begin(&frame->peer, PEER_EMBREE, frame->bench,
                                          frame->loaded.scene, "own.triangles")
                             : result;
}

whit_result frame_trace_rays(struct frame *frame, double *ms)
{
    double closest[2] = {0.0}, forth[2] = {0.0}, back[2] = {0.0};
    whit_result result = peer_rays(&frame->peer, closest_name, false);
    if (result == WHIT_OK)
        result = peer_trace(&frame->peer, "single", false, false, closest);
    if (result == WHIT_OK)
        result = peer_rays(&frame->peer, shadow_name, true);
    if (result == WHIT_OK)
        result = peer_trace(&frame->peer, "single", false, false, forth);
    if (result == WHIT_OK)
        result = peer_trace(&frame->peer, "single", true, false, back);
    int clock = frame->bench->is_cpu ? 0 : 1;
    *ms = closest[clock] + fmin(forth[clock], back[clock]);
    return result;
}
