/* The levels of numerics on the device: all agree with the float mirror bit for bit, `exact` agrees
   with rational arithmetic, and only `fast` lets rays through where they should hit. */
#include "../cases.h"
#include "ray_fixture.h"
#include "unit.h"

#include "owned_rational.h"
#include "render_scenes.h"
#include "sphere_fixture.h"

static const char *const names[] = {
    [NUMERICS_WATERTIGHT] = "watertight", [NUMERICS_FAST] = "fast", [NUMERICS_EXACT] = "exact"};
enum { LEVELS = 3 };
#define RAYS cases_of(32000)

static uint32_t count_unlike_rational(const struct fixture *f, const struct gpu_ray *rays,
                                      const struct gpu_hit *hits)
{
    own_rational *rational = rational_create(f->accel);
    assert_non_null(rational);
    uint32_t bad = 0, on_edges = 0;
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct rational_hit truth;
        rational_trace(rational, &rays[i], NULL, &truth);
        on_edges += truth.edges != 0;
        bad += truth.t != hits[i].t || truth.primitive != hits[i].primitive ||
               truth.instance != hits[i].instance;
    }
    print_message("  %u of %u unlike rational arithmetic, %u exactly on edges\n", bad, RAYS,
                  on_edges);
    return bad;
}

static void check_levels(struct scene *scene, const whit_accel_params *accel_params)
{
    own_memory struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(RAYS, sizeof *hits);
    assert_true(rays && hits);
    whit_renderer_params params = {.width = 16, .height = 16, .count = true};
    own_fixture f = fixture_open(scene, accel_params, &params);
    aim_rays(&f, rays, RAYS, 7);
    for (uint32_t level = 0; level < LEVELS; ++level) {
        params.numerics = level;
        fixture_renew(&f, &params);
        check_rays(&f, names[level], rays, RAYS, hits);
        if (level == NUMERICS_EXACT)
            assert_int_equal(count_unlike_rational(&f, rays, hits), 0);
    }
}

TEST(one_mesh)
{
    check_levels(terrain_scene(), NULL);
}

TEST_BY_TURNS(instances, 0, 2)
{
    check_levels(ring_scene(), NULL);
    check_levels(ring_scene(), &(whit_accel_params){.instances = WHIT_INSTANCES_OFF});
}

/* At 2^-20 of the size of the terrain in one_mesh: no level may depend on a built-in length. */
TEST_BY_TURNS(split_triangles, 1, 2)
{
    struct scene *scene = scene_begin(&fixture_log, "test");
    scene_put(scene, mesh_terrain(0x1p-20 * 10.0, 0x1p-20 * 2.0, 40, 3), NULL);
    check_levels(scene, &(whit_accel_params){.build = WHIT_BUILD_SPATIAL, .spatial_alpha = 1e-9f});
}

/* The same triangle many times, in one mesh and in instances at one place, so that hits tie. */
TEST_BY_TURNS(ties, 0, 2)
{
    struct scene *scene = scene_begin(&fixture_log, "test");
    scene_put_mesh(scene, mesh_terrain(10.0, 2.0, 4, 3));
    for (int i = 0; i < 6; ++i)
        scene_put_again(scene, 0, NULL);
    check_levels(scene, NULL);
}

/* Spheres that stick out of terrain: hits of spheres and of triangles, which are decided in two
   ways, must be in the right order. aim_rays aims only at triangles. */
TEST_BY_TURNS(spheres, 1, 2)
{
    struct scene_mesh balls = scattered_spheres(60, 5.0, 1.5);
    struct scene *scene = terrain_scene();
    scene_put(scene, balls, NULL);
    check_levels(scene, NULL);
}

/* Rays from inside a sphere, at vertices and edges. */
TEST(only_fast_leaks)
{
    struct scene *scene = scene_begin(&fixture_log, "test");
    scene_put(scene, mesh_sphere(2.0, 80, 40), NULL);
    whit_renderer_params params = {.width = 16, .height = 16, .packets = WHIT_PACKETS_ON};
    own_fixture f = fixture_open(scene, NULL, &params);
    own_memory struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(RAYS, sizeof *hits);
    assert_true(rays && hits);
    aim_rays(&f, rays, RAYS, 21);
    uint64_t state_random = 5;
    for (uint32_t i = 0; i < RAYS; ++i) { /* those that are aimed, from inside */
        rays[i].t_min = 0.0f;
        rays[i].t_max = INFINITY;
        for (int k = 0; k < 3; ++k) {
            float target = rays[i].origin[k] + rays[i].dir[k];
            rays[i].origin[k] = 0.5f * random_float_signed(&state_random);
            rays[i].dir[k] =
                i % 4 % 2 ? target - rays[i].origin[k] : random_float_signed(&state_random);
        }
    }
    uint32_t leaks[LEVELS] = {0};
    for (uint32_t level = 0; level < LEVELS; ++level) {
        params.numerics = level;
        fixture_renew(&f, &params);
        assert_int_equal(renderer_trace(f.renderer, rays, RAYS, false, hits, NULL), WHIT_OK);
        leaks[level] = RAYS - count_met(hits, RAYS);
        print_message("  %s: %u of %u rays leak\n", names[level], leaks[level], RAYS);
    }
    assert_true(leaks[NUMERICS_FAST] > 0); /* else the rays are not hard enough */
    assert_int_equal(leaks[NUMERICS_WATERTIGHT], 0);
    assert_int_equal(leaks[NUMERICS_EXACT], 0);
}

/* Without trees every box is that of the whole scene, which changes neither exact decisions by
   integers nor deferred rays. */
TEST(trees_do_not_matter)
{
    const whit_accel_params none = {.build = WHIT_BUILD_NONE};
    const whit_renderer_params params = {.width = 24,
                                         .height = 16,
                                         .depth = 6,
                                         .camera = GLASS_CAMERA,
                                         .packets = WHIT_PACKETS_ON,
                                         .numerics = NUMERICS_EXACT};
    own_picture with = picture_of(glass_scene(), NULL, &params);
    own_picture without = picture_of(glass_scene(), &none, &params);
    assert_true(with.stats.deferred > 0 && without.stats.deferred > 0);
    assert_same_picture("without trees", &with, &without);
}
