/* The shader (a user's file) in the window: read again whenever it is written, with its sliders. */
#ifndef VIEW_SHADERS_H
#define VIEW_SHADERS_H

#include <stdbool.h>
#include <stdint.h>

#include "view/engine.h"

struct watch;

enum { SHADERS_LINE = 256 };

/* Moments that the user waits for after a save, by whit_clock_ms; 0 if one has not come yet. */
struct shaders_wait {
    bool goes_on;          /* true until its line was shown, or until the next save */
    struct settings asked; /* the settings when the window noticed the save */
    double saved_ms;       /* when the window noticed the save */
    double first_ms;       /* when the first picture by the new file was shown */
    double whole_ms;       /* when the whole picture of `asked` was shown */
    double error_ms;       /* when an error was shown instead */
};

/* Numbers of saves that have come to each of these moments, for replays. */
struct shaders_counts {
    uint64_t first, whole, refused;
};

struct shaders {
    struct watch *watch;      /* watches the file and its includes; NULL: not possible */
    struct shader_ref *shown; /* shader of the picture that is shown; NULL: none */
    /* Why the current file is not shown, an error a line; "": it is shown, or may still be. */
    char errors[SESSION_ERRORS];
    uint32_t errors_reload; /* settings.shader_reload of the save that failed */
    int64_t saved_ns;       /* watch_now_ns() at the last save, before its files were read */
    uint32_t errors_drawn;  /* number of errors drawn in the window */
    bool was_saved;         /* `before`: settings.shader_reload of the version before */
    uint32_t before;
    struct shaders_wait wait;
    struct shaders_counts counts;
    uint64_t reload;         /* number of the last engine_reload that was handled */
    char line[SHADERS_LINE]; /* what the last reload changed; "": not known yet */
};

struct view;

void shaders_begin(struct view *view);
void shaders_end(struct view *view);
/* Asks for the shader again if one of its files was written. */
void shaders_watch(struct view *view);
/* Call it when there is a new picture. */
void shaders_take(struct view *view);
/* Makes `settings` those of the version before the last save. False: there is none. */
bool shaders_set_before(const struct view *view, struct settings *settings);
/* Call it when a request failed. If its shader is the reason, the compiler's errors are kept and
   shown. False: the reason is another. */
bool shaders_refuse(struct view *view);
/* Call it when the window was just drawn, with view->frame and errors. */
void shaders_shown(struct view *view);
/* Shows what a reload changed, once that is known. */
void shaders_step(struct view *view);
/* Writes what a reload changed as a line. Unknown values are left out, except for the time: the
   line says why it is not known. */
void shaders_say(const struct engine_reload *reload, const struct shaders_wait *wait,
                 char line[SHADERS_LINE]);
/* Draws the sliders of the shader in a panel. */
void shaders_draw(struct view *view);

#endif
