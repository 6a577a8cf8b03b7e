/* Linked into whit in the place of some calls (--wrap): a library in which one thing is wrong, for
   `whit cost` to find. WHIT_TEST_WRONG names it:
   slow      pictures of at least 16 bounces take 10 % more time
   noisy     every fifth picture takes three times as long
   compile   a thousand seconds pass before a picture is drawn, as if kernels were made
   schlick   pictures by Schlick's approximation are 5 % too bright
   waits     pictures over trees by medians take 10 % more time by the wall clock alone
   triangle  trees by medians have the 11th triangle moved, which a camera before the cube sees,
             and pictures over them take 10 % more time

   Clocks move only while a picture is drawn, by the same time for each sample; trees are said to
   take 9 ms to build, by medians 1 ms. So every figure is known. With WHIT_TEST_CLOCK=real they are
   those of the machine. */
#include <stdlib.h>
#include <string.h>

#include "../wrapped.h"
#include "api/handles.h"
#include "render/renderer.h"
#include "whit_program.h"

/* A sample takes SAMPLE_MS, of which TENTH_MS is 10 %: sums of such times are exact in floating
   point. */
#define SAMPLE_MS (10.0 / 128.0)
#define TENTH_MS  (1.0 / 128.0)

static double turned_ms; /* what the clocks say */
static double waited_ms; /* what the wall clock says beyond that */

static bool is_wrong(const char *what)
{
    const char *wanted = getenv("WHIT_TEST_WRONG");
    return wanted && strcmp(wanted, what) == 0;
}

static bool clock_is_real(void)
{
    const char *clock = getenv("WHIT_TEST_CLOCK");
    return clock && strcmp(clock, "real") == 0;
}

WRAPPED(double, whit_clock_ms, void)
{
    return clock_is_real() ? __real_whit_clock_ms() : turned_ms + waited_ms;
}

WRAPPED(double, whit_clock_cpu_ms, void)
{
    return clock_is_real() ? __real_whit_clock_cpu_ms() : turned_ms;
}

static bool by_medians(const struct accel *accel)
{
    return accel->params.build == WHIT_BUILD_MEDIAN;
}

WRAPPED(whit_result, whit_renderer_render, whit_renderer *renderer)
{
    const whit_renderer_params *params = &renderer->renderer->params;
    bool slow = (is_wrong("slow") && params->depth >= 16) ||
                (is_wrong("triangle") && by_medians(renderer->accel));
    turned_ms += is_wrong("compile") ? 1e6 : 0.0;
    double start_ms = whit_clock_cpu_ms();
    whit_result result = __real_whit_renderer_render(renderer);
    double samples = (double)renderer->renderer->picture.stats.rays_primary;
    static uint32_t pictures;
    bool late = is_wrong("noisy") && ++pictures % 5 == 0;
    turned_ms += samples * (late ? 3.0 : 1.0) * (SAMPLE_MS + (slow ? TENTH_MS : 0.0));
    waited_ms += is_wrong("waits") && by_medians(renderer->accel) ? samples * TENTH_MS : 0.0;
    double end_ms = whit_clock_cpu_ms();
    end_ms += 0.1 * (end_ms - start_ms);
    while (slow && clock_is_real() && whit_clock_cpu_ms() < end_ms)
        ;
    return result;
}

WRAPPED(whit_result, whit_renderer_image, whit_renderer *renderer, whit_aov aov, whit_image **out)
{
    whit_result result = __real_whit_renderer_image(renderer, aov, out);
    if (result != WHIT_OK || aov != WHIT_AOV_COLOR || !is_wrong("schlick") ||
        !renderer->renderer->params.schlick)
        return result;
    struct image *image = &(*out)->image;
    for (size_t i = 0; i < (size_t)image->width * image->height * image->channels; ++i)
        image->pixels[i] *= i % image->channels < 3 ? 1.05f : 1.0f;
    return result;
}

WRAPPED(whit_result, whit_accel_create, const whit_scene *scene, const whit_accel_params *params,
        whit_accel **out)
{
    whit_result result = __real_whit_accel_create(scene, params, out);
    if (result == WHIT_OK && !clock_is_real())
        (*out)->accel->build_ms = by_medians((*out)->accel) ? 1.0 : 9.0;
    if (result == WHIT_OK && is_wrong("triangle") && by_medians((*out)->accel))
        for (int k = 0; k < 3; ++k)
            (*out)->accel->triangles[10].v0[k] *= 0.5f;
    return result;
}
