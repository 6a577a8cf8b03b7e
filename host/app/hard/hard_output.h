/* The request of `whit hard`, and its results, as text and as JSON. */
#ifndef APP_HARD_HARD_OUTPUT_H
#define APP_HARD_HARD_OUTPUT_H

#include "app/job.h"

#define HARD_ALL WHIT_NONE

struct hard {
    struct job job;
    whit_hard_params params;
    whit_hard_view_params view;
    const char *camera, *json_path, *output; /* NULL: none */
    uint32_t drawn;                          /* of values_hard_view: which picture is drawn in place
                                                of the table; 0: none */
    uint32_t level;                          /* whit_numerics; HARD_ALL: the table has all */
    bool quick;
    whit_hard_report *report;
    struct cli_progress progress;
};

/* On standard output. */
int hard_print(const struct hard *hard);
/* To json_path. */
whit_result hard_save_json(const struct hard *hard);

#endif
