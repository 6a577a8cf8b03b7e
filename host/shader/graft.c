#include "shader/graft.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

/* --- ids -------------------------------------------------------------------------------------- */

uint32_t graft_id(struct graft *g, uint32_t id)
{
    if (id >= g->user.bound) {
        g->why = "the compiler names what there is not";
        return 0;
    }
    if (!g->ids[id])
        g->ids[id] = g->base.next_id++;
    return g->ids[id];
}

void graft_put(struct graft *g, struct spv_words *to, const uint32_t *words)
{
    uint32_t at = to->count;
    spv_put(&g->base, to, words, spv_length(words));
    for (uint32_t i = 1; !g->base.failed && i < spv_length(words); ++i) {
        if (spv_is_id(words, i))
            to->words[at + i] = graft_id(g, words[i]);
    }
}

static const char **read_names(const struct spv_module *m)
{
    const char **names = array_alloc_zeroed(m->bound + (size_t)1, sizeof *names);
    for (const uint32_t *words = spv_step(m, NULL); names && words; words = spv_step(m, words)) {
        if (spv_op(words) == OP_NAME && spv_length(words) > 2 && words[1] < m->bound &&
            memchr(words + 2, 0, 4 * (size_t)(spv_length(words) - 2)))
            names[words[1]] = (const char *)(words + 2);
    }
    return names;
}

bool graft_same_name(const char *a, const char *b)
{
    return a && b && strcmp(a, b) == 0;
}

/* --- types and constants ---------------------------------------------------------------------- */

static bool has_decoration(const struct spv_module *m, uint32_t id)
{
    for (const uint32_t *words = spv_step(m, NULL); words; words = spv_step(m, words)) {
        uint32_t op = spv_op(words);
        if ((op == OP_DECORATE || op == OP_MEMBER_DECORATE) && words[1] == id)
            return true;
    }
    return false;
}

/* Whether two instructions are equal, except for the result id in word `result`. */
static bool is_same(const uint32_t *words, const uint32_t *asked, uint32_t result)
{
    uint32_t length = spv_length(asked);
    return words[0] == asked[0] && (result == 1 || words[1] == asked[1]) &&
           memcmp(words + result + 1, asked + result + 1, (length - result - 1) * sizeof *words) ==
               0;
}

/* The id of an equal type or constant in the kernel, or among added instructions; 0: there is none.
   A struct with decorations (a layout) is not equal to one without. */
static uint32_t find_same(const struct graft *g, const uint32_t *asked, uint32_t result,
                          const char *name)
{
    const struct spv_module *base = &g->base;
    bool record = spv_op(asked) == OP_TYPE_STRUCT;
    for (const uint32_t *words = spv_step(base, NULL); words; words = spv_step(base, words)) {
        if (is_same(words, asked, result) &&
            (!record ||
             (graft_same_name(name, g->base_names[words[1]]) && !has_decoration(base, words[1]))))
            return words[result];
    }
    for (uint32_t at = 0; !record && at < base->globals.count;
         at += spv_length(base->globals.words + at)) {
        if (is_same(base->globals.words + at, asked, result))
            return base->globals.words[at + result];
    }
    return 0;
}

void graft_value(struct graft *g, const uint32_t *words, uint32_t result)
{
    struct spv_words *globals = &g->base.globals;
    uint32_t at = globals->count, id = words[result];
    g->ids[id] = UINT32_MAX;
    graft_put(g, globals, words);
    if (g->base.failed)
        return;
    uint32_t same = find_same(g, globals->words + at, result, g->user_names[id]);
    /* An instruction that has just been added finds itself, with the id UINT32_MAX. */
    g->ids[id] = same && same != UINT32_MAX ? same : g->base.next_id++;
    globals->words[at + result] = g->ids[id];
    if (same && same != UINT32_MAX)
        globals->count = at;
}

bool graft_begin(struct graft *g, const uint32_t *base, size_t base_words, const uint32_t *user,
                 size_t user_words, const char *own)
{
    *g = (struct graft){0};
    if (!spv_read(&g->base, base, base_words, own) || !spv_read(&g->user, user, user_words, own))
        return false;
    g->ids = array_alloc_zeroed(g->user.bound + (size_t)1, sizeof *g->ids);
    g->base_names = read_names(&g->base);
    g->user_names = read_names(&g->user);
    return g->ids && g->base_names && g->user_names;
}

void graft_finish(struct graft *g)
{
    free(g->ids);
    free((void *)g->base_names);
    free((void *)g->user_names);
    spv_finish(&g->base);
    spv_finish(&g->user);
}
