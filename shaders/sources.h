/* The text of every shader, embedded at build. */
#ifndef SHADERS_SOURCES_H
#define SHADERS_SOURCES_H

#include <stddef.h>
#include <stdint.h>

struct shader_source {
    const char *path; /* from shaders/: "kernel/shade.comp" */
    const char *text; /* ends with a 0 that `bytes` does not count */
    size_t bytes;
};

extern const struct shader_source shader_sources[]; /* ordered by path */
extern const uint32_t shader_source_count;

#endif
