/* Tests every row of the table of settings. With an argument it prints, for
   tests/cli/settings_test.sh, a line for each row, with another value than the default: name,
   value, commands, change, key, title, key in JSON, separated by tabs. */
#include <math.h>

#include "settings/settings.h"
#include "unit.h"

/* Text for the option that gives it another value than the default. */
static void other_text(const struct setting *row, char text[SETTING_VALUE_BYTES])
{
    static const char *const of_names[][2] = {
        {"environment", "sky.pfm"}, {"shader", "bright.glsl"},
        {"stages", "stages"},       {"aov", "gray"},
        {"effects", "-textures"},   {"background", "#ffcc88"}};
    static const char *const of_kinds[] = {
        [SETTING_BYTES] = "8G",     [SETTING_SIZE] = "24x17",
        [SETTING_TEXT] = "0",       [SETTING_PAIRS] = "bright=1.5,tint=on",
        [SETTING_FOLDERS] = "/tmp", [SETTING_HELP] = NULL};
    const struct settings settings = settings_usual();
    const void *at = (const char *)&settings + row->offset;
    char usual[SETTING_VALUE_BYTES];
    setting_write(row, &settings, 0, usual);
    strcpy(text, of_kinds[row->kind] ? of_kinds[row->kind] : "12");
    if (row->kind == SETTING_COUNT)
        snprintf(text, SETTING_VALUE_BYTES, "%.0f", row->max > 100.0 ? 64.0 : row->max);
    if (row->kind == SETTING_NUMBER)
        setting_write_number(fmin(*(const double *)at + 0.5, row->max), text, SETTING_VALUE_BYTES);
    for (const struct setting_value *value = row->values; value && value->word; ++value) {
        if (strcmp(value->word, usual) != 0) {
            strcpy(text, value->word);
            break;
        }
    }
    for (size_t i = 0; i < sizeof of_names / sizeof *of_names; ++i) {
        if (strcmp(row->name, of_names[i][0]) == 0)
            strcpy(text, of_names[i][1]);
    }
}

/* The row behind `row`, or the first one, that takes a value; NULL: there is none. */
static const struct setting *next_row(const struct setting *row)
{
    row = row ? row + 1 : settings_table;
    while (row->name && row->kind == SETTING_GONE)
        ++row;
    return row->name ? row : NULL;
}

/* The default settings, but with another value in this row, which is also given as `text`. */
static struct settings other_settings(const struct setting *row, char text[SETTING_VALUE_BYTES])
{
    struct settings settings = settings_usual();
    char why[SETTING_WHY_BYTES];
    other_text(row, text);
    if (!settings_read(row, text, &settings, why))
        fail_msg("--%s%s", row->name, why);
    return settings;
}

TEST(a_value_is_written_as_it_is_read)
{
    char text[SETTING_VALUE_BYTES], again[SETTING_VALUE_BYTES], why[SETTING_WHY_BYTES];
    const struct settings usual = settings_usual();
    uint32_t rows = 0;
    for (const struct setting *row = next_row(NULL); row; row = next_row(row), ++rows) {
        struct settings settings = other_settings(row, text), copy = usual, third = usual;
        assert_true(row - settings_table < 64 && settings_given(&settings, row->name));
        assert_false(setting_same(row, &settings, &usual));
        setting_copy(row, &settings, &copy);
        assert_true(setting_same(row, &settings, &copy));
        assert_true(setting_write(row, &settings, 0, again));
        assert_true(setting_read(row, again, &third, why));
        assert_true(setting_same(row, &settings, &third));
    }
    assert_in_range(rows, 40, 64);
}

/* A new value in one row changes no other row. */
TEST(a_row_has_a_field_of_its_own)
{
    char text[SETTING_VALUE_BYTES];
    const struct settings usual = settings_usual();
    for (const struct setting *row = next_row(NULL); row; row = next_row(row)) {
        struct settings settings = other_settings(row, text);
        for (const struct setting *other = next_row(NULL); other; other = next_row(other)) {
            if (other != row && !setting_same(other, &settings, &usual))
                fail_msg("--%s %s changes --%s", row->name, text, other->name);
        }
    }
}

TEST(defaults_are_named_as_they_are)
{
    uint32_t fractions = 0;
    char why[SETTING_WHY_BYTES];
    for (const struct setting *row = settings_table; row->name; ++row) {
        const struct settings usual = settings_usual();
        struct settings settings = usual;
        bool is_text = row->kind == SETTING_TEXT; /* reads anything */
        if (row->kind != SETTING_GONE && !is_text && row->usual && row->usual[0] &&
            setting_read(row, row->usual, &settings, why))
            assert_true(setting_same(row, &settings, &usual));
        /* Help may name a number as a fraction, which the option does not take. */
        double above, below;
        if (row->kind == SETTING_NUMBER && row->usual &&
            sscanf(row->usual, "%lf/%lf", &above, &below) == 2) {
            ++fractions;
            assert_true(*(const double *)((const char *)&usual + row->offset) == above / below);
        }
        assert_true(row->kind == SETTING_GONE || row->commands != 0);
        for (const struct setting *other = settings_table; other < row; ++other)
            assert_string_not_equal(other->name, row->name);
    }
    assert_int_equal(fractions, 1); /* --bailout */
}

