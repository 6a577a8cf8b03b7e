/* The file of `whit batch`: a picture or a part a line. */
#ifndef APP_BATCH_LINES_H
#define APP_BATCH_LINES_H

#include "app/render/render_command.h"

enum { LINE_BYTES_MAX = 64 << 10 };

/* Lines are grouped by their scene, and within one scene by their trees and kernels. */
enum { LINE_SCENE, LINE_KERNEL, LINE_GROUPS };

/* A line of the text: `bytes` bytes from byte `at` on, without its end. */
struct line_place {
    size_t at, bytes;
    uint64_t group[LINE_GROUPS]; /* equal in lines of one LINE_* group */
    uint32_t number;
    bool left; /* it is still to be drawn */
};

struct lines {
    const char *path;
    char *text;
    const struct settings *own; /* of the whole command */
    bool resume;                /* of all lines */
    struct line_place *places;  /* in the order in which they are drawn */
    uint32_t count, capacity;
    bool compile; /* a line has functions or stages that are compiled */
};

/* A line that was read; its words are in `text`. */
struct line {
    char where[SETTING_PATH_BYTES + 16], text[LINE_BYTES_MAX];
    struct job job; /* settings alone */
    struct render_request request;
};

/* Reads the file `path` and all its lines, and puts those next to each other that are of one scene,
   and among these those of the same kernels; what comes first in the file comes first. `line`: room
   for one. Gives the exit code; errors were said. For lines_finish in any case. */
int lines_init(struct lines *lines, struct line *line);
/* False: the line is not to be drawn, and why was said. */
bool line_read(struct line *line, const struct lines *lines, const struct line_place *place);
/* Whether lines of other kernels are of the same scene. */
bool lines_share_scene(const struct lines *lines, const struct line_place *place);
void lines_finish(struct lines *lines);

#endif
