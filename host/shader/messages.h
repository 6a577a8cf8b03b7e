/* Turns messages of glslang into reasons with places in the user's text. */
#ifndef SHADER_MESSAGES_H
#define SHADER_MESSAGES_H

#include "shader/glslang.h"

/* Adds an error, unless its line has one. `own` as in struct glslang_error. */
void messages_add(struct glslang_answer *answer, uint32_t own, uint32_t file, uint32_t line,
                  const char *reason);
/* Adds the errors in a log of glslang, without those that follow from others; at least one.
   `preprocessed`: the question's text as the preprocessor left it. */
void messages_take(struct glslang_answer *answer, const struct glslang_question *question,
                   const char *preprocessed, const char *log);
/* Finds the first place of a word in the user's text. */
bool messages_find_word(const struct glslang_question *question, const char *word, uint32_t *file,
                        uint32_t *line);

#endif
