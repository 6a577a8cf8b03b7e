#include "base/file.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/input.h"
#include "base/platform.h"

/* Paths of unfinished files, and of locks that are held. Code that takes a pointer out of its slot
   owns it, so that the signal handler never reads a string that another thread frees. Slot numbers
   start at 1. */
enum { SLOT_COUNT = 64, NAME_KEPT = 200 }; /* NAME_MAX is 255 */
static _Atomic(char *) unfinished[SLOT_COUNT];
static char *abandoned[SLOT_COUNT]; /* not freed: signal handlers may not call free() */
/* Held while a file is begun and while a slot is given back, so that slots' paths can be read. */
static pthread_mutex_t begin_lock = PTHREAD_MUTEX_INITIALIZER;

int file_slot_take(const char *path)
{
    char *copy = string_copy(path);
    if (!copy)
        return 0;
    for (int i = 0; i < SLOT_COUNT; ++i) {
        char *empty = NULL;
        if (atomic_compare_exchange_strong(&unfinished[i], &empty, copy))
            return i + 1;
    }
    free(copy);
    return 0;
}

/* Frees the slot of an unfinished file. The caller holds begin_lock. */
static void slot_free(int slot)
{
    if (slot > 0)
        free(atomic_exchange(&unfinished[slot - 1], NULL));
}

void file_slot_give_back(int slot)
{
    pthread_mutex_lock(&begin_lock);
    slot_free(slot);
    pthread_mutex_unlock(&begin_lock);
}

void file_abandon_all(void)
{
    for (int i = 0; i < SLOT_COUNT; ++i) {
        char *path = atomic_exchange(&unfinished[i], NULL);
        if (!path)
            continue;
        unlink(path);
        abandoned[i] = path;
    }
}

