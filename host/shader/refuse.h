/* What functions of users may not do, found in what was made of them. */
#ifndef SHADER_REFUSE_H
#define SHADER_REFUSE_H

#include "shader/module.h"

enum { REFUSE_VARIABLE_BYTES = 16 << 10 }; /* of all variables of the user's together */

/* Why an instruction of the user's is refused; NULL: it is not. */
const char *refuse_instruction(const struct spv_module *m, const uint32_t *words);

/* Whether an OpFunctionCall of the user's calls what is neither the user's nor meant for users:
   what reads and writes whit's buffers checks no index. `why` has room for SHADER_REASON_BYTES. */
bool refuse_call(const struct spv_module *m, const uint32_t *words, char *why);

/* Variables of the user's functions, one after the other. */
struct refuse_variables {
    uint64_t bytes;
    uint32_t *tables; /* initializers, which are counted once */
    uint32_t table_count, table_capacity;
    bool refused; /* once is enough */
};
/* NULL, or why a variable of the user's is one too many. `words` is an OpVariable. */
const char *refuse_variable(struct refuse_variables *all, struct spv_module *m,
                            const uint32_t *words);

/* A capability that kernels do not have without the user's text; 0: there is none. *name says what
   it is for, "" where that is not known. */
uint32_t refuse_capability(const struct spv_module *m, const char **name);

/* The file of whit's that a function of the module stands in; NULL: it is one of the user's. */
const char *refuse_file(const struct spv_module *m, const uint32_t *function);

#endif
