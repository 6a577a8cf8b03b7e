#include "shader/exact.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/spirv.h"

static bool is_float_operation(uint32_t op)
{
    return op == OP_F_NEGATE || op == OP_F_ADD || op == OP_F_SUB || op == OP_F_MUL ||
           op == OP_F_DIV || op == OP_F_REM || op == OP_F_MOD ||
           (op >= OP_VECTOR_TIMES_SCALAR && op <= OP_DOT);
}

struct scan {
    bool *marked; /* by id: whether it is decorated already */
    size_t types_at, operations;
};

static bool scan_module(const uint32_t *words, size_t count, struct scan *scan)
{
    for (size_t at = SPV_HEADER_WORDS; at < count; at += spv_length(words + at)) {
        uint32_t length = spv_length(words + at), op = spv_op(words + at);
        if (length == 0 || length > count - at)
            return false;
        if (op == OP_TYPE_VOID && scan->types_at == 0)
            scan->types_at = at;
        if (op == OP_DECORATE && length == 3 && words[at + 2] == DECORATION_NO_CONTRACTION &&
            words[at + 1] < words[SPV_BOUND_AT])
            scan->marked[words[at + 1]] = true;
        if (!is_float_operation(op))
            continue;
        if (length < 4 || words[at + 2] >= words[SPV_BOUND_AT])
            return false;
        scan->operations++;
    }
    return true;
}

static size_t put_decorations(uint32_t *out, const uint32_t *words, size_t count,
                              const bool *marked)
{
    size_t used = 0;
    for (size_t at = SPV_HEADER_WORDS; at < count; at += spv_length(words + at)) {
        if (!is_float_operation(spv_op(words + at)) || marked[words[at + 2]])
            continue;
        out[used++] = spv_head(OP_DECORATE, 3);
        out[used++] = words[at + 2];
        out[used++] = DECORATION_NO_CONTRACTION;
    }
    return used;
}

enum shader_exact shader_exact(const uint32_t *words, size_t count, uint32_t **out,
                               size_t *out_count)
{
    *out = NULL;
    if (count < SPV_HEADER_WORDS || words[0] != SPV_MAGIC || words[SPV_BOUND_AT] > SPV_BOUND_MAX)
        return EXACT_DAMAGED;
    struct scan scan = {.marked = calloc(words[SPV_BOUND_AT] + (size_t)1, sizeof(bool))};
    if (!scan.marked)
        return EXACT_NO_MEMORY;
    enum shader_exact end = scan_module(words, count, &scan) ? EXACT_DONE : EXACT_DAMAGED;
    if (end == EXACT_DONE && scan.types_at == 0)
        end = EXACT_NO_TYPES;
    if (end == EXACT_DONE && !(*out = malloc((count + 3 * scan.operations) * sizeof **out)))
        end = EXACT_NO_MEMORY;
    if (end == EXACT_DONE) {
        memcpy(*out, words, scan.types_at * sizeof **out);
        size_t used = scan.types_at;
        used += put_decorations(*out + used, words, count, scan.marked);
        memcpy(*out + used, words + scan.types_at, (count - scan.types_at) * sizeof **out);
        *out_count = used + count - scan.types_at;
    }
    free(scan.marked);
    return end;
}
