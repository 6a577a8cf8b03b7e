/* Verdicts on cases, by the golden file and by what was found, and the exit code of all cases. */
#include "app/check/verdict.h"
#include "unit.h"

#include <sys/resource.h>

static const struct golden_case usual = {.name = (char[]){"room"},
                                         .ids = 1,
                                         .colors = 2,
                                         .width = 4,
                                         .height = 3,
                                         .rays = {12, 5, 6, 7},
                                         .mean = {0.5, 0.25, 0.125},
                                         .made_by = (char[]){"room.json"}};

static void put_part(struct golden *golden, const char *key, uint64_t content)
{
    uint32_t hash = golden_part_hash(key, content);
    assert_true(golden_put_part(golden, key, hash));
    assert_true(golden_case_add_part(&golden->cases[0], hash));
    golden_sort(golden);
}

static struct settings settings = {.shader = "toon.glsl"};
static const struct check_case with_shader = {.settings = &settings};

static void fill(struct golden *golden, const struct golden_case *item)
{
    *golden = (struct golden){.exists = true};
    assert_true(golden_put(golden, item));
    put_part(golden, "mesh ball of room.json", 1);
}

/* Asserts the verdict on the case `found`, against a golden file that has `usual`. */
static void expect_verdict(const struct golden_case *found, uint64_t ball, const char *other,
                           enum check_verdict verdict, const char *text)
{
    struct golden golden;
    struct check_result result = {.item = &with_shader};
    fill(&golden, &usual);
    result.found = (struct golden){.exists = true};
    assert_true(golden_put(&result.found, found));
    put_part(&result.found, "mesh ball of room.json", ball);
    if (other)
        put_part(&result.found, other, 1);
    assert_true(verdict_find(&result, &golden));
    assert_string_equal(result.text, text);
    assert_int_equal(result.verdict, verdict);
    verdict_finish(&result);
    golden_finish(&golden);
}

TEST(what_is_as_it_was)
{
    struct golden_case found = usual;
    expect_verdict(&found, 1, NULL, CHECK_OK, "ok");
    found.rays[1] = 4;
    expect_verdict(&found, 1, NULL, CHECK_OK, "ok; rays: 4 shadow, were 5");
    found = usual;
    found.name = (char[]){"hall"};
    expect_verdict(&found, 1, NULL, CHECK_NEW, "no golden");
}

TEST(what_is_seen_decides)
{
    struct golden_case found = usual;
    found.ids = 9;
    expect_verdict(&found, 1, NULL, CHECK_DIFFERS,
                   "differs: what pixels hit is other, with the same colours");
    found = usual;
    found.colors = 9;
    found.mean[1] = 0.5;
    expect_verdict(&found, 1, NULL, CHECK_DIFFERS,
                   "differs: colours other, of the same hits; mean colour 0.5 0.5 0.125, was 0.5 "
                   "0.25 0.125");
    found.ids = 9;
    found.mean[1] = 0.25;
    expect_verdict(&found, 1, NULL, CHECK_DIFFERS, "differs: colours other, and what pixels hit");
    found = usual;
    found.height = 4;
    expect_verdict(&found, 1, NULL, CHECK_DIFFERS, "differs: 4 x 4 pixels, were 4 x 3");
}

TEST(what_it_is_made_of_does_not)
{
    struct golden_case found = usual;
    expect_verdict(&found, 2, NULL, CHECK_SAME,
                   "input changed, picture same: mesh ball of room.json");
    expect_verdict(&found, 1, "light 0 of room.json", CHECK_SAME,
                   "input changed, picture same: light 0 of room.json (new)");
    expect_verdict(&found, 1, "functions of room.json", CHECK_SAME,
                   "input changed, picture same: functions of toon.glsl (new)");
    found.made_by = (char[]){"room.json --leaf 2"};
    expect_verdict(&found, 1, NULL, CHECK_SAME,
                   "input changed, picture same: `room.json --leaf 2`, was `room.json`");
    found = usual;
    found.ids = 9;
    expect_verdict(&found, 2, NULL, CHECK_DIFFERS,
                   "differs: what pixels hit is other, with the same colours; input changed: mesh "
                   "ball of room.json");
}

