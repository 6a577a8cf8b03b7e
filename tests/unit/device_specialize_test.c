/* Kernels with their constants filled in. No device is needed. */
#include "abi/bindings.h"
#include "abi/spec.h"
#include "base/spirv.h"
#include "device/device.h"
#include "device/specialize.h"
#include "kernels.h"
#include "unit.h"

struct tally {
    uint32_t instructions, spec_constants, float_operations, exact, functions, calls;
    uint32_t inexact; /* float operations without the decoration NoContraction */
};

static bool is_float_operation(uint32_t opcode)
{
    return opcode == OP_F_ADD || opcode == OP_F_SUB || opcode == OP_F_MUL || opcode == OP_F_DIV;
}

/* Counts in one pass: decorations come before functions. */
static struct tally tally_of(const uint32_t *words, size_t count)
{
    struct tally tally = {0};
    size_t at = SPV_HEADER_WORDS;
    own_memory bool *marked = calloc(words[SPV_BOUND_AT], sizeof *marked); /* the bound of ids */
    assert_non_null(marked);
    while (at < count) {
        uint32_t opcode = spv_op(words + at), length = spv_length(words + at);
        assert_true(length > 0 && length <= count - at);
        ++tally.instructions;
        tally.spec_constants += opcode >= OP_SPEC_CONSTANT_TRUE && opcode <= OP_SPEC_CONSTANT_OP;
        tally.float_operations += is_float_operation(opcode);
        tally.functions += opcode == OP_FUNCTION;
        tally.calls += opcode == OP_FUNCTION_CALL;
        if (opcode == OP_DECORATE && words[at + 2] == DECORATION_NO_CONTRACTION) {
            ++tally.exact;
            marked[words[at + 1]] = true;
        }
        tally.inexact += is_float_operation(opcode) && !marked[words[at + 2]];
        at += length;
    }
    return tally;
}

static uint32_t *filled_in(int kernel, const struct gpu_spec *spec, size_t *count)
{
    uint32_t *words = NULL;
    assert_int_equal(spirv_evaluate(kernels[kernel].words, kernels[kernel].bytes / 4,
                                    (const uint32_t *)spec, GPU_SPEC_COUNT, &words, count),
                     WHIT_OK);
    return words;
}

static struct tally specialized(int kernel, const struct gpu_spec *spec)
{
    size_t count = 0;
    own_memory uint32_t *words = filled_in(kernel, spec, &count);
    return tally_of(words, count);
}

TEST(constants_are_gone_and_floats_stay_exact)
{
    const struct gpu_spec all = GPU_SPEC_DEFAULTS;
    for (int i = 0; i < KERNEL_COUNT; ++i) {
        int kernel = i;
        struct tally before = tally_of(kernels[kernel].words, kernels[kernel].bytes / 4);
        struct tally after = specialized(kernel, &all);
        assert_true(before.spec_constants > 0);
        assert_int_equal(after.spec_constants, 0);
        assert_true(after.float_operations > 0);
        assert_true(after.exact >= after.float_operations);
        assert_int_equal(after.inexact, 0);
    }
}

/* An evaluated kernel is one function, with the same operations marked as exact, and uses no
   binding that the whole kernel does not use. */
TEST(evaluated_kernels_call_nothing)
{
    const struct gpu_spec all = GPU_SPEC_DEFAULTS;
    struct gpu_spec less = all;
    less.SPEC_REFRACTION = less.SPEC_FILTERS = less.SPEC_LISTED = 0;
    for (int i = 0; i < 2 * KERNEL_COUNT; ++i) {
        int kernel = i / 2;
        struct spirv_info whole, flat;
        size_t words_before = kernels[kernel].bytes / 4, count = 0;
        own_memory uint32_t *words = filled_in(kernel, i % 2 ? &less : &all, &count);
        struct tally before = tally_of(kernels[kernel].words, words_before);
        struct tally after = tally_of(words, count);
        assert_true(spirv_inspect(kernels[kernel].words, words_before, &whole));
        assert_true(spirv_inspect(words, count, &flat));
        print_message("  %s: %u functions, %u float operations; flat: %u of %u not exact\n",
                      kernels[kernel].name, before.functions, before.float_operations,
                      after.inexact, after.float_operations);
        assert_true(before.functions > 1 && before.calls > 0);
        assert_int_equal(after.functions, 1);
        assert_int_equal(after.calls, 0);
        assert_int_equal(after.inexact, 0);
        assert_int_equal(flat.bindings & ~whole.bindings, 0);
    }
}

