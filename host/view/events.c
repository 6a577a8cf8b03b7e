#include "view/events.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "settings/setting.h"

static const struct key_name {
    int key;
    const char *name;
} key_names[] = {
    {KEY_SPACE, "Space"},
    {KEY_ESCAPE, "Escape"},
    {KEY_ENTER, "Enter"},
    {KEY_TAB, "Tab"},
    {KEY_BACKSPACE, "Backspace"},
    {KEY_DELETE, "Delete"},
    {KEY_LEFT, "Left"},
    {KEY_RIGHT, "Right"},
    {KEY_UP, "Up"},
    {KEY_DOWN, "Down"},
    {KEY_HOME, "Home"},
    {KEY_END, "End"},
    {',', "Comma"},
    {'.', "Period"},
    {'-', "Minus"},
    {'=', "Equal"},
    {'/', "Slash"},
    {'[', "["},
    {']', "]"},
    {'\\', "\\"},
    {KEY_SHIFT, "Shift"},
    {KEY_CTRL, "Ctrl"},
    {KEY_ALT, "Alt"},
};
enum { KEY_NAMES = sizeof key_names / sizeof *key_names };
enum { KEY_NAME = 16, REPLAY_BYTES_MAX = 1 << 28 };
static const char *const button_names[] = {"left", "right", "middle"};

/* Writes the name of a key, as "T", "Left", "F12", "Comma"; false: it has none. */
static bool key_to_name(int key, char name[KEY_NAME])
{
    name[0] = '\0';
    if ((key >= 'A' && key <= 'Z') || (key >= '0' && key <= '9'))
        snprintf(name, KEY_NAME, "%c", key);
    if (key >= KEY_F1 && key <= KEY_F12)
        snprintf(name, KEY_NAME, "F%d", key - KEY_F1 + 1);
    for (int i = 0; i < KEY_NAMES; ++i) {
        if (key_names[i].key == key)
            snprintf(name, KEY_NAME, "%s", key_names[i].name);
    }
    return name[0] != '\0';
}

/* ---- Lines ---- */

static bool key_from_name(const char *name, int *key)
{
    char own[KEY_NAME];
    for (*key = 0; *key <= KEY_ALT; ++*key) {
        if (key_to_name(*key, own) && strcmp(own, name) == 0)
            return true;
    }
    return false;
}

/* Parses the size of a window, in the range of --size. */
static bool parse_size(const char *rest, struct view_event *event)
{
    int end = 0;
    event->kind = EVENT_SIZE;
    return sscanf(rest, "%u %u %n", &event->width, &event->height, &end) == 2 && !rest[end] &&
           event->width > 0 && event->height > 0 && event->width <= SETTING_SIDE_MAX &&
           event->height <= SETTING_SIDE_MAX;
}

/* Parses "Shift+Ctrl+T". */
static bool chord_from_text(const char *text, int *key, unsigned *mods)
{
    static const struct {
        const char *prefix;
        unsigned mod;
    } all[] = {{"Shift+", EVENT_SHIFT}, {"Ctrl+", EVENT_CTRL}, {"Alt+", EVENT_ALT}};
    *mods = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        size_t length = strlen(all[i].prefix);
        if (strncmp(text, all[i].prefix, length) == 0) {
            *mods |= all[i].mod;
            text += length;
        }
    }
    return key_from_name(text, key);
}

static bool state_from_text(const char *text, bool *down)
{
    *down = strcmp(text, "down") == 0;
    return *down || strcmp(text, "up") == 0;
}

static bool parse_key(const char *rest, struct view_event *event)
{
    char name[32], state[8];
    int end = 0;
    event->kind = EVENT_KEY;
    return sscanf(rest, "%31s %7s %n", name, state, &end) == 2 && !rest[end] &&
           state_from_text(state, &event->down) && chord_from_text(name, &event->key, &event->mods);
}

