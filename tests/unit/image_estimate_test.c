/* The parts of the error estimate, with values by hand. */
#include "image_fixture.h"

#include "image/estimate.h"

enum { WIDTH = 5, HEIGHT = 4, COUNT = WIDTH * HEIGHT };

static struct image image_of(uint32_t channels, float value)
{
    return fixture_flat(WIDTH, HEIGHT, channels, value);
}

static void assert_within(double value, double wanted, double relative)
{
    if (fabs(value - wanted) > relative * fabs(wanted))
        fail_msg("%.9g is not %.9g", value, wanted);
}

static void assert_near(double value, double wanted)
{
    assert_within(value, wanted, 1e-6);
}

/* What estimate.c computes, once more by hand: rates, factors, and edges that were not seen. */
static const double LOW = 0.37, HIGH = 0.7, A_RATE = 1.6, MEDIAN = 0.8, EDGE = 5.0, CORNER = 3.0;

/* Notes a doubling of `samples` whose halves differ by twice `changes` in one channel of each
   pixel. */
static void note(struct estimate *estimate, const float changes[COUNT], uint32_t samples)
{
    own_image a = image_of(4, 0.5f), b = image_of(4, 0.5f);
    const struct image *const halves[2] = {&a, &b};
    for (size_t i = 0; i < COUNT; ++i) {
        b.pixels[4 * i + i % 3] += (i % 2 ? 2.0f : -2.0f) * changes[i];
        b.pixels[4 * i + 3] = 9.0f; /* no colour */
    }
    estimate_note_change(estimate, halves, samples);
}

/* The estimate of each pixel of an even picture without cut rays. */
static void estimate_even(struct estimate *estimate, struct image *out)
{
    own_image picture = image_of(4, 0.5f), cuts = image_of(2, 0.0f);
    double of_cuts;
    estimate_error(estimate, &picture, &cuts, 2.0, out, &of_cuts);
    assert_near(of_cuts, 0.0);
}

TEST(the_worst_channel_counts_and_so_does_the_median_of_pixels_around)
{
    float changes[COUNT];
    own_image out = image_of(1, 0.0f);
    struct estimate estimate;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    for (size_t i = 0; i < COUNT; ++i)
        changes[i] = i < WIDTH ? 0.0f : 0.01f * (float)i; /* an edge below the first row */
    note(&estimate, changes, 1);
    estimate_even(&estimate, &out);
    /* At (2, 0): six pixels without a change, as the row is its own neighbour beyond the border. */
    assert_near((double)out.pixels[2], 0.0);
    /* At (2, 1): three without a change, 0.06 to 0.08 and 0.11 to 0.13; at (0, 2): 0.05, 0.05,
       0.06, 0.1, 0.1, 0.11, 0.15, 0.15, 0.16. */
    assert_near((double)out.pixels[WIDTH + 2], A_RATE * 0.07);
    assert_near((double)out.pixels[2 * WIDTH], A_RATE * 0.1);
    /* Its own change is less than a part of the median: 0.01 in place of 0.12. */
    changes[2 * WIDTH + 2] = 0.01f;
    estimate.doublings = 0;
    note(&estimate, changes, 1);
    estimate_even(&estimate, &out);
    assert_near((double)out.pixels[2 * WIDTH + 2], A_RATE * MEDIAN * 0.11);
    estimate_finish(&estimate);
}

/* Edges in the picture after one doubling to `samples`, where each sample saw the same: estimates
   of pixels that a step of 0.25 separates. */
