#include "app/view_image.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "settings/values.h"

void view_read(struct cli_reader *reader, struct cost_view *view)
{
    int choice;
    if (!cli_choice(reader, &choice))
        return;
    view->given = choice > 0;
    view->view = choice > 0 ? (uint32_t)choice - 1 : 0;
}

void view_read_rays(struct cli_reader *reader, struct cost_view *view)
{
    view->has_rays = cli_choice_unsigned(reader, &view->rays);
}

void view_read_scale(struct cli_reader *reader, struct cost_view *view)
{
    view->scale = 0.0;
    view->has_scale = true;
    if (strcmp(reader->value, "auto") != 0)
        cli_number(reader, 1e-9, 1e12, &view->scale);
}

bool view_check(struct cli_reader *reader, const struct cost_view *view)
{
    if (view->given || (!view->has_rays && !view->has_scale))
        return true;
    return cli_misuse(reader,
                      "--view-%s: there is nothing to count without --view depth, visits, boxes, "
                      "tris or stack",
                      view->has_rays ? "rays" : "scale");
}

const char *view_name(const struct cost_view *view)
{
    return value_word(values_view, view->given ? 1 + (int)view->view : 0);
}

const char *view_rays_name(const struct cost_view *view)
{
    return value_word(values_rays, (int)view->rays);
}

static void find_figures(const whit_image *values, struct view_figures *out)
{
    whit_image_info info;
    whit_image_get_info(values, &info);
    const float *floats = whit_image_floats(values);
    size_t count = (size_t)info.width * info.height;
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        sum += (double)floats[i];
        out->most = fmax(out->most, (double)floats[i]);
    }
    out->mean = sum / (double)count;
}

static whit_result heat_map(const struct cost_view *view, const struct view_figures *figures,
                            const whit_image *values, whit_image **out)
{
    char title[80], unit[64];
    snprintf(title, sizeof title, "%s, %s rays", value_title(values_view, 1 + (int)view->view),
             view_rays_name(view));
    snprintf(unit, sizeof unit, "mean %.3g, most %g", figures->mean, figures->most);
    const whit_heat_params params = {.scale = figures->scale, .title = title, .unit = unit};
    whit_result result = whit_image_heat(values, &params, out);
    if (result != WHIT_OK)
        cli_error("out of memory for a picture of costs");
    return result;
}

bool view_is_png(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ".png") == 0;
}

whit_result view_image(whit_renderer *renderer, const struct cost_view *view, const char *output,
                       struct view_figures *figures, whit_image **out)
{
    whit_image *values;
    *out = NULL;
    *figures = (struct view_figures){0};
    whit_result result = whit_renderer_cost_image(renderer, (whit_view)view->view,
                                                  (whit_ray_kind)view->rays, &values);
    if (result != WHIT_OK)
        return result;
    find_figures(values, figures);
    figures->scale = view->scale > 0.0 ? view->scale : whit_image_heat_scale(values);
    if (!view_is_png(output)) {
        *out = values;
        return WHIT_OK;
    }
    result = heat_map(view, figures, values, out);
    whit_image_destroy(values);
    return result;
}
