/* The size of pictures while the camera moves, by the times that they took. */
#include "unit.h"
#include "view/pace.h"

static const double BUDGET_MS = 100.0 / 3.0;

/* Draws pictures that take overhead_ms, and whole_ms more at full size. Gives the last divisor;
   `changes` counts how often it changed. */
static uint32_t draw(struct pace *pace, int pictures, double overhead_ms, double whole_ms,
                     int *changes)
{
    uint32_t last = pace->divisor;
    for (int i = 0; i < pictures; ++i) {
        uint32_t divisor = pace_divisor(pace, BUDGET_MS);
        *changes += divisor != last;
        last = divisor;
        pace_note(pace, divisor, true, overhead_ms + whole_ms / (divisor * divisor));
    }
    return last;
}

/* A picture of the whole window, of which others are parts. */
static struct pace whole(double ms)
{
    struct pace pace = {0};
    pace_note(&pace, 1, false, ms);
    return pace;
}

TEST(without_a_picture_the_size_is_a_guess)
{
    struct pace pace = {0};
    assert_int_equal(pace_divisor(&pace, BUDGET_MS), 4);
}

TEST(sizes_follow_the_whole_picture)
{
    static const struct {
        double whole_ms;
        uint32_t divisor;
    } cases[] = {{30, 1}, {130, 2}, {290, 3}, {500, 4}, {1100, 6}, {1500, 8}, {1e5, 8}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        struct pace pace = whole(cases[i].whole_ms);
        assert_int_equal(pace_divisor(&pace, BUDGET_MS), cases[i].divisor);
    }
}

/* A small picture takes longer than its part of the pixels says: that is no reason to believe that
   one of half as many pixels would take half as long, nor to stay there. */
TEST(overhead_is_measured)
{
    int changes = 0;
    struct pace pace = whole(800);
    assert_int_equal(draw(&pace, 20, 8, 800, &changes), 6);  /* 30 ms */
    assert_int_equal(draw(&pace, 20, 14, 800, &changes), 8); /* 36 ms would not fit */
    assert_int_equal(draw(&pace, 40, 3, 800, &changes), 6);
    assert_in_range(changes, 3, 5);
}

TEST(two_pictures_that_were_held_up_change_nothing)
{
    int changes = 0;
    struct pace pace = whole(800);
    assert_int_equal(draw(&pace, 5, 5, 800, &changes), 6);
    for (int i = 0; i < 20; ++i) {
        pace_note(&pace, 6, true, 90);
        pace_note(&pace, 6, true, 60);
        assert_int_equal(draw(&pace, 4, 5, 800, &changes), 6);
    }
    assert_int_equal(changes, 1);
    for (int i = 0; i < 3; ++i)
        pace_note(&pace, 6, true, 90);
    assert_int_equal(pace_divisor(&pace, BUDGET_MS), 8);
}

/* Once the machine is free again, a size comes back that takes nearly the whole budget. */
TEST(sizes_come_back)
{
    int changes = 0;
    struct pace pace = whole(800);
    assert_int_equal(draw(&pace, 20, 8.5, 800, &changes), 6); /* 31 ms */
    assert_int_equal(draw(&pace, 20, 13, 800, &changes), 8);  /* 35 */
    assert_int_equal(draw(&pace, 60, 8.5, 800, &changes), 6);
    assert_int_equal(changes, 3);
}

TEST(a_whole_picture_that_was_held_up_changes_nothing)
{
    int changes = 0;
    struct pace pace = whole(20);
    assert_int_equal(draw(&pace, 5, 1, 20, &changes), 1);
    for (int i = 0; i < 20; ++i) {
        pace_note(&pace, 1, true, 90);
        assert_int_equal(draw(&pace, 4, 1, 20, &changes), 1);
    }
}

TEST(sizes_follow_the_view)
{
    int changes = 0;
    struct pace pace = whole(250);
    assert_int_equal(draw(&pace, 5, 2, 250, &changes), 3);
    assert_int_equal(draw(&pace, 30, 2, 2000, &changes), 8);
    assert_int_equal(draw(&pace, 200, 2, 12, &changes), 1);
}

/* At the border between two sizes, times that move by a tenth change the size once. */
TEST(sizes_do_not_flicker)
{
    int changes = 0;
    struct pace pace = whole(1160);
    for (int i = 0; i < 200; ++i)
        (void)draw(&pace, 1, 1, i % 2 ? 1100 : 1220, &changes);
    assert_in_range(changes, 1, 2);
}

/* Pictures do not become larger soon after they became smaller, though they seem to fit. */
TEST(larger_sizes_wait)
{
    int changes = 0;
    struct pace pace = whole(800);
    for (int i = 0; i < 240; ++i)
        (void)draw(&pace, 1, 1, i / 6 % 2 ? 700 : 1600, &changes);
    assert_in_range(changes, 2, 1 + 2 * 240 / 20);
}
