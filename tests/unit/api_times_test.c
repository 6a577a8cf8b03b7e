/* Renderers and references of one accel, each at its own time: what one of them does does not
   change the hits and pictures of the others. */
#include "scene_fixture.h"

TESTS_IN(device_begin, device_end)

enum { WIDTH = 16, HEIGHT = 12, RAYS = 50 };

static whit_renderer_params params_at(double time_s)
{
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, NULL);
    params.time_s = time_s;
    return params;
}

static void trace(whit_renderer *renderer, whit_trace_on on, whit_hit hits[RAYS])
{
    whit_ray rays[RAYS];
    for (int i = 0; i < RAYS; ++i)
        rays[i] = (whit_ray){{(float)i * 0.24f - 6.0f, 9.0f, 0.3f}, 0.0f, {0, -1, 0}, INFINITY};
    assert_int_equal(whit_trace(renderer, on, rays, RAYS, false, hits, NULL), WHIT_OK);
}

TEST(rays_on_the_cpu_are_traced_at_the_time_of_their_renderer)
{
    whit_hit hits[2][RAYS], again[RAYS];
    const whit_renderer_params early = params_at(0.0), late = params_at(1.5);
    own_whit_renderer *on_cpu = NULL;
    scene_open(WHIT_SCENES_DIR "/spin.json");
    assert_int_equal(whit_renderer_create(NULL, accel, &late, &on_cpu), WHIT_OK);
    trace(on_cpu, WHIT_TRACE_CPU_FLOAT, hits[1]);
    own_whit_renderer *first = renderer_of(&early);
    trace(first, WHIT_TRACE_CPU_FLOAT, hits[0]);
    assert_memory_not_equal(hits[0], hits[1], sizeof again);
    trace(on_cpu, WHIT_TRACE_CPU_FLOAT, again);
    assert_memory_equal(again, hits[1], sizeof again);
    trace(first, WHIT_TRACE_DEVICE, again);
    assert_memory_equal(again, hits[0], sizeof again);
    assert_int_equal(whit_renderer_set_time(on_cpu, 0.0), WHIT_OK);
    assert_int_equal(whit_renderer_set_time(first, 1.5), WHIT_OK);
    trace(on_cpu, WHIT_TRACE_CPU_FLOAT, again);
    assert_memory_equal(again, hits[0], sizeof again);
    trace(first, WHIT_TRACE_CPU_BRUTE, again);
    assert_memory_equal(again, hits[1], sizeof again);
}

TEST(probes_and_references_stay_at_their_time)
{
    const whit_renderer_params early = params_at(0.0), late = params_at(1.5);
    whit_reference *reference = NULL;
    whit_probe_report *report = NULL;
    own_whit_image *before = NULL, *after = NULL;
    scene_open(WHIT_SCENES_DIR "/spin.json");
    assert_int_equal(whit_reference_create(accel, &late, 0, &reference), WHIT_OK);
    assert_int_equal(whit_reference_render(reference, &before, NULL), WHIT_OK);
    own_whit_renderer *renderer = renderer_of(&early);
    assert_int_equal(whit_reference_render(reference, &after, NULL), WHIT_OK);
    assert_same_image(before, after);
    for (uint32_t x = 0; x < WIDTH; ++x) {
        assert_int_equal(whit_probe(renderer, x, HEIGHT / 2, 0, &report), WHIT_OK);
        assert_int_equal(report->differing, 0);
        whit_probe_report_destroy(report);
    }
    whit_reference_destroy(reference);
}