static whit_result check_readable(const whit_log *log, const char *path, int fd,
                                  uint64_t limit_bytes, size_t *size_bytes)
{
    struct stat info;
    if (fstat(fd, &info) != 0)
        return log_failure(log, WHIT_ERROR_INPUT, "%s: cannot read: %s", path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return log_failure(log, WHIT_ERROR_INPUT, "%s: %s", path, reach_words(REACH_NOT_A_FILE));
    if (limit_bytes && (uint64_t)info.st_size > limit_bytes)
        return log_failure(log, WHIT_ERROR_INPUT, "%s: %llu bytes, over the limit of %llu", path,
                           (unsigned long long)info.st_size, (unsigned long long)limit_bytes);
    *size_bytes = (size_t)info.st_size;
    return WHIT_OK;
}

/* Reads an open file of at most *size_bytes, which becomes its size. *data is there where that
   fails, too. */
static whit_result read_whole(const whit_log *log, const char *path, int fd, uint8_t **data,
                              size_t *size_bytes)
{
    *data = array_alloc(*size_bytes + 1, 1);
    if (!*data)
        return log_failure(log, WHIT_ERROR_MEMORY, "%s: no memory for its %zu bytes", path,
                           *size_bytes);
    ssize_t got = platform_read(fd, *data, *size_bytes);
    if (got < 0)
        return log_failure(log, WHIT_ERROR_INPUT, "%s: cannot read: %s", path, strerror(errno));
    (*data)[got] = 0;
    *size_bytes = (size_t)got;
    return WHIT_OK;
}

static whit_result copy_input(const whit_log *log, uint8_t **data, size_t *size_bytes)
{
    const uint8_t *input;
    whit_result result = input_read(log, &input, size_bytes);
    if (result != WHIT_OK)
        return result;
    *data = array_copy(input, *size_bytes + 1, 1);
    return *data ? WHIT_OK
                 : log_failure(log, WHIT_ERROR_MEMORY,
                               "standard input: no memory for its %zu bytes", *size_bytes);
}

whit_result file_read(const whit_log *log, const struct roots *roots, const char *path,
                      uint64_t limit_bytes, uint8_t **data, size_t *size_bytes)
{
    *data = NULL;
    *size_bytes = 0;
    if (roots_is_input(roots, path))
        return copy_input(log, data, size_bytes);
    enum reach reach;
    int fd = roots_open(roots, path, &reach);
    if (fd < 0)
        return log_failure(log, WHIT_ERROR_INPUT, "%s: %s", path, reach_words(reach));
    whit_result result = check_readable(log, path, fd, limit_bytes, size_bytes);
    if (result == WHIT_OK)
        result = read_whole(log, path, fd, data, size_bytes);
    close(fd);
    if (result != WHIT_OK) {
        free(*data);
        *data = NULL;
        *size_bytes = 0;
    }
    return result;
}

FILE *file_open(const char *path, const char **why)
{
    enum reach reach;
    int fd = roots_open(NULL, path, &reach);
    FILE *from = fd < 0 ? NULL : fdopen(fd, "r");
    *why = reach == REACH_NOT_A_FILE ? reach_words(reach) : strerror(errno);
    if (fd >= 0 && !from)
        close(fd);
    return from;
}

/* The process that writes an unfinished file for `target`, by the file's name as open_sibling makes
   it; 0 where `name` is no such name. */
static pid_t writer_of(const char *name, const char *target)
{
    size_t length = strnlen(target, NAME_KEPT);
    if (name[0] != '.' || strncmp(name + 1, target, length) != 0 || name[length + 1] != '.' ||
        !isdigit((unsigned char)name[length + 2]))
        return 0;
    char *rest;
    long pid = strtol(name + length + 2, &rest, 10);
    if (rest[0] == '.' && isdigit((unsigned char)rest[1]))
        (void)strtol(rest + 1, &rest, 10);
    return strcmp(rest, ".tmp") == 0 && pid > 0 && pid <= INT_MAX ? (pid_t)pid : 0;
}

/* Whether the writer of file `name` still runs. Files with this process's own number may be left by
   an earlier process of that number: only those in slots are ours. */
static bool is_alive(pid_t writer, const char *name)
{
    if (writer != getpid())
        return kill(writer, 0) == 0 || errno != ESRCH;
    for (int i = 0; i < SLOT_COUNT; ++i) {
        const char *path = atomic_load(&unfinished[i]);
        if (path && strcmp(path_name(path), name) == 0)
            return true;
    }
    return false;
}

/* Removes a file whose writer was killed before it finished. A writer holds a lock on its file,
   which also shows writers in other containers, whose process numbers mean nothing here. */
static void remove_left(const char *path)
{
    struct stat info;
    if (lstat(path, &info) != 0 || !S_ISREG(info.st_mode) || info.st_uid != geteuid())
        return;
    int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) == 0)
        unlink(path);
    if (fd >= 0)
        close(fd);
}

/* The hidden files of a folder that may be unfinished. A folder is listed anew after as many writes
   as it has thousands of entries, so that the time of a write does not grow with them; at each
   write where more hidden files are there than are kept. */
enum { LISTINGS = 4, ENTRIES_A_WRITE = 1000, HIDDEN_KEPT = 8 };
struct listing {
    uint64_t folder; /* hash of its path */
    uint64_t entries, writes;
    uint32_t count;
    char hidden[HIDDEN_KEPT][NAME_MAX + 1];
};
static struct listing listings[LISTINGS]; /* guarded by begin_lock */

/* Removes `name` if it is an unfinished file for `target` that a killed run left. */
static void sweep_one(const char *folder, const char *target, const char *name)
{
    pid_t writer = writer_of(name, target);
    char *path = writer && !is_alive(writer, name) ? string_format("%s%s", folder, name) : NULL;
    if (path)
        remove_left(path);
    free(path);
}

/* Lists the folder anew, and sweeps it meanwhile. */
static void list(struct listing *listing, const char *folder, const char *target)
{
    DIR *dir = opendir(folder[0] ? folder : ".");
    bool keeps_all = true;
    listing->entries = listing->writes = listing->count = 0;
    for (struct dirent *entry; dir && (entry = readdir(dir)); ++listing->entries) {
        const char *name = entry->d_name;
        if (name[0] != '.' || !path_is(name, "tmp"))
            continue;
        sweep_one(folder, target, name);
        keeps_all = keeps_all && listing->count < HIDDEN_KEPT;
        if (keeps_all)
            strcpy(listing->hidden[listing->count++], name);
    }
    if (!keeps_all)
        listing->entries = 0;
    if (dir)
        closedir(dir);
}

