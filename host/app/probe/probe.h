/* The request of `whit probe`, and its results. */
#ifndef APP_PROBE_PROBE_H
#define APP_PROBE_PROBE_H

#include "app/job.h"

struct probe {
    struct job job;
    uint32_t x, y, max_rays; /* max_rays 0: as many as fit */
    bool has_pixel;
    const char *json_path; /* NULL: none */
    whit_probe_report *report;
};

#endif
