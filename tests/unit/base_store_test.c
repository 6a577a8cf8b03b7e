/* Tests the cache of files between runs, and what it does about damaged or foreign files. */
#include <errno.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>

#include "../wrapped.h"
#include "base/array.h"
#include "base/store.h"
#include "folder_fixture.h"

static char kept_in[80]; /* whit's folder below XDG_CACHE_HOME, which is this test's folder */
/* Owner that fstat gives from call `foreign_from` on; 0: the real one. */
static uid_t owner_of_next;
static int foreign_from;
static int64_t disk_bytes = -1; /* free bytes on the simulated disk; < 0: enough */
static pid_t dies_at_write;     /* id of a process that ends in its next large write */
static int opened;              /* how often a file named "a" was opened to be read */

WRAPPED(int, openat, int at, const char *name, int flags, ...)
{
    va_list args;
    va_start(args, flags);
    mode_t mode = flags & O_CREAT ? va_arg(args, mode_t) : 0;
    va_end(args);
    opened += strcmp(name, "a") == 0;
    return __real_openat(at, name, flags, mode);
}

WRAPPED(int, fstat, int fd, struct stat *info)
{
    int result = __real_fstat(fd, info);
    if (foreign_from && --foreign_from == 0) {
        info->st_uid = owner_of_next;
        foreign_from = 1;
    }
    return result;
}

WRAPPED(ssize_t, write, int fd, const void *data, size_t bytes)
{
    if (dies_at_write == getpid() && bytes > 100) {
        (void)!__real_write(fd, data, bytes / 2);
        _exit(9);
    }
    if (disk_bytes < 0)
        return __real_write(fd, data, bytes);
    if (disk_bytes == 0) {
        errno = ENOSPC;
        return -1;
    }
    size_t now = bytes < (size_t)disk_bytes ? bytes : (size_t)disk_bytes;
    disk_bytes -= (int64_t)now;
    return __real_write(fd, data, now);
}

static char *path_of(const char *name)
{
    char inner[128];
    snprintf(inner, sizeof inner, "whit/%s", name);
    return in_folder(inner);
}

static bool exists(const char *name)
{
    struct stat info;
    return lstat(path_of(name), &info) == 0;
}

/* A log without output; tests that expect messages use another one. */
static const whit_log silent;
enum { BYTES = 1000 };

static void keep(const char *name, int seed)
{
    uint8_t data[BYTES];
    for (int i = 0; i < BYTES; ++i)
        data[i] = (uint8_t)(seed + i);
    store_write(&silent, name, data, BYTES);
}

/* Whether the file is kept; what is read must be what was written. */
static bool is_kept(const char *name, int seed)
{
    own_memory uint8_t *data = NULL;
    size_t bytes = 0;
    bool found = store_read(&silent, name, &data, &bytes);
    assert_true(found == (data != NULL));
    if (found) {
        assert_int_equal(bytes, BYTES);
        for (int i = 0; i < BYTES; ++i)
            assert_int_equal(data[i], (uint8_t)(seed + i));
        assert_int_equal(data[BYTES], 0);
    }
    return found;
}

static void set_age(const char *name, time_t days)
{
    const struct timespec times[2] = {{.tv_nsec = UTIME_OMIT}, {.tv_sec = 86400 * (9999 - days)}};
    assert_int_equal(utimensat(AT_FDCWD, path_of(name), times, AT_SYMLINK_NOFOLLOW), 0);
}

static int begin(void **state)
{
    int result = folder_begin(state);
    snprintf(kept_in, sizeof kept_in, "%s/whit", folder);
    setenv("XDG_CACHE_HOME", folder, 1);
    unsetenv("WHIT_NO_CACHE");
    unsetenv("WHIT_CACHE_LIMIT");
    foreign_from = 0;
    disk_bytes = -1;
    return result;
}