TEST(an_edge_beside_a_pixel_may_have_been_missed)
{
    float changes[COUNT] = {0};
    own_image picture = image_of(4, 0.5f), cuts = image_of(2, 0.0f), out = image_of(1, 0.0f);
    struct estimate estimate;
    double of_cuts;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    picture.pixels[4 * 3 + 1] = 0.75f;           /* (3, 0) */
    picture.pixels[4 * (WIDTH + 4) + 1] = 0.75f; /* (4, 1): (3, 1) is in the corner of the edge */
    note(&estimate, changes, 8);
    estimate_error(&estimate, &picture, &cuts, 2.0, &out, &of_cuts);
    assert_near((double)out.pixels[2], 0.25 / 16.0);                          /* a strip */
    assert_near((double)out.pixels[WIDTH + 3], 0.25 * (CORNER + 1.0) / 16.0); /* and a corner */
    assert_near((double)out.pixels[WIDTH + 2], 0.0);                          /* at its corner */
    /* A neighbour that has seen the edge leaves no strip, and a pixel that has seen it no more. */
    changes[3] = changes[WIDTH + 4] = (float)(0.2 / (8.0 * EDGE));
    estimate.doublings = 0;
    note(&estimate, changes, 8);
    estimate_error(&estimate, &picture, &cuts, 2.0, &out, &of_cuts);
    assert_within((double)out.pixels[2], (0.25 - 0.2) / 16.0, 1e-4);
    assert_within((double)out.pixels[WIDTH + 3], (0.25 * CORNER + 0.05) / 16.0, 1e-4);
    changes[WIDTH + 3] = (float)(0.15 / (8.0 * EDGE));
    estimate.doublings = 0;
    note(&estimate, changes, 8);
    estimate_error(&estimate, &picture, &cuts, 2.0, &out, &of_cuts);
    assert_within((double)out.pixels[WIDTH + 3], A_RATE * 0.15 / (8.0 * EDGE) + 0.1 * CORNER / 16.0,
                  1e-4);
    estimate_finish(&estimate);
}

/* All pixels change alike, by `rate` from doubling to doubling: the factor of the estimate. */
static double factor_of(double rate, int doublings)
{
    own_image out = image_of(1, 0.0f);
    struct estimate estimate;
    float changes[COUNT];
    double change = 1.0;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    for (int n = 0; n < doublings; ++n) {
        change *= n > 0 ? rate : 1.0;
        for (size_t i = 0; i < COUNT; ++i)
            changes[i] = (float)change;
        note(&estimate, changes, 1u << n);
    }
    estimate_even(&estimate, &out);
    double factor = (double)out.pixels[7] / change;
    estimate_finish(&estimate);
    return factor;
}

/* The root of 1 + (f / rate)^2 + (f / rate)^4 ...: faded changes, in units of the last one. */
static double faded(double fades, double rate, int doublings)
{
    double sum = 0.0;
    for (int n = 0; n < doublings; ++n)
        sum += pow(fades / rate, 2.0 * n);
    return sqrt(sum);
}

TEST(earlier_changes_fade_by_the_rate_of_their_pixel)
{
    static const double rates[] = {0.1, LOW, 0.45, 0.6, HIGH, 0.8};
    const double middle = sqrt(LOW * HIGH);
    for (size_t i = 0; i < sizeof rates / sizeof *rates; ++i) {
        double fades = fmin(fmax(rates[i], LOW), HIGH);
        assert_within(factor_of(rates[i], 5), A_RATE * rates[i] * faded(fades, rates[i], 5), 1e-3);
    }
    assert_within(factor_of(0.5, 2), A_RATE * 0.5 * faded(middle, 0.5, 2), 1e-4);
    /* Changes that grow: a rate of 1. */
    assert_within(factor_of(1.5, 2), A_RATE * faded(middle, 1.5, 2), 1e-4);
    assert_within(factor_of(0.5, ESTIMATE_DOUBLINGS_MAX),
                  A_RATE * 0.5 * faded(0.5, 0.5, ESTIMATE_DOUBLINGS_MAX), 2e-2);
}

TEST(rates_are_those_of_the_pixels_around)
{
    float changes[COUNT] = {0};
    own_image out = image_of(1, 0.0f);
    struct estimate estimate;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    for (int n = 0; n < 5; ++n) {
        changes[0] = (float)pow(0.4, n);
        changes[4] = (float)pow(0.7, n); /* the other corner of the row */
        note(&estimate, changes, 1u << n);
    }
    estimate_even(&estimate, &out);
    double rate = pow((pow(0.4, 4) + pow(0.7, 4)) / 2.0, 0.25);
    assert_within((double)out.pixels[0], A_RATE * rate * pow(0.4, 4) * faded(0.4, 0.4, 5), 1e-4);
    assert_within((double)out.pixels[4], A_RATE * rate * pow(0.7, 4) * faded(0.7, 0.7, 5), 1e-4);
    estimate_finish(&estimate);
}

