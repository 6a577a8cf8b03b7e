/* The size and the samples of the reference that `whit cost` judges by: no device. */
#include "folder_fixture.h"
#include "scene_fixture.h"

#include "cost/measure.h"

enum { SIDE = 64, SAMPLES = 4 };
static struct cost_report report;
static double asked_s; /* for the whole report */

/* Makes references for a picture of SIDE x SIDE pixels. All judged pictures of a pixel take
   7/3 * pixel_ms for each sample of the reference. */
static void make(uint32_t samples_max, uint32_t side_min, double pixel_ms, double seconds)
{
    const whit_log log = messages_log(&messages);
    const struct cost_request request = {.scene = scene,
                                         .accel = accel,
                                         .log = &log,
                                         .seconds = asked_s,
                                         .samples_max = samples_max,
                                         .judged_width_min = side_min,
                                         .judged_height_min = side_min};
    report = (struct cost_report){.width = SIDE, .height = SIDE};
    struct measure measure = {.request = &request,
                              .report = &report,
                              .usual = settings_usual(),
                              .usual_pixel_ms = pixel_ms};
    assert_int_equal(measure_references(&measure, seconds), WHIT_OK);
    for (int i = 0; i < 2; ++i)
        whit_image_destroy(measure.references[i]);
}

static int begin(void **state)
{
    int failed = folder_begin(state);
    setenv("XDG_CACHE_HOME", folder, 1);
    unsetenv("WHIT_NO_CACHE");
    scene_open(WHIT_SCENES_DIR "/cube.json");
    return failed;
}

static int end(void **state)
{
    scene_close();
    return folder_end(state);
}

/* Beside the judged pictures, of which a pixel takes 9.3 s here, the reference takes no time. */
TEST_IN(a_kept_reference_makes_no_judged_picture_smaller, begin, end)
{
    make(SAMPLES, 0, 1e3, 2500.0);
    assert_int_equal(report.judged_width, SIDE / 4);
    make(SAMPLES, 0, 1e3, 10000.0); /* a larger one fits into the time */
    assert_int_equal(report.judged_width, SIDE / 2);
    make(SAMPLES, SIDE, 1e3, 2500.0); /* the others are below the least size */
    assert_int_equal(report.judged_width, SIDE);
    make(SAMPLES, 0, 1e3, 2500.0); /* and here the larger ones do not fit */
    assert_int_equal(report.judged_width, SIDE / 4);
    assert_true(report.reference_cached[0] && report.reference_cached[1]);
}

TEST_IN(a_kept_reference_takes_no_time, begin, end)
{
    make(SAMPLES, SIDE / 2, 0.0, 0.0);
    assert_int_equal(report.judged_width, SIDE / 2);
    make(SAMPLES, 0, 0.0, 0.0);
    assert_int_equal(report.judged_width, SIDE / 2);
    assert_true(report.reference_cached[0] && report.reference_cached[1]);
}

TEST_IN(a_reference_that_takes_longer_than_all_should_is_announced, begin, end)
{
    asked_s = 1e-6;
    make(SAMPLES, 0, 0.0, 0.0);
    assert_non_null(strstr(messages.last, "the reference in double takes about"));
    make(SAMPLES, 0, 0.0, 0.0); /* it is kept */
    assert_int_equal(messages.count, 0);
    asked_s = 1e6;
    make(SAMPLES, SIDE, 0.0, 0.0);
    assert_int_equal(messages.count, 0);
}

TEST_IN(few_samples_keep_the_judged_picture_large, begin, end)
{
    make(0, 0, 1e3, 40000.0); /* 64 samples at a quarter of the size take 38000 s */
    assert_int_equal(report.judged_width, SIDE / 4);
    assert_int_equal(report.reference_samples, 64);
    make(0, SIDE / 2, 1e3, 40000.0); /* and 16 samples at half the size as well */
    assert_int_equal(report.judged_width, SIDE / 2);
    assert_int_equal(report.reference_samples, 16);
}
