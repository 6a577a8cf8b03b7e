/* The fields that suites may have expectations of, and the check of these. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "app/check/describe.h"
#include "base/array.h"
#include "whit/whit_hard.h"

/* ---- Of the whole picture ---- */

typedef const struct drawing drawing_t;
typedef const struct check_expectation expectation_t;

static whit_result read_nonfinite(drawing_t *drawing, expectation_t *one,
                                  struct expect_value *value)
{
    double mean[3];
    whit_image_info info;
    (void)one;
    whit_image_get_info(drawing->color, &info);
    size_t finite = drawing_find_color(drawing, COLOR_MEAN, mean);
    value->numbers[0] = (double)((size_t)info.width * info.height - finite);
    return WHIT_OK;
}

static whit_result read_colors(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    drawing_find_color(drawing, expect_fields[one->field].color, value->numbers);
    return WHIT_OK;
}

static whit_result read_hits(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    (void)one;
    value->numbers[0] = (double)drawing_count_hits(drawing);
    return WHIT_OK;
}

/* ---- Rays ---- */

static whit_result read_count(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    const char *stats = (const char *)&drawing->stats;
    value->numbers[0] = (double)*(const uint64_t *)(stats + expect_fields[one->field].stat);
    return WHIT_OK;
}

static whit_result read_all_rays(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    const whit_stats *stats = &drawing->stats;
    (void)one;
    value->numbers[0] = (double)(stats->rays_primary + stats->rays_shadow + stats->rays_reflected +
                                 stats->rays_refracted + stats->rays_straight);
    return WHIT_OK;
}

/* Whether a device drew the picture; else prints an error, and the case counts as one that cannot
   be drawn. */
static bool by_device(drawing_t *drawing, expectation_t *one)
{
    if (drawing->reference)
        cli_error("line %u expects %s, of which the reference knows nothing", one->line, one->text);
    return !drawing->reference;
}

static whit_result read_max_stack(drawing_t *drawing, expectation_t *one,
                                  struct expect_value *value)
{
    if (!by_device(drawing, one))
        return WHIT_ERROR_USAGE;
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        value->numbers[0] = fmax(value->numbers[0], (double)drawing->stats.costs[kind].stack);
    return WHIT_OK;
}

static whit_result read_leaks(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    const whit_renderer_params *picture = &drawing->params;
    const whit_hard_view_params params = {.width = picture->width,
                                          .height = picture->height,
                                          .camera = picture->camera,
                                          .time_s = picture->time_s,
                                          .portable = picture->portable,
                                          .numerics = picture->numerics,
                                          .instances = drawing->job.settings.trees.instances};
    uint64_t wrong = 0, other = 0;
    whit_image *image = NULL;
    if (!by_device(drawing, one))
        return WHIT_ERROR_USAGE;
    whit_result result = whit_hard_view(drawing->job.device, drawing->job.scene, &params, &cli_log,
                                        &wrong, &other, &image);
    whit_image_destroy(image);
    value->numbers[0] = (double)wrong;
    return result;
}

/* ---- Of a pixel ---- */

static size_t pixel_of(drawing_t *drawing, expectation_t *one)
{
    whit_image_info info;
    whit_image_get_info(drawing->ids, &info);
    return (size_t)one->y * info.width + one->x;
}

static whit_result read_pixel(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    drawing_color_at(drawing, pixel_of(drawing, one), value->numbers);
    return WHIT_OK;
}

static const uint32_t *ids_of(drawing_t *drawing, expectation_t *one)
{
    return whit_image_words(drawing->ids) + 2 * pixel_of(drawing, one);
}

static whit_result read_instance(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    uint32_t instance = ids_of(drawing, one)[0];
    whit_instance_info info = {.name = NULL};
    if (instance != WHIT_NONE)
        whit_scene_get_instance(drawing->job.scene, instance, &info);
    value->word = instance == WHIT_INSTANCE_SHAPE ? "intersect()" : info.name;
    return WHIT_OK;
}

static whit_result read_primitive(drawing_t *drawing, expectation_t *one,
                                  struct expect_value *value)
{
    uint32_t primitive = ids_of(drawing, one)[1];
    value->numbers[0] = (double)primitive;
    return primitive == WHIT_NONE ? WHIT_ERROR_FAILED : WHIT_OK;
}

static whit_result read_t(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    whit_probe_ray ray;
    whit_result result = drawing_probe(drawing, one->x, one->y, &ray);
    value->numbers[0] = ray.device.t;
    return result == WHIT_OK && !isfinite(ray.device.t) ? WHIT_ERROR_FAILED : result;
}

static whit_result read_material(drawing_t *drawing, expectation_t *one, struct expect_value *value)
{
    whit_probe_ray ray;
    whit_material_info info = {.name = NULL};
    whit_result result = drawing_probe(drawing, one->x, one->y, &ray);
    if (result == WHIT_OK && ray.material != WHIT_NONE)
        whit_scene_get_material(drawing->job.scene, ray.material, &info);
    value->word = info.name;
    return result;
}

