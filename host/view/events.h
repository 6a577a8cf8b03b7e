/* Events of the user, from the window or from a file of a replay.

   A file has one event a line; # begins a comment. --record writes:
       wait MS | key [Shift+][Ctrl+][Alt+]NAME down|up | char CODE | button left|right|middle
       down|up | move X Y | wheel X Y | size W H | drop PATH | close
       clock real                        `wait` takes real time from here on
   Replays, which tests use, may also have:
       press [Shift+][Ctrl+][Alt+]NAME   a key down and up
       click X Y                         moves there; the left button down and up
       still, picture, priced, refined, until FIELD [= VALUE], await PATH
                                         the replay waits for that
       choose LABEL                      a click on the item with this label, once it is there
       state [NAME]                      writes one line of JSON to standard output
       shot FILE.png                     saves the window, with what is drawn over the picture
       minimise | restore
   docs/view.md describes each of them. */
#ifndef VIEW_EVENTS_H
#define VIEW_EVENTS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/log.h"

enum view_event_kind {
    EVENT_NONE,
    EVENT_KEY,
    EVENT_CHAR,
    EVENT_BUTTON,
    EVENT_MOVE,
    EVENT_WHEEL,
    EVENT_SIZE, /* size of the window, pixels; 0 x 0: minimised */
    EVENT_DROP,
    EVENT_CLOSE,
    EVENT_REFRESH, /* the window wants to be drawn again */
    /* The events below occur in replays only. */
    EVENT_WAIT,
    EVENT_STILL,
    EVENT_PICTURE,
    EVENT_PRICED,
    EVENT_REFINED,
    EVENT_UNTIL,
    EVENT_AWAIT,
    EVENT_CHOOSE,
    EVENT_CLOCK, /* `wait` takes real time from here on */
    EVENT_STATE,
    EVENT_SHOT,
    EVENT_MINIMISE,
    EVENT_RESTORE,
};

enum { EVENT_SHIFT = 1, EVENT_CTRL = 2, EVENT_ALT = 4, EVENT_PATH = 1024 };

/* Keys: letters (as capitals), digits and signs are their ASCII codes; others follow from 256
   on. */
enum view_key {
    KEY_SPACE = ' ',
    KEY_ESCAPE = 256,
    KEY_ENTER,
    KEY_TAB,
    KEY_BACKSPACE,
    KEY_DELETE,
    KEY_LEFT,
    KEY_RIGHT,
    KEY_UP,
    KEY_DOWN,
    KEY_HOME,
    KEY_END,
    KEY_F1, /* F2 to F11 follow */
    KEY_F12 = KEY_F1 + 11,
    KEY_SHIFT,
    KEY_CTRL,
    KEY_ALT,
};

struct view_event {
    enum view_event_kind kind;
    int key;       /* enum view_key, or a character */
    bool down;     /* keys and buttons */
    unsigned mods; /* EVENT_SHIFT and others, or-ed */
    int button;    /* 0 left, 1 right, 2 middle */
    uint32_t code; /* EVENT_CHAR: Unicode */
    double x, y;   /* window pixels; wheel: notches; EVENT_WAIT: x in ms */
    uint32_t width, height;
    /* A path, shorter than EVENT_PATH; EVENT_STATE: its name; EVENT_UNTIL: the condition;
       EVENT_CHOOSE: the label. Borrowed from where the event came from. */
    const char *path;
};

/* Parses a line, without its end; false: it is no event, which is logged with file and line. Empty
   lines and comments are EVENT_NONE. `press` and `click` give several events. Paths point into
   `text`. */
enum { EVENTS_A_LINE = 4 };
bool events_from_line(const whit_log *log, const char *file, uint32_t line, const char *text,
                      struct view_event events[EVENTS_A_LINE], int *count);
/* Writes an event as a line that events_from_line reads; nothing for events that have no line. */
void event_to_line(const struct view_event *event, FILE *to);

/* All events of a file. */
struct event_list {
    struct view_event *events;
    uint32_t count, capacity;
    uint8_t *text; /* of the file: the events point into it */
};
/* After an error the list is empty. */
WHIT_CHECK whit_result events_load(const whit_log *log, const char *path, struct event_list *list);
void events_finish(struct event_list *list);

#endif
