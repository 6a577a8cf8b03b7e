// Results of the tests of a user's file. SPEC_CHECK_WORDS: words with a bit for each check of a
// test.
#ifndef HOOK_CHECK_GLSL
#define HOOK_CHECK_GLSL

#include "../abi/bindings.h"

// For each test, word and seed: bits of the checks that were reached, and of those that failed.
layout(set = 0, binding = BIND_PROBE, std430) writeonly buffer CheckBuffer { uvec2 check_rows[]; };

uint checks_reached[SPEC_CHECK_WORDS], checks_failed[SPEC_CHECK_WORDS];

// Records whether a test's statement holds. In a file it is written check(holds); whit adds the
// check's word and bit as constants, so that the driver keeps the arrays in registers: kernels that
// write them to memory take long to compile.
void check(uint word, uint bit, bool holds)
{
    checks_reached[word] |= bit;
    checks_failed[word] |= holds ? 0u : bit;
}

void begin_checks()
{
    for (uint word = 0u; word < SPEC_CHECK_WORDS; word++) {
        checks_reached[word] = 0u;
        checks_failed[word] = 0u;
    }
}

void store_checks(uint test, uint seed)
{
    for (uint word = 0u; word < SPEC_CHECK_WORDS; word++)
        check_rows[(test * SPEC_CHECK_WORDS + word) * TEST_SEEDS + seed] =
            uvec2(checks_reached[word], checks_failed[word]);
}

#endif
