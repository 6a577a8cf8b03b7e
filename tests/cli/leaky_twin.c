/* The traversal of the float mirror loses a ray now and then, which `whit hard` must find. Kernels
   that are not portable lose a ray too, so that `whit check` must ask for portable ones. With
   WHIT_TEST_REFUSED no kernel can be made portable, and asking for one is an error. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../wrapped.h"
#include "accel/accel.h"
#include "shader/portable.h"
#include "twin/traverse.h"
#include "whit.h"

WRAPPED(void, traverse_ray, const struct accel *accel, const struct traverse_params *params,
        const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost, uint32_t *status)
{
    __real_traverse_ray(accel, params, ray, hit, cost, status);
    if (ray->dir[0] > 0.0f && ray->dir[0] < 0.01f)
        *hit = (struct gpu_hit){.t = INFINITY, .primitive = HIT_NONE, .instance = HIT_NONE};
}

WRAPPED(whit_result, whit_hard_view, whit_device *device, const whit_scene *scene,
        const whit_hard_view_params *params, const whit_log *log, uint64_t *wrong_pixels,
        uint64_t *other_pixels, whit_image **out)
{
    whit_result result =
        __real_whit_hard_view(device, scene, params, log, wrong_pixels, other_pixels, out);
    *wrong_pixels += params == NULL || !params->portable;
    return result;
}

WRAPPED(whit_result, shader_make_portable, const struct portable_params *params,
        const uint32_t *words, size_t word_count, uint32_t **out, size_t *out_words,
        char why[PORTABLE_WHY_BYTES])
{
    if (!getenv("WHIT_TEST_REFUSED"))
        return __real_shader_make_portable(params, words, word_count, out, out_words, why);
    snprintf(why, PORTABLE_WHY_BYTES, "portable kernels are refused");
    *out = NULL;
    return WHIT_ERROR_INPUT;
}
