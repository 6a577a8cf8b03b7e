/* The HTML page of `whit check` if its pictures exceed the page's limit of bytes. */
#include "app/check/check.h"
#include "base/file.h"
#include "folder_fixture.h"
#include "random_fixture.h"

enum { CASES = 60, PAGE_BYTES_MAX = 1000000 };

static struct settings settings;

static struct check_png make_png(size_t size_bytes)
{
    struct check_png png = {malloc(size_bytes), size_bytes};
    assert_non_null(png.data);
    for (size_t i = 0; i < size_bytes; ++i)
        png.data[i] = (uint8_t)random_bits64(&random_state);
    return png;
}

/* Fills in a case that differs, with pictures of `picture_bytes` each, and a thumbnail. */
static void fill(struct check_case *item, struct check_result *result, uint32_t index,
                 size_t picture_bytes)
{
    char name[16];
    snprintf(name, sizeof name, "case-%u", index);
    *item = (struct check_case){.name = strdup(name), .line = index + 1, .settings = &settings};
    *result = (struct check_result){.item = item,
                                    .verdict = CHECK_DIFFERS,
                                    .text = strdup("differs: colours other"),
                                    .cause = strdup("cause: mesh \"ball\""),
                                    .pictures = {.thumbnail = make_png(THUMBNAIL_BYTES_MAX),
                                                 .after = make_png(picture_bytes),
                                                 .before = make_png(picture_bytes),
                                                 .difference = make_png(picture_bytes),
                                                 .flip = make_png(picture_bytes)}};
}

/* Makes a page of `count` cases that all differ; free() it. */
static char *make_page(uint32_t count, size_t picture_bytes)
{
    char path[512];
    struct check_case items[CASES];
    struct check_result results[CASES];
    struct check check = {.report = path, .golden_path = path, .results = results};
    settings = settings_usual();
    random_state = 3;
    for (uint32_t i = 0; i < count; ++i)
        fill(&items[i], &results[i], i, picture_bytes);
    check.suite = (struct suite){.path = "looks.whit", .cases = items, .count = count};
    snprintf(path, sizeof path, "%s/page.html", folder);
    assert_int_equal(check_save_page(&check, EXIT_DIFFERS), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i) {
        verdict_finish(&results[i]);
        free(items[i].name);
    }
    uint8_t *page = NULL;
    size_t bytes;
    assert_int_equal(file_read(NULL, NULL, path, 0, &page, &bytes), WHIT_OK);
    return (char *)page;
}

static uint32_t count_of(const char *text, const char *word)
{
    uint32_t count = 0;
    for (const char *at = text; (at = strstr(at, word)) != NULL; at += strlen(word))
        ++count;
    return count;
}

#define PICTURE(key) "\"" key "\":\"data:image/png;base64,"

TEST_IN(what_has_no_room_is_left_out, folder_begin, folder_end)
{
    own_memory char *page = make_page(CASES, PICTURE_BYTES_MAX);
    size_t bytes = strlen(page);
    uint32_t before = count_of(page, PICTURE("before")), after = count_of(page, PICTURE("after"));
    print_message("%zu bytes, %u pictures of what was, %u of what is\n", bytes, before, after);
    assert_true(bytes <= PAGE_BYTES_MAX);
    assert_true(bytes > PAGE_BYTES_MAX - PICTURE_BYTES_MAX / 3 * 4);
    assert_true(before > 0 && before < CASES);
    assert_int_equal(count_of(page, "\"cause\":\"cause: mesh"), CASES);
    assert_int_equal(count_of(page, "\"command\":\"whit render "), CASES);
}

TEST_IN(what_has_room_is_there, folder_begin, folder_end)
{
    static const char *const keys[] = {PICTURE("before"), PICTURE("difference"), PICTURE("flip"),
                                       PICTURE("after")};
    own_memory char *page = make_page(CASES, 1500);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i)
        assert_int_equal(count_of(page, keys[i]), CASES);
    assert_true(strlen(page) <= PAGE_BYTES_MAX);
}
