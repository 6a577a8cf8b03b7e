#include "base/watch.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/array.h"
#include "base/file.h"
#include "base/input.h"
#include "base/threads.h"

struct watched {
    char *path;
    int folder; /* inotify's number of the folder that is watched */
    /* The name that is watched for in that folder: the file's, or where its folder is missing, that
       of the uppermost folder that is. */
    char *name;
    bool lacks_folder;
    bool changed; /* an event about it was read since watch_changed was called last */
};

struct watch {
    int fd;
    int end, both; /* end: an eventfd that ends the thread; both: an epoll over `end` and `fd` */
    struct thread *thread;
    void (*wake)(void *user);
    struct watched *files;
    uint32_t count, capacity;
    bool missed; /* a file had changed before it was watched */
    /* Files that had changed when watch_clear was called: nobody was told yet. */
    char **untold;
    uint32_t untold_count, untold_capacity;
};

static bool take_events(struct watch *watch);
static void forget_untold(struct watch *watch);

/* inotify merges an event with an equal one that is still unread, and then wakes nobody, as the
   epoll is edge-triggered. So the owner must read all events, by watch_changed, each time it is
   woken. */
static void wait_for_events(void *context)
{
    const struct watch *watch = context;
    struct epoll_event event = {.data.fd = -1};
    while (event.data.fd != watch->end) {
        if (epoll_wait(watch->both, &event, 1, -1) == 1 && event.data.fd == watch->fd)
            watch->wake(NULL);
    }
}

static bool start_waking(struct watch *watch)
{
    struct epoll_event changes = {.events = EPOLLIN | EPOLLET, .data.fd = watch->fd};
    struct epoll_event end = {.events = EPOLLIN, .data.fd = watch->end};
    if (watch->both < 0 || watch->end < 0 ||
        epoll_ctl(watch->both, EPOLL_CTL_ADD, watch->fd, &changes) != 0 ||
        epoll_ctl(watch->both, EPOLL_CTL_ADD, watch->end, &end) != 0)
        return false;
    watch->thread = thread_start(wait_for_events, watch);
    return watch->thread;
}

struct watch *watch_create(void (*wake)(void *user))
{
    struct watch *watch = array_alloc_zeroed(1, sizeof *watch);
    if (!watch)
        return NULL;
    *watch = (struct watch){.fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC),
                            .end = eventfd(0, EFD_CLOEXEC),
                            .both = epoll_create1(EPOLL_CLOEXEC),
                            .wake = wake};
    if (watch->fd >= 0 && start_waking(watch))
        return watch;
    watch_destroy(watch);
    return NULL;
}

static void close_open(int fd)
{
    if (fd >= 0)
        close(fd);
}

void watch_destroy(struct watch *watch)
{
    if (!watch)
        return;
    if (watch->thread)
        (void)eventfd_write(watch->end, 1);
    thread_join(watch->thread);
    watch_clear(watch);
    forget_untold(watch);
    free(watch->untold);
    free(watch->files);
    close_open(watch->fd);
    close_open(watch->end);
    close_open(watch->both);
    free(watch);
}

static void forget_untold(struct watch *watch)
{
    while (watch->untold_count > 0)
        free(watch->untold[--watch->untold_count]);
}

static bool is_untold(const struct watch *watch, const char *path)
{
    for (uint32_t i = 0; i < watch->untold_count; ++i) {
        if (strcmp(watch->untold[i], path) == 0)
            return true;
    }
    return false;
}

/* Folders are let go before the last events are read, so that none comes in between; these events
   may make others be watched. inotify_rm_watch works once per folder. */
void watch_clear(struct watch *watch)
{
    if (!watch)
        return;
    for (uint32_t i = 0; i < watch->count; ++i)
        (void)inotify_rm_watch(watch->fd, watch->files[i].folder);
    (void)take_events(watch);
    for (uint32_t i = 0; i < watch->count; ++i) {
        struct watched *file = &watch->files[i];
        (void)inotify_rm_watch(watch->fd, file->folder);
        if (!file->changed ||
            !ARRAY_PUSH(watch->untold, watch->untold_count, watch->untold_capacity, file->path))
            free(file->path);
        free(file->name);
    }
    watch->count = 0;
    watch->missed = false;
    (void)take_events(watch); /* drops what came of folders that were let go */
}

