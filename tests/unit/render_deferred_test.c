/* At `exact`, a ray whose hit floats do not decide is deferred to a second dispatch. Its hit is the
   same as with a kernel that decides at once, as kernels with counters do. */
#include "ray_fixture.h"

#include "render_scenes.h"
#include "unit.h"

enum { SIDE = 96, RAYS = 20000 };

static whit_renderer_params exact_params(bool count)
{
    return (whit_renderer_params){.width = SIDE,
                                  .height = SIDE,
                                  .depth = 4,
                                  .sampling.count = 1,
                                  .camera = GLASS_CAMERA,
                                  .numerics = NUMERICS_EXACT,
                                  .count = count};
}

/* ---- Batches ---- */

TEST(batches_are_those_of_looks_in_place)
{
    const whit_renderer_params counted = exact_params(true), deferred = exact_params(false);
    own_memory struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(4 * (size_t)RAYS, sizeof *hits);
    assert_true(rays && hits);
    own_fixture f = fixture_open(ring_scene(), NULL, &counted);
    aim_rays(&f, rays, RAYS, 11);
    for (int any = 0; any < 2; ++any)
        assert_int_equal(renderer_trace(f.renderer, rays, RAYS, any, hits + any * RAYS, NULL),
                         WHIT_OK);
    assert_int_equal(f.renderer->trace.deferred_count, 0);
    fixture_renew(&f, &deferred);
    for (int any = 0; any < 2; ++any) {
        struct gpu_hit *own = hits + (2 + any) * RAYS;
        assert_int_equal(renderer_trace(f.renderer, rays, RAYS, any, own, NULL), WHIT_OK);
        uint32_t differ = 0, count = f.renderer->trace.deferred_count;
        for (uint32_t i = 0; i < RAYS; ++i)
            differ += memcmp(&own[i], &hits[any * RAYS + (int)i], sizeof *own) != 0;
        print_message("  %s hits: %u of %u rays deferred, %u differ\n", any ? "any" : "closest",
                      count, RAYS, differ);
        assert_true(count > RAYS / 20 && count < RAYS);
        assert_int_equal(differ, 0);
    }
}

/* ---- Pictures ---- */

static void check_picture(const char *name, struct scene *scene, whit_camera camera,
                          uint32_t deferred_min)
{
    whit_renderer_params counted = exact_params(true), deferred = exact_params(false);
    counted.camera = deferred.camera = camera;
    own_fixture f = fixture_open(scene, NULL, &counted);
    own_picture in_place = render_picture(&f);
    fixture_renew(&f, &deferred);
    own_picture later = render_picture(&f);
    print_message("  %s: %u deferred\n", name, later.stats.deferred);
    assert_int_equal(in_place.stats.deferred, 0);
    assert_true(later.stats.deferred >= deferred_min);
    assert_same_picture(name, &in_place, &later);
}

/* The camera is straight above a corner of the ground's grid, so that the rays of whole rows and
   columns of pixels meet edges. */
TEST(pictures_are_those_of_looks_in_place)
{
    check_picture("ground", glass_scene_of(20, 12),
                  (whit_camera)CAMERA_AT(3, 1000, 3, 3, 0, 3, 0, 0, -1, 1), 100);
    check_picture("glass", glass_scene(), glass_camera, 1);
}
