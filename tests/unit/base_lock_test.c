/* Locks on files have one holder at a time, and end with the process that holds them. */
#include "base/lock.h"

#include <signal.h>
#include <sys/wait.h>

#include "base/file.h"
#include "folder_fixture.h"

TEST_IN(one_holder_at_a_time, folder_begin, folder_end)
{
    struct lock mine, other;
    char *path = in_folder("a"), *file = in_folder("a.lock");
    assert_int_equal(lock_take(&warnings_log, path, &mine), LOCK_MINE);
    assert_true(file_exists(file));
    assert_int_equal(lock_take(&warnings_log, path, &other), LOCK_OTHERS);
    lock_give_back(&other); /* holds nothing */
    assert_true(file_exists(file));
    lock_give_back(&mine);
    assert_false(file_exists(file));
    assert_int_equal(lock_take(&warnings_log, path, &other), LOCK_MINE);
    lock_give_back(&other);
    assert_int_equal(messages.count, 0);
}

/* A signal handler that ends the process removes the files of locks that are held, and of no
   others. */
TEST_IN(the_lock_of_a_process_that_ends_is_removed, folder_begin, folder_end)
{
    struct lock lock;
    char *path = in_folder("a"), *file = in_folder("a.lock");
    assert_int_equal(lock_take(&warnings_log, path, &lock), LOCK_MINE);
    file_abandon_all();
    assert_false(file_exists(file));
    lock_give_back(&lock);
    assert_int_equal(lock_take(&warnings_log, path, &lock), LOCK_MINE);
    lock_give_back(&lock);
    put_text("a.lock", "of another process");
    file_abandon_all();
    assert_true(file_exists(file));
}

TEST_IN(the_lock_of_a_killed_process_is_taken_over, folder_begin, folder_end)
{
    struct lock lock;
    char *path = in_folder("a");
    int held[2], status;
    assert_int_equal(pipe(held), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        char byte = lock_take(&warnings_log, path, &lock) == LOCK_MINE;
        ssize_t written = write(held[1], &byte, 1);
        while (written == 1)
            pause();
        _exit(1);
    }
    char byte = 0;
    assert_int_equal(read(held[0], &byte, 1), 1);
    assert_int_equal(byte, 1);
    assert_int_equal(lock_take(&warnings_log, path, &lock), LOCK_OTHERS);
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(file_exists(in_folder("a.lock")));
    assert_int_equal(lock_take(&warnings_log, path, &lock), LOCK_MINE);
    lock_give_back(&lock);
    close(held[0]);
    close(held[1]);
}

TEST_IN(a_folder_that_is_not_there_is_an_error, folder_begin, folder_end)
{
    struct lock lock;
    assert_int_equal(lock_take(&warnings_log, in_folder("none/a"), &lock), LOCK_FAILED);
    lock_give_back(&lock);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last, "none/a.lock: cannot be locked: "));
}
