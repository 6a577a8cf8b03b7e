/* Output of `whit probe` about the functions of --shader. */
#ifndef APP_PROBE_PROBE_SHADER_H
#define APP_PROBE_PROBE_SHADER_H

#include "app/document.h"
#include "app/probe/probe.h"

/* Prints nothing without --shader. */
void probe_print_shader(const struct probe *probe);
void probe_print_calls(const whit_probe_report *report);
json_t *probe_shader_document(const struct probe *probe); /* null without --shader */
json_t *probe_calls_document(const whit_probe_report *report);

#endif
