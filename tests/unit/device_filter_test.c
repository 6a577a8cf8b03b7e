/* Compares the float filter of NUMERICS_EXACT on the device with the float mirror. Bounds do not
   show in hits, so only this test finds a bound that is too small in one of the two.
   accel_filter_test.c tests that the bounds are right. */
#include "hard_fixture.h"

#include "device_fixture.h"

#include "device_filter.h"
#include "unit.h"

enum { CASES = 40000 };

/* The record of device_filter.comp. */
struct filter_case {
    float shear[3];
    uint32_t dominant;
    float a[3], pad_a, b[3], pad_b, c[3], pad_c;
};
struct filter_answer {
    float t, u, v, lo, hi;
    uint32_t said;
};

static struct filter_case cases[CASES];
static struct filter_answer answers[CASES];

static float any_coordinate(int power)
{
    int more = (int)random_below(&random_state, 5) - 2;
    return ldexpf(random_within(1.0f), power + more);
}

/* A target: a third of them inside of the triangle, a third on edges and vertices, others
   random. */
static struct vec3 target_of(const struct vec3 v[3], uint32_t i)
{
    float s = random_below(&random_state, 4) ? random_float(&random_state) : 0.0f;
    float t = i % 3 == 0 ? (1.0f - s) * random_float(&random_state) : 0.0f;
    struct vec3 p = vec3_add(v[0], vec3_scale(vec3_sub(v[1], v[0]), s));
    p = vec3_add(p, vec3_scale(vec3_sub(v[2], v[0]), t));
    return i % 3 == 2 ? random_point(2.0f) : p;
}

static void make_case(uint32_t i, struct filter_case *out, struct filter_answer *expected)
{
    int power = (int)random_below(&random_state, 81) - 40;
    struct vec3 v[3];
    for (int k = 0; k < 3; ++k) {
        float x = any_coordinate(power), y = any_coordinate(power);
        v[k] = vec3_make(x, y, any_coordinate(power));
    }
    struct ray_setup ray = make_ray_setup(vec3_make(0, 0, 0), target_of(v, i));
    if (i % 64 == 1)
        ray.shear = vec3_make(NAN, NAN, NAN);
    struct exact_bounds bounds;
    exact_filter(&ray, v[0], v[1], v[2], &bounds);
    *out = (struct filter_case){.dominant = ray.dominant_x ? 0 : ray.dominant_y ? 1 : 2};
    vec3_store(out->shear, ray.shear);
    vec3_store(out->a, v[0]);
    vec3_store(out->b, v[1]);
    vec3_store(out->c, v[2]);
    *expected = (struct filter_answer){bounds.t,  bounds.u,
                                       bounds.v,  bounds.lo,
                                       bounds.hi, (uint32_t)(bounds.outside | bounds.inside << 1)};
}

static bool same_float(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static bool same_answer(const struct filter_answer *a, const struct filter_answer *b)
{
    return same_float(a->t, b->t) && same_float(a->u, b->u) && same_float(a->v, b->v) &&
           same_float(a->lo, b->lo) && same_float(a->hi, b->hi) && a->said == b->said;
}

TEST(bounds_are_those_of_c)
{
    static struct filter_answer expected[CASES];
    uint32_t differ = 0, said[4] = {0};
    struct device *device = device_open(&messages, false);
    random_state = 17;
    for (uint32_t i = 0; i < CASES; ++i)
        make_case(i, &cases[i], &expected[i]);
    kernel_answer(device, device_filter, sizeof device_filter, CASES, cases, sizeof *cases, answers,
                  sizeof *answers);
    for (uint32_t i = 0; i < CASES; ++i) {
        differ += !same_answer(&answers[i], &expected[i]);
        ++said[expected[i].said];
    }
    print_message(
        "%u of %u filtered triangles differ: %u outside, %u inside, %u left to integers\n", differ,
        (uint32_t)CASES, said[1], said[2], said[0]);
    assert_int_equal(differ, 0);
    assert_true(said[0] > CASES / 10 && said[1] > CASES / 10 && said[2] > CASES / 10);
    device_close(device, &messages);
}
