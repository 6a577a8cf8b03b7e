/* The files that the lines of `whit batch` write, to find two that are the same. */
#ifndef APP_BATCH_OUTPUTS_H
#define APP_BATCH_OUTPUTS_H

#include "app/render/render_command.h"

/* Numbered files of one line: all names that are equal but for a number of as many digits. */
struct output {
    uint64_t key;         /* hash of the name without the number, and of its digits */
    uint32_t first, last; /* the numbers */
    uint32_t line;
    const char *option; /* "-o" */
};

/* Zeroed: none. */
struct outputs {
    struct output *items;
    uint32_t count, capacity;
};

/* Adds what a line writes. False: out of memory. */
bool outputs_add(struct outputs *outputs, const struct render_request *request, uint32_t line);
/* False, with an error that begins with `path`: a file is written twice, so that one picture would
   be lost. Sorts the outputs. */
bool outputs_check(struct outputs *outputs, const char *path);
void outputs_finish(struct outputs *outputs);

#endif