TEST_IN(what_is_kept_is_read, begin, folder_end)
{
    struct stat info;
    assert_false(is_kept("a", 1));
    keep("a", 1);
    keep("b", 2);
    assert_true(is_kept("a", 1) && is_kept("b", 2));
    keep("a", 3);
    assert_true(is_kept("a", 3));
    assert_int_equal(stat(kept_in, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0700);
    assert_int_equal(stat(path_of("a"), &info), 0);
    assert_int_equal(info.st_mode & 0777, 0600);
    store_write(&silent, "empty", "", 0);
    own_memory uint8_t *data = NULL;
    size_t bytes;
    assert_true(store_read(&silent, "empty", &data, &bytes));
    assert_int_equal(bytes, 0);
}

/* Damage: any byte flipped, any length, payload of zeros, another version, another file's
   content. */
TEST_IN(damage_is_thrown_away, begin, folder_end)
{
    uint8_t good[2 * BYTES], bad[2 * BYTES] = {0};
    keep("a", 1);
    FILE *file = fopen(path_of("a"), "rb");
    assert_non_null(file);
    size_t bytes = fread(good, 1, sizeof good, file);
    fclose(file);
    assert_int_equal(bytes, BYTES + 24);
    for (size_t i = 0; i < bytes; i += i < 40 ? 1 : 97) {
        memcpy(bad, good, bytes);
        bad[i] ^= (uint8_t)(1 << i % 8);
        put_file(path_of("a"), bad, bytes);
        assert_false(is_kept("a", 1));
        assert_false(exists("a"));
    }
    memcpy(bad, good, bytes);
    for (size_t i = 0; i <= bytes + 8; i += i < 40 ? 1 : 8) {
        put_file(path_of("a"), bad, i);
        assert_true(is_kept("a", 1) == (i == bytes));
    }
    memset(bad + 24, 0, BYTES);
    put_file(path_of("a"), bad, bytes);
    assert_false(is_kept("a", 1));
    memcpy(bad, good, bytes);
    bad[7] = '0';
    put_file(path_of("a"), bad, bytes);
    assert_false(is_kept("a", 1));
    put_file(path_of("b"), good, bytes);
    assert_false(is_kept("b", 1));
    put_file(path_of("a"), good, bytes);
    assert_true(is_kept("a", 1));
}

/* What may stand in the place of a file of ours. Only root makes devices: others get a link to one.
 */
enum entry { LINK, NOWHERE, SECOND_NAME, PIPE, FOLDER, SOCKET, DEVICE, WRITABLE, ENTRIES };

static int put_socket(const char *path)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    snprintf(address.sun_path, sizeof address.sun_path, "%.100s", path);
    int fd = socket(AF_UNIX, SOCK_STREAM, 0);
    int result = bind(fd, (struct sockaddr *)&address, sizeof address);
    close(fd);
    return result;
}

static int put_entry(enum entry entry, const char *path)
{
    switch (entry) {
    case LINK:
        return symlink(in_folder("target"), path);
    case NOWHERE:
        return symlink("/nowhere/at-all", path);
    case SECOND_NAME:
        return link(in_folder("target"), path);
    case PIPE:
        return mkfifo(path, 0600);
    case FOLDER:
        return mkdir(path, 0700);
    case SOCKET:
        return put_socket(path);
    case DEVICE: /* /dev/zero */
        return mknod(path, S_IFCHR | 0600, (1 << 8) | 5) && symlink("/dev/zero", path);
    default:
        keep("a", 1);
        return chmod(path, 0622);
    }
}

/* Entries that are no regular files of this user are neither opened nor followed; they are removed,
   and a file can be kept in their place. */
TEST_IN(what_is_no_file_of_ours_is_thrown_away, begin, folder_end)
{
    char text[2 * BYTES];
    struct stat info;
    keep("a", 1); /* links lead to a valid file, which would be accepted */
    assert_int_equal(rename(path_of("a"), in_folder("target")), 0);
    for (enum entry i = 0; i < ENTRIES; ++i) {
        assert_int_equal(put_entry(i, path_of("a")), 0);
        opened = 0;
        assert_false(is_kept("a", 1));
        assert_int_equal(opened, 0);
        assert_false(exists("a"));
        if (i == FOLDER)
            continue;
        assert_int_equal(put_entry(i, path_of("a")), 0);
        keep("a", 2);
        assert_true(is_kept("a", 2));
        assert_int_equal(lstat(path_of("a"), &info), 0);
        assert_true(S_ISREG(info.st_mode));
        assert_int_equal(unlink(path_of("a")), 0);
    }
    FILE *file = fopen(in_folder("target"), "rb");
    assert_non_null(file);
    assert_int_equal(fread(text, 1, sizeof text, file), BYTES + 24);
    assert_int_equal((uint8_t)text[24], 1);
    fclose(file);
}

