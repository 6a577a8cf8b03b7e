/* The request of `whit probe`, and its results, as text and as JSON. */
#ifndef APP_PROBE_PROBE_OUTPUT_H
#define APP_PROBE_PROBE_OUTPUT_H

#include "app/job.h"

struct probe {
    struct job job;
    uint32_t x, y, max_rays; /* max_rays 0: as many as fit */
    bool has_pixel;
    const char *json_path; /* NULL: none */
    whit_probe_report *report;
};

/* On standard output. */
int probe_print(const struct probe *probe);
/* To json_path. */
whit_result probe_save_json(const struct probe *probe);

#endif
