/* The grid on the ground: the places of its lines, and the distances of rays to them. */
#include "picture/grid.h"
#include "unit.h"

enum { SIDE = 64, COUNT = SIDE * SIDE };

static struct gpu_ray rays[COUNT];
static float cover[COUNT];

/* A scene of a unit cube on y = 2, so that lines are 0.2 apart. */
static const struct scene_pose unit_pose = {.lo = {0, 2, 0}, .hi = {1, 3, 1}};

/* Straight down onto the square around (x, z) whose sides are `size`, from height 5. */
static void look_down(double x, double z, double size)
{
    for (int i = 0; i < COUNT; ++i) {
        double u = (i % SIDE + 0.5) / SIDE - 0.5, v = ((double)(i / SIDE) + 0.5) / SIDE - 0.5;
        rays[i] = (struct gpu_ray){.origin = {(float)(x + u * size), 5, (float)(z + v * size)},
                                   .dir = {0, -1, 0},
                                   .t_max = INFINITY};
    }
    grid_cover(&unit_pose, SIDE, SIDE, rays, cover);
}

static double mean(void)
{
    double sum = 0.0;
    for (int i = 0; i < COUNT; ++i)
        sum += (double)cover[i];
    return sum / COUNT;
}

TEST(lines_are_a_pixel_wide_and_a_step_apart)
{
    look_down(0.5, 0.5, 0.8);
    for (int i = 0; i < COUNT; ++i) {
        double x = (double)rays[i].origin[0] / 0.2, z = (double)rays[i].origin[2] / 0.2;
        double off = fmin(fabs(x - round(x)), fabs(z - round(z))) * 0.2;
        assert_true((cover[i] > 0.0f) == (off < 0.8 / SIDE - 1e-6) ||
                    fabs(off - 0.8 / SIDE) < 1e-5);
        assert_true(cover[i] >= 0.0f && cover[i] <= 1.0f);
    }
    /* Four lines each way of 64 pixels. */
    assert_float_equal(mean(), 2 * 4.0 / SIDE, 0.02);
}

/* The grid is just below the bottom of the scene, so that a floor there hides it. */
TEST(rays_end_on_the_ground)
{
    look_down(0.5, 0.5, 0.8);
    for (int i = 0; i < COUNT; ++i) {
        if (cover[i] > 0.0f)
            assert_true(rays[i].t_max > 3.0f && rays[i].t_max < 3.001f);
        else
            assert_true(rays[i].t_max < 0.0f);
    }
}

TEST(lines_fade_where_they_are_too_fine_or_far)
{
    look_down(0.5, 0.5, 0.2 * SIDE / 4.0 * 0.99);
    assert_true(mean() > 0.1);
    look_down(0.5, 0.5, 0.2 * SIDE / 2.0 * 1.01);
    assert_float_equal(mean(), 0.0, 0.0);
    look_down(1.5, 0.5, 0.8);
    double near = mean();
    look_down(3.7, 0.5, 0.8);
    assert_true(mean() > 0.0 && mean() < 0.6 * near);
    look_down(6.0, 0.5, 0.8);
    assert_float_equal(mean(), 0.0, 0.0);
}

TEST(there_is_no_ground_above)
{
    look_down(0.5, 0.5, 0.8);
    for (int i = 0; i < COUNT; ++i)
        rays[i].dir[1] = 1.0f;
    grid_cover(&unit_pose, SIDE, SIDE, rays, cover);
    assert_float_equal(mean(), 0.0, 0.0);
}

/* An empty scene has a ground too: at height 0. */
TEST(nothing_stands_on_a_grid)
{
    static const struct scene_pose empty = {.lo = {INFINITY, INFINITY, INFINITY},
                                            .hi = {-INFINITY, -INFINITY, -INFINITY}};
    look_down(0.5, 0.5, 0.8);
    grid_cover(&empty, SIDE, SIDE, rays, cover);
    for (int i = 0; i < COUNT; ++i)
        assert_true(isfinite(cover[i]) &&
                    (cover[i] == 0.0f || fabsf(rays[i].t_max - 5.0f) < 1e-3f));
}
