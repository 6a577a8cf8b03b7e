/* Compares FLIP with a second implementation in this file, in double and without separable filters;
   with figures of a program in Python; with a published figure of OpenImageIO; and, for pictures of
   one colour, with distances computed by hand. */
#include "image_fixture.h"

#include "image/flip.h"

static const double PI = 3.14159265358979323846;

static void put(struct image *image, uint32_t x, uint32_t y, const uint8_t codes[3])
{
    for (int c = 0; c < 3; ++c)
        image->pixels[3 * ((size_t)y * image->width + x) + (size_t)c] =
            image_linear_from_srgb((float)codes[c] / 255.0f);
}

static struct image image_of_one(uint32_t width, uint32_t height, const uint8_t codes[3])
{
    struct image image = fixture_flat(width, height, 3, 0.0f);
    for (uint32_t i = 0; i < width * height; ++i)
        put(&image, i % width, i / width, codes);
    return image;
}

/* The mean FLIP; `map`: receives the map, or NULL. */
static double flip_of(const struct image *a, const struct image *b, double pixels_per_degree,
                      struct image *map)
{
    struct image kept;
    struct flip_summary summary;
    assert_int_equal(image_flip(a, b, pixels_per_degree, &kept, &summary), WHIT_OK);
    double sum = 0.0, largest = 0.0;
    for (uint32_t i = 0; i < kept.width * kept.height; ++i) {
        assert_true(kept.pixels[i] >= 0.0f && kept.pixels[i] <= 1.0f);
        sum += (double)kept.pixels[i];
        largest = fmax(largest, (double)kept.pixels[i]);
    }
    assert_true(fabs(summary.mean - sum / (kept.width * kept.height)) < 1e-9);
    assert_true(summary.largest == largest);
    if (map)
        *map = kept;
    else
        image_finish(&kept);
    return summary.mean;
}

/* ---- The second implementation ---- */

/* The fractions are those of the authors' program. */
static const double direct_matrix[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
};

static void direct_xyz(const double rgb[3], double xyz[3])
{
    for (int i = 0; i < 3; ++i) {
        const double *m = direct_matrix[i];
        xyz[i] = (m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2]) / (m[0] + m[1] + m[2]);
    }
}

static void direct_ycc(const double rgb[3], double ycc[3])
{
    double xyz[3];
    direct_xyz(rgb, xyz);
    ycc[0] = 116.0 * xyz[1] - 16.0;
    ycc[1] = 500.0 * (xyz[0] - xyz[1]);
    ycc[2] = 200.0 * (xyz[1] - xyz[2]);
}

static double minor(int row, int column)
{
    const double(*m)[3] = direct_matrix;
    int r = (row + 1) % 3, s = (row + 2) % 3, c = (column + 1) % 3, d = (column + 2) % 3;
    return m[r][c] * m[s][d] - m[r][d] * m[s][c];
}

/* Converts back to RGB by Cramer's rule, clamped. */
static void direct_rgb(const double ycc[3], double rgb[3])
{
    double y = (ycc[0] + 16.0) / 116.0, determinant = 0.0;
    const double relative[3] = {y + ycc[1] / 500.0, y, y - ycc[2] / 200.0};
    for (int c = 0; c < 3; ++c)
        determinant += direct_matrix[0][c] * minor(0, c);
    for (int c = 0; c < 3; ++c) {
        double value = 0.0;
        for (int r = 0; r < 3; ++r) {
            const double *m = direct_matrix[r];
            value += minor(r, c) * relative[r] * (m[0] + m[1] + m[2]);
        }
        rgb[c] = fmin(fmax(value / determinant, 0.0), 1.0);
    }
}

static double direct_root(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0;
}

static double direct_hyab(const double p[3], const double q[3])
{
    double lab[2][3];
    for (int i = 0; i < 2; ++i) {
        double xyz[3];
        direct_xyz(i ? q : p, xyz);
        lab[i][0] = 116.0 * direct_root(xyz[1]) - 16.0;
        lab[i][1] = 5.0 * lab[i][0] * (direct_root(xyz[0]) - direct_root(xyz[1]));
        lab[i][2] = 2.0 * lab[i][0] * (direct_root(xyz[1]) - direct_root(xyz[2]));
    }
    return fabs(lab[0][0] - lab[1][0]) + hypot(lab[0][1] - lab[1][1], lab[0][2] - lab[1][2]);
}

