/* The boxes that are drawn: those of a level, with the leaves above it, in world space. */
#include <stdlib.h>

#include "accel/boxes.h"
#include "render_fixture.h"

struct seen {
    struct accel_box boxes[4096];
    uint32_t count, max;
};

static bool see(void *user, const struct accel_box *box)
{
    struct seen *seen = user;
    assert_in_range(seen->count, 0, 4095);
    seen->boxes[seen->count++] = *box;
    return seen->count < seen->max;
}

static struct scene *placed_spheres(void)
{
    struct scene *scene = scene_begin(&fixture_log, "spheres");
    scene_put_mesh(scene, mesh_sphere(1.0, 16, 8));
    const double turned[4] = {0.0, 0.3826834323650898, 0.0, 0.9238795325112867};
    for (int i = 0; i < 5; ++i) {
        const double to[3] = {4.0 * i, 0.0, 0.0}, scale[3] = {1.0, 2.0, 1.0};
        struct affine m = affine_from_trs(to, turned, scale);
        scene_put_again(scene, 0, &(struct put){.matrix = &m});
    }
    return scene_ready(scene);
}

struct world {
    struct scene *scene;
    struct accel *accel;
    struct scene_pose pose;
    struct seen *seen;
};

static struct world open_world(bool flatten)
{
    struct world w = {.scene = placed_spheres(), .seen = calloc(1, sizeof *w.seen)};
    const struct accel_params params = {.flatten = flatten};
    assert_non_null(w.seen);
    w.seen->max = UINT32_MAX;
    assert_int_equal(accel_create(&fixture_log, w.scene, &params, &w.accel), WHIT_OK);
    assert_int_equal(scene_pose_init(w.scene, 0.0, &w.pose), WHIT_OK);
    return w;
}

static void close_world(struct world *w)
{
    scene_pose_finish(&w->pose);
    accel_destroy(w->accel);
    scene_destroy(w->scene);
    free(w->seen);
}

/* Every vertex of instance `i` is in some box of it: in the box's own space, by its three edges. */
static void check_covered(const struct world *w, uint32_t instance)
{
    const struct scene_mesh *mesh = &w->scene->meshes[0];
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        bool inside = false;
        double p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = (double)mesh->positions[3 * v + (uint32_t)k];
        affine_point(&w->pose.instances[instance], p, p);
        for (uint32_t b = 0; b < w->seen->count && !inside; ++b) {
            const struct accel_box *box = &w->seen->boxes[b];
            inside = box->instance == instance || box->instance == HIT_NONE;
            for (int k = 0; k < 3 && inside; ++k) {
                double along = 0.0, length = 0.0;
                for (int c = 0; c < 3; ++c) {
                    double edge = (double)box->corners[1 << k][c] - (double)box->corners[0][c];
                    along += (p[c] - (double)box->corners[0][c]) * edge;
                    length += edge * edge;
                }
                inside = along >= -1e-4 * length - 1e-5 && along <= length * 1.0001 + 1e-5;
            }
        }
        assert_true(inside);
    }
}

static void mesh_trees_level_by_level(void **state)
{
    (void)state;
    struct world w = open_world(false);
    accel_boxes(w.accel, &w.pose, false, 0, see, w.seen);
    assert_int_equal(w.seen->count, 5); /* a root each */
    for (uint32_t level = 0; level < 6; ++level) {
        w.seen->count = 0;
        accel_boxes(w.accel, &w.pose, false, level, see, w.seen);
        for (uint32_t i = 0; i < w.seen->count; ++i) {
            const struct accel_box *box = &w.seen->boxes[i];
            assert_true(box->level == level || (box->leaf && box->level < level));
        }
        for (uint32_t i = 0; i < 5; ++i)
            check_covered(&w, i);
    }
    w.seen->count = 0;
    accel_boxes(w.accel, &w.pose, false, 127, see, w.seen);
    for (uint32_t i = 0; i < w.seen->count; ++i)
        assert_true(w.seen->boxes[i].leaf);
    close_world(&w);
}

static void instances_and_one_tree(void **state)
{
    (void)state;
    struct world w = open_world(false);
    accel_boxes(w.accel, &w.pose, true, 0, see, w.seen);
    assert_int_equal(w.seen->count, 1);
    check_covered(&w, 0);
    check_covered(&w, 4);
    w.seen->count = 0;
    accel_boxes(w.accel, &w.pose, true, 127, see, w.seen);
    assert_int_equal(w.seen->count, 5); /* a leaf each */
    close_world(&w);

    struct world flat = open_world(true);
    accel_boxes(flat.accel, &flat.pose, false, 2, see, flat.seen);
    assert_int_equal(flat.seen->count, 4);
    for (uint32_t i = 0; i < 5; ++i)
        check_covered(&flat, i);
    flat.seen->count = 0;
    accel_boxes(flat.accel, &flat.pose, true, 2, see, flat.seen);
    assert_int_equal(flat.seen->count, 0);
    close_world(&flat);
}

static void who_asks_can_stop(void **state)
{
    (void)state;
    struct world w = open_world(false);
    w.seen->max = 3;
    accel_boxes(w.accel, &w.pose, false, 4, see, w.seen);
    assert_int_equal(w.seen->count, 3);
    close_world(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mesh_trees_level_by_level),
        cmocka_unit_test(instances_and_one_tree),
        cmocka_unit_test(who_asks_can_stop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
