/* The results of `whit probe`, as text and as JSON. */
#ifndef APP_PROBE_PROBE_OUTPUT_H
#define APP_PROBE_PROBE_OUTPUT_H

#include "app/probe/probe.h"

/* On standard output. */
int probe_print(const struct probe *probe);
/* To json_path. */
whit_result probe_save_json(const struct probe *probe);

#endif
