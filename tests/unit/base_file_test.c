#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../wrapped.h"
#include "base/array.h"
#include "base/file.h"
#include "folder_fixture.h"

static uint32_t folders_opened;

WRAPPED(DIR *, opendir, const char *path)
{
    ++folders_opened;
    return __real_opendir(path);
}

/* A log that takes messages of all levels. */
static const whit_log full_log = {
    .fn = messages_collect, .user = &messages, .level = WHIT_LOG_DEBUG};

static int entry_count(void)
{
    int count = 0;
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(dir);
    return count;
}

static void put(const char *path, const char *text)
{
    struct file_write file;
    assert_int_equal(file_write_begin(NULL, path, &file), WHIT_OK);
    fputs(text, file.stream);
    assert_int_equal(file_write_commit(NULL, &file), WHIT_OK);
}

static void assert_content(const char *path, const char *text)
{
    own_memory uint8_t *data = NULL;
    size_t size_bytes;
    assert_int_equal(file_read(NULL, NULL, path, 0, &data, &size_bytes), WHIT_OK);
    assert_int_equal(size_bytes, strlen(text));
    assert_string_equal((char *)data, text);
}

TEST_IN(commit_replaces_at_once, folder_begin, folder_end)
{
    char *path = in_folder("a.txt");
    put(path, "old");
    chmod(path, 0640);
    struct file_write file;
    assert_int_equal(file_write_begin(NULL, path, &file), WHIT_OK);
    fputs("new and longer", file.stream);
    fflush(file.stream);
    assert_content(path, "old");
    assert_int_equal(entry_count(), 2);
    assert_int_equal(path_name(file.temporary_path)[0], '.');
    assert_int_equal(file_write_commit(NULL, &file), WHIT_OK);
    assert_content(path, "new and longer");
    assert_int_equal(entry_count(), 1);
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
}

TEST_IN(abandon_leaves_the_old_file, folder_begin, folder_end)
{
    char *path = in_folder("a.txt");
    put(path, "old");
    struct file_write file;
    assert_int_equal(file_write_begin(NULL, path, &file), WHIT_OK);
    fputs("half", file.stream);
    file_write_abandon(&file);
    assert_content(path, "old");
    assert_int_equal(entry_count(), 1);
    file_write_abandon(&file);
    assert_int_equal(file_write_commit(NULL, &file), WHIT_OK);
    file_write_abandon(NULL);
}

TEST_IN(abandon_all_removes_every_open_file, folder_begin, folder_end)
{
    char *path = in_folder("a.txt");
    struct file_write first, second;
    assert_int_equal(file_write_begin(NULL, path, &first), WHIT_OK);
    assert_int_equal(file_write_begin(NULL, path, &second), WHIT_OK);
    assert_string_not_equal(first.temporary_path, second.temporary_path);
    assert_int_equal(entry_count(), 2);
    file_abandon_all();
    assert_int_equal(entry_count(), 0);
    assert_int_equal(file_write_commit(&full_log, &first), WHIT_ERROR_OUTPUT);
    assert_int_equal(messages.count, 1);
    file_write_abandon(&second);
    assert_int_equal(entry_count(), 0);
}

TEST_IN(write_failures_name_path_and_reason, folder_begin, folder_end)
{
    struct file_write file;
    char *path = in_folder("none/a.txt");
    assert_int_equal(file_write_begin(&full_log, path, &file), WHIT_ERROR_OUTPUT);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.last, path));
    assert_non_null(strstr(messages.last, strerror(ENOENT)));
    assert_null(file.stream);
    assert_int_equal(file_write_begin(&full_log, folder, &file), WHIT_ERROR_OUTPUT);
    assert_non_null(strstr(messages.last, strerror(EISDIR)));
    assert_int_equal(file_write_begin(&full_log, "/dev/full", &file), WHIT_OK);
    fputs("text", file.stream);
    assert_int_equal(file_write_commit(&full_log, &file), WHIT_ERROR_OUTPUT);
    assert_non_null(strstr(messages.last, strerror(ENOSPC)));
    assert_int_equal(entry_count(), 0);
}