const struct expect_field expect_fields[] = {
    {"nonfinite", EXPECT_NUMBER, .read = read_nonfinite},
    {"hits", EXPECT_NUMBER, .read = read_hits},
    {"leaks", EXPECT_NUMBER, .read = read_leaks},
    {"rays", EXPECT_NUMBER, .read = read_all_rays},
    {"rays.primary", EXPECT_NUMBER, .read = read_count, .stat = offsetof(whit_stats, rays_primary)},
    {"rays.shadow", EXPECT_NUMBER, .read = read_count, .stat = offsetof(whit_stats, rays_shadow)},
    {"rays.reflected", EXPECT_NUMBER, .read = read_count,
     .stat = offsetof(whit_stats, rays_reflected)},
    {"rays.refracted", EXPECT_NUMBER, .read = read_count,
     .stat = offsetof(whit_stats, rays_refracted)},
    {"rays.cut_by_depth", EXPECT_NUMBER, .read = read_count,
     .stat = offsetof(whit_stats, rays_cut_depth)},
    {"rays.cut_by_bailout", EXPECT_NUMBER, .read = read_count,
     .stat = offsetof(whit_stats, rays_cut_bailout)},
    {"max_stack", EXPECT_NUMBER, .counts = true, .read = read_max_stack},
    {"mean", EXPECT_COLOR, .read = read_colors, .color = COLOR_MEAN},
    {"min", EXPECT_COLOR, .floats = true, .read = read_colors, .color = COLOR_MIN},
    {"max", EXPECT_COLOR, .floats = true, .read = read_colors, .color = COLOR_MAX},
    {"pixel", EXPECT_COLOR, .of_pixel = true, .floats = true, .read = read_pixel},
    {"pixel.instance", EXPECT_NAME, .of_pixel = true, .read = read_instance},
    {"pixel.primitive", EXPECT_NUMBER, .of_pixel = true, .read = read_primitive},
    {"pixel.material", EXPECT_NAME, .of_pixel = true, .read = read_material},
    {"pixel.t", EXPECT_NUMBER, .of_pixel = true, .read = read_t},
    {0},
};

/* ---- Comparing ---- */

static bool holds(enum expect_op op, double a, double b, double tolerance)
{
    switch (op) {
    case EXPECT_EQUAL:
        return a == b;
    case EXPECT_OTHER:
        return a != b;
    case EXPECT_AT_MOST:
        return a <= b;
    case EXPECT_AT_LEAST:
        return a >= b;
    case EXPECT_BELOW:
        return a < b;
    case EXPECT_ABOVE:
        return a > b;
    default:
        return fabs(a - b) <= tolerance;
    }
}

/* The number of channel `i` that a field's value is compared with. */
static double number_of(expectation_t *one, uint32_t i)
{
    double number = one->numbers[one->count == 3 ? i : 0];
    bool rounds = expect_fields[one->field].floats && one->op != EXPECT_WITHIN;
    return rounds && fabs(number) <= (double)FLT_MAX ? (double)(float)number : number;
}

/* All channels of a colour must hold; for != one channel is enough. */
static bool compare_numbers(expectation_t *one, const struct expect_value *value)
{
    uint32_t count = expect_fields[one->field].kind == EXPECT_COLOR ? 3 : 1, held = 0;
    for (uint32_t i = 0; i < count; ++i)
        held += holds(one->op, value->numbers[i], number_of(one, i), one->tolerance);
    return one->op == EXPECT_OTHER ? held > 0 : held == count;
}

static bool compare_words(expectation_t *one, const struct expect_value *value)
{
    bool same =
        one->word && value->word ? strcmp(one->word, value->word) == 0 : !one->word && !value->word;
    return same == (one->op == EXPECT_EQUAL);
}

/* A text that is equal to the value where an expectation has it. */
static char *value_text(const struct expect_field *field, const struct expect_value *value)
{
    char texts[3][32];
    for (int i = 0; i < 3; ++i) {
        snprintf(texts[i], sizeof texts[i], "%.9g", value->numbers[i]);
        if (!field->floats && strtod(texts[i], NULL) != value->numbers[i])
            setting_write_number(value->numbers[i], texts[i], sizeof texts[i]);
    }
    if (field->kind == EXPECT_COLOR)
        return string_format("%s %s %s", texts[0], texts[1], texts[2]);
    if (field->kind == EXPECT_NUMBER)
        return string_copy(texts[0]);
    return value->word ? string_format("\"%s\"", value->word) : string_copy("none");
}

whit_result expectation_check(const struct check_expectation *one, const struct drawing *drawing,
                              char **is)
{
    const struct expect_field *field = &expect_fields[one->field];
    struct expect_value value = {.word = NULL};
    *is = NULL;
    whit_result result = field->read(drawing, one, &value);
    if (result != WHIT_OK && result != WHIT_ERROR_FAILED)
        return result;
    *is = result == WHIT_OK ? value_text(field, &value) : string_copy("none");
    if (!*is)
        return WHIT_ERROR_MEMORY;
    bool held = field->kind == EXPECT_NAME ? compare_words(one, &value)
                                           : result == WHIT_OK && compare_numbers(one, &value);
    return held ? WHIT_OK : WHIT_ERROR_FAILED;
}
