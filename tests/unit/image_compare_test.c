#include "image_fixture.h"

#include "image/compare.h"

static whit_difference compare(const struct image *a, const struct image *b)
{
    whit_difference difference;
    assert_int_equal(image_compare(NULL, a, b, &difference), WHIT_OK);
    return difference;
}

static struct image copy_of(const struct image *image)
{
    struct image copy;
    bool integers = image->words != NULL;
    assert_int_equal(image_init(&copy, image->width, image->height, image->channels, integers),
                     WHIT_OK);
    memcpy(integers ? (void *)copy.words : (void *)copy.pixels,
           integers ? (const void *)image->words : (const void *)image->pixels,
           (size_t)image->width * image->height * image->channels * 4);
    return copy;
}

TEST(equal_pictures)
{
    own_image a = fixture_floats(10, 10, 3);
    a.pixels[4] = NAN;
    own_image b = copy_of(&a);
    whit_difference difference = compare(&a, &b);
    assert_int_equal(difference.pixel_count, 100);
    assert_int_equal(difference.differing_pixels, 0);
    assert_int_equal(difference.over_1_255, 0);
    assert_int_equal(difference.nonfinite_a, 1);
    assert_int_equal(difference.nonfinite_b, 1);
    assert_int_equal(difference.nonfinite_differing, 0);
    assert_true(difference.rmse == 0.0 && difference.largest == 0.0);
}

TEST(differences_are_measured)
{
    own_image a = fixture_flat(2, 2, 4, 0.0f), b = copy_of(&a);
    b.pixels[1] = 0.5f;     /* green of pixel 0 */
    b.pixels[4 + 3] = 1.0f; /* alpha of pixel 1: not part of the error */
    b.pixels[8] = 1e-6f;    /* far below 1/255 */
    b.pixels[12] = -0.0f;   /* only its sign */
    whit_difference difference = compare(&a, &b);
    assert_int_equal(difference.differing_pixels, 4);
    assert_int_equal(difference.over_1_255, 2);
    assert_true(difference.largest == 0.5);
    assert_true(fabs(difference.rmse - sqrt((0.25 + 1e-12) / 12.0)) < 1e-12);
}

TEST(one_step_of_8_bits_is_not_over)
{
    own_image a = fixture_flat(255, 1, 1, 0.0f), b = copy_of(&a);
    for (int i = 0; i < 255; ++i) {
        a.pixels[i] = image_linear_from_srgb((float)i / 255.0f);
        b.pixels[i] = image_linear_from_srgb((float)(i + 1) / 255.0f);
    }
    assert_int_equal(compare(&a, &b).over_1_255, 0);
    for (int i = 0; i < 254; ++i)
        b.pixels[i] = image_linear_from_srgb((float)(i + 2) / 255.0f);
    assert_int_equal(compare(&a, &b).over_1_255, 254);
}

TEST(nonfinite_counts_but_does_not_spread)
{
    own_image a = fixture_flat(3, 1, 3, 0.0f), b = copy_of(&a);
    a.pixels[0] = NAN;
    b.pixels[3] = INFINITY;
    b.pixels[4] = INFINITY;
    b.pixels[6] = 0.25f;
    whit_difference difference = compare(&a, &b);
    assert_int_equal(difference.nonfinite_a, 1);
    assert_int_equal(difference.nonfinite_b, 1);
    assert_int_equal(difference.nonfinite_differing, 2);
    assert_int_equal(difference.differing_pixels, 3);
    assert_int_equal(difference.over_1_255, 3);
    assert_true(difference.largest == 0.25);
    assert_true(fabs(difference.rmse - sqrt(0.0625 / 3.0)) < 1e-12);
}

