/* The camera that the user moves. */
#include "unit.h"
#include "view/camera.h"

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static struct view_camera front(void)
{
    return (struct view_camera){.eye = {0, 0, 5}, .up = {0, 1, 0}, .fov_y_degrees = 60.0};
}

static void assert_near(double a, double b)
{
    if (!(fabs(a - b) < 1e-9))
        fail_msg("%.17g and %.17g", a, b);
}

TEST(orbits_keep_distance_and_stay_below_the_pole)
{
    struct view_camera c = front();
    camera_orbit(&c, 1.5707963267948966, 0.0); /* to the right: the eye goes to the left */
    assert_near(c.eye[0], -5.0);
    assert_near(c.eye[2], 0.0);
    for (int i = 0; i < 1000; ++i) {
        camera_orbit(&c, 0.1 * i, i % 3 ? 0.4 : -0.3);
        assert_near(distance(c.eye, c.target), 5.0);
        assert_true(fabs(c.eye[1]) < 5.0 * 0.999);
    }
}

TEST(turning_moves_the_target_alone)
{
    struct view_camera c = front();
    camera_turn(&c, 1.5707963267948966, 0.0);
    assert_near(c.eye[2], 5.0);
    assert_near(c.target[0], 5.0); /* to the right */
    assert_near(c.target[2], 5.0);
}

TEST(flying_is_by_the_distance)
{
    struct view_camera c = front();
    camera_fly(&c, 0.0, 0.0, 0.5);
    assert_near(c.eye[2], 2.5);
    assert_near(c.target[2], -2.5);
    camera_fly(&c, 1.0, 0.2, 0.0);
    assert_near(c.eye[0], 5.0);
    assert_near(c.eye[1], 1.0);
}

TEST(zoom_never_reaches_the_target_nor_infinity)
{
    struct view_camera c = front();
    camera_zoom(&c, 0.5);
    assert_near(c.eye[2], 2.5);
    for (int i = 0; i < 5000; ++i)
        camera_zoom(&c, 0.5);
    assert_true(distance(c.eye, c.target) > 0.0);
    c.target[0] = c.eye[0] = 1e7;
    for (int i = 0; i < 5000; ++i)
        camera_zoom(&c, 0.5);
    assert_true((float)c.eye[2] != (float)c.target[2] || (float)c.eye[0] != (float)c.target[0]);
    for (int i = 0; i < 5000; ++i)
        camera_zoom(&c, 2.0);
    camera_zoom(&c, INFINITY);
    assert_true(isfinite((float)c.eye[2]) && c.eye[2] > 1e30);
}

/* All corners of the box are in the picture, whatever its shape. */
TEST(all_of_a_box_is_shown)
{
    const double lo[3] = {-3, 1, 10}, hi[3] = {9, 2, 11};
    const double aspects[] = {0.3, 1.0, 1.7, 5.0};
    const struct view_camera aside = {.eye = {1, 0.7, 1.6}, .up = {0, 1, 0}, .fov_y_degrees = 45};
    for (int i = 0; i < 4; ++i) {
        struct view_camera c = aside;
        double height = 100.0, width = height * aspects[i];
        camera_show(&c, lo, hi, aspects[i]);
        for (int corner = 0; corner < 8; ++corner) {
            double p[3], line[4];
            for (int k = 0; k < 3; ++k)
                p[k] = corner >> k & 1 ? hi[k] : lo[k];
            assert_true(camera_project(&c, p, p, width, height, line));
            assert_true(line[0] > 0.0 && line[0] < width && line[1] > 0.0 && line[1] < height);
        }
    }
    const double nothing_lo[3] = {INFINITY, INFINITY, INFINITY};
    const double nothing_hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    struct view_camera c = aside;
    camera_show(&c, nothing_lo, nothing_hi, 1.0);
    for (int k = 0; k < 3; ++k)
        assert_true(isfinite(c.eye[k]) && isfinite(c.target[k]));
}

TEST(along_axes)
{
    for (int axis = 0; axis < 3; ++axis) {
        for (int from = -1; from <= 1; from += 2) {
            struct view_camera c = front();
            char text[256];
            struct view_camera back;
            camera_along(&c, axis, from);
            assert_near(c.eye[axis], 5.0 * from);
            assert_near(distance(c.eye, c.target), 5.0);
            camera_to_text(&c, text, sizeof text);
            assert_true(camera_from_text(text, &back)); /* up is not along the look */
        }
    }
}

TEST(a_view_from_above_or_below_is_turned_about_y)
{
    for (int from = -1; from <= 1; from += 2) {
        struct view_camera c = front();
        camera_along(&c, 1, from);
        camera_orbit(&c, 0.0, 0.0);
        assert_near(distance(c.eye, c.target), 5.0);
        assert_true(fabs(c.eye[0]) < 1e-9 && c.eye[2] > 0.0 && from * c.eye[1] > 4.9);
        camera_orbit(&c, 0.5 * 3.14159265358979, 0.0);
        assert_near(c.eye[2], 0.0);
        assert_true(c.eye[0] < 0.0 && c.up[1] == 1.0);
        camera_along(&c, 0, 1);
        camera_orbit(&c, 0.3, 0.0);
        assert_near(c.eye[1], c.target[1]);
    }
}

TEST(text_goes_there_and_back)
{
    struct view_camera c = front(), back;
    char text[256], again[256];
    camera_orbit(&c, 0.7, 0.3);
    camera_to_text(&c, text, sizeof text);
    assert_true(camera_from_text(text, &back));
    camera_to_text(&back, again, sizeof again);
    assert_string_equal(text, again);
    static const char *const wrong[] = {
        "",
        "0",
        "camera",
        "0,0,5,0,0,0,0,1,0",
        "0,0,5,0,0,0,0,1,0,60,1",
        "0,0,5,0,0,0,0,1,0,180",
        "0,0,5,0,0,0,0,0,1,60",
        "0,0,5,0,0,5,0,1,0,60",
        "nan,0,5,0,0,0,0,1,0,60",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i)
        assert_false(camera_from_text(wrong[i], &back));
}

/* The point around which a camera orbits whose file says only where it looks. */
TEST(target_is_beside_the_middle_of_what_there_is)
{
    struct view_camera c = front();
    const double lo[3] = {1, -1, -22}, hi[3] = {3, 1, -18}, around_lo[3] = {-2, -2, 3},
                 around_hi[3] = {2, 2, 7};
    camera_reach(&c, lo, hi); /* looks along -z from z 5 */
    assert_near(c.target[0], 0.0);
    assert_near(c.target[2], -20.0);
    camera_reach(&c, around_lo, around_hi);
    assert_near(c.target[2], 4.0);
    camera_reach(&c, around_hi, around_lo); /* an empty scene */
    assert_near(c.target[2], 4.0);
}

TEST(lines_are_cut_at_the_eye)
{
    struct view_camera c = front();
    const double ahead[3] = {0, 0, 0}, aside[3] = {1, 1, 0}, behind[3] = {1, 0, 9};
    double line[4];
    assert_true(camera_project(&c, ahead, aside, 200.0, 100.0, line));
    assert_near(line[0], 100.0);
    assert_near(line[1], 50.0);
    double focal = 50.0 / tan(0.5235987755982988);
    assert_near(line[2], 100.0 + focal / 5.0);
    assert_near(line[3], 50.0 - focal / 5.0);
    assert_true(camera_project(&c, ahead, behind, 200.0, 100.0, line));
    assert_true(isfinite(line[2]) && line[2] > 100.0);
    assert_false(camera_project(&c, behind, behind, 200.0, 100.0, line));
}
