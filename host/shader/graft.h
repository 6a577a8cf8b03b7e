/* Adds parts of one SPIR-V module, `user`, to another, `base`. Types and constants that both have
   are shared, and added instructions get ids of the base. */
#ifndef SHADER_GRAFT_H
#define SHADER_GRAFT_H

#include "shader/module.h"

struct graft {
    struct spv_module base, user;          /* added instructions are in base.globals */
    uint32_t *ids;                         /* by id of `user`: its id in `base`; 0: none yet */
    const char **base_names, **user_names; /* names by id; NULL: no name */
    const char *why;                       /* why it cannot be done; NULL: it can */
};

/* False: a module is damaged, or no memory. Call graft_finish also then. */
bool graft_begin(struct graft *g, const uint32_t *base, size_t base_words, const uint32_t *user,
                 size_t user_words, const char *own);
void graft_finish(struct graft *g);

/* The id in the base of an id of the user's module; a new id if it has none. */
uint32_t graft_id(struct graft *g, uint32_t id);
/* Appends an instruction of the user's module to `to`, with ids of the base. */
void graft_put(struct graft *g, struct spv_words *to, const uint32_t *words);
/* Adds a type or constant of the user's module, after those that it refers to. `result`: the word
   of its id. A specialization constant keeps its default value. */
void graft_value(struct graft *g, const uint32_t *words, uint32_t result);

/* Whether both names exist and are equal. */
bool graft_same_name(const char *a, const char *b);

#endif