/* FLIP for a HyAB distance where no feature differs, by hand. */
static double direct_color(double hyab)
{
    const double green[3] = {0.0, 1.0, 0.0}, blue[3] = {0.0, 0.0, 1.0};
    double max = pow(direct_hyab(green, blue), 0.7), value = pow(hyab, 0.7);
    return value < 0.4 * max ? 0.95 * value / (0.4 * max)
                             : 0.95 + 0.05 * (value - 0.4 * max) / (0.6 * max);
}

enum kind { KIND_A, KIND_RG, KIND_BY, KIND_EDGE, KIND_POINT, KIND_COUNT };

/* A filter's weight at offset (x, y) in pixels, before scaling. */
static double direct_weight(enum kind kind, double ppd, int x, int y)
{
    double z = (x * x + y * y) / (ppd * ppd), deviation = 0.5 * 0.082 * ppd;
    double g = exp(-(x * x + y * y) / (2.0 * deviation * deviation));
    switch (kind) {
    case KIND_A:
        return exp(-PI * PI * z / 0.0047);
    case KIND_RG:
        return exp(-PI * PI * z / 0.0053);
    case KIND_BY:
        return 34.1 * sqrt(PI / 0.04) * exp(-PI * PI * z / 0.04) +
               13.5 * sqrt(PI / 0.025) * exp(-PI * PI * z / 0.025);
    case KIND_EDGE:
        return -x * g;
    default:
        return (x * x / (deviation * deviation) - 1.0) * g;
    }
}

struct direct {
    const struct image *image;
    double *ycc; /* of each pixel */
    double ppd;
};

/* Filters one pixel: of a colour channel of ycc, or for features of Y relative to white. `turned`:
   the filter along y. */
static double direct_filter(const struct direct *d, enum kind kind, bool turned, int px, int py)
{
    bool feature = kind >= KIND_EDGE;
    int radius = (int)ceil(3.0 * d->ppd * (feature ? 0.041 : sqrt(0.04 / (2.0 * PI * PI))));
    int width = (int)d->image->width, height = (int)d->image->height;
    double sums[2] = {0.0, 0.0}, weights[2] = {0.0, 0.0};
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) {
            double w = direct_weight(kind, d->ppd, turned ? y : x, turned ? x : y);
            int sx = px + x < 0 ? 0 : px + x >= width ? width - 1 : px + x;
            int sy = py + y < 0 ? 0 : py + y >= height ? height - 1 : py + y;
            const double *ycc = d->ycc + 3 * (sy * width + sx);
            double value = feature ? (ycc[0] + 16.0) / 116.0 : ycc[kind];
            sums[w < 0.0] += w * value;
            weights[w < 0.0] += fabs(w);
        }
    }
    return sums[0] / weights[0] + (weights[1] > 0.0 ? sums[1] / weights[1] : 0.0);
}

static double direct_feature(const struct direct *d, enum kind kind, int x, int y)
{
    return hypot(direct_filter(d, kind, false, x, y), direct_filter(d, kind, true, x, y));
}

static double direct_flip(const struct direct sides[2], int x, int y)
{
    double rgb[2][3], features = 0.0;
    for (int i = 0; i < 2; ++i) {
        double ycc[3];
        for (int c = 0; c < 3; ++c)
            ycc[c] = direct_filter(&sides[i], (enum kind)c, false, x, y);
        direct_rgb(ycc, rgb[i]);
    }
    for (enum kind kind = KIND_EDGE; kind <= KIND_POINT; ++kind)
        features = fmax(features, fabs(direct_feature(&sides[0], kind, x, y) -
                                       direct_feature(&sides[1], kind, x, y)));
    return pow(direct_color(direct_hyab(rgb[0], rgb[1])), 1.0 - sqrt(features / sqrt(2.0)));
}

static struct direct direct_of(const struct image *image, double ppd)
{
    struct direct direct = {.image = image, .ppd = ppd};
    size_t count = (size_t)image->width * image->height;
    direct.ycc = array_alloc(3 * count, sizeof(double));
    assert_non_null(direct.ycc);
    for (size_t i = 0; i < count; ++i) {
        double rgb[3];
        for (int c = 0; c < 3; ++c)
            rgb[c] = (double)image->pixels[3 * i + (size_t)c];
        direct_ycc(rgb, direct.ycc + 3 * i);
    }
    return direct;
}

/* ---- Checks ---- */

/* Two pictures with gradients, steps and a line of single pixels, which differ in colours and
   features. */
static struct image pair[2];

