/* What the user does, as the window tells it or as a file of a replay does.

   The file has one event a line; # begins a comment. What --record writes:
       wait MS | key NAME down|up [Shift+][Ctrl+][Alt+] | char CODE | button left|right|middle
       down|up | move X Y | wheel X Y | size W H | drop PATH | close
   and, for tests, also
       press [Shift+][Ctrl+][Alt+]NAME   a key down and up
       click X Y                         move there, and the left button down and up
       still, picture, priced, until FIELD [= VALUE], await PATH
                                         the replay goes on once that is so
       choose LABEL                      a click on what has this label, once it is there
       clock real                        `wait` takes its time from here on
       state [NAME]                      one line of JSON on standard output
       shot FILE.png                     the window, with what is drawn over the picture
       minimise | restore
   docs/view.md says what each of them does. */
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
    EVENT_SIZE, /* of the window's pixels; 0 x 0: minimised */
    EVENT_DROP,
    EVENT_CLOSE,
    EVENT_REFRESH, /* the window wants to be drawn again */
    /* of replays alone */
    EVENT_WAIT,
    EVENT_STILL,
    EVENT_PICTURE,
    EVENT_PRICED,
    EVENT_REFINED,
    EVENT_UNTIL,
    EVENT_AWAIT,
    EVENT_CHOOSE,
    EVENT_CLOCK, /* the real one */
    EVENT_STATE,
    EVENT_SHOT,
    EVENT_MINIMISE,
    EVENT_RESTORE,
};

enum { EVENT_SHIFT = 1, EVENT_CTRL = 2, EVENT_ALT = 4, EVENT_PATH = 1024 };

/* Keys: letters and digits are themselves, as capitals; others from here on. */
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
    KEY_F1, /* to KEY_F1 + 11 */
    KEY_F12 = KEY_F1 + 11,
    KEY_SHIFT,
    KEY_CTRL,
    KEY_ALT,
};

struct view_event {
    enum view_event_kind kind;
    int key;       /* enum view_key, or a character */
    bool down;     /* of keys and buttons */
    bool repeat;   /* a key that is held */
    unsigned mods; /* EVENT_SHIFT and others, or-ed */
    int button;    /* 0 left, 1 right, 2 middle */
    uint32_t code; /* EVENT_CHAR: Unicode */
    double x, y;   /* pixels of the window; notches of the wheel; EVENT_WAIT: x is ms */
    uint32_t width, height;
    const char *path; /* of files, shorter than EVENT_PATH; EVENT_STATE: its name; EVENT_UNTIL: the
                         condition; borrowed from where the event came from */
};

/* One line, without the end; false, logged with file and line, for nonsense. Empty lines and
   comments are EVENT_NONE. `press` and `click` give several events. Paths point into `text`. */
enum { EVENTS_A_LINE = 4 };
bool events_from_line(const whit_log *log, const char *file, uint32_t line, const char *text,
                      struct view_event events[EVENTS_A_LINE], int *count);
/* What events_from_line reads back; nothing for events that have no line. */
void event_to_line(const struct view_event *event, FILE *to);

/* All events of a file; *events is one block with all that they point to, free() it. */
WHIT_CHECK whit_result events_load(const whit_log *log, const char *path,
                                   struct view_event **events, uint32_t *count);

#endif
