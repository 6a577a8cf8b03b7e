/* Tests medians, their intervals, and which differences count as more than chance. */
#include "base/sample.h"
#include "random_fixture.h"
#include "unit.h"

TEST(quantiles_are_between_neighbours)
{
    double values[] = {4.0, 1.0, 3.0, 2.0};
    sample_sort(values, 4);
    for (int i = 0; i < 4; ++i)
        assert_true(values[i] == i + 1.0);
    assert_true(sample_quantile(values, 4, 0.0) == 1.0 && sample_quantile(values, 4, 1.0) == 4.0);
    assert_true(sample_quantile(values, 4, 0.5) == 2.5 && sample_quantile(values, 4, 0.25) == 1.75);
    assert_true(sample_quantile(values, 3, 0.5) == 2.0 && sample_quantile(values, 0, 0.5) == 0.0);
}

TEST(runs_are_summed_up)
{
    static const double times[] = {9.0, 1.0, 5.0, 2.0, 3.0};
    struct sample_runs a = {0}, b = {0};
    for (int i = 0; i < 5; ++i) {
        sample_add(&a, times[i]);
        sample_add(&b, i == 4 ? 0.0 : 2.0 * times[i]);
    }
    const struct sample_summary of = sample_of(&a);
    assert_true(of.median == 3.0 && of.low == 2.0 && of.high == 5.0 && of.spread == 1.5);
    assert_true(of.min == 1.0 && of.max == 9.0 && a.values[0] == 9.0);
    const struct sample_runs ratio = sample_ratio(&a, &b);
    assert_int_equal(ratio.count, 5);
    assert_true(ratio.values[0] == 0.5 && ratio.values[3] == 0.5 && ratio.values[4] == 0.0);
    for (int i = 0; i < SAMPLE_RUNS_MAX; ++i)
        sample_add(&a, 1.0);
    assert_int_equal(a.count, SAMPLE_RUNS_MAX);
}

/* Ranks and coverages are from sums of binomial coefficients in integers; those for 10, 20, 30, 50
   and 100 are also in tables of many textbooks. */
TEST(ranks_are_those_of_the_binomial)
{
    static const struct {
        uint32_t count, low, high;
        double coverage;
    } known[] = {
        {1, 1, 1, 0.0},
        {2, 1, 2, 0.5},
        {5, 1, 5, 0.9375},
        {6, 1, 6, 0.96875},
        {8, 1, 8, 0.9921875},
        {9, 2, 8, 0.9609375},
        {10, 2, 9, 0.978515625},
        {15, 4, 12, 0.96484375},
        {20, 6, 15, 0.9586105346679688},
        {30, 10, 21, 0.9572260547429323},
        {50, 18, 33, 0.9671608624357315},
        {100, 40, 61, 0.9647997997822952},
    };
    double values[100];
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
        uint32_t count = known[i].count;
        for (uint32_t v = 0; v < count; ++v)
            values[v] = (double)(count - v);
        struct sample_median median = sample_median_of(values, count);
        assert_true(median.median == 0.5 * (count + 1.0));
        assert_true(median.low == known[i].low && median.high == known[i].high);
        assert_true(fabs(median.coverage - known[i].coverage) < 1e-12);
        assert_int_equal(median.count, count);
    }
    struct sample_median none = sample_median_of(values, 0);
    assert_true(none.median == 0.0 && none.coverage == 0.0 && none.count == 0);
}

/* A random number with the distribution of run times: a least value, and a long tail above. */
static double skewed(void)
{
    double u = ((double)random_bits(&random_state) + 0.5) / 4294967296.0;
    return 10.0 - log(u);
}

enum { TRIALS = 4000, COUNT = 15 };

TEST(intervals_hold_the_median)
{
    uint32_t held = 0;
    random_state = 7;
    double truth = 10.0 + log(2.0), values[COUNT];
    for (int t = 0; t < TRIALS; ++t) {
        for (int i = 0; i < COUNT; ++i)
            values[i] = skewed();
        struct sample_median median = sample_median_of(values, COUNT);
        held += median.low <= truth && truth <= median.high;
    }
    print_message("%u of %d intervals hold the median\n", held, TRIALS);
    assert_true(held > 0.955 * TRIALS && held < 0.975 * TRIALS); /* 0.9648 expected */
}