TEST(what_is_switched_off_is_gone)
{
    const struct gpu_spec all = GPU_SPEC_DEFAULTS;
    struct gpu_spec plain = all;
    plain.SPEC_REFRACTION = plain.SPEC_REFLECTION = plain.SPEC_TEXTURES = 0;
    plain.SPEC_SECONDARY = plain.SPEC_INSTANCED = plain.SPEC_FILTERS = 0;
    uint32_t of_all = specialized(KERNEL_SHADE, &all).instructions;
    uint32_t of_plain = specialized(KERNEL_SHADE, &plain).instructions;
    print_message("  %u instructions with every effect, %u without six\n", of_all, of_plain);
    assert_true(of_plain < of_all * 9 / 10);
}

/* Loops left with the control Unroll. */
static uint32_t loops_to_unroll(int kernel, const struct gpu_spec *spec)
{
    size_t count = 0;
    uint32_t *words = filled_in(kernel, spec, &count), loops = 0;
    for (size_t at = SPV_HEADER_WORDS; at < count; at += spv_length(words + at))
        loops += spv_op(words + at) == OP_LOOP_MERGE && (words[at + 3] & 1);
    free(words);
    return loops;
}

TEST(loops_of_one_and_two_iterations_are_unrolled)
{
    static const int traced[] = {KERNEL_CLOSEST, KERNEL_SHADOW};
    for (size_t i = 0; i < sizeof traced / sizeof *traced; ++i) {
        struct gpu_spec spec = GPU_SPEC_DEFAULTS;
        spec.SPEC_PACKET_RAYS = 1;
        assert_int_equal(loops_to_unroll(traced[i], &spec), 0);
        spec.SPEC_PACKET_RAYS = 2;
        assert_int_equal(loops_to_unroll(traced[i], &spec), 0);
        spec.SPEC_PACKET_RAYS = 4;
        assert_true(loops_to_unroll(traced[i], &spec) > 2);
    }
}

TEST(nonsense_is_left_to_the_driver)
{
    uint32_t words[64], *out = NULL;
    size_t count = 0;
    memset(words, 0x5a, sizeof words);
    struct spirv_info info;
    assert_int_equal(spirv_evaluate(words, 64, NULL, 0, &out, &count), WHIT_ERROR_INPUT);
    assert_null(out);
    assert_false(spirv_inspect(words, 64, &info));
}

/* Kernels truncated after each of their first 500 instructions, and after some later ones. */
TEST(cut_kernels_are_refused)
{
    const uint32_t *words = kernels[KERNEL_TRACE].words;
    const uint32_t total = (uint32_t)(kernels[KERNEL_TRACE].bytes / 4);
    const struct gpu_spec spec = GPU_SPEC_DEFAULTS;
    uint32_t cuts = 0;
    for (uint32_t at = SPV_HEADER_WORDS, i = 0; at < total; at += spv_length(words + at), ++i) {
        uint32_t *cut = malloc(at * sizeof *cut),
                 *out = NULL; /* exact size: sanitizers see reads beyond */
        size_t count = 0;
        if (!cut || (i > 500 && i % 97)) {
            free(cut);
            continue;
        }
        memcpy(cut, words, at * sizeof *cut);
        assert_int_equal(
            spirv_evaluate(cut, at, (const uint32_t *)&spec, GPU_SPEC_COUNT, &out, &count),
            WHIT_ERROR_INPUT);
        assert_null(out);
        free(cut);
        ++cuts;
    }
    print_message("  0 of %u cut kernels were taken\n", cuts);
    assert_true(cuts > 500);
}

/* info.bindings has exactly the bindings that the evaluated function uses. */
TEST(bindings_follow_the_constants)
{
    struct gpu_spec spec = GPU_SPEC_DEFAULTS;
    for (uint32_t i = 0; i < 2; ++i) {
        uint32_t path = i % 2 ? LOAD_TEXEL : LOAD_STORAGE;
        size_t count = 0;
        struct spirv_info info;
        spec.SPEC_LOAD_PATH = path;
        own_memory uint32_t *words = filled_in(KERNEL_CLOSEST, &spec, &count);
        assert_true(spirv_inspect(words, count, &info));
        assert_true(info.instructions > 0 &&
                    info.instructions < tally_of(words, count).instructions);
        assert_int_equal(info.bindings >> BIND_NODES & 1, path == LOAD_STORAGE);
        assert_int_equal(info.bindings >> BIND_NODE_TEXELS & 1, path == LOAD_TEXEL);
        assert_int_equal(info.bindings >> BIND_ENVIRONMENT & 1, 1);
        assert_int_equal(info.bindings >> BIND_COSTS & 1, 0); /* SPEC_COUNT is 0 */
    }
}
