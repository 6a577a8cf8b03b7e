/* Kernels whose loops are unrolled before the driver sees them compute what C computes. */
#include "device_fixture.h"

#include "device_unroll.h"
#include "unit.h"

enum { CASES = 4096, TRIPS_MAX = 4 };

static uint32_t cases[CASES], answers[CASES], squares[TRIPS_MAX];

/* The functions of device_unroll.comp. */
static uint32_t mixed(uint32_t trips, uint32_t a, uint32_t b)
{
    uint32_t sum = a;
    if ((a & 1) == b)
        return sum * 3 + b;
    for (uint32_t i = 0; i < trips; ++i)
        sum += squares[i] * b;
    return sum;
}

static uint32_t expected(uint32_t trips, uint32_t a)
{
    uint32_t kept = 5, once = 0;
    memset(squares, 0, sizeof squares);
    for (uint32_t i = 0; i < trips; ++i) {
        if (i == 0 || a > 100)
            once = i + 7;
        kept = kept * 3 + once;
        squares[i] = i * i + a;
        for (uint32_t k = 3; k > 1; --k)
            kept += mixed(trips, kept, i) * k;
    }
    for (uint32_t i = 0; i < trips; ++i) {
        if ((kept & 4) != 0 && i == 1)
            break;
        kept += 11;
    }
    for (uint32_t i = 0; i < trips; ++i) {
        for (uint32_t turns = 0; turns <= (a & 3); ++turns)
            kept = kept * 5 + i;
        kept ^= (kept & 8) != 0 ? 0 : 0x55;
    }
    return kept;
}

TEST(unrolled_loops_compute_the_same)
{
    struct device *device = device_open(&messages, false);
    for (uint32_t i = 0; i < CASES; ++i)
        cases[i] = i < 256 ? i : i * 0x9e3779b9u;
    for (uint32_t trips = 1; trips <= TRIPS_MAX; ++trips) {
        kernel_answer_as(device, &trips, 1, device_unroll, sizeof device_unroll, CASES, cases,
                         sizeof *cases, answers, sizeof *answers);
        for (uint32_t i = 0; i < CASES; ++i)
            assert_int_equal(answers[i], expected(trips, cases[i]));
    }
    device_close(device, &messages);
}
