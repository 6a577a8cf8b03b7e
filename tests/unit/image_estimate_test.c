/* The parts of the error estimate, with values by hand. */
#include "image_fixture.h"

#include <math.h>

#include "image/estimate.h"

enum { WIDTH = 5, HEIGHT = 4, COUNT = WIDTH * HEIGHT };

static struct image image_of(uint32_t channels, float value)
{
    struct image image;
    assert_int_equal(image_init(&image, WIDTH, HEIGHT, channels, false), WHIT_OK);
    for (size_t i = 0; i < (size_t)COUNT * channels; ++i)
        image.pixels[i] = value;
    return image;
}

static void assert_near(double value, double wanted)
{
    if (fabs(value - wanted) > 1e-6 * fabs(wanted))
        fail_msg("%.9g is not %.9g", value, wanted);
}

TEST(a_change_is_half_of_the_largest_difference_and_fades)
{
    struct image a = image_of(4, 0.5f), b = image_of(4, 0.5f), changes = image_of(1, 0.0f);
    const struct image *const halves[2] = {&a, &b};
    b.pixels[4 * 7] = 0.75f;
    b.pixels[4 * 7 + 1] = 0.0f;
    b.pixels[4 * 7 + 3] = 9.0f; /* no colour */
    estimate_note_change(halves, &changes);
    for (size_t i = 0; i < COUNT; ++i)
        assert_near((double)changes.pixels[i], i == 7 ? 0.25 : 0.0);
    b.pixels[4 * 7] = b.pixels[4 * 7 + 1] = 0.5f;
    b.pixels[4 * 8 + 2] = 0.4f;
    estimate_note_change(halves, &changes);
    assert_near((double)changes.pixels[7], 0.15);
    assert_near((double)changes.pixels[8], 0.05);
    b.pixels[4 * 7 + 2] = 1.5f;
    estimate_note_change(halves, &changes);
    assert_near((double)changes.pixels[7], 0.5);
    image_finish(&a);
    image_finish(&b);
    image_finish(&changes);
}

TEST(pixels_around_count_and_so_does_what_was_cut)
{
    struct image changes = image_of(1, 0.0f), cuts = image_of(2, 0.0f), out = image_of(1, 0.0f);
    changes.pixels[WIDTH + 1] = 0.9f; /* (1, 1), with eight around it */
    changes.pixels[0] = 0.4f;         /* (0, 0), with three */
    cuts.pixels[2 * 19] = 0.25f;      /* (4, 3) */
    cuts.pixels[2 * 19 + 1] = 0.5f;
    double of_cuts = 0.0, whole = estimate_error(&changes, &cuts, 2.0, &out, &of_cuts);
    double middle = 1.5 * sqrt(0.9 * (1.3 / 9.0)), corner = 1.5 * sqrt(0.4 * (1.3 / 4.0));
    assert_near((double)out.pixels[WIDTH + 1], middle);
    assert_near((double)out.pixels[0], corner);
    assert_near((double)out.pixels[1], 0.0); /* this pixel itself has not changed */
    assert_near((double)out.pixels[19], 1.5);
    assert_near(of_cuts, sqrt(1.5 * 1.5 / COUNT));
    assert_near(whole, sqrt((1.5 * 1.5 + middle * middle + corner * corner) / COUNT));
    image_finish(&changes);
    image_finish(&cuts);
    image_finish(&out);
}

TEST(rays_that_were_cut_are_reckoned_with_as_those_that_were_not)
{
    struct image whole = image_of(4, 1.0f), own = image_of(4, 1.0f), sent = image_of(2, 0.0f);
    whole.pixels[4] = 3.0f;
    own.pixels[4] = 2.0f;  /* 1 in red, by weights of 0.5 */
    sent.pixels[2] = 8.0f; /* for the depth: was not sent on by these settings either */
    sent.pixels[2 + 1] = 0.5f;
    assert_near(estimate_cut_radiance(&whole, &own, &sent), 2.0);
    sent.pixels[2 + 1] = 0.0f; /* no ray: as camera rays */
    assert_near(estimate_cut_radiance(&whole, &own, &sent), (3.0 + COUNT - 1) / COUNT);
    image_finish(&whole);
    image_finish(&own);
    image_finish(&sent);
}