/* Values by hand: errors relative to the reference, and signs of mean differences. */
TEST(means_are_those_of_the_formulas)
{
    own_image a = fixture_flat(2, 1, 3, 0.0f), b = copy_of(&a), difference_image = {0};
    const float from[6] = {0.5f, 0.25f, 0.0f, 2.0f, 0.0f, 1.0f};
    const float to[6] = {0.75f, 0.25f, 0.125f, 1.0f, 0.0f, 1.5f};
    memcpy(a.pixels, from, sizeof from);
    memcpy(b.pixels, to, sizeof to);
    whit_difference difference = compare(&a, &b);
    double relative = 0.0625 / 0.26 + 0.015625 / 0.01 + 1.0 / (4.0 + 0.01) + 0.25 / (1.0 + 0.01);
    assert_true(fabs(difference.relative_mse - relative / 6.0) < 1e-12);
    assert_true(fabs(difference.rmse - sqrt((0.0625 + 0.015625 + 1.0 + 0.25) / 6.0)) < 1e-12);
    assert_true(difference.mean[0] == -0.375 && difference.mean[1] == 0.0);
    assert_true(difference.mean[2] == 0.3125 && difference.largest == 1.0);
    whit_difference back = compare(&b, &a);
    assert_true(back.mean[0] == 0.375 && back.rmse == difference.rmse);
    assert_true(back.relative_mse != difference.relative_mse);
    b.pixels[4] = NAN;
    assert_int_equal(image_subtract(NULL, &a, &b, &difference_image), WHIT_OK);
    assert_true(difference_image.pixels[0] == 0.25f && difference_image.pixels[2] == 0.125f);
    assert_true(isnan(difference_image.pixels[3]) && isnan(difference_image.pixels[5]));
}

/* Grey compares as three equal channels, and a missing alpha as 1. */
TEST(channels_may_differ)
{
    struct image grey = fixture_floats(5, 4, 1), colours[2];
    for (uint32_t i = 0; i < 2; ++i) {
        uint32_t channels = 3 + i;
        colours[i] = fixture_flat(5, 4, channels, 0.0f);
        for (uint32_t at = 0; at < 20 * channels; ++at)
            colours[i].pixels[at] = at % channels == 3 ? 1.0f : grey.pixels[at / channels];
        assert_int_equal(compare(&grey, &colours[i]).differing_pixels, 0);
    }
    assert_int_equal(compare(&colours[0], &colours[1]).differing_pixels, 0);
    colours[0].pixels[3 * 7 + 2] += 0.5f;
    colours[1].pixels[4 * 9 + 3] = 0.5f;
    whit_difference difference = compare(&colours[1], &colours[0]);
    assert_int_equal(difference.differing_pixels, 2);
    assert_true(fabs(difference.largest - 0.5) < 1e-6 && difference.mean[0] == 0.0);
    image_finish(&grey);
    image_finish(&colours[0]);
    image_finish(&colours[1]);
}

TEST(integers_differ_or_not)
{
    own_image a = fixture_words(10, 10, 2), b = copy_of(&a);
    assert_true(compare(&a, &b).largest == 0.0);
    b.words[0] ^= 1;
    b.words[1] ^= 1;
    b.words[199] ^= 0x80000000u;
    whit_difference difference = compare(&a, &b);
    assert_int_equal(difference.differing_pixels, 2);
    assert_true(difference.largest == 1.0);
}

TEST_IN(unlike_pictures_are_refused, folder_begin, folder_end)
{
    struct image a = fixture_floats(4, 3, 3),
                 other[3] = {fixture_floats(3, 4, 3), fixture_words(4, 3, 3), {0}};
    struct image ids = fixture_words(4, 3, 2), out;
    whit_difference difference;
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(image_compare(&warnings_log, &a, &other[i], &difference),
                         WHIT_ERROR_INPUT);
        assert_int_equal(image_subtract(&warnings_log, &a, &other[i], &out), WHIT_ERROR_INPUT);
        assert_int_equal(messages.errors, 2 * i + 2);
        assert_null(out.pixels);
    }
    assert_int_equal(image_compare(NULL, &ids, &other[1], &difference), WHIT_ERROR_INPUT);
    assert_int_equal(image_subtract(NULL, &ids, &ids, &out), WHIT_ERROR_USAGE);
    for (int i = 0; i < 3; ++i)
        image_finish(&other[i]);
    image_finish(&a);
    image_finish(&ids);
}

TEST(srgb_curve)
{
    assert_true(image_srgb_from_linear(-1.0f) == 0.0f && image_srgb_from_linear(NAN) == 0.0f);
    assert_true(image_srgb_from_linear(2.0f) == 1.0f && image_linear_from_srgb(2.0f) == 1.0f);
    assert_true(fabsf(image_srgb_from_linear(0.214041f) - 0.5f) < 1e-5f);
    float last = -1.0f;
    for (int i = 0; i <= 1000; ++i) {
        float linear = (float)i / 1000.0f, srgb = image_srgb_from_linear(linear);
        assert_true(srgb > last);
        assert_true(fabsf(image_linear_from_srgb(srgb) - linear) < 2e-7f);
        last = srgb;
    }
}
