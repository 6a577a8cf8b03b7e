/* A batch of rays in a file or a pipe: 32-byte records, one whit_ray each. */
#ifndef APP_TRACE_RAY_FILE_H
#define APP_TRACE_RAY_FILE_H

#include <stdio.h>

#include "whit/whit.h"

struct ray_file {
    const char *path; /* borrowed */
    FILE *stream;
    uint64_t ray_count;  /* 0: not known, for pipes */
    uint64_t read_count; /* so far */
};

/* Both functions print errors by cli_error. A length that is not a whole number of rays is refused
   by ray_file_open where it is known, else at the end of the file. Call ray_file_close also after
   an error. */
WHIT_CHECK whit_result ray_file_open(const char *path, struct ray_file *file);
/* Reads the next rays, at most `max`; *count is 0 at the end. */
WHIT_CHECK whit_result ray_file_read(struct ray_file *file, whit_ray *rays, uint64_t max,
                                     uint64_t *count);
void ray_file_close(struct ray_file *file);

#endif
