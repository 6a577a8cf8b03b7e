/* Compares spheres at `exact` on the device with the float mirror, which hard_sphere_test.c
   compares with fractions. */
#include "hard_sphere_fixture.h"

#include "abi/spec.h"
#include "device_fixture.h"
#include "twin/ff_sphere.h"

#include "device_sphere.h"
#include "unit.h"

enum { OF_KIND = 2000, CASES = OF_KIND * SPHERE_KINDS };

/* The record of device_sphere.comp. */
struct sphere_case {
    float origin[3], radius, dir[3], t_min, center[3];
    uint32_t only_far;
};
struct sphere_answer {
    float near_lo, near_hi, far_lo, far_hi, key, pair_key;
    uint32_t said, filtered;
};

static struct sphere_case cases[CASES];
static struct sphere_answer answers[CASES];

static uint32_t bits_of(bool a, bool b, bool c)
{
    return (uint32_t)a | (uint32_t)b << 1 | (uint32_t)c << 2;
}

static struct sphere_answer answer_of(const struct sphere_case *c)
{
    struct vec3 origin = vec3_load(c->origin), dir = vec3_load(c->dir),
                center = vec3_load(c->center);
    struct ray_setup ray = make_ray_setup(origin, dir);
    struct sphere_bounds bounds;
    struct sphere_candidate exact, pairs;
    bound_ray_setup(&ray);
    bound_sphere(&ray, center, c->radius, &bounds);
    exact_meet_sphere(origin, dir, center, c->radius, c->only_far, c->t_min, &exact);
    bool sure = ff_meet_sphere(origin, dir, center, c->radius, c->only_far, c->t_min, &pairs);
    return (struct sphere_answer){
        .near_lo = bounds.near_lo,
        .near_hi = bounds.near_hi,
        .far_lo = bounds.far_lo,
        .far_hi = bounds.far_hi,
        .key = exact.key,
        .pair_key = sure ? pairs.key : 0.0f,
        .said = bits_of(exact.met, exact.at_exit, exact.inward) |
                (sure ? bits_of(pairs.met, pairs.at_exit, pairs.inward) << 3 | 64u : 0u),
        .filtered = bits_of(bounds.outside, bounds.inside, bounds.inward_known) | 8u};
}

TEST(spheres_are_met_as_in_c)
{
    static const struct gpu_spec exact = {.SPEC_NUMERICS = NUMERICS_EXACT};
    struct device *device = device_open(&messages, false);
    for (uint32_t k = 0; k < SPHERE_KINDS; ++k) {
        random_state = 100 + k;
        for (uint32_t i = 0; i < OF_KIND; ++i) {
            struct subject s = make_subject(k);
            struct sphere_case *c = &cases[k * OF_KIND + i];
            *c = (struct sphere_case){
                .radius = s.radius, .t_min = s.t_min, .only_far = random_below(&random_state, 2)};
            vec3_store(c->origin, s.origin);
            vec3_store(c->dir, s.dir);
            vec3_store(c->center, s.center);
        }
    }
    kernel_answer_as(device, (const uint32_t *)&exact, GPU_SPEC_COUNT, device_sphere,
                     sizeof device_sphere, CASES, cases, sizeof *cases, answers, sizeof *answers);
    for (uint32_t k = 0; k < SPHERE_KINDS; ++k) {
        uint32_t differ = 0, met = 0;
        for (uint32_t i = 0; i < OF_KIND; ++i) {
            struct sphere_answer expected = answer_of(&cases[k * OF_KIND + i]);
            differ += memcmp(&answers[k * OF_KIND + i], &expected, sizeof expected) != 0;
            met += expected.said & 1u;
        }
        print_message("%-26s %u of %u differ, %u met\n", sphere_kinds[k].name, differ,
                      (uint32_t)OF_KIND, met);
        assert_int_equal(differ, 0);
        assert_true(met > OF_KIND / 10 && met < OF_KIND);
    }
    device_close(device, &messages);
}
