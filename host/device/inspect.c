/* Counts the instructions of a SPIR-V module's functions, and finds the bindings they name. */
#include "device/specialize.h"

#include <stdlib.h>

#include "base/array.h"
#include "device/evaluate.h"

enum { BINDINGS_MAX = 64 };

/* The bindings whose variables the instruction names: bit i for binding i. */
static uint64_t named_bindings(const uint32_t *at, const uint8_t *binding_of, uint32_t bound)
{
    struct spirv_shape shape = spirv_shape(spv_op(at));
    uint64_t bits = 0;
    if (spv_op(at) == OP_FUNCTION_CALL)
        shape = (struct spirv_shape){.result = true, .ids = UINT32_MAX};
    uint32_t head = shape.result ? HEAD_WORDS_RESULT : HEAD_WORDS;
    for (uint32_t i = head; i < spv_length(at); ++i) {
        if (spirv_operand_is_id(shape, i - head) && at[i] < bound && binding_of[at[i]])
            bits |= UINT64_C(1) << (binding_of[at[i]] - 1);
    }
    return bits;
}

/* `binding_of` [id]: 1 + its binding; 0: none. */
static bool inspect_words(const uint32_t *words, size_t word_count, uint8_t *binding_of,
                          struct spirv_info *out)
{
    bool in_function = false;
    for (size_t at = SPV_HEADER_WORDS; at < word_count; at += spv_length(words + at)) {
        const uint32_t *instruction = words + at;
        uint32_t length = spv_length(instruction), op = spv_op(instruction);
        if (length == 0 || length > word_count - at)
            return false;
        if (op == OP_DECORATE && length == 4 && instruction[2] == DECORATION_BINDING &&
            instruction[1] < words[3] && instruction[3] < BINDINGS_MAX)
            binding_of[instruction[1]] = (uint8_t)(instruction[3] + 1);
        in_function = in_function || op == OP_FUNCTION;
        out->instructions += in_function;
        if (in_function)
            out->bindings |= named_bindings(instruction, binding_of, words[3]);
        in_function = in_function && op != OP_FUNCTION_END;
    }
    return true;
}

bool spirv_inspect(const uint32_t *words, size_t word_count, struct spirv_info *out)
{
    *out = (struct spirv_info){0};
    if (word_count <= SPV_HEADER_WORDS || words[0] != SPV_MAGIC || words[3] == 0 ||
        words[3] > SPIRV_BOUND_MAX)
        return false;
    uint8_t *binding_of = array_alloc_zeroed(words[3], 1);
    bool done = binding_of && inspect_words(words, word_count, binding_of, out);
    free(binding_of);
    return done;
}
