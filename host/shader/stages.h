/* Stages (kernels of pictures) of a checkout, in place of the embedded ones: the files in `kernel/`
   of its `shaders/`, with all that they include. */
#ifndef SHADER_STAGES_H
#define SHADER_STAGES_H

#include "shader/errors.h"
#include "sources.h"

enum { SHADER_STAGES_MAX = 128, SHADER_STAGES_FILE_BYTES = 1 << 20 };

/* files[i] has the path of shader_sources[i], for i < shader_source_count; further included files
   follow. A file that no kernel includes has no text. */
struct shader_stages {
    struct shader_source files[SHADER_STAGES_MAX];
    /* As whit opened the files: for messages, and to watch them. NULL: the file has no text. */
    char *names[SHADER_STAGES_MAX];
    uint32_t count;
    uint64_t hash; /* hash of all paths and texts */
};

/* Reads `kernels`, paths relative to `folder` that end with NULL, and all that they include, which
   has to be below `folder`. Errors, with the line of the #include: a file that is missing or
   outside, or a file of abi/ that differs from the embedded one, which the program was built with.
   WHIT_ERROR_INPUT, _MEMORY; *out is then NULL. Free it by shader_stages_destroy. */
WHIT_CHECK whit_result shader_stages_read(const whit_log *log, const char *folder,
                                          const char *const *kernels, struct shader_stages **out,
                                          struct shader_errors *errors);
void shader_stages_destroy(struct shader_stages *stages); /* NULL is fine */

/* The files of `stages`; NULL: the embedded ones. */
const struct shader_source *shader_stages_list(const struct shader_stages *stages, uint32_t *count);
/* The index of a path in shader_stages_list; the list's length: there is no such file, or it has no
   text. */
uint32_t shader_stages_find(const struct shader_stages *stages, const char *path);

#endif
