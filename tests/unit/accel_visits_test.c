/* Numbers of nodes that rays open in the trees of different builders, and in different orders. */
#include "accel_fixture.h"
#include "unit.h"

enum { RAYS = 4000 };

/* Traces closest-hit rays at a soup, or, if it is NULL, random rays in the box -1..1, where the
   small triangles are. */
static struct gpu_cost cost_of(const struct scene *scene, const struct soup *soup,
                               whit_accel_params params, uint32_t order)
{
    own_accel *accel = accel_of(scene, params);
    struct gpu_cost cost = {0};
    random_state = 7;
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_ray ray = soup ? soup_ray(soup, &accel->meshes[0].box, i)
                                  : ray_from_cube(1.0f, random_point(1.0f));
        trace_with(accel, (struct traverse_params){.order = order}, &ray, &cost);
    }
    return cost;
}

/* One triangle a thousand times as large as the cloud of small ones: bins over its extent would
   put the whole cloud in one. With the label long the cloud is a million. */
TEST(one_giant_costs_little)
{
    const char *many = getenv("WHIT_TEST_TRIANGLES");
    const uint32_t small_ones = many ? (uint32_t)atoi(many) : 20000;
    const float size = 0.02f * cbrtf(20000.0f / (float)small_ones);
    random_state = 3;
    own_soup soup = soup_scattered(small_ones + 1, size);
    soup_set(&soup, small_ones, (float[3]){-1000, -1.1f, -1000}, (float[3]){1000, -1.1f, -1000},
             (float[3]){0, -1.2f, 1000});
    own_scene *scene = scene_ready(soup_scene(&soup));
    struct gpu_cost sweep =
        cost_of(scene, NULL, (whit_accel_params){.build = WHIT_BUILD_SWEEP}, ORDER_DISTANCE);
    static const whit_accel_params others[] = {
        {.build = WHIT_BUILD_BINNED},
        {.build = WHIT_BUILD_BINNED, .bins = 7},
        {.build = WHIT_BUILD_BINNED, .optimize = true},
        {.build = WHIT_BUILD_SPATIAL},
    };
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        struct gpu_cost cost = cost_of(scene, NULL, others[i], ORDER_DISTANCE);
        print_message("  %u pairs, sweep %u\n", cost.inner_nodes, sweep.inner_nodes);
        assert_true(cost.inner_nodes <= 2 * sweep.inner_nodes);
        assert_true(cost.triangles <= 2 * sweep.triangles);
    }
}

/* ORDER_BASIC opens the most nodes. Spatial splits save some where boxes overlap. */
TEST(orders_and_splits_save_visits)
{
    random_state = 10;
    const struct {
        struct soup soup;
        double spatial; /* most nodes with spatial splits, as a share of those with binned splits */
    } rows[] = {{soup_terrain(64), 1.02},
                {soup_sphere(30, 20), 1.02},
                {soup_rooms(1500), 0.7},
                {soup_hair(2500, 1e-3f), 0.99},
                {soup_hair(1500, 0.05f), 0.99}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        own_soup soup = rows[i].soup;
        own_scene *scene = scene_ready(soup_scene(&soup));
        const whit_accel_params binned = {.build = WHIT_BUILD_BINNED},
                                split = {.build = WHIT_BUILD_SPATIAL};
        uint32_t basic = cost_of(scene, &soup, binned, ORDER_BASIC).inner_nodes,
                 distance = cost_of(scene, &soup, binned, ORDER_DISTANCE).inner_nodes,
                 sign = cost_of(scene, &soup, binned, ORDER_SIGN).inner_nodes,
                 spatial = cost_of(scene, &soup, split, ORDER_DISTANCE).inner_nodes;
        print_message("  %s: basic %u, distance %u, sign %u pairs; spatial splits: %u\n", soup.name,
                      basic, distance, sign, spatial);
        if (distance >= basic || sign >= basic || spatial > rows[i].spatial * distance)
            fail_msg("%s", soup.name);
    }
}