static int64_t to_ns(struct timespec time)
{
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

int64_t watch_now_ns(void)
{
    struct timespec now;
    return clock_gettime(CLOCK_REALTIME, &now) == 0 ? to_ns(now) : 0;
}

/* st_ctim is also the time of a rename. A time in the future, by another machine's clock, tells
   nothing, and would be found at each call. */
static bool has_changed(const char *path, int64_t since_ns)
{
    struct stat info;
    if (lstat(path, &info) != 0 || !(S_ISREG(info.st_mode) || S_ISLNK(info.st_mode)))
        return false;
    int64_t changed_ns = to_ns(info.st_ctim);
    return changed_ns > since_ns && changed_ns <= watch_now_ns();
}

/* Watches the folder of `path`, or the nearest one above that is there: `path` is then cut to what
   is missing in it. Below 0: there is none. */
static int watch_folder(const struct watch *watch, char *path)
{
    const uint32_t usual =
        IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVE_SELF | IN_DELETE_SELF | IN_MASK_ADD;
    for (bool whole = true;; whole = false) {
        char *folder = path_folder(path);
        int number = folder ? inotify_add_watch(watch->fd, folder[0] ? folder : ".",
                                                whole ? usual : usual | IN_CREATE)
                            : -1;
        bool missing = number < 0 && (errno == ENOENT || errno == ENOTDIR);
        size_t length = missing && folder ? strlen(folder) : 0;
        free(folder);
        if (length <= 1)
            return number;
        path[length - 1] = '\0';
    }
}

static void place(const struct watch *watch, struct watched *file)
{
    struct stat info;
    bool comes = true; /* a missing folder comes while the one above begins to be watched */
    while (comes) {
        char *path = string_copy(file->path);
        free(file->name);
        file->folder = path ? watch_folder(watch, path) : -1;
        file->name = path ? string_copy(path_name(path)) : NULL;
        file->lacks_folder = path && strlen(path) < strlen(file->path);
        comes = file->lacks_folder && file->folder >= 0 && stat(path, &info) == 0 &&
                S_ISDIR(info.st_mode);
        free(path);
    }
}

static void add_one(struct watch *watch, const char *path, int64_t since_ns)
{
    struct watched file = {.path = string_copy(path)};
    if (!file.path)
        return;
    place(watch, &file);
    if (file.folder < 0 || !file.name ||
        !ARRAY_PUSH(watch->files, watch->count, watch->capacity, file)) {
        free(file.path);
        free(file.name);
    } else if (is_untold(watch, path) || has_changed(path, since_ns)) {
        watch->missed = true;
        watch->wake(NULL);
    }
}

static bool is_link(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
}

/* Adds the links among the folders of a file. */
static void add_links(struct watch *watch, const char *path, int64_t since_ns)
{
    char *part = string_copy(path);
    for (char *slash = part; slash && slash[0] && (slash = strchr(slash + 1, '/'));) {
        *slash = '\0';
        if (is_link(part))
            add_one(watch, part, since_ns);
        *slash = '/';
    }
    free(part);
}

void watch_add(struct watch *watch, const char *path, int64_t since_ns)
{
    if (!watch || is_input(path))
        return;
    add_one(watch, path, since_ns);
    add_links(watch, path, since_ns);
    char *target = is_link(path) ? realpath(path, NULL) : NULL;
    if (target)
        add_one(watch, target, since_ns);
    free(target);
}

/* Whether an event is about a file, or about a folder that it is in. */
static bool is_about(const struct inotify_event *event, const struct watched *file)
{
    if (event->wd != file->folder)
        return false;
    if (event->mask & (IN_MOVE_SELF | IN_DELETE_SELF))
        return true;
    return event->len > 0 && file->name && strcmp(file->name, event->name) == 0 &&
           (file->lacks_folder || !(event->mask & IN_CREATE));
}

static void let_go(const struct watch *watch, int folder)
{
    for (uint32_t i = 0; i < watch->count; ++i) {
        if (watch->files[i].folder == folder)
            return;
    }
    (void)inotify_rm_watch(watch->fd, folder);
}

static bool take_event(struct watch *watch, const struct inotify_event *event)
{
    bool all = event->mask & IN_Q_OVERFLOW; /* nothing is known of events without room */
    bool changed = all;
    for (uint32_t i = 0; i < watch->count; ++i) {
        struct watched *file = &watch->files[i];
        if (!all && !is_about(event, file))
            continue;
        changed = file->changed = true;
        if (!all && (file->lacks_folder || event->mask & (IN_MOVE_SELF | IN_DELETE_SELF)))
            place(watch, file);
    }
    if (changed)
        let_go(watch, event->wd);
    return changed;
}

static bool take_events(struct watch *watch)
{
    _Alignas(struct inotify_event) char buffer[4096];
    bool changed = false;
    ssize_t bytes;
    while ((bytes = read(watch->fd, buffer, sizeof buffer)) > 0) {
        for (ssize_t at = 0; at < bytes;) {
            const struct inotify_event *event = (const void *)(buffer + at);
            changed = take_event(watch, event) || changed;
            at += (ssize_t)(sizeof *event + event->len);
        }
    }
    return changed;
}

bool watch_changed(struct watch *watch)
{
    if (!watch)
        return false;
    bool changed = take_events(watch) || watch->missed;
    watch->missed = false;
    for (uint32_t i = 0; i < watch->count; ++i)
        watch->files[i].changed = false;
    forget_untold(watch);
    return changed;
}
