/* Partial evaluation of a kernel: its specialization constants are filled in, its calls inlined,
   short loops unrolled, and what is then never executed or used is left out. This takes one pass
   over the words of the module; a library of general passes takes a hundred times as long. Floats
   are never computed and nothing is moved or merged, so results keep their bits.

   It handles the SPIR-V that glslang writes: structured, blocks in the order of their nesting, one
   entry point, no recursion. Any other module is refused.

   evaluate_read.c finds what the module contains, evaluate_constants.c computes its constants,
   evaluate.c walks through the functions and decides branches, evaluate_loops.c finds loops to
   unroll, evaluate_memory.c follows what variables hold, evaluate_output.c leaves out what nothing
   uses and writes the module. */
#ifndef DEVICE_EVALUATE_H
#define DEVICE_EVALUATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "device/spirv_ops.h"

enum { SPIRV_BOUND_MAX = 1 << 20 };

/* Facts about an id of the input module, while its function is walked through. */
struct source_id {
    uint32_t at;     /* index of its instruction's first word; 0: none */
    uint32_t to;     /* its id in the output module; 0: none so far */
    uint32_t holds;  /* of pointers: id of the value behind them, the same all through the function;
                        0: not known */
    uint32_t writes; /* of variables and parameters: number of instructions that write there, at
                        most 2 */
    uint32_t returns;   /* of functions: number of return instructions */
    uint32_t chosen;    /* of blocks: the only successor; 0: all that the branch names */
    uint32_t end_label; /* of blocks: label of the output block that they ended in */
    uint32_t incoming;  /* of blocks: number of branches to them so far */
    uint32_t header;    /* of continue blocks: the loop's header block */
    bool exact;         /* decorated with NoContraction */
    bool begins_loop;
    bool reached, visited, is_merge, is_continue;
    bool is_set; /* of specialization constants: the caller gave a value */
};

/* Facts about an id of the output module. */
struct result_id {
    uint32_t type;  /* of a known value */
    uint32_t value; /* known value, of bools and 32-bit integers */
    uint32_t base; /* of a pointer: the variable with storage class Function that it points into; 0:
                      none */
    uint32_t stored; /* of such a variable: id of its value while open[depth] is `region` */
    uint32_t region, depth;
    uint32_t same_as; /* of labels that take_back_wrap removed: the block that goes on instead */
    bool known, exact, live;
};

struct word_list {
    uint32_t *words;
    uint32_t count, capacity;
};

/* The entry point, or a call being inlined, while its function is walked through. */
struct instance {
    const struct instance *caller;
    uint32_t depth;       /* how deep the calls are nested */
    uint32_t label;       /* input id of the current block */
    uint32_t merge;       /* input word of a merge instruction that waits for its branch; 0: none */
    uint32_t after;       /* label behind the call; 0 for the entry point */
    uint32_t variable;    /* for the returned value, once one is needed; 0: none yet */
    uint32_t result_type; /* 0: returns nothing */
    uint32_t returns;     /* number of returns that are reached */
    uint32_t value;       /* id that the waiting return returns */
    bool return_waits;    /* the branch of a return is not written yet: if it stays the only return,
                             the caller goes on in its block */
    bool skips;           /* leaves out instructions until the next block that is reached */
    uint32_t wrap, wrap_label, label_before; /* see begin_wrap; wrap: its first word in `body` */
    uint32_t loops[16], loop_depth;          /* input ids: merge blocks of the enclosing loops */
    uint32_t unrolled;  /* header of the innermost loop that is being unrolled; 0: none */
    uint32_t resume_at; /* input word behind a loop that was unrolled just now; 0: none */
};

struct evaluation {
    const uint32_t *words;
    uint32_t count, functions_at, entry;
    struct source_id *source;
    uint32_t source_count;
    struct result_id *results;
    uint32_t result_count, result_capacity;
    struct word_list globals, variables, body;
    struct word_list constants; /* ids of constants whose value is known */
    uint32_t uint_type;
    uint32_t first_label;  /* of the output function */
    uint32_t label;        /* of the current output block */
    uint32_t goes_to;      /* input id of the block to which the last branch goes, if it is the only
                              one; 0: none */
    struct word_list open; /* numbers of the regions around the current output block */
    struct word_list constructs; /* of those around it: label of the merge block, open.count */
    uint32_t regions;            /* numbers given so far */
    uint32_t delayed; /* input id of the block that the last one branches to, with that branch not
                         written yet; 0: none */
    bool failed;      /* the module is refused, or memory ran out */
    bool starved;     /* memory ran out */
};

/* evaluate_read.c: false when the module is broken. spec_of[id]: number of a specialization
   constant, for ids that have one. */
bool evaluate_read(struct evaluation *e, uint32_t *spec_of);

/* evaluate_output.c: malloc()ed; NULL when memory runs out. */
uint32_t *evaluate_write(struct evaluation *e, size_t *word_count);

/* A new output id; 0, which is no valid id, when there are too many ids or memory runs out. */
uint32_t evaluate_new_id(struct evaluation *e);
void evaluate_push(struct evaluation *e, struct word_list *list, uint32_t word);
void evaluate_push_words(struct evaluation *e, struct word_list *list, uint32_t count,
                         const uint32_t *words);
/* Adds an instruction of the given words to a list. */
#define EVALUATE_EMIT(e, list, op, ...)                                                            \
    do {                                                                                           \
        const uint32_t words_[] = {0, __VA_ARGS__};                                                \
        uint32_t count_ = sizeof words_ / sizeof *words_;                                          \
        evaluate_push((e), (list), spv_head((op), count_));                                        \
        evaluate_push_words((e), (list), count_ - 1, words_ + 1);                                  \
    } while (0)
/* The output id for input id `id`; made where there is none yet. */
uint32_t evaluate_id(struct evaluation *e, uint32_t id);
/* The output id for `instruction`'s result. It is exact (NoContraction) where the input's is. */
uint32_t evaluate_result(struct evaluation *e, const uint32_t *instruction);
void evaluate_copy(struct evaluation *e, const uint32_t *instruction);

#endif
