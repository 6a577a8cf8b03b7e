#include "image/flip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/vec.h"
#include "image/compare.h"

/* ---- Colours ---- */

/* Linear sRGB to XYZ and back, where X, Y and Z are divided by those of white (0.950428545, 1,
   1.088900371 in the authors' program). */
static const float xyz_from_rgb[3][3] = {
    {0.433895389f, 0.376242373f, 0.189862239f},
    {0.212636822f, 0.715182982f, 0.072180196f},
    {0.017752423f, 0.109465629f, 0.872781948f},
};
static const float rgb_from_xyz[3][3] = {
    {3.080341988f, -1.537398969f, -0.542943019f},
    {-0.921178396f, 1.875929984f, 0.045248412f},
    {0.052881293f, -0.204011206f, 1.151129913f},
};

static void multiply(const float matrix[3][3], const float from[3], float to[3])
{
    for (int i = 0; i < 3; ++i)
        to[i] = matrix[i][0] * from[0] + matrix[i][1] * from[1] + matrix[i][2] * from[2];
}

/* The paper's YCxCz without its factors and offset. Filters with a sum of weights of 1 commute with
   these, so they can be left out. */
static void opponent_from_rgb(const float rgb[3], float opponent[3])
{
    float xyz[3];
    multiply(xyz_from_rgb, rgb, xyz);
    opponent[0] = xyz[1];
    opponent[1] = xyz[0] - xyz[1];
    opponent[2] = xyz[1] - xyz[2];
}

static float clamped(float value)
{
    return value > 0.0f ? fminf(value, 1.0f) : 0.0f;
}

static void rgb_from_opponent(const float opponent[3], float rgb[3])
{
    const float xyz[3] = {opponent[0] + opponent[1], opponent[0], opponent[0] - opponent[2]};
    multiply(rgb_from_xyz, xyz, rgb);
    for (int c = 0; c < 3; ++c)
        rgb[c] = clamped(rgb[c]);
}

/* The function f of CIE 15 for L*a*b*: a cube root, linear near black. */
static float lightness_root(float value)
{
    const float delta = 6.0f / 29.0f;
    return value > delta * delta * delta ? cbrtf(value)
                                         : value / (3.0f * delta * delta) + 4.0f / 29.0f;
}

/* L*a*b* with a* and b* reduced in dark colours: the Hunt effect. */
static void hunt_from_rgb(const float rgb[3], float hunt[3])
{
    float xyz[3];
    multiply(xyz_from_rgb, rgb, xyz);
    for (int i = 0; i < 3; ++i)
        xyz[i] = lightness_root(xyz[i]);
    hunt[0] = 116.0f * xyz[1] - 16.0f;
    hunt[1] = 0.01f * hunt[0] * 500.0f * (xyz[0] - xyz[1]);
    hunt[2] = 0.01f * hunt[0] * 200.0f * (xyz[1] - xyz[2]);
}

/* The HyAB distance (Abasi, Tehran and Fairchild 2019) to the power of 0.7. */
static float color_distance(const float a[3], const float b[3])
{
    float da = a[1] - b[1], db = a[2] - b[2];
    return powf(fabsf(a[0] - b[0]) + sqrtf(da * da + db * db), 0.7f);
}

static float largest_distance(void)
{
    static const float green[3] = {0.0f, 1.0f, 0.0f}, blue[3] = {0.0f, 0.0f, 1.0f};
    float a[3], b[3];
    hunt_from_rgb(green, a);
    hunt_from_rgb(blue, b);
    return color_distance(a, b);
}

/* Maps distances to 0..1, piecewise linear: those up to 0.4 of the largest get 0..0.95. */
static float remap(float distance, float largest)
{
    const float bend = 0.4f * largest, bent = 0.95f;
    if (distance < bend)
        return distance * bent / bend;
    return bent + (distance - bend) / (largest - bend) * (1.0f - bent);
}

/* ---- Filters ---- */

enum { RADIUS_MAX = 144 };
struct kernel {
    int radius;
    float weights[2 * RADIUS_MAX + 1];
};

/* Contrast sensitivity in space, a sum of Gaussians a sqrt(pi/b) exp(-pi^2 x^2 / b), x in degrees.
 */
struct gaussian {
    double a, b;
};
static const struct gaussian lightness = {1.0, 0.0047}, red_green = {1.0, 0.0053},
                             blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
static const double WIDEST_B = 0.04, FEATURE_DEGREES = 0.082;

/* Radius in pixels of all sensitivity filters: three standard deviations of the widest Gaussian. */
static int sensitivity_radius(double pixels_per_degree)
{
    return (int)ceil(3.0 * sqrt(WIDEST_B / (2.0 * PI * PI)) * pixels_per_degree);
}

/* Makes one dimension of a Gaussian, scaled to sum 1; gives the sum before scaling. */
static double gaussian_init(struct kernel *kernel, double b, double pixels_per_degree)
{
    double sum = 0.0;
    kernel->radius = sensitivity_radius(pixels_per_degree);
    for (int pass = 0; pass < 2; ++pass) {
        double scale = pass ? 1.0 / sum : 0.0;
        for (int i = -kernel->radius; i <= kernel->radius; ++i) {
            double x = i / pixels_per_degree, weight = exp(-PI * PI * x * x / b);
            sum += pass ? 0.0 : weight;
            kernel->weights[i + kernel->radius] = (float)(weight * scale);
        }
    }
    return sum;
}

