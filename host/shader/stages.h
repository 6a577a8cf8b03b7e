/* The stages of a checkout, in place of those that are embedded: what `kernel/` of its `shaders/`
   has and includes. */
#ifndef SHADER_STAGES_H
#define SHADER_STAGES_H

#include "shader/errors.h"
#include "sources.h"

enum { SHADER_STAGES_MAX = 128, SHADER_STAGES_FILE_BYTES = 1 << 20 };

/* files[i] is that of shader_sources[i], up to shader_source_count; more that they include follow.
   Those that no kernel includes have no text. */
struct shader_stages {
    struct shader_source files[SHADER_STAGES_MAX];
    char *names[SHADER_STAGES_MAX]; /* as whit opened them, for messages and to be watched; NULL
                                       where there is no text */
    uint32_t count;
    uint64_t hash; /* of all paths and texts */
};

/* Reads `kernels`, paths from `folder` that end with NULL, with all that they include, below
   `folder`. What is missing or outside is an error with the line of its #include, and so is a file
   of abi/ that is not the embedded one: the program was built with that. WHIT_ERROR_INPUT, _MEMORY;
   *out is then NULL. Ended by shader_stages_destroy. */
WHIT_CHECK whit_result shader_stages_read(const whit_log *log, const char *folder,
                                          const char *const *kernels, struct shader_stages **out,
                                          struct shader_errors *errors);
void shader_stages_destroy(struct shader_stages *stages); /* NULL is fine */

/* Those of `stages`; NULL: what is embedded. */
const struct shader_source *shader_stages_list(const struct shader_stages *stages, uint32_t *count);
/* The index of a path among them; their count: there is none with a text. */
uint32_t shader_stages_find(const struct shader_stages *stages, const char *path);

#endif
