/* Pictures written in strips: the file equals that of the whole picture, or there is none. */
#include "image_fixture.h"

#include "image/rows.h"

static const whit_text recipe[] = {{"scene", "scenes/default.json"},
                                   {"note", "\xc3\xbc 5\xc2\xb0"}};
enum { RECIPE_COUNT = sizeof recipe / sizeof *recipe };

static struct image_rows *begin(const char *path, const struct image *shape)
{
    struct image_rows *rows;
    assert_int_equal(image_rows_begin(&warnings_log, path, shape, recipe, RECIPE_COUNT, &rows),
                     WHIT_OK);
    return rows;
}

/* A strip of `count` rows from `first` on, borrowed from the whole picture. */
static struct image strip_of(const struct image *whole, uint32_t first, uint32_t count)
{
    struct image strip = *whole;
    size_t at = (size_t)first * whole->width * whole->channels;
    strip.height = count;
    strip.pixels = whole->pixels ? whole->pixels + at : NULL;
    strip.words = whole->words ? whole->words + at : NULL;
    return strip;
}

static void check_strips(const char *name, const struct image *image, uint32_t each)
{
    uint8_t *data[2];
    size_t bytes[2];
    char *one = in_folder(name), strips[64];
    snprintf(strips, sizeof strips, "strips-%s", name);
    char *path = in_folder(strips);
    assert_int_equal(image_save(&warnings_log, image, NULL, 0, one, recipe, RECIPE_COUNT), WHIT_OK);
    struct image_rows *rows = begin(path, image);
    for (uint32_t y = 0; y < image->height; y += each) {
        uint32_t left = image->height - y;
        const struct image strip = strip_of(image, y, left < each ? left : each);
        assert_int_equal(image_rows_add(rows, &strip), WHIT_OK);
    }
    assert_int_equal(image_rows_commit(rows), WHIT_OK);
    assert_int_equal(file_read(&warnings_log, NULL, one, 0, &data[0], &bytes[0]), WHIT_OK);
    assert_int_equal(file_read(&warnings_log, NULL, path, 0, &data[1], &bytes[1]), WHIT_OK);
    assert_int_equal(bytes[0], bytes[1]);
    assert_memory_equal(data[0], data[1], bytes[0]);
    free(data[0]);
    free(data[1]);
}

TEST_IN(strips_have_the_bytes_of_the_whole, folder_begin, folder_end)
{
    for (uint32_t each = IMAGE_STRIP_ROWS; each <= 64; each *= 2) {
        own_image colors = fixture_floats(37, 75, 4), words = fixture_words(37, 75, 2);
        check_strips("a.png", &colors, each);
        check_strips("a.exr", &colors, each);
        check_strips("a.pfm", &colors, each);
        check_strips("ids.exr", &words, each);
    }
    assert_int_equal(messages.count, 0);
}

TEST_IN(too_few_or_too_many_rows_leave_no_file, folder_begin, folder_end)
{
    static const char *const names[] = {"a.png", "a.exr", "a.pfm"};
    struct image image = fixture_floats(8, 48, 4);
    const struct image half = strip_of(&image, 0, 32);
    for (int i = 0; i < 3; ++i) {
        char *path = in_folder(names[i]);
        struct image_rows *rows = begin(path, &image);
        assert_int_equal(image_rows_add(rows, &half), WHIT_OK);
        assert_int_equal(image_rows_commit(rows), WHIT_ERROR_USAGE);
        rows = begin(path, &image);
        assert_int_equal(image_rows_add(rows, &half), WHIT_OK);
        assert_int_equal(image_rows_add(rows, &half), WHIT_ERROR_USAGE);
        assert_int_equal(image_rows_commit(rows), WHIT_ERROR_USAGE);
        rows = begin(path, &image);
        image_rows_abandon(rows);
        assert_false(file_exists(path));
    }
    image_finish(&image);
    assert_int_equal(messages.errors, 6);
}

TEST_IN(a_strip_of_another_kind_is_refused, folder_begin, folder_end)
{
    own_image image = fixture_floats(8, 48, 4), words = fixture_words(8, 16, 4),
              wide = fixture_floats(9, 16, 4);
    const struct image *const others[] = {&words, &wide};
    for (int i = 0; i < 2; ++i) {
        struct image_rows *rows = begin(in_folder("a.exr"), &image);
        assert_int_equal(image_rows_add(rows, others[i]), WHIT_ERROR_USAGE);
        image_rows_abandon(rows);
    }
}
