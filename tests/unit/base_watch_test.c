/* Tests the watching of files that are written, replaced, or left alone. */
#include <fcntl.h>
#include <semaphore.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/watch.h"
#include "folder_fixture.h"

static sem_t woken;

static void wake(void *user)
{
    (void)user;
    sem_post(&woken);
}

TEST_IN(changes_are_told_once, folder_begin, folder_end)
{
    struct watch *watch = watch_create(wake);
    assert_non_null(watch);
    put_text("a.json", "1");
    watch_add(watch, in_folder("a.json"), watch_now_ns());
    assert_false(watch_changed(watch));
    put_text("a.json", "2");
    assert_true(watch_changed(watch));
    assert_false(watch_changed(watch));
    put_text("new", "3"); /* as editors do */
    assert_false(watch_changed(watch));
    assert_int_equal(rename(in_folder("new"), in_folder("a.json")), 0);
    assert_true(watch_changed(watch));
    watch_destroy(watch);
}

/* A pause lets the system's coarse clock of files go on. */
static int64_t moment(void)
{
    const struct timespec pause = {.tv_nsec = 50000000};
    nanosleep(&pause, NULL);
    return watch_now_ns();
}

TEST_IN(changes_before_it_was_watched_are_told, folder_begin, folder_end)
{
    struct watch *watch = watch_create(wake);
    put_text("a.json", "1");
    put_text("new", "2");
    int64_t since_ns = moment();
    watch_add(watch, in_folder("a.json"), since_ns);
    watch_add(watch, in_folder("late.json"), since_ns);
    assert_false(watch_changed(watch));
    moment();
    put_text("late.json", "1");
    watch_clear(watch);
    while (sem_trywait(&woken) == 0)
        continue;
    watch_add(watch, in_folder("late.json"), since_ns);
    assert_int_equal(sem_trywait(&woken), 0);
    assert_true(watch_changed(watch));
    assert_false(watch_changed(watch));
    assert_int_equal(rename(in_folder("new"), in_folder("a.json")), 0);
    watch_clear(watch);
    watch_add(watch, in_folder("a.json"), since_ns);
    assert_true(watch_changed(watch));
    watch_add(watch, in_folder("a.json"), moment());
    assert_false(watch_changed(watch));
    watch_destroy(watch);
}

/* The second save comes within the same tick of the clock of files as `since_ns`. */
TEST_IN(changes_that_nobody_was_told_of_survive_a_clear, folder_begin, folder_end)
{
    struct watch *watch = watch_create(wake);
    put_text("a.json", "1");
    put_text("b.json", "1");
    for (int times = 1; times <= 2; ++times) {
        int64_t since_ns = watch_now_ns();
        watch_add(watch, in_folder("a.json"), since_ns);
        assert_false(watch_changed(watch));
        put_text("a.json", "2");
        int64_t after_ns = moment();
        for (int i = 0; i < times; ++i)
            watch_clear(watch);
        watch_add(watch, in_folder("a.json"), after_ns);
        assert_true(watch_changed(watch));
        assert_false(watch_changed(watch));
        put_text("a.json", "3");
        moment();
        watch_clear(watch);
        watch_add(watch, in_folder("b.json"), watch_now_ns()); /* another one */
        assert_false(watch_changed(watch));
        watch_clear(watch);
        watch_add(watch, in_folder("a.json"), watch_now_ns()); /* too late */
        assert_false(watch_changed(watch));
        watch_clear(watch);
    }
    watch_destroy(watch);
}

TEST_IN(who_waits_is_woken, folder_begin, folder_end)
{
    struct timespec until;
    struct watch *watch = watch_create(wake);
    assert_non_null(watch);
    watch_add(watch, in_folder("a.json"), watch_now_ns());
    while (sem_trywait(&woken) == 0)
        continue;
    assert_int_equal(clock_gettime(CLOCK_REALTIME, &until), 0);
    until.tv_sec += 60;
    for (int i = 0; i < 3; ++i) {
        put_text("a.json", "1");
        assert_int_equal(sem_timedwait(&woken, &until), 0);
        assert_true(watch_changed(watch));
    }
    watch_destroy(watch);
}

TEST_IN(others_are_nobodys_business, folder_begin, folder_end)
{
    struct watch *watch = watch_create(wake);
    watch_add(watch, in_folder("a.json"), watch_now_ns());
    put_text("b.json", "1");
    assert_false(watch_changed(watch));
    watch_add(watch, in_folder("b.json"), watch_now_ns());
    put_text("b.json", "2");
    assert_true(watch_changed(watch));
    watch_clear(watch);
    put_text("a.json", "3");
    assert_false(watch_changed(watch));
    watch_add(watch, in_folder("a.json"), watch_now_ns()); /* again, after the folder was let go */
    put_text("a.json", "4");
    assert_true(watch_changed(watch));
    watch_destroy(watch);
}

