/* Rows of a ray tree: the ray that brings the most light comes first, and shadow rays that ended
   alike share a row. */
#include "unit.h"
#include "whit.h"

enum { RAYS = 12 };

static whit_probe_ray rays[RAYS];
static whit_probe_report report = {.rays = rays, .ray_count = RAYS};

static void put(uint32_t i, whit_ray_kind kind, uint32_t parent, whit_probe_end end, float added)
{
    rays[i] = (whit_probe_ray){.kind = kind,
                               .parent = parent,
                               .end = end,
                               .added = {added, added, added},
                               .light = kind == WHIT_RAY_SHADOW ? 0 : WHIT_NONE,
                               .equal = true};
}

/* A camera ray; 4 shadow rays, of which 2 are blocked by one instance; a dim mirror whose own
   branch brings light, and a refracted ray that brings more. */
static int make_report(void **state)
{
    (void)state;
    put(0, WHIT_RAY_PRIMARY, WHIT_NONE, WHIT_PROBE_DIVIDED, 0.1f);
    put(1, WHIT_RAY_SHADOW, 0, WHIT_PROBE_BLOCKED, 0.0f);
    put(2, WHIT_RAY_SHADOW, 0, WHIT_PROBE_REACHED, 1.0f);
    put(3, WHIT_RAY_SHADOW, 0, WHIT_PROBE_BLOCKED, 0.0f);
    put(4, WHIT_RAY_SHADOW, 0, WHIT_PROBE_REACHED, 1.0f);
    put(5, WHIT_RAY_SHADOW, 0, WHIT_PROBE_BLOCKED, 0.0f);
    put(6, WHIT_RAY_REFLECTED, 0, WHIT_PROBE_DIVIDED, 0.0f);
    put(7, WHIT_RAY_SHADOW, 6, WHIT_PROBE_REACHED, 1.0f);
    put(8, WHIT_RAY_REFLECTED, 6, WHIT_PROBE_MISSED, 0.2f);
    put(9, WHIT_RAY_REFLECTED, 0, WHIT_PROBE_BAILOUT, 0.0f);
    put(10, WHIT_RAY_REFRACTED, 0, WHIT_PROBE_OPAQUE, 0.3f);
    put(11, WHIT_RAY_SHADOW, 10, WHIT_PROBE_REACHED, 1.0f);
    rays[5].device.instance = 3; /* not the blocker of rays 1 and 3 */
    return 0;
}

struct wanted {
    uint32_t ray, count;
};

static void check_rows(const struct wanted *expected, uint32_t expected_count)
{
    whit_probe_row *rows;
    uint32_t count;
    assert_int_equal(whit_probe_rows(&report, &rows, &count), WHIT_OK);
    assert_int_equal(count, expected_count);
    for (uint32_t i = 0; i < count; ++i) {
        assert_int_equal(rows[i].ray, expected[i].ray);
        assert_int_equal(rows[i].count, expected[i].count);
    }
    whit_memory_destroy(rows);
}

TEST(what_brought_most_comes_first)
{
    static const struct wanted expected[] = {{0, 1},  {2, 2}, {1, 2}, {5, 1}, {10, 1},
                                             {11, 1}, {6, 1}, {7, 1}, {8, 1}, {9, 1}};
    check_rows(expected, 10);
}

/* A ray for which device, float mirror and exact arithmetic differ has a row of its own. */
TEST(what_differs_stands_alone)
{
    static const struct wanted expected[] = {{0, 1},  {2, 1}, {4, 1}, {1, 2}, {5, 1}, {10, 1},
                                             {11, 1}, {6, 1}, {7, 1}, {8, 1}, {9, 1}};
    rays[4].equal = false;
    check_rows(expected, 11);
    rays[4].equal = true;
    rays[4].light = 1;
    check_rows(expected, 11);
    rays[4].light = 0;
}

/* Shares of the light that come through glass differ from point to point. */
TEST(a_row_has_the_mean_of_its_rays)
{
    whit_probe_row *rows;
    uint32_t count;
    rays[4].added[0] = 0.5f;
    assert_int_equal(whit_probe_rows(&report, &rows, &count), WHIT_OK);
    assert_int_equal(rows[1].ray, 2);
    assert_int_equal(rows[1].count, 2);
    assert_float_equal(rows[1].added[0], 0.75f, 0.0);
    assert_float_equal(rows[1].added[1], 1.0f, 0.0);
    assert_float_equal(rows[4].added[0], 0.3f, 0.0);
    whit_memory_destroy(rows);
    rays[4].added[0] = 1.0f;
}

TEST(a_report_without_rays_has_no_rows_and_no_reason)
{
    char why[2] = "ab";
    report.ray_count = 0;
    check_rows(NULL, 0);
    whit_probe_why(&report, NULL, why, 0);
    assert_memory_equal(why, "ab", 2);
    whit_probe_why(&report, NULL, why, 1);
    assert_memory_equal(why, "\0b", 2);
    report.ray_count = RAYS;
}

TESTS_IN(make_report, NULL)
