/* Compares shaders/lib/portable.glsl on the device with functions of C in double: results are
   rounded correctly, or are within the bounds of `rows`, and special values are those of C. Tests
   edge cases and some random floats. WHIT_TEST_FLOATS=N: every N-th of all floats for functions of
   one argument, and 10^9 / N pairs for functions of two.

   Double is accurate enough. A quotient or square root of floats that is rounded to double and then
   to float is rounded correctly: 53 >= 2 * 24 + 2 (Figueroa 1995, "When is double rounding
   innocuous?"). The other functions have an error of 1e-8 ulp of float in double, which is small
   compared with the errors measured here. */
#include "device_fixture.h"
#include "random_fixture.h"

#include "abi/portable.h"
#include "kernels.h"
#include "render/portable.h"
#include "unit.h"

enum { BATCH = 1 << 18, RANDOM = 1 << 17, SPECIAL_MAX = 80 };

struct row {
    const char *name;
    uint32_t function;
    double (*unary)(double);
    double (*binary)(double, double);
    double bound_ulp; /* 0.5: rounded correctly */
};

static double divide(double x, double y)
{
    return x / y;
}

static double inverse_root(double x)
{
    return 1.0 / sqrt(x);
}

static double power(double x, double y)
{
    return y == 0.0 || x == 1.0 ? 1.0 : x < 0.0 ? NAN : pow(fabs(x), y);
}

static double sum(double x, double y)
{
    return x + y;
}

static double product(double x, double y)
{
    return x * y;
}

static double smaller(double x, double y)
{
    return y < x ? y : x;
}

static double larger(double x, double y)
{
    return x < y ? y : x;
}

static double relations(double x, double y)
{
    return (x < y) | (x <= y) << 1 | (x == y) << 2 | (x != y) << 3 | (x > y) << 4 | (x >= y) << 5 |
           !(y < x) << 6;
}

/* x truncated to a whole number, within these limits; 0 for NaN. */
static double whole(double x, double least, double most)
{
    return isnan(x) ? 0.0 : trunc(x < least ? least : x > most ? most : x);
}

static double to_int(double x)
{
    return whole(x, -2147483648.0, 2147483647.0);
}

static double to_uint(double x)
{
    return whole(x, 0.0, 4294967295.0);
}

static const struct row rows[] = {
    {"int", PORTABLE_INT, to_int, NULL, 0.0},
    {"uint", PORTABLE_UINT, to_uint, NULL, 0.0},
    {"sum", PORTABLE_SUM, NULL, sum, 0.5},
    {"product", PORTABLE_PRODUCT, NULL, product, 0.5},
    {"divide", PORTABLE_DIVIDE, NULL, divide, 0.5},
    {"sqrt", PORTABLE_SQRT, sqrt, NULL, 0.5},
    {"inversesqrt", PORTABLE_INVERSESQRT, inverse_root, NULL, 1.5},
    {"exp2", PORTABLE_EXP2, exp2, NULL, 1.1},
    {"exp", PORTABLE_EXP, exp, NULL, 1.35},
    {"log2", PORTABLE_LOG2, log2, NULL, 0.53},
    {"log", PORTABLE_LOG, log, NULL, 0.53},
    {"pow", PORTABLE_POW, NULL, power, 2.8},
    {"sin", PORTABLE_SIN, sin, NULL, 1.0},
    {"cos", PORTABLE_COS, cos, NULL, 1.0},
    {"tan", PORTABLE_TAN, tan, NULL, 2.5},
    {"asin", PORTABLE_ASIN, asin, NULL, 2.5},
    {"acos", PORTABLE_ACOS, acos, NULL, 1.5},
    {"atan", PORTABLE_ATAN, atan, NULL, 2.5},
    {"atan2", PORTABLE_ATAN2, NULL, atan2, 2.5},
    {"abs", PORTABLE_ABS, fabs, NULL, 0.5},
    {"relations", PORTABLE_RELATIONS, NULL, relations, 0.0},
    {"min", PORTABLE_MIN, NULL, smaller, 0.5},
    {"max", PORTABLE_MAX, NULL, larger, 0.5},
};

static uint32_t cases[BATCH][2], answers[2][BATCH];

