/* The file of hooks in the window: read again whenever it is written, with its sliders. */
#ifndef VIEW_SHADERS_H
#define VIEW_SHADERS_H

#include <stdbool.h>
#include <stdint.h>

#include "view/engine.h"

struct watch;

struct shaders {
    struct watch *watch;        /* on the file and what it includes; NULL: not possible */
    struct shader_ref *shown;   /* of the picture that is shown; NULL: none */
    char error[ENGINE_MESSAGE]; /* why the file as it now stands is not shown; "": it is, or may be
                                   yet */
    bool was_saved;             /* `before` is settings.shader_reload of the version before */
    uint32_t before;
    uint64_t change; /* number of the last change that was looked at */
    double read_ms;  /* when it was read again; 0: what is shown is up to date */
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
/* Says what a reload changed, once that is known. */
void shaders_step(struct view *view);
/* Its sliders, in a panel. */
void shaders_draw(struct view *view);

#endif
