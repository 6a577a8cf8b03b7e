/* Lights as the kernel reads them. */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/vec.h"
#include "device/buffer.h"
#include "oracle/nearest.h"
#include "render/lights.h"
#include "render/renderer.h"

enum { ROW_BYTES = 16, SAMPLES_DEFAULT = 16 };

_Static_assert((int)WHIT_LIGHT_POINT == (int)LIGHT_POINT &&
                   (int)WHIT_LIGHT_DIRECTIONAL == (int)LIGHT_DIRECTIONAL &&
                   (int)WHIT_LIGHT_SPOT == (int)LIGHT_SPOT &&
                   (int)WHIT_LIGHT_AREA_SAMPLE == (int)LIGHT_AREA_SAMPLE &&
                   (int)WHIT_LIGHT_RECTANGLE == (int)LIGHT_RECTANGLE &&
                   (int)WHIT_LIGHT_TRIANGLE == (int)LIGHT_TRIANGLE,
               "the same numbers");

static double emitter_area(const struct scene_light *light)
{
    double parallelogram = double3_area(light->edge_u, light->edge_v);
    return light->kind == WHIT_LIGHT_TRIANGLE ? 0.5 * parallelogram : parallelogram;
}

static struct gpu_light make_light(const struct scene_light *light, uint32_t samples)
{
    struct gpu_light out = {
        .kind = (uint32_t)light->kind,
        .per_range = light->range > 0.0f ? 1.0f / light->range : 0.0f,
        .falloff = light->falloff || light->kind == WHIT_LIGHT_AREA_SAMPLE,
        .spot_edge = light->versine_outer,
        .spot_slope = (float)(1.0 / scene_light_cone_width(light)),
        .two_sided = light->two_sided,
    };
    for (int i = 0; i < 3; ++i) {
        out.position[i] = (float)light->position[i];
        out.direction[i] = (float)light->direction[i];
        out.color[i] = light->color[i];
    }
    if (scene_light_is_flat(light)) {
        out.falloff = true;
        out.area_share = (float)(emitter_area(light) / (PI * samples));
        for (int i = 0; i < 3; ++i) {
            out.edge_u[i] = (float)light->edge_u[i];
            out.edge_v[i] = (float)light->edge_v[i];
        }
    }
    return out;
}

whit_result lights_write(struct renderer *renderer)
{
    const struct scene_pose *pose = &renderer->pose;
    struct gpu_light *lights = array_alloc(pose->light_count, sizeof *lights);
    if (!lights)
        return render_no_memory(renderer, "lights");
    for (uint32_t i = 0; i < pose->light_count; ++i) {
        lights[i] = make_light(&pose->lights[i], lights_samples(renderer));
        lights[i].end = accel_light_end(renderer->accel, pose, &pose->lights[i]);
    }
    whit_result result = buffer_write(renderer->scene_buffers.shading,
                                      (uint64_t)renderer->frame.light_row * ROW_BYTES, lights,
                                      (uint64_t)pose->light_count * sizeof *lights);
    free(lights);
    return result;
}

uint32_t lights_kinds(const struct scene_pose *pose)
{
    uint32_t kinds = 0;
    for (uint32_t i = 0; i < pose->light_count; ++i)
        kinds |= 1u << pose->lights[i].kind;
    return kinds;
}

bool lights_share_hits(const struct scene_pose *pose)
{
    bool reaches_all = true;
    for (uint32_t i = 0; i < pose->light_count; ++i)
        reaches_all &= pose->lights[i].kind != WHIT_LIGHT_SPOT && pose->lights[i].range == 0.0f;
    return pose->light_count > LIGHT_LISTS || (pose->light_count > 1 && reaches_all);
}

uint32_t lights_samples(const struct renderer *renderer)
{
    uint32_t asked = renderer->params.light_samples;
    bool flat = renderer->effects.called[SCENE_EFFECT_AREA_LIGHTS] &&
                (lights_kinds(&renderer->pose) & LIGHT_FLAT_BITS) != 0;
    return !flat ? 1 : asked ? asked : SAMPLES_DEFAULT;
}

uint32_t lights_points(const struct renderer *renderer, uint32_t each)
{
    const struct scene_pose *pose = &renderer->pose;
    uint32_t points = 0;
    for (uint32_t i = 0; i < pose->light_count && i < LIGHT_LISTS; ++i)
        points += scene_light_is_flat(&pose->lights[i]) ? each : 1;
    return points;
}
