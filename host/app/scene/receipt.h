/* The receipt of `whit scene --effects`: what each effect costs here, and what it gives. */
#ifndef APP_SCENE_RECEIPT_H
#define APP_SCENE_RECEIPT_H

#include "app/commands.h"
#include "base/sample.h"

/* What the receipt says of one effect. */
struct receipt_row {
    const char *name, *reason; /* "" when not called for */
    bool called, compiled;
    bool priced; /* what follows was measured */
    /* Per pair of runs: the time of a frame with the effect less that of one without it. */
    struct sample_runs cost;
    /* What the picture has by it: pixels with any difference, largest one of a channel. */
    uint64_t pixels;
    double largest;
};

enum { RECEIPT_ROWS_MAX = 64 };
struct receipt {
    const struct job *job;
    whit_kernel_info kernel;
    struct sample_runs frame;
    uint32_t row_count;
    struct receipt_row rows[RECEIPT_ROWS_MAX];
};

/* Measures and prints. EXIT_DIFFERS where a picture is not what it must be: one with an effect that
   the scene does not call for has to be the same. */
int receipt_run(struct job *job, bool json);

/* receipt_output.c */
int receipt_print_text(const struct receipt *receipt);
int receipt_print_json(const struct receipt *receipt);

#endif
