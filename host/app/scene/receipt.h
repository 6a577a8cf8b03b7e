/* The report of `whit scene --effects`: what each effect costs in this scene, and how much it
   changes the picture. */
#ifndef APP_SCENE_RECEIPT_H
#define APP_SCENE_RECEIPT_H

#include "app/job.h"
#include "cost/cost.h"

enum { RECEIPT_ROWS_MAX = 64 };
struct receipt {
    const struct job *job;
    struct cli_progress progress;
    whit_kernel_info kernel;
    struct sample_median frame_ms; /* time of the picture with the scene's own effects; by the
                                      device's clock where it has one */
    uint32_t row_count;
    struct cost_effect rows[RECEIPT_ROWS_MAX]; /* by the index of whit_effect_name */
};

/* Measures and prints. EXIT_DIFFERS where an effect that the scene does not call for changes the
   picture. */
int receipt_run(struct job *job, bool json);

#endif
