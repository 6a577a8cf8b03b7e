/* State and functions that the parts of cost_measure share; see cost.h. */
#ifndef COST_MEASURE_H
#define COST_MEASURE_H

#include "cost/cost.h"

/* Settings of the reference. Glass doubles the rays at every bounce, so without any bail-out this
   depth would take for ever. */
enum { MEASURE_DEPTH = 32, MEASURE_LIGHT_SAMPLES = 64 };
#define MEASURE_BAILOUT 0x1p-16

struct measure {
    const struct cost_request *request;
    struct cost_report *report;
    double start_ms;
    struct settings usual;
    whit_renderer *renderer;             /* has the usual settings */
    whit_renderer *beside;               /* another one, for rows of KNOB_VIEW; or NULL */
    whit_image *references[2];           /* with one sample, with report->reference_samples */
    whit_image *usual_color, *usual_ids; /* at the judged size */
    whit_judge *judges[COST_SETS];       /* or NULL */
    whit_hit *hits;                      /* room for the hits of one set of rays */
    double usual_pixel_ms;               /* usual picture's wall clock per pixel */
    uint32_t row;                        /* index of the row that is being measured */
    double row_s;                        /* running mean of the time per row; 0: not known */
};

/* WHIT_ERROR_CANCELLED once the request's `cancel` is set, WHIT_ERROR_TIME_LIMIT after its time. */
whit_result measure_still_wanted(const struct measure *measure);
/* Seconds left until end_ms, as the limit for renderers and references, which count from their
   own start; 0: there is no limit. */
double measure_left_s(const struct measure *measure);
/* Reports progress; `what`: the current task. */
void measure_say(const struct measure *measure, const char *what);
/* reference.c: makes both references, at the largest size that `seconds` allow. */
WHIT_CHECK whit_result measure_references(struct measure *measure, double seconds);

#endif
