/* A SPIR-V module as glslang made it, with OpLine and OpName, and its rewriting: it is read once,
   then each instruction of its functions is checked, and copied or replaced. The result has no
   debug instructions. This runs in the child process that compiled the module. */
#ifndef SHADER_MODULE_H
#define SHADER_MODULE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/spirv.h"
#include "shader/compile.h"

struct spv_words {
    uint32_t *words;
    uint32_t count, capacity;
};

/* A place in the user's text; `file` UINT32_MAX: in whit's own text. */
struct spv_place {
    uint32_t file, line;
};

struct spv_constant {
    uint32_t type, value, id;
};

struct spv_module {
    const uint32_t *words;
    size_t count;
    size_t functions_at;      /* the first word of the first OpFunction */
    uint32_t *defined_at;     /* by id: first word of its defining instruction; 0: none */
    uint32_t bound;           /* all ids in `words` are below it */
    uint32_t next_id;         /* next id for added instructions */
    uint32_t glsl;            /* id of GLSL.std.450; 0: not imported */
    uint32_t fuel, fuel_loop; /* ids of whit_fuel, whit_fuel_loop; 0: not declared */
    const char *own;          /* how names of whit's own files begin */
    bool failed;              /* no memory */

    /* The output: added types and constants, and functions. */
    struct spv_words globals, body;
    struct spv_words zeroed; /* global variables that begin as 0, unless initialized */
    struct spv_constant *constants;
    uint32_t constant_count, constant_capacity;

    /* The function and the place of the current instruction. */
    uint32_t function, return_type;
    bool user_function;
    struct spv_place place;
};

/* False: the module is damaged, or no memory. */
bool spv_read(struct spv_module *m, const uint32_t *words, size_t count, const char *own);
void spv_finish(struct spv_module *m);

/* Updates function and place by OpLine and OpFunction. True: the instruction is in the user's
   code. */
bool spv_follow(struct spv_module *m, const uint32_t *instruction);
/* The instruction that defines an id; NULL: there is none. */
const uint32_t *spv_def(const struct spv_module *m, uint32_t id);
/* The result id of an instruction; 0: it has none. */
uint32_t spv_result(const struct spv_module *m, const uint32_t *words);
/* The first instruction in front of all functions, or with `words` the one behind it; NULL: there
   is none. The same for OpFunctions. */
const uint32_t *spv_step(const struct spv_module *m, const uint32_t *words);
const uint32_t *spv_next_function(const struct spv_module *m, const uint32_t *function);
/* The length of a function in words. */
uint32_t spv_function_words(const struct spv_module *m, const uint32_t *function);
/* Whether word `i` of an instruction (0: the first) is an id. */
bool spv_is_id(const uint32_t *words, uint32_t i);
/* Whether it is a debug instruction, which does nothing. */
bool spv_is_remark(uint32_t op);
uint32_t spv_type_of(const struct spv_module *m, uint32_t id); /* 0: it has none */
/* The value of an OpConstant of 32 bits. */
bool spv_constant_value(const struct spv_module *m, uint32_t id, uint32_t *value);
/* Bytes that a variable of this type takes; UINT64_MAX where that is not known. */
uint64_t spv_size(const struct spv_module *m, uint32_t type);
/* The text of an OpString; "": `id` is no OpString. */
const char *spv_string(const struct spv_module *m, uint32_t id);
/* The OpName of an id; "": it has none. */
const char *spv_name(const struct spv_module *m, uint32_t id);

/* The id of a type or constant, which is added if the module has none. */
uint32_t spv_uint(struct spv_module *m);
uint32_t spv_bool(struct spv_module *m);
uint32_t spv_constant(struct spv_module *m, uint32_t type, uint32_t value);
uint32_t spv_true(struct spv_module *m, uint32_t type);
uint32_t spv_null(struct spv_module *m, uint32_t type);
uint32_t spv_pointer(struct spv_module *m, uint32_t type); /* pointer to a variable of a function */

void spv_put(struct spv_module *m, struct spv_words *to, const uint32_t *words, uint32_t count);
/* SPV_EMIT(m, op, operands...) appends an instruction to m->body. */
#define SPV_EMIT(m, op, ...)                                                                       \
    do {                                                                                           \
        const uint32_t operands_[] = {__VA_ARGS__};                                                \
        spv_emit(m, op, operands_, sizeof operands_ / sizeof *operands_);                          \
    } while (0)
void spv_emit(struct spv_module *m, uint32_t op, const uint32_t *operands, uint32_t count);

/* Writes the module with added types and constants, and with `body` as its functions; without debug
   instructions unless keeps_remarks. Free ->words. */
struct spv_words spv_write(struct spv_module *m, bool keeps_remarks);

#endif
