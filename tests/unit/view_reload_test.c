/* The report on a change of a file of functions that is saved while the engine shows it. */
#include <stdatomic.h>

#include "../wrapped.h"
#include "engine_fixture.h"
#include "folder_fixture.h"
#include "view/shaders.h"
#include "whit/whit_compare.h"

static whit_shader_compiler *compiler;

static void save(const char *text)
{
    put_file(settings.shader, text, strlen(text));
}

/* Takes pictures until nothing more is known about the reload. */
static void measure(void)
{
    double start_ms = clock_ms();
    engine_measure_reload(engine);
    while (!status_now().reload.over)
        (void)take(start_ms);
    take_all();
}

static void ask(const char *text)
{
    save(text);
    ++settings.shader_reload;
    engine_ask(engine, &settings, false);
}

static int begin_saved(void **state, uint32_t times)
{
    if (folder_begin(state) != 0)
        return -1;
    settings = settings_of("cube.json");
    settings.shader_reload = times;
    snprintf(settings.shader, sizeof settings.shader, "%s/a.glsl", folder);
    const whit_log silent = {0};
    assert_int_equal(whit_shader_compiler_create(NULL, &silent, &compiler), WHIT_OK);
    save("vec3 post(ivec2 at, vec3 color) { return color; }\n");
    engine_begin(&(struct engine_params){.compiler = compiler});
    return 0;
}

static int begin(void **state)
{
    return begin_saved(state, 0);
}

/* The file was saved before the first picture was whole. */
static int begin_early(void **state)
{
    return begin_saved(state, 1);
}

static int end(void **state)
{
    engine_end();
    whit_shader_compiler_destroy(compiler);
    return folder_end(state);
}

static double flip_of(const whit_image *a, const whit_image *b)
{
    whit_difference difference;
    const whit_compare_params params = {0};
    assert_int_equal(whit_image_compare(a, b, &params, NULL, &difference, NULL), WHIT_OK);
    return difference.flip_mean;
}

/* The new version changes one column of pixels, but not what they hit. */
TEST_IN(a_save_is_measured_against_the_version_before, begin, end)
{
    struct engine_frame before = frame;
    frame = (struct engine_frame){.number = before.number};
    assert_int_equal(status_now().reload.number, 0);
    ask("vec3 post(ivec2 at, vec3 color) { return at.x == 40 ? vec3(0.5) : color; }\n");
    take_all();
    assert_false(status_now().reload.over); /* measuring was not asked for */
    measure();
    const struct engine_reload reload = status_now().reload;
    assert_int_equal(reload.number, 1);
    assert_true(reload.compared && reload.has_colors && reload.has_flip);
    assert_int_equal(reload.difference.pixels, WIDTH * HEIGHT);
    assert_int_equal(reload.difference.other_colors, HEIGHT);
    assert_int_equal(reload.difference.other_ids, 0);
    assert_true(reload.flip > 0.0 && reload.flip == flip_of(before.color, frame.color));
    assert_string_equal(reload.why, "");
    assert_true(reload.ms.count >= 6 && reload.ms.coverage >= 0.95);
    assert_true(reload.ms.low <= reload.ms.median && reload.ms.median <= reload.ms.high);
    /* Measuring has changed neither the picture nor its session. */
    engine_frame_finish(&before);
    before = frame;
    frame = (struct engine_frame){.number = before.number};
    settings.picture.exposure_ev = 1.0;
    draw();
    settings.picture.exposure_ev = 0.0;
    draw();
    assert_memory_equal(before.rgba, frame.rgba, (size_t)WIDTH * HEIGHT * 4);
    assert_int_equal(status_now().reload.number, 1);
    engine_frame_finish(&before);
}

static void wait_for_spare(bool makes)
{
    double start_ms = clock_ms();
    while (status_now().makes_spare != makes) {
        engine_wait(engine, 1.0);
        assert_true(clock_ms() - start_ms < PATIENCE_MS);
    }
}

/* Before the first save there is a spare session, whose scene is loaded, whose trees are built and
   whose device is open. */
TEST_IN(the_first_save_finds_a_session, begin, end)
{
    uint64_t number = frame.number;
    wait_for_spare(true);
    wait_for_spare(false);
    ask("vec3 post(ivec2 at, vec3 color) { return color.grb; }\n");
    while (frame.number == number) {
        enum session_stage stage = status_now().stage;
        assert_true(stage == SESSION_SHADER || stage == SESSION_COMPILING || stage == SESSION_DONE);
        engine_wait(engine, 1.0);
        (void)engine_take(engine, false, &frame);
    }
    assert_int_equal(frame.settings.shader_reload, settings.shader_reload);
    take_all();
    assert_int_equal(status_now().reload.number, 1);
}