/* Two files take turns, so that no event is merged with the one before it. */
TEST_IN(more_events_than_there_is_room_for_are_a_change, folder_begin, folder_end)
{
    unsigned room = 0;
    FILE *limit = fopen("/proc/sys/fs/inotify/max_queued_events", "r");
    if (!limit || fscanf(limit, "%u", &room) != 1 || room > 100000)
        skip();
    fclose(limit);
    struct watch *watch = watch_create(wake);
    watch_add(watch, in_folder("a.json"), watch_now_ns());
    for (unsigned i = 0; i < room; ++i)
        assert_int_equal(close(open(in_folder(i % 2 ? "b" : "c"), O_WRONLY | O_CREAT, 0600)), 0);
    put_text("a.json", "1"); /* which gets lost */
    assert_true(watch_changed(watch));
    assert_false(watch_changed(watch));
    watch_destroy(watch);
}

/* As a version control system does when it changes to a version without the folder, and back. */
TEST_IN(folders_that_go_and_come_are_followed, folder_begin, folder_end)
{
    const char *const part = "part", *const deep = "part/deep", *const file = "part/deep/a.glsl";
    struct watch *watch = watch_create(wake);
    watch_add(watch, in_folder(file), watch_now_ns());
    put_text("other", "1");
    assert_false(watch_changed(watch));
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(mkdir(in_folder(part), 0700), 0);
        assert_true(watch_changed(watch));
        put_text("part/other", "1");
        assert_false(watch_changed(watch));
        assert_int_equal(mkdir(in_folder(deep), 0700), 0);
        assert_true(watch_changed(watch));
        put_text(file, "1");
        assert_true(watch_changed(watch));
        assert_int_equal(unlink(in_folder(file)), 0);
        assert_false(watch_changed(watch));
        assert_int_equal(rmdir(in_folder(deep)), 0);
        assert_true(watch_changed(watch));
        assert_int_equal(unlink(in_folder("part/other")), 0);
        assert_int_equal(rmdir(in_folder(part)), 0);
        assert_true(watch_changed(watch));
        assert_false(watch_changed(watch));
    }
    watch_destroy(watch);
}

TEST_IN(folders_that_are_replaced_are_followed, folder_begin, folder_end)
{
    struct watch *watch = watch_create(wake);
    assert_int_equal(mkdir(in_folder("part"), 0700), 0);
    put_text("part/a.glsl", "1");
    watch_add(watch, in_folder("part/a.glsl"), moment());
    assert_false(watch_changed(watch));
    assert_int_equal(rename(in_folder("part"), in_folder("old")), 0);
    assert_true(watch_changed(watch));
    put_text("old/a.glsl", "2"); /* is watched no more */
    assert_false(watch_changed(watch));
    assert_int_equal(mkdir(in_folder("part"), 0700), 0);
    put_text("part/a.glsl", "3"); /* both at once */
    assert_true(watch_changed(watch));
    assert_false(watch_changed(watch));
    put_text("part/a.glsl", "4");
    assert_true(watch_changed(watch));
    watch_destroy(watch);
}

TEST_IN(a_file_in_the_place_of_a_folder_is_followed, folder_begin, folder_end)
{
    struct watch *watch = watch_create(wake);
    put_text("part", "1");
    watch_add(watch, in_folder("part/deep/a.glsl"), moment());
    assert_false(watch_changed(watch));
    put_text("part", "2");
    assert_true(watch_changed(watch));
    assert_int_equal(unlink(in_folder("part")), 0);
    assert_int_equal(mkdir(in_folder("part"), 0700), 0);
    assert_int_equal(mkdir(in_folder("part/deep"), 0700), 0);
    put_text("part/deep/a.glsl", "1");
    assert_true(watch_changed(watch));
    assert_false(watch_changed(watch));
    put_text("part/deep/a.glsl", "2");
    assert_true(watch_changed(watch));
    watch_destroy(watch);
}

TEST_IN(a_link_to_a_folder_that_is_replaced_is_a_change, folder_begin, folder_end)
{
    struct watch *watch = watch_create(wake);
    assert_int_equal(mkdir(in_folder("one"), 0777), 0);
    assert_int_equal(symlink("one", in_folder("link")), 0);
    put_text("one/a.glsl", "1");
    watch_add(watch, in_folder("link/a.glsl"), moment());
    assert_false(watch_changed(watch));
    assert_int_equal(symlink("other", in_folder("new")), 0);
    assert_false(watch_changed(watch));
    assert_int_equal(rename(in_folder("new"), in_folder("link")), 0); /* as `ln -sfn` does */
    assert_true(watch_changed(watch));
    assert_false(watch_changed(watch));
    watch_destroy(watch);
}

TEST(nothing_is_fine)
{
    watch_add(NULL, "a", watch_now_ns());
    watch_clear(NULL);
    assert_false(watch_changed(NULL));
    watch_destroy(NULL);
    struct watch *watch = watch_create(wake);
    watch_add(watch, in_folder("no/such/folder/a.json"), watch_now_ns());
    watch_add(watch, "", watch_now_ns());
    assert_false(watch_changed(watch));
    watch_destroy(watch);
}