/* Removes unfinished files for `target` that killed runs left beside it. */
static void sweep(const char *folder, const char *target)
{
    static uint32_t turn;
    uint64_t key = hash_bytes(HASH_START, folder, strlen(folder));
    struct listing *listing = listings;
    while (listing < listings + LISTINGS && listing->folder != key)
        ++listing;
    bool known = listing < listings + LISTINGS;
    if (!known)
        listing = &listings[turn++ % LISTINGS];
    listing->folder = key;
    if (!known || ++listing->writes * ENTRIES_A_WRITE > listing->entries) {
        list(listing, folder, target);
        return;
    }
    for (uint32_t i = 0; i < listing->count; ++i)
        sweep_one(folder, target, listing->hidden[i]);
}

/* Takes the slot before the file exists, so that a signal just after open() finds it. A file that
   exists already belongs to another process. */
static int open_new(struct file_write *file)
{
    errno = EEXIST;
    if (file_exists(file->temporary_path))
        return -1;
    file->slot = file_slot_take(file->temporary_path);
    int fd = open(file->temporary_path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    int reason = errno;
    if (fd < 0) {
        slot_free(file->slot);
        file->slot = 0;
    } else {
        (void)flock(fd, LOCK_EX | LOCK_NB); /* see remove_left */
    }
    errno = reason;
    return fd;
}

static int open_sibling(struct file_write *file)
{
    enum { ATTEMPTS = 16 };
    char *folder = path_folder(file->path);
    int fd = -1;
    if (folder)
        sweep(folder, path_name(file->path));
    errno = ENOMEM;
    for (int attempt = 0; folder && attempt < ATTEMPTS && fd < 0; ++attempt) {
        char number[16] = "";
        if (attempt)
            snprintf(number, sizeof number, ".%d", attempt);
        free(file->temporary_path);
        file->temporary_path = string_format("%s.%.*s.%ld%s.tmp", folder, NAME_KEPT,
                                             path_name(file->path), (long)getpid(), number);
        if (!file->temporary_path) {
            errno = ENOMEM;
            break;
        }
        fd = open_new(file);
        if (fd < 0 && errno != EEXIST)
            break;
    }
    int reason = errno;
    free(folder);
    errno = reason;
    return fd;
}

/* Opens a pipe, a device or the standard output: they cannot be replaced by a rename, and are
   written directly. */
static int open_direct(const char *path)
{
    if (strcmp(path, "/dev/stdout") == 0)
        return fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    return open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
}

/* The file that `path` leads to, also where it is a link to one that is not there yet: a symbolic
   link stays, what it points to is written. NULL, with errno. */
static char *target_of(const char *path)
{
    char to[PATH_MAX];
    char *target = realpath(path, NULL);
    if (target || errno != ENOENT)
        return target;
    ssize_t length = readlink(path, to, sizeof to - 1);
    if (length < 0)
        return string_copy(path);
    to[length] = 0;
    char *next = path_beside(path, to);
    target = next ? target_of(next) : NULL;
    free(next);
    return target;
}

static int open_for_writing(struct file_write *file, const char *path)
{
    struct stat info;
    bool exists = stat(path, &info) == 0;
    bool standard_output = strcmp(path, "/dev/stdout") == 0;
    if (exists && S_ISDIR(info.st_mode)) {
        errno = EISDIR;
        return -1;
    }
    if (standard_output || (exists && !S_ISREG(info.st_mode))) {
        file->path = string_copy(path);
        return file->path ? open_direct(path) : -1;
    }
    if (exists && access(path, W_OK) != 0)
        return -1;
    /* An open file that has no name any more exists, and cannot be replaced. */
    file->path = exists ? realpath(path, NULL) : target_of(path);
    if (!file->path)
        return -1;
    pthread_mutex_lock(&begin_lock);
    int fd = open_sibling(file);
    pthread_mutex_unlock(&begin_lock);
    if (fd < 0) {
        free(file->temporary_path);
        file->temporary_path = NULL;
        return -1;
    }
    if (exists && fchmod(fd, info.st_mode & 07777) != 0)
        errno = 0; /* no error: some file systems have no permissions to keep */
    return fd;
}

whit_result file_write_begin(const whit_log *log, const char *path, struct file_write *file)
{
    *file = (struct file_write){0};
    int fd = open_for_writing(file, path);
    if (fd >= 0)
        file->stream = fdopen(fd, "wb");
    if (file->stream)
        return WHIT_OK;
    int reason = errno;
    if (fd >= 0)
        close(fd);
    file_write_abandon(file);
    log_error(log, "%s: cannot write: %s", path, strerror(reason));
    return reason == ENOMEM ? WHIT_ERROR_MEMORY : WHIT_ERROR_OUTPUT;
}

/* The errno for a stream that failed to write earlier, when errno was not kept: found by writing
   another byte (EIO if that works). The file is lost anyway. */
static int reason_again(FILE *stream)
{
    clearerr(stream);
    errno = 0;
    if (fputc(0, stream) != EOF && fflush(stream) == 0)
        return EIO;
    return errno ? errno : EIO;
}

/* 0, or the errno of the first thing that went wrong. */
static int flush_and_close(struct file_write *file)
{
    int reason = 0;
    errno = 0;
    if (fflush(file->stream) != 0)
        reason = errno ? errno : EIO;
    else if (ferror(file->stream))
        reason = reason_again(file->stream);
    /* Synced before the rename: else a power cut could leave the new name with no data. */
    if (!reason && file->temporary_path && fsync(fileno(file->stream)) != 0 && errno != EINVAL)
        reason = errno;
    if (fclose(file->stream) != 0 && !reason)
        reason = errno ? errno : EIO;
    file->stream = NULL;
    return reason;
}

whit_result file_write_commit(const whit_log *log, struct file_write *file)
{
    if (!file->stream)
        return WHIT_OK;
    int reason = flush_and_close(file);
    if (!reason && file->temporary_path) {
        if (rename(file->temporary_path, file->path) != 0) {
            reason = errno;
        } else {
            free(file->temporary_path);
            file->temporary_path = NULL;
        }
    }
    if (reason)
        log_error(log, "%s: cannot write: %s", file->path, strerror(reason));
    file_write_abandon(file);
    return reason ? WHIT_ERROR_OUTPUT : WHIT_OK;
}

void file_write_abandon(struct file_write *file)
{
    if (!file)
        return;
    if (file->stream)
        fclose(file->stream);
    if (file->temporary_path)
        unlink(file->temporary_path);
    file_slot_give_back(file->slot);
    free(file->temporary_path);
    free(file->path);
    *file = (struct file_write){0};
}

whit_result file_write_append(const whit_log *log, struct file_write *file, const void *data,
                              size_t size_bytes)
{
    errno = 0;
    if (size_bytes == 0 || fwrite(data, 1, size_bytes, file->stream) == size_bytes)
        return WHIT_OK;
    log_error(log, "%s: cannot write: %s", file->path, strerror(errno ? errno : EIO));
    return WHIT_ERROR_OUTPUT;
}

whit_result file_write_end(const whit_log *log, struct file_write *file, whit_result result)
{
    if (result == WHIT_OK)
        return file_write_commit(log, file);
    file_write_abandon(file);
    return result;
}

whit_result file_write_whole(const whit_log *log, const char *path, const void *data,
                             size_t size_bytes)
{
    struct file_write file;
    whit_result result = file_write_begin(log, path, &file);
    if (result != WHIT_OK)
        return result;
    return file_write_end(log, &file, file_write_append(log, &file, data, size_bytes));
}

bool file_exists(const char *path)
{
    return access(path, F_OK) == 0;
}
