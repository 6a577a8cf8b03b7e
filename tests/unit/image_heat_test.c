/* Heat maps: the colours, the automatic scale, and a legend that fits any picture. */
#include "image_fixture.h"

#include "image/heat.h"
#include "image/image_reply.h"

static struct image heat_of(const struct image *values, double scale, const char *title)
{
    struct image out;
    const whit_heat_params params = {.scale = scale, .title = title, .unit = "tests"};
    assert_int_equal(image_heat(values, &params, &out), WHIT_OK);
    return out;
}

static void assert_color(double share, uint8_t red, uint8_t green, uint8_t blue)
{
    uint8_t codes[3];
    heat_color(share, codes);
    assert_int_equal(codes[0], red);
    assert_int_equal(codes[1], green);
    assert_int_equal(codes[2], blue);
}

TEST(colors_are_those_of_viridis)
{
    assert_color(0.0, 0x44, 0x01, 0x54);
    assert_color(15.0 / 255.0, 0x48, 0x17, 0x69);
    assert_color(120.0 / 255.0, 0x23, 0x89, 0x8e);
    assert_color(1.0, 0xfd, 0xe7, 0x25);
    assert_color(-1.0, 0x44, 0x01, 0x54);
    assert_color((double)NAN, 0x44, 0x01, 0x54);
    assert_color(1e30, 0xfd, 0xe7, 0x25);
}

/* Colours of viridis between the entries of the table are matched closely. */
TEST(colors_between_are_near)
{
    static const struct {
        int index;
        uint8_t codes[3];
    } known[] = {{51, {0x41, 0x44, 0x87}}, {127, {0x21, 0x91, 0x8c}}, {187, {0x58, 0xc7, 0x65}}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
        uint8_t codes[3];
        heat_color(known[i].index / 255.0, codes);
        for (int c = 0; c < 3; ++c)
            assert_true(abs(codes[c] - known[i].codes[c]) <= 5);
    }
}

static double light_of(const uint8_t codes[3])
{
    const double weights[3] = {0.2126, 0.7152, 0.0722};
    double light = 0.0;
    for (int c = 0; c < 3; ++c)
        light += weights[c] * (double)image_linear_from_srgb((float)codes[c] / 255.0f);
    return light;
}

/* Brightness rises with the value, so that maps can be read without seeing colours. */
TEST(brightness_rises)
{
    double before = -1.0;
    for (int i = 0; i <= 100; ++i) {
        uint8_t codes[3];
        heat_color(i / 100.0, codes);
        assert_true(light_of(codes) > before);
        before = light_of(codes);
    }
}

/* Both sides darken away from 0, blue on one, brown on the other. */
TEST(signed_colors_have_two_sides)
{
    uint8_t zero[3], below[3], above[3], beyond[3];
    heat_signed_color(0.0, zero);
    double before[2] = {light_of(zero), light_of(zero)};
    for (int i = 1; i <= 100; ++i) {
        heat_signed_color(i * -0.01, below);
        heat_signed_color(i * 0.01, above);
        assert_true(light_of(below) < before[0] && light_of(above) < before[1]);
        before[0] = light_of(below);
        before[1] = light_of(above);
        assert_true(below[2] > below[0] && above[0] > above[2]);
    }
    heat_signed_color(-7.0, beyond);
    assert_memory_equal(beyond, below, 3);
    heat_signed_color((double)NAN, beyond);
    assert_memory_equal(beyond, zero, 3);
}

TEST(signed_pictures_show_the_farthest_channel)
{
    own_image values = fixture_flat(200, 2, 3, 0.0f), heat = {0};
    for (int i = 0; i < 400; ++i)
        values.pixels[3 * i + 1] = i == 8 ? 0.5f : -0.25f;
    values.pixels[0] = 0.375f;
    values.pixels[3 * 5 + 2] = NAN;
    const whit_heat_params params = {.is_signed = true, .title = "b - a"};
    assert_int_equal(image_heat(&values, &params, &heat), WHIT_OK);
    const float *left = heat.pixels + 3 * (size_t)((heat.width - 200) / 2);
    assert_true(left[0] > left[2]); /* 0.375 */
    assert_true(left[3] < left[5]); /* -0.25 */
    assert_true(isnan(left[3 * 5]));
    uint8_t codes[3]; /* of 399 distances one in 200 is over 0.375; 0.4 reads well */
    heat_signed_color(-0.25 / 0.4, codes);
    assert_true(fabsf(left[4] - image_linear_from_srgb((float)codes[1] / 255.0f)) < 1e-6f);
    /* The bar of the legend goes from one side to the other. */
    const float *bar = heat.pixels + 3 * (size_t)heat.width * (2 + 20);
    assert_true(bar[3 * 5] < bar[3 * 5 + 2]);
    assert_true(bar[3 * (heat.width - 6)] > bar[3 * (heat.width - 6) + 2]);
    assert_true(bar[3 * (heat.width / 2)] > 0.8f);
}

TEST(the_scale_ignores_the_brightest_200th)
{
    own_image values = fixture_flat(100, 10, 1, 0.0f);
    for (int i = 0; i < 1000; ++i)
        values.pixels[(i * 7) % 1000] = (float)(i + 1); /* 1 to 1000 */
    assert_true(image_heat_scale(&values) == 1000.0);   /* 995, rounded up */
    for (int i = 0; i < 1000; ++i)
        values.pixels[i] = values.pixels[i] > 995.0f ? 1e9f : 37.0f;
    assert_true(image_heat_scale(&values) == 40.0);
    values.pixels[0] = values.pixels[0] > 1e8f ? values.pixels[0] : 1e9f; /* one more than 5 */
    assert_true(image_heat_scale(&values) == 1e9);
}

