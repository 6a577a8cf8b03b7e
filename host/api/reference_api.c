/* The reference in double: pictures and ray trees. */
#include <math.h>
#include <stdlib.h>

#include "api/handles.h"
#include "reference/reference.h"

struct whit_reference {
    struct reference *reference;
    whit_renderer_params params; /* strings in it may be gone, and are not read */
    const struct accel *accel;   /* borrowed */
    whit_log log;
    whit_stats stats; /* of the picture rendered last */
};

whit_result whit_reference_create(whit_accel *accel, const whit_renderer_params *params,
                                  uint32_t threads, whit_reference **out)
{
    const struct reference_params inner = {.picture = api_params(params), .thread_count = threads};
    *out = NULL;
    whit_reference *reference = calloc(1, sizeof *reference);
    if (!reference)
        return API_FAIL(&accel->log, WHIT_ERROR_MEMORY, "out of memory");
    reference->log = accel->log;
    reference->accel = accel->accel;
    reference->params = inner.picture;
    whit_result result = reference_create(&accel->log, accel->accel, &inner, &reference->reference);
    if (result == WHIT_OK)
        *out = reference;
    else
        whit_reference_destroy(reference);
    return result;
}

void whit_reference_destroy(whit_reference *reference)
{
    if (!reference)
        return;
    reference_destroy(reference->reference);
    free(reference);
}

whit_result whit_reference_render(whit_reference *reference, whit_image **color, whit_image **ids)
{
    struct image made = {0}, made_ids = {0};
    whit_result result =
        reference_render(reference->reference, &made, ids ? &made_ids : NULL, &reference->stats);
    result = api_hand_out(&reference->log, &made, result, color);
    if (ids)
        result = api_hand_out(&reference->log, &made_ids, result, ids);
    if (result == WHIT_OK) {
        whit_image_display_as(*color, &reference->params);
        return WHIT_OK;
    }
    whit_image_destroy(*color);
    *color = NULL;
    return result;
}

void whit_reference_get_stats(const whit_reference *reference, whit_stats *stats)
{
    *stats = reference->stats;
    stats->render_device_ms = stats->bailout_bound = -1.0;
    stats->weight_cut_depth = stats->weight_cut_bailout = -1.0;
    api_set_rate(stats);
}

static void to_floats(const double from[3], float to[3])
{
    for (int i = 0; i < 3; ++i)
        to[i] = (float)from[i];
}

static whit_probe_ray ray_of(const struct accel *accel, const struct reference_ray *all,
                             uint32_t index)
{
    const struct reference_ray *from = &all[index];
    const whit_probe_hit none = {INFINITY, WHIT_NONE, WHIT_NONE};
    bool shadow = from->kind == REFERENCE_SHADOW, straight = from->kind == REFERENCE_STRAIGHT;
    uint32_t medium = from->medium;
    whit_probe_ray ray = {
        .kind = straight ? WHIT_RAY_REFRACTED : (whit_ray_kind)from->kind,
        .straight = straight,
        .end = from->end,
        .parent = from->parent,
        .ray.t_max = (float)from->t_max,
        .device = from->instance == WHIT_NONE
                      ? none
                      : (whit_probe_hit){from->t, from->instance, from->primitive},
        .twin = none,
        .exact = none,
        .material = from->material,
        .medium = medium,
        .ior = medium == WHIT_NONE ? 1.0f : accel->scene->materials[medium].ior,
        .light = from->light,
        .light_sample = shadow ? from->point : WHIT_NONE,
    };
    to_floats(from->origin, ray.ray.origin);
    to_floats(from->dir, ray.ray.dir);
    to_floats(shadow ? all[from->parent].weight : from->weight, ray.weight);
    to_floats(shadow ? from->weight : from->radiance, ray.added);
    to_floats(from->normal, ray.normal);
    for (int i = 0; i < 3 && from->instance != WHIT_NONE; ++i)
        ray.point[i] = (float)(from->origin[i] + from->t * from->dir[i]);
    return ray;
}

whit_result whit_reference_rays(whit_reference *reference, uint32_t x, uint32_t y, uint32_t sample,
                                whit_probe_ray **rays, uint32_t *count)
{
    struct reference_ray *found = NULL;
    *rays = NULL;
    whit_result result = reference_ray_tree(reference->reference, x, y, sample, &found, count);
    if (result == WHIT_OK)
        *rays = calloc(*count, sizeof **rays);
    if (result == WHIT_OK && !*rays)
        result = API_FAIL(&reference->log, WHIT_ERROR_MEMORY, "out of memory");
    for (uint32_t i = 0; result == WHIT_OK && i < *count; ++i) {
        whit_probe_ray *ray = &(*rays)[i];
        *ray = ray_of(reference->accel, found, i);
        ray->generation = ray->parent == WHIT_NONE ? 0 : (*rays)[ray->parent].generation + 1;
    }
    free(found);
    return result;
}
