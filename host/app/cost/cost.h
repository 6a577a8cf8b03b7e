/* The request of `whit cost`, and its report in all formats. */
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
    double under, within_ms; /* limits to choose settings for; 0: not given */
    uint32_t metric;
    uint32_t rays; /* COST_RAYS_UNSAID: chosen by whit */
    char *command; /* the command line of this run; owned */
    struct cli_progress progress;
    char doing[COST_NAME]; /* what is being measured, for errors */
    struct cost_report *report;
};

/* Default time limits: of `whit cost`, and of `whit cost --quick` and the choices of `whit
   render`. */
#define COST_SECONDS       150.0
#define COST_SECONDS_QUICK 20.0

extern const char cost_page_html[]; /* page_head.html and page.html, ended by 0 */
whit_result cost_save_page(const struct cost *cost);

/* Prints a comparison of two reports (cost_compare.c). */
int cost_compare_files(const char *a, const char *b);

#endif