static float as_float(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t as_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Gives the error of the float `found` in ulp of the exact value, 0.5 or less for the nearest one;
   infinite where another kind of number is right. */
static double error_ulp(float found, double exact)
{
    float nearest = (float)exact;
    if (isnan(exact) || isnan(found))
        return isnan(exact) && as_bits(found) == 0x7fc00000 ? 0.0 : INFINITY;
    if (as_bits(found) == as_bits(nearest))
        return exact == 0.0 || isinf(nearest) ? 0.0 : 0.5;
    if (isinf(exact) || exact == 0.0 || signbit(found) != signbit(nearest))
        return INFINITY;
    double of = isinf(found) ? copysign(0x1p128, (double)found) : (double)found;
    int exponent;
    (void)frexp(exact, &exponent);
    return fabs(of - exact) / ldexp(1.0, exponent - 24 < -149 ? -149 : exponent - 24);
}

/* The library's kernel for one function, in two versions: with the device's own division and
   comparisons, where these are right, and without. */
struct runner {
    struct device *device;
    struct buffer *in, *out;
    struct kernel_run runs[2];
    struct portable_params asks; /* only modes, as the library must not call itself */
};

static void runner_begin(struct runner *r, struct device *device, uint32_t function)
{
    *r = (struct runner){.device = device,
                         .in = buffer_make(device, sizeof cases, BUFFER_STORAGE, "cases"),
                         .out = buffer_make(device, sizeof *answers, BUFFER_STORAGE, "answers")};
    const whit_log quiet = {0};
    struct portable_params asks;
    assert_int_equal(portable_choose(&quiet, device, &asks), WHIT_OK);
    r->asks = asks;
    r->asks.own_division = r->asks.own_comparison = true;
    for (uint32_t own = 0; own < 2; ++own) {
        const uint32_t spec[] = {own && asks.own_division, function, own && asks.own_comparison};
        struct pipeline_params params =
            storage_params(portable_kernel.words, portable_kernel.bytes, 2, "portable");
        params.spec = spec;
        params.spec_count = 3;
        params.rewrite = portable_rewrite;
        params.rewrite_user = &r->asks;
        params.rewrite_as = portable_number(&r->asks);
        r->runs[own] = kernel_make(device, &params, (struct buffer *const[]){r->in, r->out});
    }
}

static void runner_run(struct runner *r)
{
    assert_int_equal(buffer_write(r->in, 0, cases, sizeof cases), WHIT_OK);
    for (uint32_t own = 0; own < 2; ++own) {
        kernel_dispatch(r->device, &r->runs[own], NULL, 0, BATCH / 64);
        assert_int_equal(buffer_read(r->out, 0, answers[own], sizeof *answers), WHIT_OK);
    }
}

static void runner_end(struct runner *r)
{
    kernel_free(&r->runs[0]);
    kernel_free(&r->runs[1]);
    buffer_destroy(r->in);
    buffer_destroy(r->out);
}

static uint32_t make_special(uint32_t bits[SPECIAL_MAX])
{
    static const float values[] = {0.0f,          0x1p-149f,     0x1.8p-148f, 0x1.fffffcp-127f,
                                   0x1p-126f,     0x1p-75f,      0x1p-24f,    0x1.fffffep-1f,
                                   1.0f,          0x1.000002p0f, 0.5f,        0.75f,
                                   1.5f,          2.0f,          3.0f,        10.0f,
                                   127.0f,        128.0f,        149.0f,      150.0f,
                                   88.75f,        104.0f,        0x1p24f,     0x1p31f,
                                   0x1.921fb6p0f, 0x1.921fb6p1f, 0x1p100f,    0x1.fffffep127f,
                                   INFINITY,      0x1p-127f,     0x1p32f};
    uint32_t count = 0;
    for (size_t i = 0; i < sizeof values / sizeof *values; ++i) {
        bits[count++] = as_bits(values[i]);
        bits[count++] = as_bits(-values[i]);
    }
    bits[count++] = 0x7fc00000;
    bits[count++] = 0x7f800001;
    bits[count++] = 0xffc00123;
    return count;
}

/* Gives the error of an answer in ulp; where the function gives integers it is 0 or infinite. */
static double answer_error(const struct row *row, uint32_t answer, double exact)
{
    if (row->function == PORTABLE_INT || row->function == PORTABLE_UINT ||
        row->function == PORTABLE_RELATIONS)
        return answer == (uint32_t)(int64_t)exact ? 0.0 : INFINITY;
    return error_ulp(as_float(answer), exact);
}

struct tally {
    double worst_ulp;
    uint32_t at[2];
    uint64_t tried, apart; /* apart: cases for which the two versions gave different bits */
};

static void judge(const struct row *row, uint32_t count, struct tally *tally)
{
    for (uint32_t i = 0; i < count; ++i) {
        float x = as_float(cases[i][0]), y = as_float(cases[i][1]);
        double exact = row->unary ? row->unary((double)x) : row->binary((double)x, (double)y);
        bool copies = row->function == PORTABLE_MIN || row->function == PORTABLE_MAX ||
                      row->function == PORTABLE_ABS;
        bool own = row->function == PORTABLE_SUM || row->function == PORTABLE_PRODUCT;
        if (own && isnan(exact))
            continue; /* the device's own operation may give any NaN */
        double error = copies && isnan(exact) && isnan(as_float(answers[0][i]))
                           ? 0.0
                           : answer_error(row, answers[0][i], exact);
        bool nan = isnan(as_float(answers[0][i])) && isnan(as_float(answers[1][i]));
        tally->apart += answers[0][i] != answers[1][i] && !nan;
        ++tally->tried;
        if (error > tally->worst_ulp) {
            tally->worst_ulp = error;
            memcpy(tally->at, cases[i], sizeof tally->at);
        }
    }
}

/* Tries all edge cases, and all pairs of them. */
static void try_special(struct runner *r, const struct row *row, struct tally *tally)
{
    uint32_t bits[SPECIAL_MAX], count = make_special(bits);
    memset(cases, 0, sizeof cases);
    for (uint32_t i = 0; i < count * count; ++i) {
        cases[i][0] = bits[i / count];
        cases[i][1] = bits[i % count];
    }
    runner_run(r);
    judge(row, count * count, tally);
}

/* Makes random pairs. Half of the second arguments have the exponent of the first, or, for pow, a
   size at which the power is finite. */
static void fill_random(const struct row *row, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        uint64_t bits = random_bits64(&random_state);
        cases[i][0] = (uint32_t)bits;
        cases[i][1] = (uint32_t)(bits >> 32);
        if (row->function == PORTABLE_POW && i % 2 == 0) {
            float x = fabsf(as_float(cases[i][0])), l = log2f(x);
            cases[i][0] = as_bits(x);
            cases[i][1] = as_bits((float)(300.0 * random_unit(&random_state) - 150.0) /
                                  (isfinite(l) && l != 0.0f ? l : 1.0f));
        } else if (i % 2 == 0) {
            cases[i][1] = (cases[i][1] & 0x807fffff) | (cases[i][0] & 0x7f800000);
        }
    }
}

