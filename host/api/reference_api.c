/* The reference in double: pictures and ray trees. */
#include <stdlib.h>

#include "api/handles.h"
#include "reference/reference.h"

_Static_assert(sizeof(whit_tree_ray) == sizeof(struct reference_ray) &&
                   offsetof(whit_tree_ray, radiance) == offsetof(struct reference_ray, radiance) &&
                   offsetof(whit_tree_ray, t) == offsetof(struct reference_ray, t) &&
                   offsetof(whit_tree_ray, light) == offsetof(struct reference_ray, light),
               "rays are handed on as they are");
_Static_assert((uint32_t)WHIT_TREE_STRAIGHT == REFERENCE_STRAIGHT &&
                   (uint32_t)WHIT_TREE_BAILOUT == REFERENCE_END_BAILOUT &&
                   (uint32_t)WHIT_TREE_LIGHT == REFERENCE_END_LIGHT,
               "kinds and ends");

struct whit_reference {
    struct reference *reference;
    whit_renderer_params params; /* its strings are not read again */
    struct log log;
};

whit_result whit_reference_create(whit_accel *accel, const whit_renderer_params *params,
                                  uint32_t threads, whit_reference **out)
{
    const whit_renderer_params defaults = whit_renderer_defaults();
    struct reference_params inner = {.thread_count = threads};
    *out = NULL;
    whit_result result =
        render_params_from_public(&accel->log, params ? params : &defaults, &inner.picture);
    if (result != WHIT_OK)
        return result;
    whit_reference *reference = calloc(1, sizeof *reference);
    if (!reference) {
        log_error(&accel->log, "out of memory");
        return WHIT_ERROR_MEMORY;
    }
    reference->log = accel->log;
    reference->params = params ? *params : defaults;
    result = reference_create(&accel->log, accel->accel, &inner, &reference->reference);
    if (result != WHIT_OK) {
        whit_reference_destroy(reference);
        return result;
    }
    *out = reference;
    return WHIT_OK;
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
    whit_image *to_color = calloc(1, sizeof *to_color);
    whit_image *to_ids = ids ? calloc(1, sizeof *to_ids) : NULL;
    whit_result result = to_color && (to_ids || !ids) ? WHIT_OK : WHIT_ERROR_MEMORY;
    if (result != WHIT_OK)
        log_error(&reference->log, "out of memory");
    else
        result = reference_render(reference->reference, &to_color->image,
                                  to_ids ? &to_ids->image : NULL, NULL);
    if (result != WHIT_OK) {
        free(to_color);
        free(to_ids);
        to_color = to_ids = NULL;
    } else {
        whit_image_display_as(to_color, &reference->params);
    }
    *color = to_color;
    if (ids)
        *ids = to_ids;
    return result;
}

whit_result whit_reference_rays(whit_reference *reference, uint32_t x, uint32_t y, uint32_t sample,
                                whit_tree_ray **rays, uint32_t *count)
{
    struct reference_ray *found = NULL;
    whit_result result = reference_ray_tree(reference->reference, x, y, sample, &found, count);
    *rays = (whit_tree_ray *)(void *)found;
    return result;
}
