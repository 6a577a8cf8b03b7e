// What tests of a user's file find. SPEC_CHECK_WORDS: words that have a bit for each check of a test.
#ifndef HOOK_CHECK_GLSL
#define HOOK_CHECK_GLSL

#include "../abi/bindings.h"

// For each test, word and seed: bits of checks that were reached, and of those that failed.
layout(set = 0, binding = BIND_PROBE, std430) writeonly buffer CheckBuffer { uvec2 check_rows[]; };

uint checks_reached[SPEC_CHECK_WORDS], checks_failed[SPEC_CHECK_WORDS];

// Whether what a test says holds. In a file it is written check(holds): whit puts the check's word and bit
// in front, as numbers, so that the driver keeps them in registers: it takes long to make what writes.
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
