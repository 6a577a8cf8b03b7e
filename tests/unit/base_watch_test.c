/* Files that are written, replaced, or not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/watch.h"

static char folder[64];

static const char *in_folder(const char *name)
{
    static char path[4][128];
    static int at;
    at = (at + 1) % 4;
    snprintf(path[at], sizeof path[at], "%s/%s", folder, name);
    return path[at];
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(in_folder(name), "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int set_up(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/whit-watch-XXXXXX");
    return mkdtemp(folder) ? 0 : 1;
}

static int tear_down(void **state)
{
    (void)state;
    static const char *const names[] = {"a.json", "b.json", "new"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        unlink(in_folder(names[i]));
    return rmdir(folder);
}

static void changes_are_told_once(void **state)
{
    (void)state;
    struct watch *watch = watch_create();
    assert_non_null(watch);
    write_file("a.json", "1");
    watch_add(watch, in_folder("a.json"));
    assert_false(watch_changed(watch));
    write_file("a.json", "2");
    assert_true(watch_changed(watch));
    assert_false(watch_changed(watch));
    write_file("new", "3"); /* as editors do */
    assert_false(watch_changed(watch));
    assert_int_equal(rename(in_folder("new"), in_folder("a.json")), 0);
    assert_true(watch_changed(watch));
    watch_destroy(watch);
}

static void others_are_nobodys_business(void **state)
{
    (void)state;
    struct watch *watch = watch_create();
    watch_add(watch, in_folder("a.json"));
    write_file("b.json", "1");
    assert_false(watch_changed(watch));
    watch_add(watch, in_folder("b.json"));
    write_file("b.json", "2");
    assert_true(watch_changed(watch));
    watch_clear(watch);
    write_file("a.json", "3");
    assert_false(watch_changed(watch));
    watch_add(watch, in_folder("a.json")); /* again, after the folder was let go */
    write_file("a.json", "4");
    assert_true(watch_changed(watch));
    watch_destroy(watch);
}

static void nothing_is_fine(void **state)
{
    (void)state;
    watch_add(NULL, "a");
    watch_clear(NULL);
    assert_false(watch_changed(NULL));
    watch_destroy(NULL);
    struct watch *watch = watch_create();
    watch_add(watch, in_folder("no/such/folder/a.json"));
    assert_false(watch_changed(watch));
    watch_destroy(watch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(changes_are_told_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(others_are_nobodys_business, set_up, tear_down),
        cmocka_unit_test(nothing_is_fine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
