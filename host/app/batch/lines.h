/* The file of `whit batch`: each line is a picture or a part of one. */
#ifndef APP_BATCH_LINES_H
#define APP_BATCH_LINES_H

#include "app/batch/outputs.h"
#include "base/key_table.h"

enum { LINE_BYTES_MAX = 64 << 10 };

/* A line of the text: `bytes` bytes from byte `at` on, without its end. */
struct line_place {
    size_t at, bytes;
    /* Lines are grouped by their scene, and within one scene by their trees and kernels: the
       numbers of the first lines of these groups. */
    uint32_t scene, kernel;
    uint32_t number;
    bool left; /* it is still to be drawn */
};

struct lines {
    const char *path;
    char *text;
    const struct settings *own; /* settings of the command itself */
    bool resume;                /* --resume of the command, for all lines */
    bool keeps;                 /* --resume can keep the files of all lines */
    struct line_place *places;  /* in the order in which they are drawn */
    uint32_t count, capacity;
    struct outputs outputs;  /* while lines are read */
    struct key_table groups; /* while lines are read: numbers of first lines by the hash of their
                                group */
    bool compile;            /* a line has functions or stages that are compiled */
};

/* A line that was read; its words are in `text`. */
struct line {
    char where[SETTING_PATH_BYTES + 16], text[LINE_BYTES_MAX];
    struct job job; /* only its settings are used */
    struct render_request request;
};

/* Reads and checks all lines of the file `path`, and sorts them so that lines of one scene, and
   within it lines of the same kernels, follow each other; groups are in the order of their first
   lines. `line`: scratch memory. Gives the exit code; errors were printed. Call lines_finish in any
   case. */
int lines_init(struct lines *lines, struct line *line);
/* Reads a line. False: the line cannot be drawn, and the reason was printed. */
bool line_read(struct line *line, const struct lines *lines, const struct line_place *place);
/* Whether other lines have the same scene but other kernels. */
bool lines_share_scene(const struct lines *lines, const struct line_place *place);
void lines_finish(struct lines *lines);

#endif
