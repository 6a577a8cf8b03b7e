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
/* The target's picture at another size, in what is left of the time limit. */
whit_renderer_params measure_sized(const struct measure *measure, const struct settings *target,
                                   uint32_t width, uint32_t height);

/* Both references, at the largest size that `seconds` allow (reference.c). */
WHIT_CHECK whit_result measure_references(struct measure *measure, double seconds);
/* The sets of rays (rays.c) for the usual trees, and the hits of a renderer of `target`. */
WHIT_CHECK whit_result measure_judges(struct measure *measure);
WHIT_CHECK whit_result measure_hits(struct measure *measure, whit_renderer *renderer,
                                    const struct settings *target, struct cost_row *row);
/* One row: renderer, errors, price, hits, within about `seconds` (row.c). What a device or a scene
   refuses is a note in the row, and WHIT_OK. */
WHIT_CHECK whit_result measure_row(struct measure *measure, const struct settings *target,
                                   enum knob_level level, double seconds, struct cost_row *row);
/* The usual settings' row, from measure->renderer, within about `seconds`. */
WHIT_CHECK whit_result measure_usual(struct measure *measure, double seconds, struct cost_row *row);
/* Opens what rows are measured with. */
WHIT_CHECK whit_result measure_open(struct measure *measure, const struct cost_request *request,
                                    struct cost_report *report);
void measure_close(struct measure *measure);

#endif