static bool parse_button(const char *rest, struct view_event *event)
{
    char name[16], state[8];
    int end = 0;
    event->kind = EVENT_BUTTON;
    if (sscanf(rest, "%15s %7s %n", name, state, &end) != 2 || rest[end] ||
        !state_from_text(state, &event->down))
        return false;
    for (event->button = 0; event->button < 3; ++event->button) {
        if (strcmp(button_names[event->button], name) == 0)
            return true;
    }
    return false;
}

static bool parse_pair(const char *rest, enum view_event_kind kind, struct view_event *event)
{
    int end = 0;
    event->kind = kind;
    return sscanf(rest, "%lf %lf %n", &event->x, &event->y, &end) == 2 && !rest[end] &&
           isfinite(event->x) && isfinite(event->y);
}

static bool parse_path(const char *rest, enum view_event_kind kind, struct view_event *event)
{
    event->kind = kind;
    event->path = rest;
    return rest[0] && strlen(rest) < EVENT_PATH;
}

static bool parse_press(const char *rest, struct view_event events[EVENTS_A_LINE], int *count)
{
    char name[32];
    int end = 0;
    if (sscanf(rest, "%31s %n", name, &end) != 1 || rest[end] ||
        !chord_from_text(name, &events[0].key, &events[0].mods))
        return false;
    events[0].kind = EVENT_KEY;
    events[1] = events[0];
    events[0].down = true;
    *count = 2;
    return true;
}

static bool parse_click(const char *rest, struct view_event events[EVENTS_A_LINE], int *count)
{
    if (!parse_pair(rest, EVENT_MOVE, &events[0]))
        return false;
    events[1] = (struct view_event){.kind = EVENT_BUTTON, .down = true};
    events[2] = (struct view_event){.kind = EVENT_BUTTON};
    *count = 3;
    return true;
}

static bool parse(const char *verb, const char *rest, struct view_event events[EVENTS_A_LINE],
                  int *count)
{
    static const struct {
        const char *verb;
        enum view_event_kind kind;
        bool has_path;
    } plain[] = {{"still", EVENT_STILL, false},       {"picture", EVENT_PICTURE, false},
                 {"priced", EVENT_PRICED, false},     {"refined", EVENT_REFINED, false},
                 {"minimise", EVENT_MINIMISE, false}, {"restore", EVENT_RESTORE, false},
                 {"close", EVENT_CLOSE, false},       {"drop", EVENT_DROP, true},
                 {"shot", EVENT_SHOT, true},          {"until", EVENT_UNTIL, true},
                 {"await", EVENT_AWAIT, true},        {"choose", EVENT_CHOOSE, true}};
    struct view_event *event = &events[0];
    int end = 0;
    *count = 1;
    for (size_t i = 0; i < sizeof plain / sizeof *plain; ++i) {
        if (strcmp(plain[i].verb, verb) == 0) {
            event->kind = plain[i].kind;
            return plain[i].has_path ? parse_path(rest, event->kind, event) : !rest[0];
        }
    }
    if (strcmp(verb, "state") == 0) {
        (void)parse_path(rest, EVENT_STATE, event); /* may be empty */
        return strlen(rest) < EVENT_PATH;
    }
    if (strcmp(verb, "press") == 0)
        return parse_press(rest, events, count);
    if (strcmp(verb, "click") == 0)
        return parse_click(rest, events, count);
    if (strcmp(verb, "key") == 0)
        return parse_key(rest, event);
    if (strcmp(verb, "button") == 0)
        return parse_button(rest, event);
    if (strcmp(verb, "move") == 0)
        return parse_pair(rest, EVENT_MOVE, event);
    if (strcmp(verb, "wheel") == 0)
        return parse_pair(rest, EVENT_WHEEL, event);
    event->kind = EVENT_CLOCK;
    if (strcmp(verb, "clock") == 0)
        return strcmp(rest, "real") == 0;
    if (strcmp(verb, "size") == 0)
        return parse_size(rest, event);
    event->kind = EVENT_CHAR;
    if (strcmp(verb, "char") == 0)
        return sscanf(rest, "%u %n", &event->code, &end) == 1 && !rest[end];
    event->kind = EVENT_WAIT;
    return strcmp(verb, "wait") == 0 && sscanf(rest, "%lf %n", &event->x, &end) == 1 &&
           !rest[end] && event->x >= 0.0 && isfinite(event->x);
}

