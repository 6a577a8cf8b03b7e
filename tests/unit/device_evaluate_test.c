/* Kernels that are evaluated before the driver sees them compute what C computes. */
#include "device/specialize.h"
#include "device_fixture.h"

#include "device_evaluate.h"
#include "unit.h"

enum { CASES = 4096, TRIPS_MAX = 4 };

static uint32_t cases[CASES], answers[CASES][2], squares[TRIPS_MAX];

/* The functions of device_evaluate.comp. */
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

static uint32_t early(uint32_t a, uint32_t *b)
{
    *b += 1;
    if ((a & 16) != 0)
        return *b;
    *b += 2;
    if ((a & 32) != 0)
        return a;
    *b = 9;
    return a + *b;
}

/* The variables of remember(). */
struct memory {
    uint32_t v, w, x, y, z, sum;
};

static void choose(uint32_t a, struct memory *m)
{
    if ((a & 1) != 0) {
        m->v = 4;
        m->sum += m->v + m->w;
    } else {
        m->sum += m->v * m->w;
        m->x = 8;
    }
    m->sum = m->sum * 3 + m->v + m->w + m->x;
    switch (a >> 1 & 3) {
    case 0:
        m->v = 20;
        /* fall through */
    case 1:
        m->sum += m->v + m->y;
        m->w = 6;
        break;
    case 2:
        m->v = 21;
        m->sum += m->v;
        break;
    default:
        break;
    }
    m->sum = m->sum * 3 + m->v + m->w;
}

static void repeat(uint32_t a, struct memory *m)
{
    for (uint32_t i = 0; i < (a >> 3 & 7); ++i) {
        m->sum = m->sum * 3 + m->v + m->x + m->y + m->z;
        m->z += 2;
        if (i == 2)
            continue;
        m->v = i;
        if (i == 5)
            break;
        m->x += m->v;
    }
    m->sum = m->sum * 3 + m->v + m->x + m->y;
    uint32_t turns = 0;
    do {
        if ((a >> 6 & 3) == turns)
            break;
        m->w = 30 + turns;
        m->sum += m->w;
        if ((a >> 8 & 1) != 0)
            continue;
        m->y = 40;
    } while (turns++ < 2);
    m->sum = m->sum * 3 + m->w + m->y;
}

static uint32_t remembered(uint32_t a)
{
    struct memory m = {3, 5, 7, 11, 13, 0};
    choose(a, &m);
    repeat(a, &m);
    m.z = 17;
    while ((m.v & 7) != 0) {
        m.v--;
        m.sum += m.z;
        m.sum += early(a + m.v, &m.z);
        m.sum += m.z;
    }
    m.sum = m.sum * 3;
    m.sum += early(a >> 2, &m.w);
    return m.sum * 3 + m.v + m.w + m.x + m.y + m.z;
}

/* A kernel that is refused would go to the driver whole. */
static void check_it_is_evaluated(uint32_t trips)
{
    own_memory uint32_t *words = NULL;
    size_t count;
    assert_int_equal(
        spirv_evaluate(device_evaluate, sizeof device_evaluate / 4, &trips, 1, &words, &count),
        WHIT_OK);
}

TEST(evaluated_kernels_compute_the_same)
{
    struct device *device = device_open(&messages, false);
    for (uint32_t i = 0; i < CASES; ++i)
        cases[i] = i < 1024 ? i : i * 0x9e3779b9u;
    for (uint32_t trips = 1; trips <= TRIPS_MAX; ++trips) {
        check_it_is_evaluated(trips);
        kernel_answer_as(device, &trips, 1, device_evaluate, sizeof device_evaluate, CASES, cases,
                         sizeof *cases, answers, sizeof *answers);
        for (uint32_t i = 0; i < CASES; ++i) {
            assert_int_equal(answers[i][0], expected(trips, cases[i]));
            assert_int_equal(answers[i][1], remembered(cases[i]));
        }
    }
    device_close(device, &messages);
}