TEST_IN(files_of_others_are_thrown_away, begin, folder_end)
{
    keep("a", 1);
    owner_of_next = geteuid() + 1;
    foreign_from = 2; /* the first call of fstat is for the folder */
    assert_false(is_kept("a", 1));
    foreign_from = 0;
    assert_false(exists("a"));
}

static bool store_is_used(void)
{
    uint8_t *data;
    size_t bytes;
    messages = (struct messages){0};
    store_write(&warnings_log, "used", "x", 1);
    bool found = store_read(&warnings_log, "used", &data, &bytes);
    free(data);
    return found;
}

/* A folder of another user is not used, which is logged once per process. */
TEST_IN(folders_of_others_are_not_used, begin, folder_end)
{
    struct store_info info;
    struct stat about;
    owner_of_next = geteuid() + 1;
    assert_true(store_is_used());
    foreign_from = 1;
    assert_false(is_kept("used", 0));
    foreign_from = 1;
    assert_false(store_is_used());
    assert_int_equal(messages.warnings, 1);
    assert_non_null(strstr(messages.last, "belongs to somebody else"));
    assert_non_null(strstr(messages.last, kept_in));
    foreign_from = 0;
    for (mode_t write = 020; write; write = write == 020 ? 002 : 0) {
        assert_int_equal(chmod(kept_in, 0700 | write), 0);
        assert_false(store_is_used());
        assert_int_equal(messages.count, 0);
        store_get_info(&info);
        assert_string_equal(info.why_not, "others may write to it");
        assert_string_equal(info.folder, kept_in);
        assert_null(store_folder(&silent));
    }
    assert_int_equal(chmod(kept_in, 0755), 0); /* readable by others: whit changes that */
    assert_true(store_is_used());
    assert_int_equal(messages.count, 0);
    assert_int_equal(stat(kept_in, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0700);
}

/* Without a place for the cache whit works silently without one: no such variable, a file or a link
   in place of the folder, a missing parent, WHIT_NO_CACHE. */
TEST_IN(without_a_folder_nothing_is_kept, begin, folder_end)
{
    assert_int_equal(mkdir(in_folder("other"), 0700), 0);
    for (int i = 0; i < 5; ++i) {
        if (i == 0)
            assert_int_equal(symlink(in_folder("other"), kept_in), 0);
        if (i == 1)
            assert_int_equal(close(open(kept_in, O_WRONLY | O_CREAT, 0600)), 0);
        if (i == 2)
            setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
        if (i == 3)
            setenv("XDG_CACHE_HOME", "relative", 1);
        if (i == 4)
            unsetenv("XDG_CACHE_HOME");
        if (i >= 3)
            unsetenv("HOME");
        assert_false(store_is_used());
        assert_int_equal(messages.count, 0);
        assert_null(store_folder(&silent));
        struct store_info info;
        store_get_info(&info);
        assert_true(info.why_not[0] != '\0');
        if (i < 2)
            assert_int_equal(unlink(kept_in), 0);
    }
    assert_int_equal(rmdir(in_folder("other")), 0); /* nothing came into it */
    setenv("HOME", folder, 1);
    assert_true(store_is_used()); /* below ~/.cache */
    assert_int_equal(access(in_folder(".cache/whit/used"), R_OK), 0);
    setenv("XDG_CACHE_HOME", folder, 1);
    setenv("WHIT_NO_CACHE", "1", 1);
    assert_false(store_is_used());
    assert_int_not_equal(access(kept_in, F_OK), 0);
    setenv("WHIT_NO_CACHE", "0", 1);
    assert_true(store_is_used());
    setenv("WHIT_NO_CACHE", "1", 1);
    assert_false(is_kept("used", 0));
    keep("a", 1);
    assert_false(exists("a"));
}

static uint64_t used_bytes(void)
{
    struct store_info info;
    store_get_info(&info);
    return info.used_bytes;
}

/* Tries disks with room for each length of a partial file. */
TEST_IN(full_disks_leave_nothing_half, begin, folder_end)
{
    keep("a", 1);
    for (int64_t left = 0; left < BYTES + 24; left += left < 30 ? 1 : 100) {
        disk_bytes = left;
        keep("a", 2);
        disk_bytes = left;
        keep("b", 2);
        disk_bytes = -1;
        assert_true(is_kept("a", 1));
        assert_false(is_kept("b", 2));
        assert_int_equal(used_bytes(), BYTES + 24);
    }
}

static pid_t run_apart(void (*work)(void))
{
    pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) {
        work();
        _exit(0);
    }
    return pid;
}