bool events_from_line(const whit_log *log, const char *file, uint32_t line, const char *text,
                      struct view_event events[EVENTS_A_LINE], int *count)
{
    char verb[16] = "";
    int read = 0;
    memset(events, 0, EVENTS_A_LINE * sizeof *events);
    *count = 0;
    if (sscanf(text, " %15s %n", verb, &read) != 1 || verb[0] == '#')
        return true;
    if (parse(verb, text + read, events, count))
        return true;
    log_error(log, "%s:%u: `%s` is no event of a replay", file, line, text_token(text).text);
    return false;
}

void event_to_line(const struct view_event *event, FILE *to)
{
    const char *state = event->down ? "down" : "up";
    char name[KEY_NAME];
    switch (event->kind) {
    case EVENT_KEY:
        if (key_to_name(event->key, name))
            fprintf(to, "key %s%s%s%s %s\n", event->mods & EVENT_SHIFT ? "Shift+" : "",
                    event->mods & EVENT_CTRL ? "Ctrl+" : "", event->mods & EVENT_ALT ? "Alt+" : "",
                    name, state);
        break;
    case EVENT_CHAR:
        fprintf(to, "char %u\n", event->code);
        break;
    case EVENT_BUTTON:
        fprintf(to, "button %s %s\n", button_names[event->button], state);
        break;
    case EVENT_MOVE:
        fprintf(to, "move %.9g %.9g\n", event->x, event->y);
        break;
    case EVENT_WHEEL:
        fprintf(to, "wheel %.9g %.9g\n", event->x, event->y);
        break;
    case EVENT_SIZE:
        if (event->width > 0)
            fprintf(to, "size %u %u\n", event->width, event->height);
        break;
    case EVENT_DROP:
        if (isspace((unsigned char)event->path[0]) || strpbrk(event->path, "\r\n"))
            fprintf(to, "# a file was dropped whose name is not one that a line can hold\n");
        else
            fprintf(to, "drop %s\n", event->path);
        break;
    case EVENT_WAIT:
        fprintf(to, "wait %.0f\n", event->x);
        break;
    case EVENT_CLOCK:
        fprintf(to, "clock real\n");
        break;
    case EVENT_CLOSE:
        fprintf(to, "close\n");
        break;
    default:
        break;
    }
}

/* ---- Files ---- */

/* The text ends with a 0; ends of lines in it are overwritten. */
static whit_result read_lines(const whit_log *log, const char *path, struct event_list *list)
{
    uint32_t line = 1;
    for (char *at = (char *)list->text; at; ++line) {
        struct view_event events[EVENTS_A_LINE];
        int count;
        char *end = strpbrk(at, "\r\n");
        char *next = end ? end + 1 : NULL;
        if (end && end[0] == '\r' && end[1] == '\n')
            ++next;
        if (end)
            *end = '\0';
        if (!events_from_line(log, path, line, at, events, &count))
            return WHIT_ERROR_INPUT;
        for (int i = 0; i < count; ++i) {
            if (!ARRAY_PUSH(list->events, list->count, list->capacity, events[i]))
                return log_failure(log, WHIT_ERROR_MEMORY, "%s: out of memory", path);
        }
        at = next;
    }
    return WHIT_OK;
}

whit_result events_load(const whit_log *log, const char *path, struct event_list *list)
{
    size_t bytes;
    *list = (struct event_list){0};
    whit_result result = file_read(log, NULL, path, REPLAY_BYTES_MAX, &list->text, &bytes);
    if (result == WHIT_OK && memchr(list->text, '\0', bytes)) {
        log_error(log, "%s: it is no text, as it holds a byte 0", path);
        result = WHIT_ERROR_INPUT;
    }
    if (result == WHIT_OK)
        result = read_lines(log, path, list);
    if (result != WHIT_OK)
        events_finish(list);
    return result;
}

void events_finish(struct event_list *list)
{
    free(list->events);
    free(list->text);
    *list = (struct event_list){0};
}
