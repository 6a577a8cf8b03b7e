/* By how much a picture can differ from one that traces every ray, however small its weight: the
   weights that were cut from a pixel, times the largest radiance that a ray can bring, plus what
   untraced shadow rays would have added. */
#include <math.h>
#include <stdlib.h>

#include "oracle/nearest.h"
#include "render/renderer.h"
#include "render/textures.h"

static double largest(const float rgb[3])
{
    return fmax(fmax((double)rgb[0], (double)rgb[1]), fmax((double)rgb[2], 0.0));
}

/* The most light that can arrive at a point; < 0: no bound is known. `highlights`: some material
   has them. A flat emitter fills at most the hemisphere over a surface, which bounds only diffuse
   light. */
static double arriving_max(const struct renderer *renderer, bool highlights)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < renderer->pose.light_count; ++i) {
        const struct scene_light *light = &renderer->pose.lights[i];
        double color = largest(light->color);
        if (light->kind == WHIT_LIGHT_AREA_SAMPLE || (scene_light_is_flat(light) && highlights))
            return -1.0;
        if (light->falloff && light->kind != WHIT_LIGHT_DIRECTIONAL &&
            !scene_light_is_flat(light)) {
            /* A hit may lie closer to the light than the exact surface, by rounding. */
            double away = 0.999 * accel_distance(renderer->accel, &renderer->pose, light->position);
            if (!(away > 0.0))
                return -1.0;
            color /= away * away;
        }
        sum += color;
    }
    return sum;
}

/* Upper bounds for a material: the light that it sends itself, and the sum of the weights of all
   rays that it sends on. */
struct max {
    double own, weights;
};

static bool uses(const struct scene_material *m, enum scene_slot slot)
{
    return m->textures[slot].texture != SCENE_NONE;
}

/* GGX times visibility and the light's cosine is at most 1 / alpha^2 (half vector along the normal)
   times 0.5 / alpha (the spread is no less than alpha times the cosine; lib/optics.glsl). */
static double ggx_max(const struct scene_material *m)
{
    double alpha =
        uses(m, SCENE_SLOT_METAL_ROUGH) ? 0.0 : (double)m->roughness * (double)m->roughness;
    alpha = fmax(alpha, 0.02);
    return 0.5 / (alpha * alpha * alpha);
}

static double weights_max(const struct scene_material *m, double base)
{
    double through = largest(m->transmission), mirror = largest(m->reflection), weights = mirror;
    if (m->model == WHIT_MODEL_METAL_ROUGH) {
        weights = fmax(fmax(1.0, base), through * fmax(1.0, base));
    } else if (through > 0.0) {
        weights = fmax(1.0, m->fresnel ? through : through + mirror);
    } else if (m->fresnel && mirror > 0.0) {
        weights = fmax(1.0, mirror);
    }
    if (m->model == WHIT_MODEL_UNLIT)
        weights = 0.0;
    return m->alpha == SCENE_ALPHA_BLEND || m->shadow_catcher ? fmax(1.0, weights) : weights;
}

static bool has_highlight(const struct scene_material *m)
{
    return m->model == WHIT_MODEL_METAL_ROUGH ||
           (m->model == WHIT_MODEL_PHONG && largest(m->specular) > 0.0);
}

static struct max material_max(const struct renderer *renderer, const struct scene_material *m,
                               double arriving)
{
    double base = largest(m->diffuse), ambient = largest(m->ambient);
    double highlight = largest(m->specular);
    if (m->model == WHIT_MODEL_METAL_ROUGH) {
        highlight = fmax(1.0, base); /* bound of F0 */
        ambient = base + highlight;
        highlight *= ggx_max(m);
    }
    struct max max = {.own = base + largest(m->emission), .weights = weights_max(m, base)};
    if (m->model != WHIT_MODEL_UNLIT)
        max.own = largest(m->emission) + ambient * largest(renderer->frame.ambient) +
                  (base + (has_highlight(m) ? highlight : 0.0)) * arriving;
    return max;
}

static double sky_max(const struct renderer *renderer)
{
    const struct scene_environment *sky = &renderer->scene->environment;
    const struct gpu_frame *frame = &renderer->frame;
    double max =
        fmax(largest(frame->zenith), fmax(largest(frame->horizon), largest(frame->ground)));
    if (sky->kind != WHIT_ENVIRONMENT_MAP || frame->environment_size == 0)
        return max;
    return (double)sky->rgb_max * largest(sky->scale);
}

/* Upper bounds for a ray of weight 1. `radiance`: the sky's, or a surface's own light plus what its
   rays bring. `unshadowed`: light lost at all hits of its ray tree because shadow rays are not
   traced; a hit loses at most BAILOUT_SHADOW_SHARE of its ray's weight, as rays below the bailout
   are not traced themselves. A ray may pass many blended surfaces before its next bounce. */
struct brought {
    double radiance, unshadowed;
};

static struct brought ray_max(const struct renderer *renderer, const uint8_t *worn)
{
    const struct scene *scene = renderer->scene;
    bool highlights = false;
    double passed = 1.0;
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        highlights |= worn[i] && has_highlight(&scene->materials[i]);
        if (worn[i] && scene->materials[i].alpha == SCENE_ALPHA_BLEND)
            passed = 1u << STATE_BOUNCES_SHIFT;
    }
    double arriving = arriving_max(renderer, highlights), sky = sky_max(renderer);
    if (arriving < 0.0)
        return (struct brought){-1.0, -1.0};
    double radiance = 0.0, hits = 0.0;
    for (uint32_t level = 0; level <= renderer->params.depth; ++level) {
        double next = sky, called = 0.0;
        for (uint32_t i = 0; i < scene->material_count; ++i) {
            if (!worn[i])
                continue;
            const struct scene_material m = material_drawn(renderer, i);
            struct max max = material_max(renderer, &m, arriving);
            next = fmax(next, max.own + max.weights * radiance);
            called = fmax(called, max.weights * hits);
        }
        radiance = next;
        hits = passed + called;
    }
    double unshadowed = BAILOUT_SHADOW_SHARE * arriving * hits;
    return isfinite(radiance) ? (struct brought){radiance, unshadowed}
                              : (struct brought){-1.0, -1.0};
}

double bailout_bound(const struct renderer *renderer, double weight)
{
    if (!(renderer->params.bailout > 0.0))
        return 0.0;
    struct brought max = ray_max(renderer, renderer->worn);
    return max.radiance < 0.0 ? -1.0 : weight * max.radiance + max.unshadowed;
}
