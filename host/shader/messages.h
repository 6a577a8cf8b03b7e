/* What glslang says, as places in the user's text and reasons. */
#ifndef SHADER_MESSAGES_H
#define SHADER_MESSAGES_H

#include "shader/glslang.h"

/* The first one of a line is kept. `own` as in struct glslang_error. */
void messages_add(struct glslang_answer *answer, uint32_t own, uint32_t file, uint32_t line,
                  const char *reason);
/* A log of glslang's: its errors, without what follows from them. One at least. */
void messages_take(struct glslang_answer *answer, const struct glslang_question *question,
                   const char *log);
/* The first place in the user's text that has this word. */
bool messages_find_word(const struct glslang_question *question, const char *word, uint32_t *file,
                        uint32_t *line);

#endif
