/* What the parts of cost_measure share; see cost.h. */
#ifndef COST_MEASURE_H
#define COST_MEASURE_H

#include "cost/cost.h"

/* The reference's. Glass doubles the rays at every bounce: with no bail-out at all such a depth
   would take for ever. */
enum { MEASURE_DEPTH = 32, MEASURE_LIGHT_SAMPLES = 64 };
#define MEASURE_BAILOUT 0x1p-16

struct measure {
    const struct cost_request *request;
    struct cost_report *report;
    double start_ms;
    struct settings usual;
    whit_renderer *renderer;             /* of the usual settings */
    whit_renderer *beside;               /* the same again for other views, or NULL */
    whit_image *references[2];           /* of one sample, of the most */
    whit_image *usual_color, *usual_ids; /* at the judged size */
    whit_judge *judges[COST_SETS];       /* or NULL */
    whit_hit *hits;                      /* room for those of a set */
    double usual_pixel_ms;               /* of the usual picture, by the wall clock */
    uint32_t row;                        /* that is being measured */
    double row_s;                        /* that one took of late; 0: not known */
};

whit_result measure_still_wanted(const struct measure *measure);
/* Seconds left of the time limit, to be the limit of renderers and references, which count from
   their own start; 0: there is none. */
double measure_left_s(const struct measure *measure);
/* Tells `what` is being done. */
void measure_say(const struct measure *measure, const char *what);

/* Opens what rows are measured with. */
WHIT_CHECK whit_result measure_open(struct measure *measure, const struct cost_request *request,
                                    struct cost_report *report);
void measure_close(struct measure *measure);

#endif
