/* The receipt of `whit scene --effects`: what each effect costs here, and what it gives. */
#ifndef APP_SCENE_RECEIPT_H
#define APP_SCENE_RECEIPT_H

#include "app/job.h"
#include "cost/cost.h"

enum { RECEIPT_ROWS_MAX = 64 };
struct receipt {
    const struct job *job;
    struct cli_progress progress;
    whit_kernel_info kernel;
    struct sample_median frame_ms; /* of the picture as it is, by the clock that counts */
    uint32_t row_count;
    struct cost_effect rows[RECEIPT_ROWS_MAX]; /* by the index of whit_effect_name */
};

/* Measures and prints. EXIT_DIFFERS where an effect that the scene does not call for changes the
   picture. */
int receipt_run(struct job *job, bool json);

#endif