/* Makes one dimension of a feature detector: a Gaussian's derivative of `order` (0: the Gaussian).
   Positive weights are scaled to sum 1, negative ones to sum -1. */
static void feature_init(struct kernel *kernel, int order, double pixels_per_degree)
{
    double deviation = 0.5 * FEATURE_DEGREES * pixels_per_degree, above = 0.0, below = 0.0;
    kernel->radius = (int)ceil(3.0 * deviation);
    for (int pass = 0; pass < 2; ++pass) {
        for (int i = -kernel->radius; i <= kernel->radius; ++i) {
            double x = i / deviation, weight = exp(-0.5 * x * x);
            weight *= order == 0 ? 1.0 : order == 1 ? -x : x * x - 1.0;
            if (pass)
                kernel->weights[i + kernel->radius] = (float)(weight > 0.0  ? weight / above
                                                              : below > 0.0 ? weight / below
                                                                            : 0.0);
            else if (weight > 0.0)
                above += weight;
            else
                below -= weight;
        }
    }
}

struct filters {
    struct kernel lightness, red_green, blue_yellow[2];
    float blue_yellow_shares[2];
    struct kernel features[3]; /* by order */
};

static void filters_init(struct filters *filters, double pixels_per_degree)
{
    double parts[2];
    gaussian_init(&filters->lightness, lightness.b, pixels_per_degree);
    gaussian_init(&filters->red_green, red_green.b, pixels_per_degree);
    for (int i = 0; i < 2; ++i) {
        const struct gaussian *g = &blue_yellow[i];
        double sum = gaussian_init(&filters->blue_yellow[i], g->b, pixels_per_degree);
        parts[i] = g->a * sqrt(PI / g->b) * sum * sum;
    }
    for (int i = 0; i < 2; ++i)
        filters->blue_yellow_shares[i] = (float)(parts[i] / (parts[0] + parts[1]));
    for (int order = 0; order < 3; ++order)
        feature_init(&filters->features[order], order, pixels_per_degree);
}

/* ---- Planes ---- */

/* Indices of planes: three colour channels first, then the strengths of edges and of points. */
enum { EDGES = 3, POINTS, PLANES };
struct work {
    uint32_t width, height;
    size_t count;
    float *memory;
    float *planes[2][PLANES], *rows, *sum; /* the last two are scratch */
    float *padded;                         /* one row with its ends repeated */
    struct filters filters;
};

static whit_result work_init(struct work *work, const struct image *image, double pixels_per_degree)
{
    *work = (struct work){.width = image->width, .height = image->height};
    work->count = (size_t)image->width * image->height;
    work->memory = array_alloc(work->count, (2 * PLANES + 2) * sizeof(float));
    work->padded = array_alloc((size_t)image->width + 2 * RADIUS_MAX, sizeof(float));
    if (!work->memory || !work->padded)
        return WHIT_ERROR_MEMORY;
    for (int i = 0; i < 2 * PLANES; ++i)
        work->planes[i / PLANES][i % PLANES] = work->memory + (size_t)i * work->count;
    work->rows = work->memory + 2 * PLANES * work->count;
    work->sum = work->rows + work->count;
    filters_init(&work->filters, pixels_per_degree);
    return WHIT_OK;
}

static void work_finish(struct work *work)
{
    free(work->memory);
    free(work->padded);
}

static void add_weighted(float *restrict to, const float *restrict from, float weight,
                         uint32_t count)
{
    for (uint32_t x = 0; x < count; ++x)
        to[x] += weight * from[x];
}

/* Filters all rows into work->rows. Beyond its borders a picture repeats its last pixel. */
static void filter_rows(const struct work *work, const struct kernel *kernel, const float *from)
{
    size_t radius = (size_t)kernel->radius, width = work->width;
    memset(work->rows, 0, work->count * sizeof(float));
    for (uint32_t y = 0; y < work->height; ++y) {
        const float *row = from + y * width;
        for (size_t i = 0; i < radius; ++i) {
            work->padded[i] = row[0];
            work->padded[radius + width + i] = row[width - 1];
        }
        memcpy(work->padded + radius, row, width * sizeof *row);
        for (size_t i = 0; i <= 2 * radius; ++i)
            add_weighted(work->rows + y * width, work->padded + i, kernel->weights[i], work->width);
    }
}

/* Filters the columns of work->rows, and adds the result times `share` to `to`. */
static void add_columns(const struct work *work, const struct kernel *kernel, float share,
                        float *to)
{
    int64_t last = (int64_t)work->height - 1;
    for (int64_t y = 0; y <= last; ++y) {
        for (int i = -kernel->radius; i <= kernel->radius; ++i) {
            int64_t row = y + i < 0 ? 0 : y + i > last ? last : y + i;
            add_weighted(to + (size_t)y * work->width, work->rows + (size_t)row * work->width,
                         share * kernel->weights[i + kernel->radius], work->width);
        }
    }
}