TEST(cut_rays_carry_twice_the_mean)
{
    float changes[COUNT] = {[0] = 0.4f};
    own_image picture = image_of(4, 0.5f), cuts = image_of(2, 0.0f), out = image_of(1, 0.0f);
    struct estimate estimate;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    note(&estimate, changes, 1);
    cuts.pixels[2 * 19] = 0.25f; /* (4, 3) */
    cuts.pixels[2 * 19 + 1] = 0.5f;
    double of_cuts = 0.0, whole = estimate_error(&estimate, &picture, &cuts, 2.0, &out, &of_cuts);
    double corner = (double)out.pixels[0];
    assert_near((double)out.pixels[19], 3.0);
    assert_near(of_cuts, sqrt(3.0 * 3.0 / COUNT) / 1.5);
    assert_near(whole, sqrt((3.0 * 3.0 + corner * corner) / COUNT) / 1.5);
    estimate_finish(&estimate);
}

/* Threads estimate rows by bands of 16. */
TEST(a_column_of_edges_is_estimated_alike_in_all_rows)
{
    enum { ROWS = 37 };
    own_image a = fixture_flat(WIDTH, ROWS, 4, 0.5f), b = fixture_flat(WIDTH, ROWS, 4, 0.5f);
    own_image cuts = fixture_flat(WIDTH, ROWS, 2, 0.0f), out = fixture_flat(WIDTH, ROWS, 1, 0.0f);
    const struct image *const halves[2] = {&a, &b};
    struct estimate estimate;
    double of_cuts, row = 0.0;
    for (size_t y = 0; y < ROWS; ++y) {
        a.pixels[4 * (y * WIDTH + 2)] = 0.9f;
        cuts.pixels[2 * y * WIDTH] = 0.25f;
    }
    assert_int_equal(estimate_init(&estimate, WIDTH, ROWS), WHIT_OK);
    estimate_note_change(&estimate, halves, 1);
    double whole = estimate_error(&estimate, &a, &cuts, 2.0, &out, &of_cuts);
    for (size_t i = 0; i < (size_t)WIDTH * ROWS; ++i)
        assert_float_equal(out.pixels[i], out.pixels[i % WIDTH], 0.0f);
    for (size_t x = 0; x < WIDTH; ++x)
        row += (double)out.pixels[x] * (double)out.pixels[x];
    assert_true(out.pixels[2] > 0.3f);
    assert_near(whole, sqrt(row / WIDTH) / 1.5);
    assert_near(of_cuts, sqrt(1.0 / WIDTH) / 1.5);
    estimate_finish(&estimate);
}

/* A pixel that is infinite in one half has an error that no bound meets, one that is infinite in
   both tells nothing. */
TEST(infinite_pixels_leave_the_others_as_they_are)
{
    own_image a = image_of(4, 0.5f), b = image_of(4, 0.5f), cuts = image_of(2, 0.0f);
    own_image out = image_of(1, 0.0f);
    const struct image *const halves[2] = {&a, &b};
    struct estimate estimate;
    double of_cuts;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    a.pixels[0] = a.pixels[4 * 19] = b.pixels[4 * 19] = INFINITY;
    estimate_note_change(&estimate, halves, 1);
    double whole = estimate_error(&estimate, &a, &cuts, 0.0, &out, &of_cuts);
    assert_true(isfinite(whole) && whole > 1e9 && out.pixels[0] > 1e9f);
    for (size_t i = 1; i < COUNT; ++i)
        assert_true(out.pixels[i] == 0.0f);
    estimate_finish(&estimate);
}

TEST(rays_that_were_cut_are_reckoned_with_as_those_that_were_not)
{
    own_image whole = image_of(4, 1.0f), own = image_of(4, 1.0f), sent = image_of(2, 0.0f);
    whole.pixels[4] = 3.0f;
    own.pixels[4] = 2.0f;  /* 1 in red, by weights of 0.5 */
    sent.pixels[2] = 8.0f; /* for the depth: was not sent on by these settings either */
    sent.pixels[2 + 1] = 0.5f;
    assert_near(estimate_cut_radiance(&whole, &own, &sent), 2.0);
    sent.pixels[2 + 1] = 0.0f; /* no ray: as camera rays */
    assert_near(estimate_cut_radiance(&whole, &own, &sent), (3.0 + COUNT - 1) / COUNT);
}
