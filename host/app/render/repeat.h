/* Pictures as projects: `whit view toon.png` and `whit render toon.png` repeat what a picture's
   recipe says. */
#ifndef APP_RENDER_REPEAT_H
#define APP_RENDER_REPEAT_H

#include "app/arguments.h"
#include "app/job.h"

/* The options with which a command draws again what a picture says of itself. */
struct repeat {
    const char *picture; /* --recipe; NULL: a picture in the place of the scene */
    bool yes;            /* --yes */
};

/* Rows of the options of a command whose record `type` has a struct repeat. */
#define REPEAT_OPTIONS(type, member)                                                               \
    {"recipe", 0, "PICTURE",                                                                       \
     "what PICTURE, a .png or .exr of whit's, says of itself:\n"                                   \
     "scene, camera, settings, functions, sliders; SCENE and\n"                                    \
     "options beside it have the last word",                                                       \
     SETTING_AT_NAME(type, member.picture)},                                                       \
    {                                                                                              \
        "yes", 0, NULL, "load and compile what a picture says without asking",                     \
            SETTING_AT_FLAG(type, member.yes)                                                      \
    }

/* The picture whose recipe is wanted, of what was read; NULL: none. */
const char *repeat_picture(const struct cli_reader *reader, const struct repeat *repeat);

/* Puts what the picture says into the job, and over it what the command line says, which is read
   once more, into `own` too. Nothing that the picture names outside of its folder is taken, nor an
   option that is no part of a picture: those that widen what files and functions may are said by
   the user alone. Shows what is to be loaded and compiled, and asks on the terminal. False: exit
   with reader->status; why was said. */
bool repeat_read(struct job *job, struct cli_reader *reader, void *own, const struct repeat *repeat,
                 int argc, char **argv);

/* The text that a picture carries under `key`, which lives in *texts, for whit_memory_destroy.
   NULL, and why was said: it cannot be read, or has none. */
const char *repeat_text(const char *picture, const whit_load_params *params, const char *key,
                        whit_text **texts);

#endif
