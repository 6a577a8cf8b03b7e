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

/* What estimate.c computes, once more by hand: rates, fading and factor. */
static const double LOW = 0.36, HIGH = 0.65, FADES = 0.8, A_RATE = 2.6;

/* Notes a doubling whose halves differ by twice `changes` in one channel of each pixel. */
static void note(struct estimate *estimate, const float changes[COUNT])
{
    own_image a = image_of(4, 0.5f), b = image_of(4, 0.5f);
    const struct image *const halves[2] = {&a, &b};
    for (size_t i = 0; i < COUNT; ++i) {
        b.pixels[4 * i + i % 3] += (i % 2 ? 2.0f : -2.0f) * changes[i];
        b.pixels[4 * i + 3] = 9.0f; /* no colour */
    }
    estimate_note_change(estimate, halves);
}

/* Notes the changes, and gives the estimate of each pixel of a picture without cut rays. */
static void note_and_estimate(struct estimate *estimate, const float changes[COUNT],
                              struct image *out)
{
    own_image cuts = image_of(2, 0.0f);
    double of_cuts;
    note(estimate, changes);
    estimate_error(estimate, &cuts, 2.0, out, &of_cuts);
    assert_near(of_cuts, 0.0);
}

TEST(the_worst_channel_counts_and_so_do_pixels_around)
{
    float changes[COUNT] = {[0] = 0.4f, [WIDTH + 1] = 0.9f}; /* (0, 0), (1, 1) */
    own_image out = image_of(1, 0.0f);
    struct estimate estimate;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    note_and_estimate(&estimate, changes, &out);
    double around = (0.4 + 0.9) / 9.0, corner = (0.4 + 0.9) / 4.0;
    assert_near((double)out.pixels[WIDTH + 1], A_RATE * pow(0.9, 0.75) * pow(around, 0.25));
    assert_near((double)out.pixels[0], A_RATE * pow(0.4, 0.75) * pow(corner, 0.25));
    assert_near((double)out.pixels[1], 0.0); /* this pixel itself has not changed */
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
        note_and_estimate(&estimate, changes, &out);
    }
    double factor = (double)out.pixels[7] / change;
    estimate_finish(&estimate);
    return factor;
}

/* 1 + (f / rate)^2 + (f / rate)^4 ...: the squares of faded changes, in units of the last one. */
static double faded(double fades, double rate, int doublings)
{
    double sum = 0.0;
    for (int n = 0; n < doublings; ++n)
        sum += pow(fades / rate, 2.0 * n);
    return sum;
}

TEST(earlier_changes_fade_by_the_rate_of_their_pixel)
{
    static const double rates[] = {0.1, LOW, 0.45, 0.6, HIGH, 0.8};
    for (size_t i = 0; i < sizeof rates / sizeof *rates; ++i) {
        double quick = faded(FADES * LOW, rates[i], 5), slow = faded(FADES * HIGH, rates[i], 5);
        double share = (log(rates[i]) - log(LOW)) / (log(HIGH) - log(LOW));
        share = fmin(fmax(share, 0.0), 1.0);
        assert_within(factor_of(rates[i], 5),
                      A_RATE * rates[i] * sqrt(quick + share * (slow - quick)), 1e-4);
    }
    double before = 0.5 * (faded(FADES * LOW, 0.5, 2) + faded(FADES * HIGH, 0.5, 2));
    assert_within(factor_of(0.5, 2), A_RATE * 0.5 * sqrt(before), 1e-4);
    assert_within(factor_of(1.5, 2),
                  A_RATE * sqrt(0.5 * (faded(FADES * LOW, 1.5, 2) + faded(FADES * HIGH, 1.5, 2))),
                  1e-4); /* changes that grow: a rate of 1 */
}

TEST(rates_are_those_of_the_pixels_around)
{
    float changes[COUNT] = {0};
    own_image out = image_of(1, 0.0f);
    struct estimate estimate;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    for (int n = 0; n < 5; ++n) {
        changes[0] = (float)pow(0.3, n);
        changes[4] = (float)pow(0.7, n); /* the other corner of the row */
        note_and_estimate(&estimate, changes, &out);
    }
    double rate = pow((pow(0.3, 4) + pow(0.7, 4)) / 2.0, 0.25);
    double quick = sqrt(faded(FADES * LOW, 0.3, 5)), slow = sqrt(faded(FADES * HIGH, 0.7, 5));
    assert_within((double)out.pixels[0], A_RATE * rate * pow(0.3, 4) * quick * pow(4.0, -0.25),
                  1e-4);
    assert_within((double)out.pixels[4], A_RATE * rate * pow(0.7, 4) * slow * pow(4.0, -0.25),
                  1e-4);
    estimate_finish(&estimate);
}

TEST(cut_rays_carry_twice_the_mean)
{
    float changes[COUNT] = {[0] = 0.4f};
    own_image cuts = image_of(2, 0.0f), out = image_of(1, 0.0f);
    struct estimate estimate;
    assert_int_equal(estimate_init(&estimate, WIDTH, HEIGHT), WHIT_OK);
    note(&estimate, changes);
    cuts.pixels[2 * 19] = 0.25f; /* (4, 3) */
    cuts.pixels[2 * 19 + 1] = 0.5f;
    double of_cuts = 0.0, whole = estimate_error(&estimate, &cuts, 2.0, &out, &of_cuts);
    double corner = (double)out.pixels[0];
    assert_near((double)out.pixels[19], 3.0);
    assert_near(of_cuts, sqrt(3.0 * 3.0 / COUNT) / 1.5);
    assert_near(whole, sqrt((3.0 * 3.0 + corner * corner) / COUNT) / 1.5);
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
    estimate_note_change(&estimate, halves);
    double whole = estimate_error(&estimate, &cuts, 0.0, &out, &of_cuts);
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
