#include "base/store.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/platform.h"

/* The header at the start of each cache file. */
struct header {
    char magic[8];
    uint64_t data_bytes;
    uint64_t hash; /* of name and data, so that a file under another's name counts as damaged */
};

static const char magic[8] = {'w', 'h', 'i', 't', 'k', 'e', 'p', '1'};
static const uint64_t limit_default_mib = 512;

/* ---- The folder ---- */

static uint64_t limit_bytes(void)
{
    const char *text = getenv("WHIT_CACHE_LIMIT");
    char *end = NULL;
    unsigned long long mib = text ? strtoull(text, &end, 10) : 0;
    bool good = text && end != text && *end == '\0' && mib < UINT64_MAX >> 20;
    return (good ? mib : limit_default_mib) << 20;
}

static bool is_off(void)
{
    const char *value = getenv("WHIT_NO_CACHE");
    return value && *value && strcmp(value, "0") != 0;
}

/* Makes the folder and its parent. *error: why either could not be made, or 0; other failures show
   when the folder is opened. */
static char *make_folder(int *error)
{
    const char *xdg = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    char *parent = NULL;
    if (xdg && xdg[0] == '/') /* the specification says to ignore relative ones */
        parent = string_copy(xdg);
    else if (home && home[0] == '/')
        parent = string_format("%s/.cache", home);
    char *folder = parent ? string_format("%s/whit", parent) : NULL;
    if (folder && !is_off()) {
        *error = mkdir(parent, 0700) != 0 && errno != EEXIST ? errno : 0;
        if (mkdir(folder, 0700) != 0 && errno != EEXIST && !*error)
            *error = errno;
    }
    free(parent);
    return folder;
}

/* Checks an open folder. NULL, or why it is not used. Access by others is removed if they can only
   read it; a folder that others can write to is not trusted. */
static const char *distrust(int fd)
{
    struct stat info;
    if (fstat(fd, &info) != 0 || info.st_uid != geteuid())
        return "it belongs to somebody else";
    if (info.st_mode & 022)
        return "others may write to it";
    if (info.st_mode & 055 && fchmod(fd, 0700) != 0)
        return "others may read it";
    return NULL;
}

/* Makes and opens the folder: a descriptor, or -1 with *why. *out, its path, which may be NULL, is
   the caller's. */
static int open_folder(const whit_log *log, char **out, const char **why)
{
    static atomic_flag warned = ATOMIC_FLAG_INIT;
    int error = 0;
    const char *path = *out = make_folder(&error);
    *why = is_off() ? "WHIT_NO_CACHE is set" : "neither XDG_CACHE_HOME nor HOME names a folder";
    if (is_off() || !path)
        return -1;
    int fd = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    *why = fd < 0 ? strerror(error ? error : errno) : distrust(fd);
    if (fd < 0) {
        log_debug(log, "%s: %s: nothing is kept", path, *why);
    } else if (*why) {
        if (log && log->fn && log->level >= WHIT_LOG_WARNING && !atomic_flag_test_and_set(&warned))
            log_warning(log, "%s: %s: nothing is kept there", path, *why);
        close(fd);
        fd = -1;
    }
    return fd;
}

static int open_own(const whit_log *log)
{
    const char *why;
    char *path;
    int fd = open_folder(log, &path, &why);
    free(path);
    return fd;
}

char *store_folder(const whit_log *log)
{
    const char *why;
    char *path;
    int fd = open_folder(log, &path, &why);
    if (fd >= 0) {
        close(fd);
        return path;
    }
    free(path);
    return NULL;
}

/* ---- Reading ---- */

/* Whether it is a plain file that only this user can write. It has one link, or none if another
   process has replaced it meanwhile; with more it also stands elsewhere under another name. */
static bool is_own_file(const struct stat *info)
{
    return S_ISREG(info->st_mode) && info->st_uid == geteuid() && info->st_nlink <= 1 &&
           !(info->st_mode & 022);
}

static bool read_whole(int fd, void *data, size_t size_bytes)
{
    return platform_read(fd, data, size_bytes) == (ssize_t)size_bytes;
}

static uint64_t hash_of(const char *name, const void *data, size_t size_bytes)
{
    return hash_bytes(hash_bytes(HASH_START, name, strlen(name)), data, size_bytes);
}

static bool read_checked(int fd, const char *name, uint8_t **data, size_t *size_bytes)
{
    struct stat info;
    struct header header;
    if (fstat(fd, &info) != 0 || !is_own_file(&info) || !read_whole(fd, &header, sizeof header) ||
        memcmp(header.magic, magic, sizeof magic) != 0 ||
        header.data_bytes != (uint64_t)info.st_size - sizeof header ||
        header.data_bytes > limit_bytes())
        return false;
    size_t bytes = (size_t)header.data_bytes;
    uint8_t *read = array_alloc(bytes + 1, 1);
    if (!read || !read_whole(fd, read, bytes) || hash_of(name, read, bytes) != header.hash) {
        free(read);
        return false;
    }
    read[bytes] = 0;
    *data = read;
    *size_bytes = bytes;
    return true;
}

