/* Partial evaluation of a kernel: its constants filled in, its calls replaced by what they call,
   and of all that only what is then left to do. One way through the words of the module, where a
   library of general passes takes a hundred times as long. Floats are never computed and nothing is
   moved or merged, so results keep their bits.

   It knows the SPIR-V that glslang writes: structured, blocks in the order of their nesting, one
   entry point, no recursion. What it does not know it refuses.

   evaluate_read.c finds what there is, evaluate.c walks through the functions and decides branches,
   evaluate_memory.c follows what variables hold, evaluate_output.c leaves out what nothing uses and
   writes the module. */
#ifndef DEVICE_EVALUATE_H
#define DEVICE_EVALUATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "device/spirv_ops.h"

enum { SPIRV_BOUND_MAX = 1 << 20 };

/* An id of the module that came in, while the function that it stands in is walked through. */
struct source_id {
    uint32_t at;        /* word of its instruction; 0: none */
    uint32_t to;        /* the id that it became; 0: none so far */
    uint32_t holds;     /* of pointers: value in what they point to, all through the function */
    uint32_t writes;    /* of variables and parameters: instructions that write there */
    uint32_t returns;   /* of functions: instructions that return */
    uint32_t chosen;    /* of blocks: the only block that follows; 0: all that are named */
    uint32_t end_label; /* of blocks: the block that they ended in */
    uint32_t incoming;  /* of blocks: ways in so far */
    uint32_t header;    /* of blocks that continue a loop: its first block */
    bool exact;         /* NoContraction */
    bool begins_loop;
    bool reached, visited, is_merge, is_continue;
    bool is_set; /* of constants: by the caller */
};

/* An id of the module that goes out. */
struct result_id {
    uint32_t type;   /* of a known value */
    uint32_t value;  /* of bools and 32-bit integers */
    uint32_t base;   /* of a pointer: the variable of a function that it points into; 0: none */
    uint32_t stored; /* of such a variable: value in it, in block number `block` */
    uint32_t block;
    uint32_t same_as; /* of labels that were taken back: the block they are part of */
    bool known, exact, live;
};

struct word_list {
    uint32_t *words;
    uint32_t count, capacity;
};

/* A function that is being walked through. */
struct instance {
    const struct instance *caller;
    uint32_t depth;    /* of calls */
    uint32_t label;    /* source: block in hand */
    uint32_t merge;    /* source: word of a merge instruction that waits for its branch; 0: none */
    uint32_t after;    /* label behind the call; 0: of the entry point */
    uint32_t variable; /* of what is returned, once there is one */
    uint32_t result_type; /* 0: none */
    uint32_t returns;     /* that are reached */
    uint32_t value;       /* that is returned by the one that waits */
    bool return_waits;    /* a return's branch is not written: where it is the only return, the
                             caller goes on in its block */
    bool skips;           /* until the next block that is reached */
    uint32_t wrap, wrap_label, label_before; /* see begin_wrap; word of the body; 0: none */
    uint32_t loops[16], loop_depth;          /* source: merge blocks of the loops around */
};

struct evaluation {
    const uint32_t *words;
    uint32_t count, functions_at, entry;
    struct source_id *source;
    uint32_t source_count;
    struct result_id *results;
    uint32_t result_count, result_capacity;
    struct word_list globals, variables, body;
    struct word_list constants; /* ids of those that are known */
    uint32_t uint_type;
    uint32_t first_label; /* of the function */
    uint32_t block;       /* number of the block in hand */
    uint32_t label;       /* that it begins with */
    uint32_t delayed;     /* source: block that the last one goes on in; 0: none */
    bool failed;          /* refused, or out of memory */
    bool starved;         /* the latter */
};

/* evaluate_read.c: false when the module is broken. spec_of[id]: number of a specialization
   constant, for ids that have one. */
bool evaluate_read(struct evaluation *e, uint32_t *spec_of);

/* evaluate_output.c: malloc()ed; NULL when memory runs out. */
uint32_t *evaluate_write(struct evaluation *e, size_t *word_count);

void evaluate_push(struct evaluation *e, struct word_list *list, uint32_t word);
/* The id that `id` became, or will become. */
uint32_t evaluate_id(struct evaluation *e, uint32_t id);
/* The id for `instruction`'s result in the new body. It is exact (NoContraction) where the old one
   was. */
uint32_t evaluate_result(struct evaluation *e, const uint32_t *instruction);
void evaluate_copy(struct evaluation *e, const uint32_t *instruction);

#endif
