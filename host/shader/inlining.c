#include "shader/inlining.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "shader/reach.h"
#include "shader/refuse.h"

/* Instructions that stand for whit's own functions, whose bodies are not in the module: a traversal
   takes thousands. */
enum { OWN_PLAIN = 100, OWN_TRACES = 16000 };

struct inlining {
    struct spv_module *m;
    uint32_t *sizes; /* by id of a function; 0: not known */
    const uint32_t *large;
};

static uint32_t own_size(const struct inlining *in, const uint32_t *function)
{
    const char *file = refuse_file(in->m, function);
    if (!file || strcmp(file, "hook/interface.glsl") != 0)
        return 0;
    return reach_traces(spv_name(in->m, function[2])) ? OWN_TRACES : OWN_PLAIN;
}

/* The recursion is at most as deep as there are functions, and glslang has refused calls in a
   circle. */
static uint32_t measure(struct inlining *in, const uint32_t *function)
{
    uint32_t *known = &in->sizes[function[2]];
    if (*known)
        return *known;
    uint64_t size = own_size(in, function) + 1;
    for (const uint32_t *at = function; spv_op(at) != OP_FUNCTION_END; at += spv_length(at)) {
        const uint32_t *called = spv_op(at) == OP_FUNCTION_CALL ? spv_def(in->m, at[3]) : NULL;
        size += called && spv_op(called) == OP_FUNCTION ? measure(in, called)
                                                        : !spv_is_remark(spv_op(at));
    }
    *known = size < UINT32_MAX ? (uint32_t)size : UINT32_MAX;
    if (size > INLINING_MAX && !in->large)
        in->large = function;
    return *known;
}

const uint32_t *inlining_find_large(struct spv_module *m)
{
    struct inlining in = {.m = m, .sizes = array_alloc_zeroed(m->bound, sizeof *in.sizes)};
    m->failed = m->failed || !in.sizes;
    for (const uint32_t *words = spv_next_function(m, NULL); in.sizes && words;
         words = spv_next_function(m, words))
        (void)measure(&in, words);
    free(in.sizes);
    return in.large;
}
