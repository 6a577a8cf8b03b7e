/* Tests host/base/same.h against libm's long doubles, where these have more digits than doubles,
   and by a hash of result bits that must be the same with every compiler and machine. */
#include <float.h>

#include "base/hash.h"
#include "base/same.h"
#include "random_fixture.h"
#include "unit.h"

enum { TRIED = 200000 };

/* A function of x, or of x and y, and the same function of libm. */
#define OF_X(name)  same_##name, name##l, NULL, NULL
#define OF_XY(name) NULL, NULL, same_##name, name##l

/* Arguments are drawn from -size to size, or from 2^-size to 2^size. */
static const struct row {
    const char *name;
    double (*same)(double);
    long double (*exact)(long double);
    double (*same_xy)(double, double);
    long double (*exact_xy)(long double, long double);
    double x_size, y_size;
    bool x_power, y_power;
    long double bound_ulp;
} rows[] = {
    {"sin", OF_X(sin), 20.0, 0.0, false, false, 1.0L},
    {"sin of large angles", OF_X(sin), 1e6, 0.0, false, false, 1.0L},
    {"cos", OF_X(cos), 20.0, 0.0, false, false, 1.0L},
    {"tan", OF_X(tan), 4.0, 0.0, false, false, 1.0L},
    {"acos", OF_X(acos), 1.0, 0.0, false, false, 1.0L},
    {"atan2", OF_XY(atan2), 1.0, 1.0, false, false, 1.0L},
    {"atan2 of unlike sizes", OF_XY(atan2), 500.0, 500.0, true, true, 1.0L},
    {"log", OF_X(log), 1000.0, 0.0, true, false, 0.55L},
    {"log near 1", OF_X(log), 0.1, 0.0, true, false, 0.55L},
    {"log2", OF_X(log2), 1000.0, 0.0, true, false, 0.55L},
    {"log10", OF_X(log10), 1000.0, 0.0, true, false, 0.55L},
    {"exp", OF_X(exp), 700.0, 0.0, false, false, 0.55L},
    {"pow", OF_XY(pow), 8.0, 60.0, true, false, 0.55L},
    {"pow of sRGB", OF_XY(pow), 5.0, 2.5, true, false, 0.55L},
};

static double argument(double size, bool power)
{
    double at = size * (2.0 * random_unit(&random_state) - 1.0);
    return power ? ldexp(1.0 + random_unit(&random_state), (int)floor(at)) : at;
}

TEST(functions_are_within_their_bound)
{
    uint32_t wrong = 0;
    random_state = 5;
    for (size_t r = 0; r < sizeof rows / sizeof *rows; ++r) {
        const struct row *row = &rows[r];
        long double worst = 0.0L;
        uint32_t floats = 0;
        for (int i = 0; i < TRIED; ++i) {
            double x = argument(row->x_size, row->x_power);
            double y = argument(row->y_size, row->y_power);
            double found = row->same ? row->same(x) : row->same_xy(x, y);
            long double exact = row->exact ? row->exact((long double)x)
                                           : row->exact_xy((long double)x, (long double)y);
            int exponent;
            (void)frexp((double)exact, &exponent);
            long double error = fabsl((long double)found - exact) / ldexpl(1.0L, exponent - 53);
            worst = error > worst || isnan(error) ? error : worst;
            floats += (float)found != (float)exact;
        }
        print_message("%-24s off by at most %.4Lf ulp, %u of %d floats differ\n", row->name, worst,
                      floats, TRIED);
        wrong += !(worst <= row->bound_ulp);
    }
    if (LDBL_MANT_DIG > DBL_MANT_DIG)
        assert_int_equal(wrong, 0);
}

static bool is_same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

TEST(special_values_are_those_of_c)
{
    static const double values[] = {0.0, 1.0, 0.5, 2.0, DBL_MIN, DBL_MAX, INFINITY, NAN, 0x1p-1074};
    enum { COUNT = 2 * (int)(sizeof values / sizeof *values) };
    for (int i = 0; i < COUNT; ++i) {
        double x = i % 2 ? -values[i / 2] : values[i / 2];
        bool special = x == 0.0 || !isfinite(x);
        assert_true(!special || is_same(same_sin(x), sin(x)));
        assert_true(!special || is_same(same_cos(x), cos(x)));
        assert_true(!special || is_same(same_tan(x), tan(x)));
        assert_true(is_same(same_acos(x), acos(x)));
        assert_true((!special && x > 0.0) || is_same(same_log(x), log(x)));
        assert_true((!special && x > 0.0) || is_same(same_log2(x), log2(x)));
        assert_true((!special && x > 0.0) || is_same(same_log10(x), log10(x)));
        assert_true(!special || is_same(same_exp(x), exp(x)));
        for (int j = 0; j < COUNT; ++j) {
            double y = j % 2 ? -values[j / 2] : values[j / 2];
            bool either = special || y == 0.0 || !isfinite(y);
            assert_true(!either || is_same(same_atan2(x, y), atan2(x, y)));
            assert_true(!either || signbit(x) || is_same(same_pow(x, y), pow(x, y)));
        }
    }
    for (int i = -20; i <= 20; ++i) /* where the result is a double */
        assert_true(i < 0 || is_same(same_log10(same_pow(10.0, i)), i));
}

/* A hash of result bits: it shows compilers that contract or reorder operations, and machines
   without IEEE doubles. */
TEST(bits_are_the_same_everywhere)
{
    uint64_t hash = HASH_START;
    random_state = 7;
    for (int i = 0; i < 20000; ++i) {
        double x = argument(20.0, false), y = argument(20.0, false), of = argument(20.0, true);
        const double found[] = {same_sin(x),      same_cos(x),  same_tan(x),   same_acos(x / 20.0),
                                same_atan2(x, y), same_log(of), same_log2(of), same_log10(of),
                                same_pow(of, y),  same_exp(x)};
        hash = hash_bytes(hash, found, sizeof found);
    }
    print_message("%016llx\n", (unsigned long long)hash);
    assert_true(hash == UINT64_C(0x52de27c7070b9709));
}
