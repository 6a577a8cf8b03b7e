/* Kernels with their constants filled in. No device is needed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "abi/spec.h"
#include "device/specialize.h"
#include "kernels.h"

enum { HEADER_WORDS = 5, OP_SPEC_FIRST = 48, OP_SPEC_LAST = 52, OP_DECORATE = 71 };
enum { DECORATION_NO_CONTRACTION = 42 };

struct tally {
    uint32_t instructions, spec_constants, float_operations, exact;
};

/* OpFAdd 129, OpFSub 131, OpFMul 133, OpFDiv 136. */
static bool is_float_operation(uint32_t opcode)
{
    return opcode == 129 || opcode == 131 || opcode == 133 || opcode == 136;
}

static struct tally tally_of(const uint32_t *words, size_t count)
{
    struct tally tally = {0};
    size_t at = HEADER_WORDS;
    while (at < count) {
        uint32_t opcode = words[at] & 0xffff, length = words[at] >> 16;
        assert_true(length > 0 && length <= count - at);
        ++tally.instructions;
        tally.spec_constants += opcode >= OP_SPEC_FIRST && opcode <= OP_SPEC_LAST;
        tally.float_operations += is_float_operation(opcode);
        tally.exact += opcode == OP_DECORATE && words[at + 2] == DECORATION_NO_CONTRACTION;
        at += length;
    }
    return tally;
}

static struct tally specialized(enum kernel kernel, const struct gpu_spec *spec)
{
    uint32_t *words = NULL;
    size_t count = 0;
    assert_true(spirv_specialize(kernels[kernel].words, kernels[kernel].bytes / 4,
                                 (const uint32_t *)spec, GPU_SPEC_COUNT, &words, &count));
    struct tally tally = tally_of(words, count);
    free(words);
    return tally;
}

static void constants_are_gone_and_floats_stay_exact(void **state)
{
    (void)state;
    const struct gpu_spec all = GPU_SPEC_DEFAULTS;
    for (int kernel = 0; kernel < KERNEL_COUNT; ++kernel) {
        struct tally before = tally_of(kernels[kernel].words, kernels[kernel].bytes / 4);
        struct tally after = specialized((enum kernel)kernel, &all);
        assert_true(before.spec_constants > 0);
        assert_int_equal(after.spec_constants, 0);
        assert_true(after.float_operations > 0);
        assert_true(after.exact >= after.float_operations);
    }
}

static void what_is_switched_off_is_gone(void **state)
{
    (void)state;
    const struct gpu_spec all = GPU_SPEC_DEFAULTS;
    struct gpu_spec plain = all;
    plain.SPEC_REFRACTION = plain.SPEC_REFLECTION = plain.SPEC_TEXTURES = 0;
    plain.SPEC_SECONDARY = plain.SPEC_INSTANCED = plain.SPEC_FILTERS = 0;
    uint32_t of_all = specialized(KERNEL_WHITTED, &all).instructions;
    uint32_t of_plain = specialized(KERNEL_WHITTED, &plain).instructions;
    print_message("  %u instructions with every effect, %u without six\n", of_all, of_plain);
    assert_true(of_plain < of_all * 9 / 10);
}

static void nonsense_is_left_to_the_driver(void **state)
{
    (void)state;
    uint32_t words[64], *out = NULL;
    size_t count = 0;
    memset(words, 0x5a, sizeof words);
    assert_false(spirv_specialize(words, 64, NULL, 0, &out, &count));
    assert_null(out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_are_gone_and_floats_stay_exact),
        cmocka_unit_test(what_is_switched_off_is_gone),
        cmocka_unit_test(nonsense_is_left_to_the_driver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
