/* The file of hooks in the window: read again whenever it is written, with its sliders. */
#ifndef VIEW_SHADERS_H
#define VIEW_SHADERS_H

#include <stdbool.h>
#include <stdint.h>

#include "view/engine.h"

struct watch;

enum { SHADERS_LINE = 256 };

/* What the user waits for after a save: moments by whit_clock_ms, 0 where that did not come yet. */
struct shaders_wait {
    bool goes_on;          /* until the line of it is said, or the next save */
    struct settings asked; /* when the window saw the save */
    double saved_ms;       /* that moment */
    double first_ms;       /* the first picture by the new file was shown */
    double whole_ms;       /* the whole picture of what was asked for then */
    double error_ms;       /* why there is none was shown */
};

/* How many saves came as far as that, for replays. */
struct shaders_counts {
    uint64_t first, whole, refused;
};

struct shaders {
    struct watch *watch;         /* on the file and what it includes; NULL: not possible */
    struct shader_ref *shown;    /* of the picture that is shown; NULL: none */
    char errors[SESSION_ERRORS]; /* why the file as it now stands is not shown, an error a line; "":
                                    it is, or may be yet */
    uint32_t errors_reload; /* the save that they are of: they stay until the next one is tried */
    uint32_t errors_drawn;  /* of them, in the window */
    bool was_saved;         /* `before` is settings.shader_reload of the version before */
    uint32_t before;
    struct shaders_wait wait;
    struct shaders_counts counts;
    uint64_t reload;         /* number of the last one that was looked at */
    char line[SHADERS_LINE]; /* what the last one changed; "": not known yet */
};

struct view;

void shaders_begin(struct view *view);
void shaders_end(struct view *view);
/* Asks for what was written. */
void shaders_watch(struct view *view);
/* There is a new picture. */
void shaders_take(struct view *view);
/* Makes settings those of the version before the last save. False: there is none. */
bool shaders_set_before(const struct view *view, struct settings *settings);
/* Settings that were asked for have failed. Where their shader is the reason, it keeps and shows
   the errors of the compiler. False: the reason is another. */
bool shaders_refuse(struct view *view);
/* The window was drawn just now, with `view->frame` and what went wrong. */
void shaders_shown(struct view *view);
/* Says what a reload changed, once that is known. */
void shaders_step(struct view *view);
/* That, as a line: what is not known is left out, but why the time is not. */
void shaders_say(const struct engine_reload *reload, const struct shaders_wait *wait,
                 char line[SHADERS_LINE]);
/* Its sliders, in a panel. */
void shaders_draw(struct view *view);

#endif
