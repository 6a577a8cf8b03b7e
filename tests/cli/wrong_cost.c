/* Linked into whit in the place of three calls (--wrap): a library in which one thing is wrong, for
   `whit cost` to find. WHIT_TEST_WRONG names it:
   slow      renderers of at least 16 bounces take 10 % more CPU time
   schlick   pictures by Schlick's approximation are 5 % too bright
   triangle  trees by medians have one triangle moved: the 11th, which a camera before the cube sees
 */
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"

whit_result __real_whit_renderer_create(whit_device *device, whit_accel *accel,
                                        const whit_renderer_params *params, whit_renderer **out);
whit_result __wrap_whit_renderer_create(whit_device *device, whit_accel *accel,
                                        const whit_renderer_params *params, whit_renderer **out);
whit_result __real_whit_renderer_set_view(whit_renderer *renderer,
                                          const whit_renderer_params *params);
whit_result __wrap_whit_renderer_set_view(whit_renderer *renderer,
                                          const whit_renderer_params *params);
whit_result __real_whit_renderer_render(whit_renderer *renderer);
whit_result __wrap_whit_renderer_render(whit_renderer *renderer);
whit_result __real_whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out);
whit_result __wrap_whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out);
whit_result __real_whit_accel_create(const whit_scene *scene, const whit_accel_params *params,
                                     whit_accel **out);
whit_result __wrap_whit_accel_create(const whit_scene *scene, const whit_accel_params *params,
                                     whit_accel **out);

/* The latest renderer of the kind that is wrong. */
static const whit_renderer *slow_one, *schlick_one;

static bool is_wrong(const char *what)
{
    const char *wanted = getenv("WHIT_TEST_WRONG");
    return wanted && strcmp(wanted, what) == 0;
}

static void note_depth(const whit_renderer *renderer, const whit_renderer_params *params)
{
    if (params->depth >= 16)
        slow_one = renderer;
    else if (slow_one == renderer)
        slow_one = NULL;
}

whit_result __wrap_whit_renderer_set_view(whit_renderer *renderer,
                                          const whit_renderer_params *params)
{
    note_depth(renderer, params);
    return __real_whit_renderer_set_view(renderer, params);
}

whit_result __wrap_whit_renderer_create(whit_device *device, whit_accel *accel,
                                        const whit_renderer_params *params, whit_renderer **out)
{
    whit_result result = __real_whit_renderer_create(device, accel, params, out);
    if (result == WHIT_OK)
        note_depth(*out, params);
    if (result == WHIT_OK && params->schlick)
        schlick_one = *out;
    else if (schlick_one == *out)
        schlick_one = NULL;
    return result;
}

whit_result __wrap_whit_renderer_render(whit_renderer *renderer)
{
    double start_ms = whit_clock_cpu_ms();
    whit_result result = __real_whit_renderer_render(renderer);
    double end_ms = whit_clock_cpu_ms();
    end_ms += 0.1 * (end_ms - start_ms);
    while (is_wrong("slow") && renderer == slow_one && whit_clock_cpu_ms() < end_ms)
        ;
    return result;
}

whit_result __wrap_whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out)
{
    whit_result result = __real_whit_renderer_image(renderer, aov, out);
    if (result != WHIT_OK || aov != WHIT_AOV_COLOR || !is_wrong("schlick") ||
        renderer != schlick_one)
        return result;
    struct image *image = &(*out)->image;
    for (size_t i = 0; i < (size_t)image->width * image->height * image->channels; ++i)
        image->pixels[i] *= i % image->channels < 3 ? 1.05f : 1.0f;
    return result;
}

whit_result __wrap_whit_accel_create(const whit_scene *scene, const whit_accel_params *params,
                                     whit_accel **out)
{
    whit_result result = __real_whit_accel_create(scene, params, out);
    if (result == WHIT_OK && is_wrong("triangle") && params->build == WHIT_BUILD_MEDIAN)
        for (int k = 0; k < 3; ++k)
            (*out)->accel->triangles[10].v0[k] *= 0.5f;
    return result;
}
