#include "base/watch.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "base/array.h"
#include "base/file.h"
#include "base/input.h"

struct watched {
    int folder; /* inotify's number of it */
    char *name; /* in that folder */
};

struct watch {
    int fd;
    struct watched *files;
    uint32_t count, capacity;
};

struct watch *watch_create(void)
{
    struct watch *watch = array_alloc_zeroed(1, sizeof *watch);
    if (!watch)
        return NULL;
    watch->fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (watch->fd >= 0)
        return watch;
    free(watch);
    return NULL;
}

void watch_destroy(struct watch *watch)
{
    if (!watch)
        return;
    watch_clear(watch);
    free(watch->files);
    close(watch->fd);
    free(watch);
}

void watch_clear(struct watch *watch)
{
    if (!watch)
        return;
    for (uint32_t i = 0; i < watch->count; ++i) {
        (void)inotify_rm_watch(watch->fd, watch->files[i].folder); /* once for all of a folder */
        free(watch->files[i].name);
    }
    watch->count = 0;
    (void)watch_changed(watch); /* what came before */
}

void watch_add(struct watch *watch, const char *path)
{
    char *folder = watch && !is_input(path) ? path_folder(path) : NULL;
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
    bool changed = false;
    ssize_t bytes;
    while (watch && (bytes = read(watch->fd, buffer, sizeof buffer)) > 0) {
        for (ssize_t at = 0; at < bytes;) {
            const struct inotify_event *event = (const void *)(buffer + at);
            changed = changed || is_watched(watch, event);
            at += (ssize_t)(sizeof *event + event->len);
        }
    }
    return changed;
}