static void throw_away(int folder, const char *name)
{
    if (unlinkat(folder, name, 0) != 0)
        (void)unlinkat(folder, name, AT_REMOVEDIR);
}

bool store_read(const whit_log *log, const char *name, uint8_t **data, size_t *size_bytes)
{
    struct stat info;
    int folder = open_own(log), fd = -1;
    bool good = false;
    *data = NULL;
    *size_bytes = 0;
    /* Checked before it is opened, since opening a pipe or a device may have an effect. */
    if (folder >= 0 && fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) == 0) {
        if (is_own_file(&info))
            fd = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        good = fd >= 0 && read_checked(fd, name, data, size_bytes);
        if (good) {
            (void)futimens(fd, NULL);
        } else {
            log_debug(log, "%s: damaged or another version's: thrown away", name);
            throw_away(folder, name);
        }
    }
    if (fd >= 0)
        close(fd);
    if (folder >= 0)
        close(folder);
    return good;
}

/* ---- Writing ---- */

/* Whether `name` is ".NAME.PID.tmp" or ".NAME.PID.COUNT.tmp" of a process that no longer exists. */
static bool is_leftover(const char *name)
{
    size_t length = strlen(name);
    char *end;
    if (name[0] != '.' || length < 5 || strcmp(name + length - 4, ".tmp") != 0)
        return false;
    for (const char *dot = strchr(name + 1, '.'); dot; dot = strchr(dot + 1, '.')) {
        long pid = strtol(dot + 1, &end, 10);
        end += strspn(end, ".0123456789");
        if (pid > 0 && strcmp(end, "tmp") == 0)
            return kill((pid_t)pid, 0) != 0 && errno == ESRCH;
    }
    return false;
}

struct tally {
    uint64_t bytes;
    struct timespec oldest_time;
    char oldest[256]; /* "": there is no file to remove */
};

/* Adds up the files in the folder and finds the oldest; removes leftover temporary files. */
static struct tally count(int folder)
{
    struct tally tally = {0};
    struct stat info;
    int fd = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *dir = fd >= 0 ? fdopendir(fd) : NULL;
    if (!dir && fd >= 0)
        close(fd);
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        const char *name = entry->d_name;
        if (fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) != 0 || S_ISDIR(info.st_mode) ||
            (is_leftover(name) && unlinkat(folder, name, 0) == 0))
            continue;
        tally.bytes += (uint64_t)info.st_size;
        const struct timespec *time = &info.st_mtim, *than = &tally.oldest_time;
        bool older = time->tv_sec < than->tv_sec ||
                     (time->tv_sec == than->tv_sec && time->tv_nsec < than->tv_nsec);
        if (name[0] == '.' || (tally.oldest[0] && !older))
            continue;
        tally.oldest_time = *time;
        snprintf(tally.oldest, sizeof tally.oldest, "%s", name);
    }
    if (dir)
        closedir(dir);
    return tally;
}

static void make_room(int folder)
{
    struct tally tally;
    do
        tally = count(folder);
    while (tally.bytes > limit_bytes() && tally.oldest[0] &&
           unlinkat(folder, tally.oldest, 0) == 0);
}

/* Writes a temporary file and renames it over `name`, which replaces a link and not its target. Not
   synced to the disk: damage by a power cut is detected by the hash. */
static bool replace(int folder, const char *name, const void *data, size_t size_bytes)
{
    static atomic_uint counter;
    struct header header = {.data_bytes = size_bytes, .hash = hash_of(name, data, size_bytes)};
    char temporary[256];
    memcpy(header.magic, magic, sizeof magic);
    snprintf(temporary, sizeof temporary, ".%.200s.%ld.%u.tmp", name, (long)getpid(),
             atomic_fetch_add(&counter, 1));
    (void)unlinkat(folder, temporary, 0); /* left by an earlier process of this number */
    int fd = openat(folder, temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (fd < 0)
        return false;
    bool whole = platform_write(fd, &header, sizeof header) && platform_write(fd, data, size_bytes);
    whole = close(fd) == 0 && whole && renameat(folder, temporary, folder, name) == 0;
    if (!whole)
        (void)unlinkat(folder, temporary, 0);
    return whole;
}

void store_write(const whit_log *log, const char *name, const void *data, size_t size_bytes)
{
    int folder = size_bytes < limit_bytes() ? open_own(log) : -1;
    if (folder < 0)
        return;
    if (!replace(folder, name, data, size_bytes))
        log_debug(log, "%s: cannot be kept: %s", name, strerror(errno));
    make_room(folder);
    close(folder);
}

void store_get_info(struct store_info *info)
{
    const whit_log silent = {0};
    const char *why;
    *info = (struct store_info){.limit_bytes = limit_bytes()};
    char *path;
    int folder = open_folder(&silent, &path, &why);
    snprintf(info->folder, sizeof info->folder, "%s", path ? path : "");
    snprintf(info->why_not, sizeof info->why_not, "%s", folder < 0 ? why : "");
    if (folder >= 0) {
        info->used_bytes = count(folder).bytes;
        close(folder);
    }
    free(path);
}
