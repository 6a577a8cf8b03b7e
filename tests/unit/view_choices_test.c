/* Differences of two settings of the viewer, in words. */
#include "unit.h"
#include "view/choices.h"

TEST(the_same_differ_in_nothing)
{
    struct choice_change changes[CHOICE_CHANGES_MAX];
    const struct settings a = {.scene = "a.json"}, b = a;
    assert_int_equal(choice_changes(&a, &b, changes), 0);
}

TEST(each_choice_is_told_by_its_name)
{
    struct choice_change changes[CHOICE_CHANGES_MAX];
    const struct settings a = settings_usual();
    uint32_t told = 0;
    for (const struct setting *row = choice_next(NULL); row; row = choice_next(row), ++told) {
        char text[CHOICE_WORDS];
        struct settings b = a;
        choice_turn(&b, row, 1);
        assert_int_equal(choice_changes(&a, &b, changes), 1);
        choice_say(&b, row, text, sizeof text);
        assert_string_equal(changes[0].name, row->title);
        assert_string_equal(changes[0].b, text);
        assert_string_not_equal(changes[0].a, changes[0].b);
        choice_turn(&b, row, -1);
        assert_int_equal(choice_changes(&a, &b, changes), 0);
    }
    assert_in_range(told, 10, CHOICE_CHANGES_MAX);
}

TEST(numbers_end_where_their_options_do)
{
    const struct setting *depth = settings_row("depth");
    struct settings settings = settings_usual();
    choice_set_number(&settings, depth, -1.0);
    assert_int_equal(settings.picture.depth, 0);
    choice_turn(&settings, depth, -1);
    assert_int_equal(settings.picture.depth, 0);
    choice_set_number(&settings, depth, 1e9);
    choice_turn(&settings, depth, 1);
    assert_int_equal(settings.picture.depth, (uint32_t)depth->max);
}

TEST(environments_are_told_by_their_files)
{
    struct choice_change changes[CHOICE_CHANGES_MAX];
    const struct settings a = settings_usual();
    struct settings b = a;
    strcpy(b.environment, "some/where/sky.hdr");
    assert_int_equal(choice_changes(&a, &b, changes), 1);
    assert_string_equal(changes[0].name, "environment");
    assert_string_equal(changes[0].a, "the file's");
    assert_string_equal(changes[0].b, "sky.hdr");
}

TEST(scenes_are_told_by_their_files)
{
    struct choice_change changes[CHOICE_CHANGES_MAX];
    const struct settings a = {.scene = "some/where/a.json"};
    struct settings b = {.scene = "b.obj"};
    char why[SETTING_WHY_BYTES];
    assert_true(effects_read("-textures", &b.picture, why));
    assert_int_equal(choice_changes(&a, &b, changes), 2);
    assert_string_equal(changes[0].name, "scene");
    assert_string_equal(changes[0].a, "a.json");
    assert_string_equal(changes[0].b, "b.obj");
    assert_string_equal(changes[1].name, "effects");
    assert_string_equal(changes[1].a, "auto");
    assert_string_equal(changes[1].b, "-textures");
    b = a;
    b.reload = 1;
    assert_int_equal(choice_changes(&a, &b, changes), 1);
    assert_string_equal(changes[0].a, "a.json");
    assert_string_equal(changes[0].b, "a.json, read again");
}
