/* What `whit cost` was asked for, and its report in all forms. */
#ifndef APP_COST_COST_H
#define APP_COST_COST_H

#include "app/document.h"
#include "app/job.h"
#include "cost/cost.h"

#define COST_RAYS_UNSAID WHIT_NONE

struct cost {
    struct job job;
    struct cost_request request;
    const char *html, *json, *csv, *markdown; /* files, or NULL */
    bool quick, compares;
    double under, within_ms; /* 0: not asked for */
    uint32_t metric;
    uint32_t rays; /* COST_RAYS_UNSAID: as it suits */
    char *command; /* that made it; owned */
    struct cli_progress progress;
    struct cost_report *report;
};

/* cost_request.progress of a cli_progress. */
void cost_on_progress(void *user, double done, double seconds_left, const char *what);

/* Seconds that `whit cost` may take by itself, with --quick, and for `whit render`'s choices. */
#define COST_SECONDS       150.0
#define COST_SECONDS_QUICK 20.0

extern const char cost_page_html[]; /* page.html, ended by 0; CMake makes it */
whit_result cost_save_page(const struct cost *cost);

/* Two reports beside each other (cost_compare.c). */
int cost_compare_files(const char *a, const char *b);

#endif