/* If two settings differ in one row, the objects that the row names are made anew. */
TEST(needs_are_kept)
{
    char text[SETTING_VALUE_BYTES];
    const struct settings usual = settings_usual();
    for (const struct setting *row = next_row(NULL); row; row = next_row(row)) {
        struct settings settings = other_settings(row, text);
        bool kernel = row->need == SETTING_NEEDS_VIEW && strcmp(row->name, "view") != 0;
        assert_int_equal(settings_same_scene(&settings, &usual), row->need < SETTING_NEEDS_SCENE);
        assert_int_equal(settings_same_kernel(&settings, &usual), kernel);
        assert_int_equal(settings_same(&settings, &usual),
                         row->change != SETTING_PAINT &&
                             (row->change == SETTING_RUN || !(row->commands & IN_RENDER)));
        bool light = row->change == SETTING_LIGHT && row->need < SETTING_NEEDS_TREES;
        assert_int_equal(settings_same_light(&settings, &usual), !light);
    }
}

TEST(each_kind_of_text_that_is_none_is_refused)
{
    static const char *const texts[] = {"",   "?",   "1x",      "-1", "nan", "99999999999999999999",
                                        "0x", "1,2", "4x4junk", "\n"};
    char why[SETTING_WHY_BYTES];
    for (const struct setting *row = next_row(NULL); row; row = next_row(row)) {
        for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
            const struct settings usual = settings_usual();
            struct settings settings = usual;
            bool any = row->kind == SETTING_TEXT || row->kind == SETTING_FOLDERS;
            if (!setting_has_argument(row) || (any && texts[i][0]))
                continue;
            const struct setting_value *word =
                row->kind == SETTING_CHOICE || row->kind == SETTING_EITHER ? row->values : NULL;
            why[0] = '\0';
            if (settings_read(row, texts[i], &settings, why))
                assert_true(row->kind == SETTING_NUMBER || row->kind == SETTING_COUNT ||
                            strcmp(row->name, "exposure") == 0);
            else
                assert_true(why[0] && memcmp(&settings, &usual, sizeof usual) == 0);
            for (; word && word->word; ++word)
                assert_non_null(strstr(why, word->word));
        }
    }
}

TEST(a_number_may_be_a_fraction)
{
    static const char *const none[] = {"1/0", "1/", "/64", "1/2/3", "1/-2", "1/ 2", "3/2"};
    const struct setting *bailout = settings_row("bailout");
    struct settings settings = settings_usual();
    char why[SETTING_WHY_BYTES];
    assert_true(settings_read(bailout, "1/64", &settings, why));
    assert_true(settings.picture.bailout == 0.015625);
    for (size_t i = 0; i < sizeof none / sizeof *none; ++i)
        assert_false(settings_read(bailout, none[i], &settings, why));
    assert_true(settings_read(settings_row("exposure"), "-1/2", &settings, why));
    assert_true(settings.picture.exposure_ev == -0.5);
}

TEST(limits_of_adaptive_samples_are_powers_of_4)
{
    static const char *const texts[] = {"adaptive:0.05,1,4",   "adaptive:0.05,1,16",
                                        "adaptive:0.05,1,64",  "adaptive:0.05,4,16",
                                        "adaptive:0.05,16,64", "adaptive:0.05"};
    static const char *const refused[] = {"adaptive:0.05,",     "adaptive:0.05,1",
                                          "adaptive:0.05,4,4",  "adaptive:0.05,2,8",
                                          "adaptive:0.05,1,4,", "adaptive:0.05,16,256"};
    const struct setting *aa = settings_row("aa");
    char text[SETTING_VALUE_BYTES], why[SETTING_WHY_BYTES];
    struct settings settings = settings_usual();
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        assert_true(settings_read(aa, texts[i], &settings, why));
        assert_true(setting_write(aa, &settings, 0, text));
        assert_string_equal(text, texts[i]);
    }
    assert_true(settings_read(aa, "adaptive:0.05,4,64", &settings, why));
    assert_true(setting_write(aa, &settings, 0, text));
    assert_string_equal(text, "adaptive:0.05");
    for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i) {
        assert_false(settings_read(aa, refused[i], &settings, why));
        assert_non_null(strstr(why, "1,4 1,16 1,64 4,16 4,64 or 16,64"));
    }
}

static void print_row(const struct setting *row)
{
    char text[SETTING_VALUE_BYTES];
    other_text(row, text);
    printf("%s\t%s\t%u\t%d\t%c\t%s\t%s\t%d\n", row->name, setting_has_argument(row) ? text : "-",
           row->commands, (int)row->change, row->key > 32 ? row->key : '-',
           row->title ? row->title : "-", row->json ? row->json : row->name,
           row->trusted || row->developer);
}

int main(int argc, char **argv)
{
    (void)argv;
    for (const struct setting *row = next_row(NULL); argc > 1 && row; row = next_row(row))
        print_row(row);
    return argc > 1 ? 0 : unit_run(NULL, NULL);
}
