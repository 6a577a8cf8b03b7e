/* What `whit probe` was asked for, and what it found. */
#ifndef APP_PROBE_PROBE_H
#define APP_PROBE_PROBE_H

#include "app/commands.h"

struct probe {
    struct job job;
    uint32_t x, y, max_rays; /* 0: all that there is room for */
    bool has_pixel;
    const char *json_path; /* NULL: none */
    whit_probe_report *report;
};

/* On standard output. */
int probe_print(const struct probe *probe);
/* probe_shader.c: nothing without functions of the user's. */
void probe_print_shader(const struct probe *probe);
void probe_print_calls(const whit_probe_report *report);
json_t *probe_shader_document(const struct probe *probe); /* null without */
json_t *probe_calls_document(const whit_probe_report *report);
/* To json_path. */
whit_result probe_save_json(const struct probe *probe);

#endif
