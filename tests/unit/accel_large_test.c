/* Ten million triangles in one mesh (U11 of the catalogue of hard cases): nothing overflows, every
   triangle is in the tree, rays hit; prints time and memory. Not run by tools/test. */
#include "hard_fixture.h"

#include <sys/resource.h>

#include "base/clock.h"
#include "hard/mesh.h"
#include "unit.h"

enum { STEPS = 2237, RAYS = 20000 };

static double peak_gib(void)
{
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    return (double)usage.ru_maxrss * 0x1p-20; /* from KiB */
}

/* A ray from above at a record, not at the border of the landscape. */
static struct gpu_ray ray_at_record(const struct accel *accel, uint32_t i)
{
    struct vec3 target;
    do
        target = point_of_record(accel, i);
    while (!(fabsf(target.x) < 4.9f && fabsf(target.z) < 4.9f));
    return ray_through(vec3_add(target, vec3_add(random_point(1.0f), vec3_make(0, 8, 0))), target);
}

TEST(ten_million_triangles)
{
    struct scene_mesh mesh;
    own_scene *scene = NULL;
    assert_int_equal(shape_terrain(10.0, 2.0, STEPS, 5, &mesh), WHIT_OK);
    assert_int_equal(hard_scene_of_mesh(&silent, "terrain", &mesh, NULL, &scene), WHIT_OK);
    assert_int_equal(scene->triangle_total, 2 * STEPS * STEPS);
    double before = peak_gib(), begin_ms = clock_ms();
    own_accel *accel = accel_of(scene, (whit_accel_params){0});
    print_message("%u triangles: %u nodes, depth %u, built in %.1f s, with validation %.1f s; peak "
                  "memory %.2f GiB, %.2f of it the scene before\n",
                  accel->record_count, accel->node_count, accel->mesh_depth, accel->build_ms * 1e-3,
                  (clock_ms() - begin_ms) * 1e-3, peak_gib(), before);
    assert_int_equal(accel->record_count, 2 * STEPS * STEPS);
    own_rational *rational = rational_create(accel);
    assert_non_null(rational);
    uint32_t other[LEVELS] = {0}, missed[LEVELS] = {0};
    random_state = 11;
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_ray ray = ray_at_record(accel, i);
        struct rational_hit exact;
        rational_trace(rational, &ray, NULL, &exact);
        for (int l = 0; l < LEVELS; ++l) {
            struct gpu_hit hit = level_trace(&levels[l], accel, ORDER_DISTANCE, false, &ray);
            missed[l] += hit.primitive == HIT_NONE && exact.primitive != HIT_NONE;
            other[l] += hit.primitive != exact.primitive;
        }
    }
    print_message("U11 of %u rays %u missed at watertight, %u other triangles; at exact %u, %u\n",
                  (uint32_t)RAYS, missed[0], other[0], missed[1], other[1]);
    assert_int_equal(missed[0] + missed[1] + other[1], 0);
}