static atomic_bool cameras_missing;

WRAPPED(whit_result, whit_scene_choose_camera, const whit_scene *scene, whit_camera *camera)
{
    if (atomic_load(&cameras_missing))
        return WHIT_ERROR_MEMORY;
    return __real_whit_scene_choose_camera(scene, camera);
}

/* A session whose camera cannot be chosen stays one of the version before. */
TEST_IN(a_version_without_a_camera_is_made_again, begin, end)
{
    ask("vec3 post(ivec2 at, vec3 color) { return color.bgr; }\n");
    take_all(); /* the session of the first version is free for the next one */
    snprintf(settings.camera, sizeof settings.camera, "auto");
    atomic_store(&cameras_missing, true);
    ask("vec3 post(ivec2 at, vec3 color) { return vec3(1.0, 0.0, 0.0); }\n");
    double start_ms = clock_ms();
    while (!status_now().failed || status_now().stage != SESSION_DONE) {
        engine_wait(engine, 5.0);
        assert_true(clock_ms() - start_ms < PATIENCE_MS);
    }
    atomic_store(&cameras_missing, false);
    settings.picture.exposure_ev = 1.0;
    draw();
    assert_int_equal(frame.settings.shader_reload, settings.shader_reload);
    assert_memory_equal(frame.rgba, ((const uint8_t[]){255, 0, 0, 255}), 4);
}

/* Measuring a reload stops where something else is asked for, and no values are made up for what
   was not measured. */
TEST_IN(measuring_gives_way, begin, end)
{
    double start_ms = clock_ms();
    ask("vec3 post(ivec2 at, vec3 color) { return color.bgr; }\n");
    while (status_now().reload.number == 0) /* its picture is not taken: it has not begun */
    {
        engine_wait(engine, 1.0);
        assert_true(clock_ms() - start_ms < PATIENCE_MS);
    }
    engine_stop_reload(engine);
    struct engine_reload reload = status_now().reload;
    assert_true(reload.over && reload.compared && !reload.has_flip);
    assert_int_equal(reload.ms.count, 0);
    assert_string_equal(reload.why, "something else came first");
    measure();
    assert_int_equal(status_now().reload.ms.count, 0);

    /* With new settings there is no earlier picture to compare with, but both versions can be drawn
       with these settings and timed. */
    settings.picture.exposure_ev = 1.0;
    ask("vec3 post(ivec2 at, vec3 color) { return color.grb; }\n");
    take_all();
    measure();
    reload = status_now().reload;
    assert_int_equal(reload.number, 2);
    assert_false(reload.compared || reload.has_flip);
    assert_true(reload.ms.count >= 6);
}

/* There is nothing to compare with, and that is told too. */
TEST_IN(a_save_before_the_first_picture_is_told, begin_early, end)
{
    const struct engine_reload reload = status_now().reload;
    assert_int_equal(reload.number, 1);
    assert_true(reload.over && !reload.compared);
    assert_int_equal(reload.settings.shader_reload, 1);
    assert_string_equal(reload.why, "no whole picture was shown before it");
    ask("vec3 post(ivec2 at, vec3 color) { return color.bgr; }\n");
    take_all();
    assert_int_equal(status_now().reload.number, 2);
    assert_true(status_now().reload.compared && !status_now().reload.over);
}

TEST(what_a_save_changed_is_one_line)
{
    char line[SHADERS_LINE];
    struct engine_reload reload = {.compared = true,
                                   .has_colors = true,
                                   .difference = {.pixels = 921600, .other_colors = 1204},
                                   .has_flip = true,
                                   .flip = 0.0031,
                                   .ms = {.median = 0.41, .low = 0.36, .high = 0.47, .count = 9},
                                   .why = ""};
    struct shaders_wait wait = {.saved_ms = 1e6, .first_ms = 1e6 + 82.3, .whole_ms = 1e6 + 402.0};
    shaders_say(&reload, &wait, line);
    assert_string_equal(line, "+0.41 ms [0.36, 0.47]  1,204 pixels other  FLIP 0.003  ids equal  "
                              "preview 82 ms, whole 0.4 s");
    reload.ms = (struct sample_median){.median = -0.4, .low = -1.0, .high = 0.2, .count = 6};
    reload.difference.other_colors = 921600;
    reload.difference.other_ids = 12;
    reload.has_flip = false;
    wait.whole_ms = 0.0;
    shaders_say(&reload, &wait, line);
    assert_string_equal(line, "-0.40 ms [-1.00, 0.20]  921,600 pixels other  12 ids other  "
                              "preview 82 ms");
    reload = (struct engine_reload){.why = "pictures take too long"};
    shaders_say(&reload, &wait, line);
    assert_string_equal(line, "time not measured: pictures take too long  preview 82 ms");
}
