/* How many nodes rays open in the trees of different builders, and in different orders. */
#include "accel_fixture.h"
#include "twin/traverse.h"

enum { RAYS = 4000 };

/* Random rays inside the box -1..1 that holds what is small; hits end them. */
static struct gpu_cost cost_of_rays(const struct accel *accel, uint32_t order)
{
    struct gpu_cost cost = {0};
    uint32_t status = 0;
    random_state = 7;
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_ray ray = {.t_max = INFINITY};
        for (int a = 0; a < 3; ++a) {
            ray.origin[a] = 2.0f * random_float(&random_state) - 1.0f;
            ray.dir[a] = 2.0f * random_float(&random_state) - 1.0f;
        }
        struct gpu_hit hit;
        traverse_float(accel, order, &ray, false, HIT_NONE, HIT_NONE, &hit, &cost, &status);
    }
    assert_int_equal(status, 0);
    return cost;
}

static struct gpu_cost cost_of(const struct scene *scene, const struct bvh_params *params,
                               uint32_t order)
{
    struct accel *accel = soup_accel(scene, params);
    struct gpu_cost cost = cost_of_rays(accel, order);
    accel_destroy(accel);
    return cost;
}

/* One triangle a thousand times as large as the cloud of small ones: bins over its extent would
   put the whole cloud in one. With the label long the cloud is a million. */
static void one_giant_costs_little(void **state)
{
    (void)state;
    const char *many = getenv("WHIT_TEST_TRIANGLES");
    const uint32_t small_ones = many ? (uint32_t)atoi(many) : 20000;
    const float size = 0.02f * cbrtf(20000.0f / (float)small_ones);
    struct soup soup = soup_make("giant", small_ones + 1);
    random_state = 3;
    for (uint32_t i = 0; i < small_ones; ++i) {
        float v[3][3], centre[3];
        for (int a = 0; a < 3; ++a)
            centre[a] = 2.0f * random_float(&random_state) - 1.0f;
        for (int k = 0; k < 3; ++k) {
            for (int a = 0; a < 3; ++a)
                v[k][a] = centre[a] + size * random_float(&random_state);
        }
        soup_set(&soup, i, v[0], v[1], v[2]);
    }
    soup_set(&soup, small_ones, (float[3]){-1000, -1.1f, -1000}, (float[3]){1000, -1.1f, -1000},
             (float[3]){0, -1.2f, 1000});
    soup_box(&soup);
    struct scene *scene = soup_scene(&soup);
    struct gpu_cost sweep =
        cost_of(scene, &(struct bvh_params){.builder = BVH_SWEEP}, ORDER_DISTANCE);
    static const struct bvh_params others[] = {
        {.builder = BVH_BINNED},
        {.builder = BVH_BINNED, .bins = 7},
        {.builder = BVH_BINNED, .optimize = true},
        {.builder = BVH_SPATIAL},
    };
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        struct gpu_cost cost = cost_of(scene, &others[i], ORDER_DISTANCE);
        print_message("  %u pairs, sweep %u\n", cost.inner_nodes, sweep.inner_nodes);
        assert_true(cost.inner_nodes <= 2 * sweep.inner_nodes);
        assert_true(cost.triangles <= 2 * sweep.triangles);
    }
    scene_destroy(scene);
    soup_finish(&soup);
}

/* The order of the source report: no order opens the most nodes. */
static void orders_save_visits(void **state)
{
    (void)state;
    struct soup soup = soup_terrain(64);
    struct scene *scene = soup_scene(&soup);
    const struct bvh_params binned = {.builder = BVH_BINNED};
    struct gpu_cost basic = cost_of(scene, &binned, ORDER_BASIC);
    struct gpu_cost distance = cost_of(scene, &binned, ORDER_DISTANCE);
    struct gpu_cost sign = cost_of(scene, &binned, ORDER_SIGN);
    print_message("  basic %u, distance %u, sign %u pairs\n", basic.inner_nodes,
                  distance.inner_nodes, sign.inner_nodes);
    assert_true(distance.inner_nodes < basic.inner_nodes);
    assert_true(sign.inner_nodes < basic.inner_nodes);
    scene_destroy(scene);
    soup_finish(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_giant_costs_little),
        cmocka_unit_test(orders_save_visits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
