/* Pictures of what traversals cost: `whit render --view`, `--counters`. */
#include <math.h>

#include "app/render/recipe.h"
#include "base/path.h"

static void find_figures(const whit_image *values, struct view_figures *out)
{
    whit_image_info info;
    whit_image_get_info(values, &info);
    const float *floats = whit_image_floats(values);
    size_t count = (size_t)info.width * info.height;
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        sum += (double)floats[i];
        out->max = fmax(out->max, (double)floats[i]);
    }
    out->mean = sum / (double)count;
}

static whit_result heat_map(const struct settings *settings, const struct view_figures *figures,
                            const whit_image *values, whit_image **out)
{
    char title[80], unit[64];
    snprintf(title, sizeof title, "%s, %s rays", value_title(values_view, (int)settings->paint),
             value_word(values_rays, (int)settings->paint_rays));
    snprintf(unit, sizeof unit, "mean %.3g, most %g", figures->mean, figures->max);
    const whit_heat_params params = {.scale = figures->scale, .title = title, .unit = unit};
    whit_result result = whit_image_heat(values, &params, out);
    if (result != WHIT_OK)
        cli_error("out of memory for a picture of costs");
    return result;
}

whit_result view_image(whit_renderer *renderer, const struct settings *settings, const char *output,
                       struct view_figures *figures, whit_image **out)
{
    whit_image *values;
    *out = NULL;
    *figures = (struct view_figures){0};
    whit_result result =
        whit_renderer_cost_image(renderer, (whit_view)(settings->paint - PAINT_DEPTH),
                                 (whit_ray_kind)settings->paint_rays, &values);
    if (result != WHIT_OK)
        return result;
    find_figures(values, figures);
    figures->scale =
        settings->paint_scale > 0.0 ? settings->paint_scale : whit_image_heat_scale(values);
    if (!path_is(output, "png")) {
        *out = values;
        return WHIT_OK;
    }
    result = heat_map(settings, figures, values, out);
    whit_image_destroy(values);
    return result;
}