static int make_pair(void **state)
{
    (void)state;
    enum { WIDTH = 24, HEIGHT = 18 };
    static const uint8_t white[3] = {255, 255, 255};
    pair[0] = fixture_flat(WIDTH, HEIGHT, 3, 0.0f);
    pair[1] = fixture_flat(WIDTH, HEIGHT, 3, 0.0f);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
        uint32_t x = i % WIDTH, y = i / WIDTH;
        uint8_t codes[3] = {(uint8_t)(7 * x + 3 * y), (uint8_t)(x * x + 5 * y),
                            (uint8_t)(11 * y + x * y)};
        put(&pair[0], x, y, codes);
        if ((x / 6 + y / 5) % 3 == 0) {
            codes[0] = (uint8_t)(codes[0] > 215 ? 255 : codes[0] + 40);
            codes[2] = (uint8_t)(codes[2] < 25 ? 0 : codes[2] - 25);
        }
        put(&pair[1], x, y, x == WIDTH / 2 ? white : codes);
    }
    return 0;
}

static int finish_pair(void **state)
{
    (void)state;
    image_finish(&pair[0]);
    image_finish(&pair[1]);
    return 0;
}

TEST(every_pixel_is_that_of_direct_sums)
{
    static const double resolutions[] = {FLIP_PIXELS_PER_DEGREE, 25.0};
    for (int r = 0; r < 2; ++r) {
        struct direct sides[2] = {direct_of(&pair[0], resolutions[r]),
                                  direct_of(&pair[1], resolutions[r])};
        double max = 0.0;
        own_image map = {0};
        flip_of(&pair[0], &pair[1], resolutions[r], &map);
        for (uint32_t i = 0; i < map.width * map.height; ++i) {
            double expected = direct_flip(sides, (int)(i % map.width), (int)(i / map.width));
            max = fmax(max, fabs(expected - (double)map.pixels[i]));
        }
        print_message("%.2f pixels a degree: off by %.2g at most\n", resolutions[r], max);
        assert_true(max < 2e-5);
        free(sides[0].ycc);
        free(sides[1].ycc);
    }
}

/* Means and largest values are from a program in Python, with direct sums in doubles. */
TEST(means_are_those_of_another_program)
{
    static const struct {
        double resolution, mean, largest;
    } known[] = {{0.0, 0.2818399, 0.8323297}, {25.0, 0.2422116, 0.9854911}};
    for (int i = 0; i < 2; ++i) {
        struct flip_summary summary;
        own_image map = {0};
        assert_int_equal(image_flip(&pair[0], &pair[1], known[i].resolution, &map, &summary),
                         WHIT_OK);
        assert_true(fabs(summary.mean - known[i].mean) < 2e-6);
        assert_true(fabs(summary.largest - known[i].largest) < 2e-5);
    }
}

static double flip_of_colors(const uint8_t p[3], const uint8_t q[3])
{
    own_image a = image_of_one(9, 7, p), b = image_of_one(9, 7, q), map = {0};
    double mean = flip_of(&a, &b, 0.0, &map);
    for (int i = 0; i < 63; ++i) /* also at the borders: filters add up to 1 there too */
        assert_true(fabs((double)map.pixels[i] - mean) < 1e-4);
    return mean;
}

TEST(one_colour_is_as_by_hand)
{
    static const uint8_t colors[][3] = {{0, 0, 0},   {255, 255, 255}, {255, 0, 0},     {0, 255, 0},
                                        {0, 0, 255}, {128, 128, 128}, {136, 128, 120}, {3, 2, 1}};
    enum { COUNT = sizeof colors / sizeof colors[0] };
    double max = 0.0;
    for (int i = 0; i < COUNT; ++i) {
        for (int j = 0; j < COUNT; ++j) {
            double p[3], q[3];
            for (int c = 0; c < 3; ++c) {
                p[c] = (double)image_linear_from_srgb((float)colors[i][c] / 255.0f);
                q[c] = (double)image_linear_from_srgb((float)colors[j][c] / 255.0f);
            }
            double expected = direct_color(direct_hyab(p, q));
            max = fmax(max, fabs(flip_of_colors(colors[i], colors[j]) - expected));
        }
    }
    /* Filters for features give 1e-7 for flat pictures; FLIP takes the root of that. */
    print_message("%d pairs: off by %.2g at most\n", COUNT * COUNT, max);
    assert_true(max < 1e-4);
    /* L* of black and white are 0 and 100, without colour: only the largest distance comes in. */
    max = pow(203.3016546, 0.7); /* of green and blue */
    double white = 0.95 + 0.05 * (pow(100.0, 0.7) - 0.4 * max) / (0.6 * max);
    assert_true(fabs(flip_of_colors(colors[0], colors[1]) - white) < 2e-5);
    assert_true(fabs(flip_of_colors(colors[3], colors[4]) - 1.0) < 1e-6);
}