TEST(a_part_that_goes_is_told)
{
    struct golden golden;
    struct check_result result = {.item = &with_shader};
    fill(&golden, &usual);
    put_part(&golden, "light 0 of room.json", 1);
    fill(&result.found, &usual);
    assert_true(verdict_find(&result, &golden));
    assert_string_equal(result.text, "input changed, picture same: light 0 of room.json (gone)");
    verdict_finish(&result);
    golden_finish(&golden);
}

/* Adds MANY parts to the first case. */
enum { MANY = 3000 };
static void put_many(struct golden *golden, uint64_t content)
{
    for (int i = 0; i < MANY; ++i) {
        char key[32];
        snprintf(key, sizeof key, "mesh %d of room.json", i);
        uint32_t hash = golden_part_hash(key, content);
        assert_true(golden_put_part(golden, key, hash));
        assert_true(golden_case_add_part(&golden->cases[0], hash));
    }
    golden_sort(golden);
}

/* Looking up each old part's key for each new part takes many seconds of the processor. */
TEST(many_parts_that_change_take_no_time)
{
    struct golden golden;
    struct check_result result = {.item = &with_shader};
    struct rlimit limit, before;
    fill(&golden, &usual);
    fill(&result.found, &usual);
    put_many(&golden, 1);
    put_many(&result.found, 2);
    assert_int_equal(getrlimit(RLIMIT_CPU, &before), 0);
    limit = (struct rlimit){2, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_CPU, &limit), 0);
    assert_true(verdict_find(&result, &golden));
    assert_int_equal(setrlimit(RLIMIT_CPU, &before), 0);
    assert_int_equal(result.verdict, CHECK_SAME);
    assert_non_null(strstr(result.text, " and 2996 more"));
    verdict_finish(&result);
    golden_finish(&golden);
}

TEST(the_worst_counts)
{
    static const struct {
        enum check_verdict verdict;
        whit_result error;
        int worst, code;
    } cases[] = {
        {CHECK_NOT_RUN, WHIT_OK, EXIT_FINE, EXIT_FINE},
        {CHECK_SAME, WHIT_OK, EXIT_FINE, EXIT_FINE},
        {CHECK_ACCEPTED, WHIT_OK, EXIT_MISSING, EXIT_MISSING},
        {CHECK_NEW, WHIT_OK, EXIT_FINE, EXIT_MISSING},
        {CHECK_NEW, WHIT_OK, EXIT_DIFFERS, EXIT_DIFFERS},
        {CHECK_DIFFERS, WHIT_OK, EXIT_MISSING, EXIT_DIFFERS},
        {CHECK_UNMET, WHIT_OK, EXIT_FINE, EXIT_DIFFERS},
        {CHECK_VACUOUS, WHIT_OK, EXIT_FINE, EXIT_DIFFERS},
        {CHECK_BROKEN, WHIT_ERROR_INPUT, EXIT_DIFFERS, EXIT_USAGE},
        {CHECK_BROKEN, WHIT_ERROR_STATUS, EXIT_FINE, EXIT_DIFFERS},
        {CHECK_DIFFERS, WHIT_OK, EXIT_USAGE, EXIT_USAGE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const struct check_result result = {.verdict = cases[i].verdict, .error = cases[i].error};
        assert_int_equal(verdict_exit(&result, cases[i].worst), cases[i].code);
    }
}

/* A worse verdict replaces a better one; the texts of both are reported. */
TEST(texts_add_up)
{
    struct check_result result = {.item = &with_shader};
    verdict_set(&result, CHECK_OK, strdup("ok"));
    verdict_add(&result, CHECK_UNMET, strdup("one"));
    assert_string_equal(result.text, "one");
    verdict_add(&result, CHECK_VACUOUS, strdup("two"));
    assert_string_equal(result.text, "one; two");
    verdict_add(&result, CHECK_UNMET, strdup("three"));
    assert_int_equal(result.verdict, CHECK_VACUOUS);
    verdict_set(&result, CHECK_NEW, strdup("no golden"));
    verdict_add(&result, CHECK_UNMET, strdup("four"));
    assert_string_equal(result.text, "no golden; four");
    assert_int_equal(result.verdict, CHECK_UNMET);
    verdict_add(&result, CHECK_UNMET, NULL); /* memory ran out */
    verdict_add(&result, CHECK_UNMET, strdup("five"));
    assert_null(result.text);
    verdict_finish(&result);
}
