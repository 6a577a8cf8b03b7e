/* Pictures as projects: `whit view toon.png` and `whit render toon.png` repeat what a picture's
   recipe says. */
#ifndef APP_RENDER_REPEAT_H
#define APP_RENDER_REPEAT_H

#include "app/arguments.h"
#include "app/job.h"

/* The options of a command that repeat a picture by its recipe. */
struct repeat {
    const char *picture; /* --recipe; NULL: a picture in the place of the scene */
    bool yes;            /* --yes */
};

/* The rows of these options in a command's table; `type` is its record, with a struct repeat at
   `member`. */
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

/* The picture whose recipe is to be repeated: that of --recipe, or the first argument where it is a
   picture; NULL: none. */
const char *repeat_picture(const struct cli_reader *reader, const struct repeat *repeat);

/* Reads the picture's recipe into the job, then the command line again, which overrides it, also
   into `own`. Files that the recipe names outside of the picture's folder are refused, and options
   that do not describe a picture are skipped: only the user may widen the rights of files and
   functions. Shows what is to be loaded and compiled, and asks on the terminal. False: exit with
   reader->status; the reason was printed. */
bool repeat_read(struct job *job, struct cli_reader *reader, void *own, const struct repeat *repeat,
                 int argc, char **argv);

#endif
