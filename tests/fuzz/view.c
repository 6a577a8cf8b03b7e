/* Files that the viewer reads: recordings, whose events are written as they were read, and the
   cameras that it remembers. */
#include "fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "view/events.h"
#include "view/remembered_cameras.h"

static void prepare(void)
{
    char folder[128];
    snprintf(folder, sizeof folder, "%s/whit", fuzz_folder());
    fuzz_check(mkdir(folder, 0700) == 0 && setenv("XDG_STATE_HOME", fuzz_folder(), 1) == 0,
               "no folder");
}

static bool same_text(const char *a, const char *b)
{
    return a == b || (a && b && strcmp(a, b) == 0);
}

/* An event that can be written as a line reads back as the same event; moves are kept to nine
   digits. */
static void check_line(const struct view_event *event)
{
    char line[EVENT_PATH + 64] = "";
    struct view_event read[EVENTS_A_LINE];
    int count;
    FILE *to = fmemopen(line, sizeof line, "w");
    fuzz_check(to, "out of memory");
    event_to_line(event, to);
    fuzz_check(fclose(to) == 0, "a line that does not fit");
    if (!line[0] || line[0] == '#')
        return;
    fuzz_check(strlen(line) > 1 && strcspn(line, "\r\n") == strlen(line) - 1, "`%s`: no line",
               line);
    line[strlen(line) - 1] = 0;
    fuzz_check(events_from_line(&fuzz_log, "a", 1, line, read, &count), "`%s` is not read", line);
    fuzz_check(count == 1 && read[0].kind == event->kind && read[0].key == event->key &&
                   read[0].down == event->down && read[0].mods == event->mods &&
                   read[0].button == event->button && read[0].code == event->code &&
                   read[0].width == event->width && read[0].height == event->height &&
                   same_text(read[0].path, event->path),
               "`%s` is another event", line);
    if (event->kind == EVENT_MOVE || event->kind == EVENT_WHEEL)
        fuzz_check(fabs(read[0].x - event->x) <= 1e-8 * fabs(event->x) &&
                       fabs(read[0].y - event->y) <= 1e-8 * fabs(event->y),
                   "`%s`: another place", line);
}

static void read_events(const char *path)
{
    struct event_list list;
    fuzz_log_clear();
    whit_result result = events_load(&fuzz_log, path, &list);
    fuzz_check_errors(result, path);
    fuzz_check(result == WHIT_OK || !list.count, "events of a file that is refused");
    for (uint32_t i = 0; i < list.count; i++) {
        const struct view_event *event = &list.events[i];
        fuzz_check(isfinite(event->x) && isfinite(event->y), "a place that is nowhere");
        check_line(event);
    }
    events_finish(&list);
}

/* Whatever its name is. */
static void drop_file(const uint8_t *data, size_t size_bytes)
{
    char name[EVENT_PATH];
    size_t length = size_bytes < sizeof name ? size_bytes : sizeof name - 1;
    memcpy(name, data, length);
    name[length] = 0;
    if (name[0])
        check_line(&(struct view_event){.kind = EVENT_DROP, .path = name});
}

static void remember(const uint8_t *data, size_t size_bytes)
{
    char camera[64] = "";
    fuzz_file("whit/cameras.json", data, size_bytes);
    if (memory_find("/a", camera, sizeof camera))
        fuzz_check(strlen(camera) < sizeof camera, "a camera without an end");
    memory_keep(&fuzz_log, "/a", "1,2,3");
    fuzz_check(memory_find("/a", camera, sizeof camera) && strcmp(camera, "1,2,3") == 0,
               "what was kept is `%s`", camera);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    read_events(fuzz_file("a.replay", data, size_bytes));
    drop_file(data, size_bytes);
    if (size_bytes && data[0] == '{') /* it is forced to the disk */
        remember(data, size_bytes);
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(1) << 20};