TEST(the_scale_of_few_or_no_values)
{
    own_image values = fixture_flat(100, 100, 1, 0.0f);
    assert_true(image_heat_scale(&values) == 1.0);
    values.pixels[77] = 13.0f; /* far below a 200th of the picture */
    assert_true(image_heat_scale(&values) == 15.0);
    for (int i = 0; i < 10000; ++i)
        values.pixels[i] = i % 2 ? NAN : INFINITY;
    assert_true(image_heat_scale(&values) == 1.0);
    values.pixels[3] = 2.0f;
    assert_true(image_heat_scale(&values) == 2.0);
    values.pixels[3] = -2.0f;
    assert_true(image_heat_scale(&values) == 1.0);
}

/* A heat map saved as PNG has exactly the codes of heat_color. */
TEST_IN(the_file_has_the_codes_of_the_table, folder_begin, folder_end)
{
    char *path = in_folder("heat.png");
    own_image values = fixture_flat(500, 3, 1, 0.0f), back = {0};
    for (uint32_t i = 0; i < 1500; ++i)
        values.pixels[i] = (float)i;
    own_image heat = heat_of(&values, 1499.0, "all of them");
    assert_int_equal(heat.width, 500);
    assert_int_equal(image_save(&warnings_log, &heat, NULL, 0, path, NULL, 0), WHIT_OK);
    assert_int_equal(image_load(&warnings_log, NULL, path, NULL, &back), WHIT_OK);
    assert_true(back.width == heat.width && back.height == heat.height);
    for (uint32_t i = 0; i < 1500; ++i) {
        uint8_t codes[3];
        heat_color((double)i / 1499.0, codes);
        for (uint32_t c = 0; c < back.channels && c < 3; ++c) {
            float code = 255.0f * image_srgb_from_linear(back.pixels[i * back.channels + c]);
            assert_int_equal((int)(code + 0.5f), codes[c]);
        }
    }
}

static uint32_t count_ink(const struct image *image, uint32_t first_row)
{
    uint32_t count = 0;
    for (size_t i = (size_t)first_row * image->width; i < (size_t)image->width * image->height; ++i)
        count += image->pixels[3 * i] > 0.7f && image->pixels[3 * i + 2] > 0.7f;
    return count;
}

TEST(the_legend_fits_any_picture)
{
    static const uint32_t sizes[][2] = {{1, 1},    {1, 300},   {300, 1},   {7, 5},
                                        {119, 40}, {640, 480}, {2048, 16}, {5000, 2}};
    static const char *const titles[] = {
        NULL, "", "box tests", "gr\xc3\xbc\xc3\x9f dich",
        "a title that goes on and on, from one end of the legend to the other, over it, and then "
        "still on to the edge of the screen, which it does not heed"};
    static const double scales[] = {1.0, 13.0, 37.25, 1e-30, 1e30, 123456789.0};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; ++s) {
        own_image values = fixture_flat(sizes[s][0], sizes[s][1], 1, 1.0f);
        for (size_t t = 0; t < sizeof titles / sizeof titles[0]; ++t) {
            own_image heat = heat_of(&values, scales[(s + t) % 6], titles[t]);
            assert_true(heat.width >= values.width && heat.width >= 120);
            assert_true(heat.height > values.height);
            assert_true(count_ink(&heat, values.height) > 50);
            for (size_t i = 0; i < 3 * (size_t)heat.width * heat.height; ++i)
                assert_true(heat.pixels[i] >= 0.0f && heat.pixels[i] <= 1.0f);
        }
    }
}

TEST(the_title_is_drawn)
{
    own_image values = fixture_flat(400, 4, 1, 0.0f);
    own_image with = heat_of(&values, 1.0, "title"), without = heat_of(&values, 1.0, "");
    assert_int_equal(with.height, without.height);
    assert_true(count_ink(&with, 4) > count_ink(&without, 4) + 20);
}

TEST(what_is_not_finite_stays_so)
{
    own_image values = fixture_flat(200, 1, 1, 3.0f);
    values.pixels[5] = NAN;
    values.pixels[6] = INFINITY;
    own_image heat = heat_of(&values, 0.0, NULL);
    assert_true(isnan(heat.pixels[15]) && isnan(heat.pixels[18]) && heat.pixels[12] >= 0.0f);
}

TEST(other_pictures_are_refused)
{
    own_image colors = fixture_floats(4, 4, 3), words = fixture_words(4, 4, 1);
    struct image out;
    whit_heat_params params = {0};
    assert_int_equal(image_heat(&colors, &params, &out), WHIT_ERROR_USAGE);
    assert_int_equal(image_heat(&words, &params, &out), WHIT_ERROR_USAGE);
    own_image values = fixture_flat(4, 4, 1, 1.0f);
    params.scale = -1.0;
    assert_int_equal(image_heat(&values, &params, &out), WHIT_ERROR_USAGE);
    params.scale = (double)NAN;
    assert_int_equal(image_heat(&values, &params, &out), WHIT_ERROR_USAGE);
}