/* OpenImageIO's testsuite/flip (commit 66c3c5e, ref/out.txt) has an implementation of its own: for
   64 x 64 pixels of 0.1 and of 0.9, linear half floats, mean and largest are 0.9514. */
TEST(grey_pair_is_as_published)
{
    own_image a = fixture_flat(64, 64, 3, 0.099975586f);
    own_image b = fixture_flat(64, 64, 3, 0.89990234f), map = {0};
    struct flip_summary summary;
    assert_int_equal(image_flip(&a, &b, 0.0, &map, &summary), WHIT_OK);
    print_message("mean %.6f, largest %.6f; published: 0.9514\n", summary.mean, summary.largest);
    assert_true(fabs(summary.mean - 0.9514) <= 0.5e-4);
    assert_true(fabs(summary.largest - 0.9514) <= 0.5e-4);
}

TEST(equal_is_exactly_none)
{
    assert_true(flip_of(&pair[0], &pair[0], 0.0, NULL) == 0.0);
    assert_true(flip_of(&pair[0], &pair[1], 0.0, NULL) > 0.1);
}

TEST(swapping_changes_nothing)
{
    own_image there = {0}, back = {0};
    flip_of(&pair[0], &pair[1], 0.0, &there);
    flip_of(&pair[1], &pair[0], 0.0, &back);
    assert_images_equal(&there, &back);
}

static struct image noisy(const struct image *image, float amplitude)
{
    struct image out = fixture_flat(image->width, image->height, 3, 0.0f);
    uint64_t seed = 99;
    for (size_t i = 0; i < 3 * (size_t)image->width * image->height; ++i) {
        float noise = random_float(&seed) - 0.5f;
        out.pixels[i] = image->pixels[i] + amplitude * noise;
    }
    return out;
}

/* More noise gives a larger difference; seen from farther away the same noise gives a smaller
   one. */
TEST(noise_counts_by_its_size)
{
    static const uint8_t grey[3] = {150, 150, 150};
    own_image a = image_of_one(40, 30, grey);
    double before = 0.0;
    for (float amplitude = 0.01f; amplitude < 0.5f; amplitude *= 1.5f) {
        own_image b = noisy(&a, amplitude);
        double mean = flip_of(&a, &b, 0.0, NULL);
        assert_true(mean > before * 1.05);
        before = mean;
        assert_true(flip_of(&a, &b, 134.0, NULL) < mean);
        assert_true(flip_of(&a, &b, 20.0, NULL) > mean);
    }
}

/* Values that a PNG clamps make no difference; non-finite pixels count as magenta. */
TEST(pictures_are_taken_as_shown)
{
    static const uint8_t white[3] = {255, 255, 255}, magenta[3] = {255, 0, 255};
    own_image a = image_of_one(12, 10, white), b = image_of_one(12, 10, white);
    own_image before = {0}, after = {0};
    for (int i = 0; i < 60; ++i)
        b.pixels[i] = 1.0f + (float)i;
    assert_true(flip_of(&a, &b, 0.0, NULL) == 0.0);
    b.pixels[3 * 61] = INFINITY;
    b.pixels[3 * 71 + 2] = NAN;
    flip_of(&a, &b, 0.0, &before);
    put(&b, 1, 5, magenta);
    put(&b, 11, 5, magenta);
    flip_of(&a, &b, 0.0, &after);
    assert_images_equal(&before, &after);
    assert_true(before.pixels[61] > 0.3f);
}

TEST(other_pictures_are_refused)
{
    own_image a = fixture_floats(4, 3, 3), b = fixture_floats(3, 4, 3);
    own_image ids = fixture_words(4, 3, 1);
    own_image map = {0};
    struct flip_summary summary;
    assert_int_equal(image_flip(&a, &b, 0.0, &map, &summary), WHIT_ERROR_USAGE);
    assert_int_equal(image_flip(&ids, &ids, 0.0, &map, &summary), WHIT_ERROR_USAGE);
    static const double resolutions[] = {-1.0, 0.5, 1001.0, INFINITY, NAN};
    for (int i = 0; i < 5; ++i)
        assert_int_equal(image_flip(&a, &a, resolutions[i], &map, &summary), WHIT_ERROR_USAGE);
    assert_null(map.pixels);
    assert_int_equal(image_flip(&a, &a, 1000.0, &map, &summary), WHIT_OK);
}

TESTS_IN(make_pair, finish_pair)
