/* The file of hooks in the window: read again whenever it is written, with its sliders. */
#ifndef VIEW_SHADERS_H
#define VIEW_SHADERS_H

#include <stdbool.h>
#include <stdint.h>

#include "view/engine.h"

struct watch;

enum { SHADERS_LINE = 256 };

/* What the user waits for after a save. */
struct shaders_wait {
    double saved_ms;       /* when the window saw the save; 0: what is shown is up to date */
    struct settings asked; /* then */
    double first_ms;       /* from then to the first picture by the new file; 0: not shown yet */
    double whole_ms;       /* likewise to the whole picture of what was asked for then */
};

struct shaders {
    struct watch *watch;        /* on the file and what it includes; NULL: not possible */
    struct shader_ref *shown;   /* of the picture that is shown; NULL: none */
    char error[ENGINE_MESSAGE]; /* why the file as it now stands is not shown; "": it is, or may be
                                   yet */
    bool was_saved;             /* `before` is settings.shader_reload of the version before */
    uint32_t before;
    struct shaders_wait wait;
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
/* What was asked for failed: keeps why, where it is the shader. */
void shaders_refuse(struct view *view);
/* The window was drawn just now, with `view->frame`. */
void shaders_shown(struct view *view);
/* Says what a reload changed, once that is known. */
void shaders_step(struct view *view);
/* That, as a line: what is not known is left out, but why the time is not. */
void shaders_say(const struct engine_reload *reload, const struct shaders_wait *wait,
                 char line[SHADERS_LINE]);
/* Its sliders, in a panel. */
void shaders_draw(struct view *view);

#endif