static void die_writing(void)
{
    dies_at_write = getpid();
    keep("a", 2);
}

/* The next writer removes the unfinished files of a killed writer, but not those of a running
   one. */
TEST_IN(killed_writers_leave_nothing_half, begin, folder_end)
{
    int status;
    char name[64];
    keep("a", 1);
    pid_t pid = run_apart(die_writing);
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_int_equal(WEXITSTATUS(status), 9);
    snprintf(name, sizeof name, ".a.%ld.tmp", (long)pid); /* a name by an older whit */
    put_file(path_of(name), "x", 1);
    snprintf(name, sizeof name, ".a.%ld.99999999.tmp", (long)getpid());
    put_file(path_of(name), "x", 1);
    assert_true(is_kept("a", 1));
    keep("b", 2);
    assert_int_equal(used_bytes(), 2 * (BYTES + 24) + 1);
    assert_true(exists(name));
    assert_true(is_kept("a", 1) && is_kept("b", 2));
}

static void write_often(void)
{
    for (int i = 0; i < 50; ++i)
        keep("a", i);
}

TEST_IN(two_writers_do_no_harm, begin, folder_end)
{
    int status;
    pid_t pid = run_apart(write_often);
    uint8_t *data;
    size_t bytes;
    for (int i = 0; i < 50; ++i) {
        keep("a", 100 + i);
        assert_true(store_read(&silent, "a", &data, &bytes)); /* complete, by either writer */
        assert_int_equal(bytes, BYTES);
        free(data);
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_int_equal(status, 0);
    assert_int_equal(used_bytes(), BYTES + 24);
}

/* Makes a sparse file of this size and age. */
static void put_large(const char *name, off_t bytes, time_t days)
{
    assert_int_equal(close(open(path_of(name), O_WRONLY | O_CREAT, 0600)), 0);
    assert_int_equal(truncate(path_of(name), bytes), 0);
    set_age(name, days);
}

TEST_IN(the_oldest_go_first, begin, folder_end)
{
    const off_t mib = 1 << 20;
    keep("used", 1);
    keep("idle", 2);
    set_age("used", 4);
    set_age("idle", 3);
    put_large("large", 511 * mib, 2);
    keep("a", 3);
    assert_true(exists("used") && exists("idle") && exists("large"));
    assert_true(is_kept("used", 1)); /* counts as new from now on */
    put_large("half", mib - 2 * BYTES, 1);
    keep("b", 4);
    assert_true(exists("used") && exists("a") && exists("b"));
    assert_false(exists("idle"));
    assert_false(exists("large"));
    setenv("WHIT_CACHE_LIMIT", "1", 1);
    put_large("half", mib - BYTES, 1);
    keep("c", 5);
    assert_false(exists("half"));
    assert_true(is_kept("c", 5));
    uint8_t *much = array_alloc_zeroed(2 << 20, 1);
    store_write(&silent, "much", much, 2 << 20);
    free(much);
    assert_false(exists("much"));
    assert_true(is_kept("c", 5));
    setenv("WHIT_CACHE_LIMIT", "all", 1);
    struct store_info info;
    store_get_info(&info);
    assert_int_equal(info.limit_bytes, 512 * mib);
}
