/* In what two settings of the viewer differ, in words. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "view/choices.h"

static void the_same_differ_in_nothing(void **state)
{
    (void)state;
    struct choice_change changes[CHOICE_CHANGES_MOST];
    const struct view_settings a = {.scene = "a.json"}, b = a;
    assert_int_equal(choice_changes(&a, &b, changes), 0);
}

static void each_choice_is_told_by_its_name(void **state)
{
    (void)state;
    struct choice_change changes[CHOICE_CHANGES_MOST];
    const struct view_settings a = {.scene = "a.json"};
    uint32_t told = 0;
    for (enum choice_id id = 0; id < CHOICE_COUNT; ++id) {
        struct view_settings b = a;
        choice_turn(&b, id, 1);
        uint32_t count = choice_changes(&a, &b, changes);
        assert_in_range(count, 0, 1);
        told += count;
        if (count == 0)
            continue;
        bool of_builder = id == CHOICE_BINS || id == CHOICE_TREES; /* which names them too */
        enum choice_id by = of_builder ? CHOICE_BUILDER : id;
        char text[CHOICE_WORDS];
        choice_say(&b, by, text, sizeof text);
        assert_int_equal(changes[0].id, by);
        assert_string_equal(changes[0].name, choice_name(by));
        assert_string_equal(changes[0].b, text);
        assert_string_not_equal(changes[0].a, changes[0].b);
    }
    assert_in_range(told, CHOICE_VIEW, CHOICE_COUNT);
}

static void scenes_are_told_by_their_files(void **state)
{
    (void)state;
    struct choice_change changes[CHOICE_CHANGES_MOST];
    const struct view_settings a = {.scene = "some/where/a.json"};
    struct view_settings b = {.scene = "b.obj", .effects = "no-shadows"};
    assert_int_equal(choice_changes(&a, &b, changes), 2);
    assert_string_equal(changes[0].name, "scene");
    assert_string_equal(changes[0].a, "a.json");
    assert_string_equal(changes[0].b, "b.obj");
    assert_string_equal(changes[1].name, "effects");
    assert_string_equal(changes[1].a, "auto");
    assert_string_equal(changes[1].b, "no-shadows");
    b = a;
    b.reload = 1;
    assert_int_equal(choice_changes(&a, &b, changes), 1);
    assert_string_equal(changes[0].a, "a.json");
    assert_string_equal(changes[0].b, "a.json, read again");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_differ_in_nothing),
        cmocka_unit_test(each_choice_is_told_by_its_name),
        cmocka_unit_test(scenes_are_told_by_their_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
