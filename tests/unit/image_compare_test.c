#include "image_fixture.h"

#include <math.h>

static struct image_difference compare(const struct image *a, const struct image *b)
{
    struct image_difference difference;
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

static void equal_pictures(void **state)
{
    (void)state;
    struct image a = fixture_floats(10, 10, 3);
    a.pixels[4] = NAN;
    struct image b = copy_of(&a);
    struct image_difference difference = compare(&a, &b);
    assert_int_equal(difference.pixel_count, 100);
    assert_int_equal(difference.differing_pixels, 0);
    assert_int_equal(difference.over_1_255, 0);
    assert_int_equal(difference.nonfinite_a, 1);
    assert_int_equal(difference.nonfinite_b, 1);
    assert_true(difference.rmse == 0.0 && difference.largest == 0.0);
    image_finish(&a);
    image_finish(&b);
}

static void differences_are_measured(void **state)
{
    (void)state;
    struct image a, b;
    assert_int_equal(image_init(&a, 2, 2, 4, false), WHIT_OK);
    b = copy_of(&a);
    b.pixels[1] = 0.5f;     /* green of pixel 0 */
    b.pixels[4 + 3] = 1.0f; /* alpha of pixel 1: not part of the error */
    b.pixels[8] = 1e-6f;    /* far below 1/255 */
    b.pixels[12] = -0.0f;   /* only its sign */
    struct image_difference difference = compare(&a, &b);
    assert_int_equal(difference.differing_pixels, 4);
    assert_int_equal(difference.over_1_255, 2);
    assert_true(difference.largest == 0.5);
    assert_true(fabs(difference.rmse - sqrt((0.25 + 1e-12) / 12.0)) < 1e-12);
    image_finish(&a);
    image_finish(&b);
}

static void one_step_of_8_bits_is_not_over(void **state)
{
    (void)state;
    struct image a, b;
    assert_int_equal(image_init(&a, 255, 1, 1, false), WHIT_OK);
    b = copy_of(&a);
    for (int i = 0; i < 255; ++i) {
        a.pixels[i] = image_linear_from_srgb((float)i / 255.0f);
        b.pixels[i] = image_linear_from_srgb((float)(i + 1) / 255.0f);
    }
    assert_int_equal(compare(&a, &b).over_1_255, 0);
    for (int i = 0; i < 254; ++i)
        b.pixels[i] = image_linear_from_srgb((float)(i + 2) / 255.0f);
    assert_int_equal(compare(&a, &b).over_1_255, 254);
    image_finish(&a);
    image_finish(&b);
}

static void nonfinite_counts_but_does_not_spread(void **state)
{
    (void)state;
    struct image a, b;
    assert_int_equal(image_init(&a, 3, 1, 3, false), WHIT_OK);
    b = copy_of(&a);
    a.pixels[0] = NAN;
    b.pixels[3] = INFINITY;
    b.pixels[4] = INFINITY;
    b.pixels[6] = 0.25f;
    struct image_difference difference = compare(&a, &b);
    assert_int_equal(difference.nonfinite_a, 1);
    assert_int_equal(difference.nonfinite_b, 1);
    assert_int_equal(difference.differing_pixels, 3);
    assert_int_equal(difference.over_1_255, 3);
    assert_true(difference.largest == 0.25);
    assert_true(fabs(difference.rmse - sqrt(0.0625 / 3.0)) < 1e-12);
    image_finish(&a);
    image_finish(&b);
}

static void integers_differ_or_not(void **state)
{
    (void)state;
    struct image a = fixture_words(10, 10, 2), b = copy_of(&a);
    assert_true(compare(&a, &b).largest == 0.0);
    b.words[0] ^= 1;
    b.words[1] ^= 1;
    b.words[199] ^= 0x80000000u;
    struct image_difference difference = compare(&a, &b);
    assert_int_equal(difference.differing_pixels, 2);
    assert_true(difference.largest == 1.0);
    image_finish(&a);
    image_finish(&b);
}

static void unlike_pictures_are_refused(void **state)
{
    struct fixture *fixture = *state;
    struct image a = fixture_floats(4, 3, 3),
                 other[4] = {
                     fixture_floats(3, 4, 3), fixture_floats(4, 3, 4), fixture_words(4, 3, 3), {0}};
    for (int i = 0; i < 4; ++i) {
        struct image_difference difference;
        assert_int_equal(image_compare(&fixture->log, &a, &other[i], &difference),
                         WHIT_ERROR_INPUT);
        assert_int_equal(fixture->errors, i + 1);
        image_finish(&other[i]);
    }
    image_finish(&a);
}

static void srgb_curve(void **state)
{
    (void)state;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures),
        cmocka_unit_test(differences_are_measured),
        cmocka_unit_test(one_step_of_8_bits_is_not_over),
        cmocka_unit_test(nonfinite_counts_but_does_not_spread),
        cmocka_unit_test(integers_differ_or_not),
        cmocka_unit_test_setup_teardown(unlike_pictures_are_refused, fixture_begin, fixture_end),
        cmocka_unit_test(srgb_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
