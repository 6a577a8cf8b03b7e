#include "view/events.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"

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
    {KEY_F1, "F1"},
    {KEY_F1 + 1, "F2"},
    {KEY_F1 + 2, "F3"},
    {KEY_F1 + 3, "F4"},
    {KEY_F1 + 4, "F5"},
    {KEY_F1 + 5, "F6"},
    {KEY_F1 + 6, "F7"},
    {KEY_F1 + 7, "F8"},
    {KEY_F1 + 8, "F9"},
    {KEY_F1 + 9, "F10"},
    {KEY_F1 + 10, "F11"},
    {KEY_F12, "F12"},
};
enum { KEY_NAMES = sizeof key_names / sizeof *key_names, REPLAY_BYTES_MAX = 1 << 28 };
static const char *const button_names[] = {"left", "right", "middle"};

static bool is_own_name(int key)
{
    return (key >= 'A' && key <= 'Z') || (key >= '0' && key <= '9');
}

/* The name of a key, as "T", "Left", "F12", "Comma"; "?": it has none. */
static const char *key_name(int key)
{
    static const char letters[26][2] = {"A", "B", "C", "D", "E", "F", "G", "H", "I",
                                        "J", "K", "L", "M", "N", "O", "P", "Q", "R",
                                        "S", "T", "U", "V", "W", "X", "Y", "Z"};
    static const char digits[10][2] = {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"};
    if (key >= 'A' && key <= 'Z')
        return letters[key - 'A'];
    if (key >= '0' && key <= '9')
        return digits[key - '0'];
    for (int i = 0; i < KEY_NAMES; ++i) {
        if (key_names[i].key == key)
            return key_names[i].name;
    }
    return "?";
}

/* ---- Lines ---- */

static bool key_from_name(const char *name, int *key)
{
    if (name[0] && !name[1] && is_own_name(name[0])) {
        *key = name[0];
        return true;
    }
    for (int i = 0; i < KEY_NAMES; ++i) {
        if (strcmp(key_names[i].name, name) == 0) {
            *key = key_names[i].key;
            return true;
        }
    }
    return false;
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
    event->kind = EVENT_KEY;
    return sscanf(rest, "%31s %7s", name, state) == 2 && state_from_text(state, &event->down) &&
           chord_from_text(name, &event->key, &event->mods);
}

static bool parse_button(const char *rest, struct view_event *event)
{
    char name[16], state[8];
    event->kind = EVENT_BUTTON;
    if (sscanf(rest, "%15s %7s", name, state) != 2 || !state_from_text(state, &event->down))
        return false;
    for (event->button = 0; event->button < 3; ++event->button) {
        if (strcmp(button_names[event->button], name) == 0)
            return true;
    }
    return false;
}

static bool parse_pair(const char *rest, enum view_event_kind kind, struct view_event *event)
{
    event->kind = kind;
    return sscanf(rest, "%lf %lf", &event->x, &event->y) == 2 && isfinite(event->x) &&
           isfinite(event->y);
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
    if (sscanf(rest, "%31s", name) != 1 || !chord_from_text(name, &events[0].key, &events[0].mods))
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
    } bare[] = {{"still", EVENT_STILL},       {"picture", EVENT_PICTURE},
                {"priced", EVENT_PRICED},     {"refined", EVENT_REFINED},
                {"minimise", EVENT_MINIMISE}, {"restore", EVENT_RESTORE},
                {"close", EVENT_CLOSE}};
    struct view_event *event = &events[0];
    *count = 1;
    for (size_t i = 0; i < sizeof bare / sizeof *bare; ++i) {
        if (strcmp(bare[i].verb, verb) == 0) {
            event->kind = bare[i].kind;
            return true;
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
    if (strcmp(verb, "drop") == 0)
        return parse_path(rest, EVENT_DROP, event);
    if (strcmp(verb, "shot") == 0)
        return parse_path(rest, EVENT_SHOT, event);
    if (strcmp(verb, "until") == 0)
        return parse_path(rest, EVENT_UNTIL, event);
    if (strcmp(verb, "await") == 0)
        return parse_path(rest, EVENT_AWAIT, event);
    if (strcmp(verb, "choose") == 0)
        return parse_path(rest, EVENT_CHOOSE, event);
    event->kind = EVENT_CLOCK;
    if (strcmp(verb, "clock") == 0)
        return strcmp(rest, "real") == 0;
    event->kind = EVENT_SIZE;
    if (strcmp(verb, "size") == 0)
        return sscanf(rest, "%u %u", &event->width, &event->height) == 2;
    event->kind = EVENT_CHAR;
    if (strcmp(verb, "char") == 0)
        return sscanf(rest, "%u", &event->code) == 1;
    event->kind = EVENT_WAIT;
    return strcmp(verb, "wait") == 0 && sscanf(rest, "%lf", &event->x) == 1 && event->x >= 0.0 &&
           isfinite(event->x);
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
    switch (event->kind) {
    case EVENT_KEY:
        if (strcmp(key_name(event->key), "?") != 0)
            fprintf(to, "key %s%s%s%s %s\n", event->mods & EVENT_SHIFT ? "Shift+" : "",
                    event->mods & EVENT_CTRL ? "Ctrl+" : "", event->mods & EVENT_ALT ? "Alt+" : "",
                    key_name(event->key), state);
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

struct list {
    struct view_event *events;
    uint32_t count, capacity;
};

/* `text` ends with a 0; ends of lines in it are overwritten. */
static whit_result read_lines(const whit_log *log, const char *path, char *text, struct list *list)
{
    uint32_t line = 1;
    for (char *at = text; at; ++line) {
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
            if (!ARRAY_PUSH(list->events, list->count, list->capacity, events[i])) {
                log_error(log, "%s: out of memory", path);
                return WHIT_ERROR_MEMORY;
            }
        }
        at = next;
    }
    return WHIT_OK;
}

/* Joins the events and the text that they point to in one block, in place of list->events. */
static bool join(struct list *list, const char *text, size_t bytes)
{
    size_t list_bytes = list->count * sizeof *list->events;
    struct view_event *events = realloc(list->events, list_bytes + bytes + 1);
    if (!events)
        return false;
    char *copy = (char *)events + list_bytes;
    memcpy(copy, text, bytes + 1);
    for (uint32_t i = 0; i < list->count; ++i) {
        if (events[i].path)
            events[i].path = copy + (events[i].path - text);
    }
    list->events = events;
    return true;
}

whit_result events_load(const whit_log *log, const char *path, struct view_event **events,
                        uint32_t *count)
{
    struct list list = {0};
    uint8_t *text = NULL;
    size_t bytes = 0;
    *events = NULL;
    *count = 0;
    whit_result result = file_read(log, NULL, path, REPLAY_BYTES_MAX, &text, &bytes);
    if (result == WHIT_OK)
        result = read_lines(log, path, (char *)text, &list);
    if (result == WHIT_OK && !join(&list, (const char *)text, bytes)) {
        log_error(log, "%s: out of memory", path);
        result = WHIT_ERROR_MEMORY;
    }
    free(text);
    if (result != WHIT_OK) {
        free(list.events);
        return result;
    }
    *events = list.events;
    *count = list.count;
    return WHIT_OK;
}
