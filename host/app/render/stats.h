/* Figures of `whit render`. */
#ifndef APP_RENDER_STATS_H
#define APP_RENDER_STATS_H

#include "app/render/render_command.h"

/* Prints `label`, the device's name and its driver as a line. */
void stats_print_device(const char *label, const whit_device *device);

/* --stats of `whit render`: on standard output. Gives the exit code. */
int stats_print(const struct job *job, const struct render_request *request,
                const whit_renderer *renderer, const struct sequence *sequence);

#endif
