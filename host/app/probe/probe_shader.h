/* What a user's functions have to do with a pixel. */
#ifndef APP_PROBE_PROBE_SHADER_H
#define APP_PROBE_PROBE_SHADER_H

#include "app/document.h"
#include "app/probe/probe.h"

/* Nothing without functions of the user's. */
void probe_print_shader(const struct probe *probe);
void probe_print_calls(const whit_probe_report *report);
json_t *probe_shader_document(const struct probe *probe); /* null without */
json_t *probe_calls_document(const whit_probe_report *report);

#endif