static void filter(const struct work *work, const struct kernel *across, const struct kernel *down,
                   const float *from, float *to)
{
    filter_rows(work, across, from);
    memset(to, 0, work->count * sizeof *to);
    add_columns(work, down, 1.0f, to);
}

/* Filters the blue-yellow plane with a sum of two Gaussians, of which only the sum has weight 1. */
static void filter_blue_yellow(const struct work *work, float *plane)
{
    const struct filters *filters = &work->filters;
    memset(work->sum, 0, work->count * sizeof(float));
    for (int i = 0; i < 2; ++i) {
        filter_rows(work, &filters->blue_yellow[i], plane);
        add_columns(work, &filters->blue_yellow[i], filters->blue_yellow_shares[i], work->sum);
    }
    memcpy(plane, work->sum, work->count * sizeof *plane);
}

/* The strength of edges (order 1) or points (order 2), whatever their direction. */
static void find_features(const struct work *work, int order, const float *from, float *to)
{
    const struct kernel *smooth = &work->filters.features[0],
                        *detector = &work->filters.features[order];
    filter(work, detector, smooth, from, work->sum);
    filter(work, smooth, detector, from, to);
    for (size_t i = 0; i < work->count; ++i)
        to[i] = sqrtf(to[i] * to[i] + work->sum[i] * work->sum[i]);
}

/* A pixel's linear colour as image_save shows it in a PNG, without rounding to 8 bits. */
static void shown_rgb(const struct image *image, size_t index, float rgb[3])
{
    float pixel[4];
    image_displayed_pixel(image, index, pixel);
    bool finite = isfinite(pixel[0]) && isfinite(pixel[1]) && isfinite(pixel[2]);
    for (int c = 0; c < 3; ++c)
        rgb[c] = finite ? clamped(pixel[c]) : c == 1 ? 0.0f : 1.0f;
}

static void analyse(const struct work *work, const struct image *image, float *planes[PLANES])
{
    for (size_t i = 0; i < work->count; ++i) {
        float rgb[3], opponent[3];
        shown_rgb(image, i, rgb);
        opponent_from_rgb(rgb, opponent);
        for (int c = 0; c < 3; ++c)
            planes[c][i] = opponent[c];
    }
    find_features(work, 1, planes[0], planes[EDGES]);
    find_features(work, 2, planes[0], planes[POINTS]);
    filter(work, &work->filters.lightness, &work->filters.lightness, planes[0], planes[0]);
    filter(work, &work->filters.red_green, &work->filters.red_green, planes[1], planes[1]);
    filter_blue_yellow(work, planes[2]);
    for (size_t i = 0; i < work->count; ++i) {
        const float opponent[3] = {planes[0][i], planes[1][i], planes[2][i]};
        float rgb[3], hunt[3];
        rgb_from_opponent(opponent, rgb);
        hunt_from_rgb(rgb, hunt);
        for (int c = 0; c < 3; ++c)
            planes[c][i] = hunt[c];
    }
}

/* FLIP of a pixel: the difference of colours, amplified by that of features. */
static float combine(const struct work *work, size_t i, float largest)
{
    float *const *a = work->planes[0], *const *b = work->planes[1];
    const float color_a[3] = {a[0][i], a[1][i], a[2][i]}, color_b[3] = {b[0][i], b[1][i], b[2][i]};
    float color = remap(color_distance(color_a, color_b), largest);
    float feature = fmaxf(fabsf(a[EDGES][i] - b[EDGES][i]), fabsf(a[POINTS][i] - b[POINTS][i]));
    if (!(color > 0.0f))
        return 0.0f;
    return powf(color, 1.0f - fminf(sqrtf(feature * 0.70710678f), 1.0f));
}

whit_result image_flip(const struct image *a, const struct image *b, double pixels_per_degree,
                       struct image *map, struct flip_summary *summary)
{
    struct work work = {0};
    *map = (struct image){0};
    *summary = (struct flip_summary){0};
    if (pixels_per_degree == 0.0)
        pixels_per_degree = FLIP_PIXELS_PER_DEGREE;
    if (!a->pixels || !b->pixels || a->width != b->width || a->height != b->height ||
        !(pixels_per_degree >= 1.0 && pixels_per_degree <= FLIP_PIXELS_PER_DEGREE_MAX))
        return WHIT_ERROR_USAGE;
    whit_result result = work_init(&work, a, pixels_per_degree);
    if (result == WHIT_OK)
        result = image_init(map, a->width, a->height, 1, false);
    if (result == WHIT_OK) {
        float largest = largest_distance();
        analyse(&work, a, work.planes[0]);
        analyse(&work, b, work.planes[1]);
        for (size_t i = 0; i < work.count; ++i) {
            map->pixels[i] = combine(&work, i, largest);
            summary->mean += (double)map->pixels[i] / (double)work.count;
            summary->largest = fmax(summary->largest, (double)map->pixels[i]);
        }
    }
    work_finish(&work);
    return result;
}
