#include "base/watch.h"

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
    int folder; /* inotify's number of the folder */
    char *name; /* in that folder */
};

struct watch {
    int fd;
    int end, both; /* end: an eventfd that ends the thread; both: an epoll over `end` and `fd` */
    struct thread *thread;
    void (*wake)(void *user);
    struct watched *files;
    uint32_t count, capacity;
    bool missed; /* a file had changed before it was watched */
};

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
    free(watch->files);
    close_open(watch->fd);
    close_open(watch->end);
    close_open(watch->both);
    free(watch);
}

void watch_clear(struct watch *watch)
{
    if (!watch)
        return;
    for (uint32_t i = 0; i < watch->count; ++i) {
        (void)inotify_rm_watch(watch->fd, watch->files[i].folder); /* works once per folder */
        free(watch->files[i].name);
    }
    watch->count = 0;
    watch->missed = false;
    (void)watch_changed(watch); /* discards earlier events */
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

static void add_one(struct watch *watch, const char *path, int64_t since_ns)
{
    char *folder = path_folder(path);
    if (!folder)
        return;
    struct watched file = {
        .folder =
            inotify_add_watch(watch->fd, folder[0] ? folder : ".", IN_CLOSE_WRITE | IN_MOVED_TO),
        .name = string_copy(path_name(path)),
    };
    free(folder);
    if (file.folder < 0 || !file.name ||
        !ARRAY_PUSH(watch->files, watch->count, watch->capacity, file))
        free(file.name);
    else if (has_changed(path, since_ns)) {
        watch->missed = true;
        watch->wake(NULL);
    }
}

void watch_add(struct watch *watch, const char *path, int64_t since_ns)
{
    struct stat info;
    if (!watch || is_input(path))
        return;
    add_one(watch, path, since_ns);
    bool is_link = lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
    char *target = is_link ? realpath(path, NULL) : NULL;
    if (target)
        add_one(watch, target, since_ns);
    free(target);
}

static bool is_watched(const struct watch *watch, const struct inotify_event *event)
{
    for (uint32_t i = 0; i < watch->count; ++i) {
        if (watch->files[i].folder == event->wd && event->len > 0 &&
            strcmp(watch->files[i].name, event->name) == 0)
            return true;
    }
    return false;
}

bool watch_changed(struct watch *watch)
{
    _Alignas(struct inotify_event) char buffer[4096];
    bool changed = watch && watch->missed;
    ssize_t bytes;
    while (watch && (bytes = read(watch->fd, buffer, sizeof buffer)) > 0) {
        for (ssize_t at = 0; at < bytes;) {
            const struct inotify_event *event = (const void *)(buffer + at);
            /* Nothing is known of events that the queue had no room for. */
            changed = changed || (event->mask & IN_Q_OVERFLOW) || is_watched(watch, event);
            at += (ssize_t)(sizeof *event + event->len);
        }
    }
    if (watch)
        watch->missed = false;
    return changed;
}