static void try_many(struct runner *r, const struct row *row, uint32_t step, struct tally *tally)
{
    uint64_t count = (row->unary ? UINT64_C(1) << 32 : 1000000000) / step;
    for (uint64_t first = 0; first < count; first += BATCH) {
        uint32_t part = (uint32_t)(count - first < BATCH ? count - first : BATCH);
        if (row->binary)
            fill_random(row, part);
        for (uint32_t i = 0; row->unary && i < part; ++i)
            cases[i][0] = ((uint32_t)first + i) * step;
        runner_run(r);
        judge(row, part, tally);
    }
}

/* Whether the function keeps its bound. */
static bool try_row(struct device *device, const struct row *row, uint32_t step)
{
    struct runner runner;
    struct tally tally = {0};
    runner_begin(&runner, device, row->function);
    try_special(&runner, row, &tally);
    if (step) {
        try_many(&runner, row, step, &tally);
    } else {
        fill_random(row, RANDOM);
        runner_run(&runner);
        judge(row, RANDOM, &tally);
    }
    runner_end(&runner);
    print_message("%-12s %10llu tried, off by at most %.3f ulp, at %a, %a\n", row->name,
                  (unsigned long long)tally.tried, tally.worst_ulp, (double)as_float(tally.at[0]),
                  (double)as_float(tally.at[1]));
    return tally.apart == 0 && tally.worst_ulp <= row->bound_ulp;
}

/* WHIT_TEST_FUNCTION: the name of the only function to test. */
TEST(functions_are_right_within_their_bounds)
{
    const char *floats = getenv("WHIT_TEST_FLOATS"), *only = getenv("WHIT_TEST_FUNCTION");
    struct device *device = device_open(&messages, false);
    random_state = 11;
    uint32_t wrong = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        if (!only || strcmp(only, rows[i].name) == 0)
            wrong += !try_row(device, &rows[i], floats ? (uint32_t)atoi(floats) : 0);
    }
    assert_int_equal(wrong, 0);
    device_close(device, &messages);
}