TEST_IN(links_pipes_and_long_names, folder_begin, folder_end)
{
    char *path = in_folder("target"), *link_path = in_folder("link"), *pipe_path = in_folder("p");
    put(path, "old");
    assert_int_equal(symlink("target", link_path), 0);
    put(link_path, "through");
    assert_content(path, "through");
    struct stat info;
    assert_int_equal(lstat(link_path, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(unlink(path), 0);
    put(link_path, "again"); /* its target is not there */
    assert_content(path, "again");
    assert_int_equal(lstat(link_path, &info), 0);
    assert_true(S_ISLNK(info.st_mode));

    struct file_write file;
    char gone[32];
    int fd = open(path, O_WRONLY);
    snprintf(gone, sizeof gone, "/dev/fd/%d", fd);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(file_write_begin(NULL, gone, &file), WHIT_ERROR_OUTPUT);
    close(fd);

    assert_int_equal(mkfifo(pipe_path, 0600), 0);
    fd = open(pipe_path, O_RDONLY | O_NONBLOCK);
    put(pipe_path, "piped");
    char text[8] = "";
    assert_int_equal(read(fd, text, 7), 5);
    assert_string_equal(text, "piped");
    close(fd);
    assert_int_equal(lstat(pipe_path, &info), 0);
    assert_true(S_ISFIFO(info.st_mode));

    char name[256];
    memset(name, 'n', 255);
    name[255] = 0;
    char *longest = in_folder(name);
    put(longest, "x");
    assert_content(longest, "x");
}

TEST_IN(read_refuses_with_one_message, folder_begin, folder_end)
{
    char *path = in_folder("a.txt"), *pipe_path = in_folder("p"), *missing = in_folder("m");
    put(path, "0123456789");
    mkfifo(pipe_path, 0600);
    uint8_t *data;
    size_t size_bytes;
    const struct {
        const char *path;
        uint64_t limit_bytes;
        const char *reason;
    } cases[] = {{path, 9, "limit"},
                 {folder, 0, "folder"},
                 {pipe_path, 0, "pipe"},
                 {"/dev/zero", 0, "device"},
                 {missing, 0, "no such file"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        messages = (struct messages){0};
        assert_int_equal(
            file_read(&full_log, NULL, cases[i].path, cases[i].limit_bytes, &data, &size_bytes),
            WHIT_ERROR_INPUT);
        assert_null(data);
        assert_int_equal(messages.count, 1);
        assert_non_null(strstr(messages.last, cases[i].path));
        assert_non_null(strstr(messages.last, cases[i].reason));
    }
    assert_int_equal(file_read(&full_log, NULL, path, 10, &data, &size_bytes), WHIT_OK);
    assert_int_equal(data[size_bytes], 0);
    free(data);
}

/* The id of a process that has ended. */
static pid_t ended_process(void)
{
    pid_t pid = fork();
    if (pid == 0)
        _exit(0);
    assert_int_equal(waitpid(pid, NULL, 0), pid);
    return pid;
}

static bool is_there(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0;
}

/* Writes a file with the name of an unfinished a.txt of process `writer`; `end`: end of that
   name. */
static char *leave(pid_t writer, const char *end, const char *text)
{
    char *path = string_format("%s/.a.txt.%ld%s.tmp", folder, (long)writer, end);
    put_file(path, text, strlen(text)); /* not beside and renamed, as put() does */
    return path;
}

TEST_IN(files_of_killed_runs_are_swept, folder_begin, folder_end)
{
    pid_t gone = ended_process();
    char *path = in_folder("a.txt");
    char *swept[] = {leave(gone, "", "half"), leave(gone, ".3", ""), leave(getpid(), "", "before")};
    put(path, "whole");
    for (size_t i = 0; i < sizeof swept / sizeof *swept; ++i) {
        assert_false(is_there(swept[i]));
        free(swept[i]);
    }
    assert_content(path, "whole");
    assert_int_equal(entry_count(), 1);
}

/* A write into a folder of many files takes no longer than one into a small folder: the folder is
   listed for a few writes together, and what a killed run left is swept all the same. */
TEST_IN(a_large_folder_is_not_listed_for_each_write, folder_begin, folder_end)
{
    enum { FILES = 2500, WRITES = 8 };
    char name[16], *left = leave(ended_process(), "", "half");
    for (int i = 0; i < FILES; ++i) {
        snprintf(name, sizeof name, "%d", i);
        put_text(name, "");
    }
    folders_opened = 0;
    for (int i = 0; i < WRITES; ++i) {
        snprintf(name, sizeof name, "b%d", i);
        put(in_folder(name), "x");
    }
    put(in_folder("a.txt"), "whole");
    assert_int_equal(folders_opened, 3);
    assert_false(is_there(left));
    free(left);
}

/* Files are left alone where the process that made them still runs, where their names are of
   another form or of another file, where they are another user's or locked, and where they are no
   regular files. */
TEST_IN(nothing_else_is_swept, folder_begin, folder_end)
{
    pid_t gone = ended_process();
    char *path = in_folder("a.txt");
    char *others[] = {leave(getppid(), "", "x"),
                      leave(gone, ".x", "x"),
                      leave(gone, "x", "x"),
                      leave(gone, ".5", "locked"),
                      leave(gone, ".6", "of another user"),
                      string_format("%s/.a.txt.%ld.7.tmp", folder, (long)gone),
                      string_format("%s/.a.txt.%ld.8.tmp", folder, (long)gone),
                      string_format("%s/.b.txt.%ld.tmp", folder, (long)gone),
                      string_format("%s/a.txt.%ld.tmp", folder, (long)gone)};
    enum { LOCKED = 3, FOREIGN, LINK, PIPE, NAMED, COUNT = sizeof others / sizeof *others };
    int lock = open(others[LOCKED], O_RDONLY);
    assert_int_equal(flock(lock, LOCK_EX), 0);
    bool has_foreign = chown(others[FOREIGN], 65534, (gid_t)-1) == 0; /* root only */
    assert_int_equal(symlink("target", others[LINK]), 0);
    assert_int_equal(mkfifo(others[PIPE], 0600), 0);
    for (int i = NAMED; i < COUNT; ++i)
        put_file(others[i], "x", 1);
    put(path, "whole");
    for (int i = 0; i < COUNT; ++i) {
        if (i != FOREIGN || has_foreign)
            assert_true(is_there(others[i]));
        free(others[i]);
    }
    close(lock);
}

/* Two writers begin before either ends, in one process and in two. */
TEST_IN(two_writers_of_one_file, folder_begin, folder_end)
{
    static const char *const texts[] = {"first", "second"};
    char *path = in_folder("a.txt");
    struct file_write files[2];
    for (int last = 0; last < 2; ++last) {
        for (int i = 0; i < 2; ++i) {
            assert_int_equal(file_write_begin(NULL, path, &files[i]), WHIT_OK);
            fputs(texts[i], files[i].stream);
        }
        assert_int_equal(file_write_commit(NULL, &files[!last]), WHIT_OK);
        assert_content(path, texts[!last]);
        assert_int_equal(file_write_commit(NULL, &files[last]), WHIT_OK);
        assert_content(path, texts[last]);
        assert_int_equal(entry_count(), 1);
    }
    int status;
    assert_int_equal(file_write_begin(NULL, path, &files[0]), WHIT_OK);
    pid_t pid = fork();
    if (pid == 0) {
        put(path, "other");
        _exit(0);
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_content(path, "other");
    fputs("mine", files[0].stream);
    assert_int_equal(file_write_commit(NULL, &files[0]), WHIT_OK);
    assert_content(path, "mine");
    assert_int_equal(entry_count(), 1);
}

TEST(paths)
{
    const struct {
        const char *path, *folder, *name, *extension;
    } cases[] = {{"a/b.PNG", "a/", "b.PNG", "png"},          {"b", "", "b", ""},
                 {"/x.tar.gz", "/", "x.tar.gz", "gz"},       {"a.d/.exr", "a.d/", ".exr", ""},
                 {"x.verylongone", "", "x.verylongone", ""}, {"a/", "a/", "", ""}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char *got = path_folder(cases[i].path);
        assert_string_equal(got, cases[i].folder);
        free(got);
        assert_string_equal(path_name(cases[i].path), cases[i].name);
        char extension[8];
        path_extension(cases[i].path, extension, sizeof extension);
        assert_string_equal(extension, cases[i].extension);
    }
    assert_true(path_is("a/b.EXR", "exr"));
    assert_true(path_is("exr", ""));
    assert_false(path_is("a/.exr", "exr"));
    assert_false(path_is("exr", "exr"));
    assert_false(path_is("a.exr/b", "exr"));
    assert_false(path_is("b.exrs", "exr"));
    char *beside = path_beside("scenes/a.json", "models/b.obj");
    assert_string_equal(beside, "scenes/models/b.obj");
    free(beside);
    beside = path_beside("scenes/a.json", "/b.obj");
    assert_string_equal(beside, "/b.obj");
    free(beside);
}
