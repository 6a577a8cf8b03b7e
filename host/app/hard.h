/* What `whit hard` was asked for, and what it found. */
#ifndef APP_HARD_H
#define APP_HARD_H

#include "app/job.h"

struct hard {
    struct job job;
    whit_hard_params params;
    const char *json_path; /* NULL: none */
    whit_hard_report *report;
    struct cli_progress progress;
    double seconds; /* that it took */
};

/* On standard output. */
int hard_print(const struct hard *hard);
/* To json_path. */
whit_result hard_save_json(const struct hard *hard);

#endif