/* Compares two series of run times, while the machine becomes slower and recovers. `slower`: factor
   by which the second series is slower. */
static int compare_once(double slower)
{
    double a[COUNT], b[COUNT], differences[COUNT];
    for (int i = 0; i < COUNT; ++i) {
        double drift = 1.0 + 0.5 * sin(i * 0.6);
        a[i] = drift * (1.0 + 0.02 * skewed());
        b[i] = drift * (1.0 + 0.02 * skewed()) * slower;
    }
    return sample_compare(a, b, COUNT, differences, NULL);
}

TEST(equal_things_are_rarely_told_apart)
{
    int wrong = 0;
    random_state = 11;
    for (int t = 0; t < TRIALS; ++t)
        wrong += compare_once(1.0) != 0;
    print_message("%d of %d pairs of equal things told apart\n", wrong, TRIALS);
    assert_true(wrong < 0.05 * TRIALS && wrong > 0.02 * TRIALS); /* 0.0352 expected */
}

TEST(ten_percent_are_found_through_a_drift)
{
    int found = 0;
    random_state = 13;
    for (int t = 0; t < TRIALS; ++t)
        found += compare_once(1.1) == -1;
    print_message("+10 %% found in %d of %d\n", found, TRIALS);
    assert_true(found > 0.99 * TRIALS);
}

TEST(few_or_equal_values_say_nothing)
{
    const double low[6] = {1, 1, 1, 1, 1, 1}, high[6] = {2, 2, 2, 2, 2, 2};
    double differences[6];
    struct sample_median median;
    assert_int_equal(sample_compare(low, high, 5, differences, &median), 0);
    assert_true(median.median == -1.0 && median.coverage == 0.9375);
    assert_int_equal(sample_compare(low, high, 6, differences, NULL), -1);
    assert_int_equal(sample_compare(high, low, 6, differences, NULL), 1);
    assert_int_equal(sample_compare(low, low, 6, differences, NULL), 0);
    assert_int_equal(sample_compare(low, high, 0, differences, NULL), 0);
}

TEST(apart_means_that_intervals_do_not_touch)
{
    const struct sample_median fast = {2.0, 1.0, 3.0, 0.96, 9}, slow = {4.0, 3.1, 5.0, 0.96, 9},
                               touching = {4.0, 3.0, 5.0, 0.96, 9}, few = {9.0, 9.0, 9.0, 0.9, 4};
    assert_int_equal(sample_compare_apart(&fast, &slow), -1);
    assert_int_equal(sample_compare_apart(&slow, &fast), 1);
    assert_int_equal(sample_compare_apart(&fast, &touching), 0);
    assert_int_equal(sample_compare_apart(&touching, &fast), 0);
    assert_int_equal(sample_compare_apart(&fast, &few), 0);
    assert_int_equal(sample_compare_apart(&few, &fast), 0);
}

struct turns {
    uint32_t order[12], count, fails_at;
};

static whit_result note_turn(void *user, uint32_t way, uint32_t round)
{
    struct turns *turns = user;
    turns->order[turns->count++] = 10 * round + way;
    return turns->count == turns->fails_at ? WHIT_ERROR_FAILED : WHIT_OK;
}

TEST(turns_go_there_and_back)
{
    static const uint32_t expected[9] = {0, 1, 2, 12, 11, 10, 20, 21, 22};
    struct turns turns = {0}, failing = {.fails_at = 5};
    assert_int_equal(sample_in_turns(3, 3, note_turn, &turns), WHIT_OK);
    assert_int_equal(turns.count, 9);
    assert_memory_equal(turns.order, expected, sizeof expected);
    assert_int_equal(sample_in_turns(3, 3, note_turn, &failing), WHIT_ERROR_FAILED);
    assert_int_equal(failing.count, 5);
}
