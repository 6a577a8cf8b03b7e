/* Parts of one module, `user`, in another, `base`: the same types and constants are one, and what
   is added gets ids of the base. */
#ifndef SHADER_GRAFT_H
#define SHADER_GRAFT_H

#include "shader/module.h"

struct graft {
    struct spv_module base, user; /* what is added stands in base.globals, with ids of base */
    uint32_t *ids;                /* by id of the user's module: of the base; 0: none as yet */
    const char **base_names, **user_names; /* by id; NULL: none */
    const char *why;                       /* it cannot be done; NULL: it can */
};

/* False: damaged, or no memory. graft_finish in either case. */
bool graft_begin(struct graft *g, const uint32_t *base, size_t base_words, const uint32_t *user,
                 size_t user_words, const char *own);
void graft_finish(struct graft *g);

/* The id that one of the user's has in the base; a new one where it has none. */
uint32_t graft_id(struct graft *g, uint32_t id);
/* Adds an instruction of the user's, with ids of the base. */
void graft_put(struct graft *g, struct spv_words *to, const uint32_t *words);
/* Takes a type or constant of the user's, whose parts were taken before; `result`: the word of its
   id. What a specialization constant is without one, it stays. */
void graft_value(struct graft *g, const uint32_t *words, uint32_t result);

/* False where there is none. */
bool graft_same_name(const char *a, const char *b);

#endif
