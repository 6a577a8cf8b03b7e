/* Refuses what functions of users may not do, as found in their SPIR-V. */
#ifndef SHADER_REFUSE_H
#define SHADER_REFUSE_H

#include "shader/module.h"

enum { REFUSE_VARIABLE_BYTES = 16 << 10 }; /* all variables of the user together */

/* Why an instruction of the user's code is refused; NULL: it is allowed. */
const char *refuse_instruction(const struct spv_module *m, const uint32_t *words);

/* Refuses an OpFunctionCall in the user's code that calls a function of whit's own which is not
   meant for users: those check no index into whit's buffers. `why` has room for
   SHADER_REASON_BYTES. */
bool refuse_call(const struct spv_module *m, const uint32_t *words, char *why);

/* Sums up the variables of the user's functions. */
struct refuse_variables {
    uint64_t bytes;
    uint32_t *tables; /* ids of initializers: each is counted once */
    uint32_t table_count, table_capacity;
    bool refused; /* an error was given: one is enough */
};
/* Adds a variable of the user (`words` is its OpVariable). NULL, or why it is one too many. */
const char *refuse_variable(struct refuse_variables *all, struct spv_module *m,
                            const uint32_t *words);

/* A capability that only the user's text needs; 0: there is none. *name: what it is for, "" if not
   known. */
uint32_t refuse_capability(const struct spv_module *m, const char **name);

/* The file of whit's own that a function of the module is from; "": not known; NULL: it is the
   user's. */
const char *refuse_file(const struct spv_module *m, const uint32_t *function);

#endif
