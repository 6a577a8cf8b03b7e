/* The engine, which draws while the window runs: devices that are lost, memory that runs out, and
   users who ask for the next picture before one is done. */
#include <pthread.h>
#include <stdatomic.h>
#include <vulkan/vulkan.h>

#include "../wrapped.h"
#include "base/clock.h"
#include "device_fixture.h"
#include "unit.h"
#include "view/engine.h"

enum { WIDTH = 96, HEIGHT = 64 };
static const double PATIENCE_MS = 60e3;

static struct settings settings_of(const char *scene)
{
    struct settings settings = {.picture = {.width = WIDTH, .height = HEIGHT}};
    snprintf(settings.scene, sizeof settings.scene, "%s/%s", WHIT_SCENES_DIR, scene);
    return settings;
}

/* Waits for the engine a moment and takes its picture. Gives whether there is a new one. */
static bool take(struct engine *engine, struct engine_frame *frame, double start_ms)
{
    engine_wait(engine, 20.0);
    assert_true(clock_ms() - start_ms < PATIENCE_MS); /* it hangs */
    return engine_take(engine, false, frame);
}

/* Takes pictures until the engine has nothing left to do. */
static void take_both(struct engine *engine, struct engine_frame *frame, struct engine_frame *other)
{
    double start_ms = clock_ms();
    while (!engine_is_still(engine)) {
        (void)take(engine, frame, start_ms);
        if (other)
            (void)engine_take(engine, true, other);
    }
    (void)engine_take(engine, false, frame);
}

static void take_all(struct engine *engine, struct engine_frame *frame)
{
    take_both(engine, frame, NULL);
}

/* An engine that has drawn this. */
static struct engine *engine_of(const struct engine_params *params, const struct settings *settings,
                                struct engine_frame *frame)
{
    struct engine *engine;
    *frame = (struct engine_frame){0};
    assert_int_equal(engine_create(params, &engine), WHIT_OK);
    engine_ask(engine, settings, false);
    take_all(engine, frame);
    assert_true(frame->whole);
    return engine;
}

static void close_engine(struct engine *engine, struct engine_frame *frame)
{
    engine_frame_finish(frame);
    assert_int_equal(engine_destroy(engine), 0);
}

/* Lets each device be lost at its n-th submission: while the engine is opened, later, or not at
   all. `once`: only the first device is lost. */
static bool lose_at(unsigned n, bool once, bool *gave_up)
{
    struct engine *engine;
    struct engine_frame frame = {0};
    struct engine_status status;
    char fault[32];
    snprintf(fault, sizeof fault, "vkQueueSubmit:%u", n);
    setenv("WHIT_FAULT", fault, 1);
    assert_int_equal(engine_create(&(struct engine_params){0}, &engine), WHIT_OK);
    struct settings settings = settings_of("cube.json");
    engine_ask(engine, &settings, false);
    if (once) {
        do {
            engine_wait(engine, 20.0);
            engine_get_status(engine, &status);
        } while (status.stage != SESSION_COMPILING && status.stage != SESSION_DONE);
        unsetenv("WHIT_FAULT");
    }
    take_all(engine, &frame);
    engine_get_status(engine, &status);
    bool whole = frame.number > 0 && frame.whole;
    *gave_up = status.device_lost;
    if (!whole)
        assert_true(status.error[0] != '\0'); /* it says why */
    engine_frame_finish(&frame);
    unsetenv("WHIT_FAULT");
    assert_int_equal(engine_destroy(engine), 0);
    return whole;
}

TEST(a_lost_device_is_made_again_or_given_up)
{
    uint32_t gave_up = 0, failed = 0, mended = 0;
    bool whole = false, lost = false;
    unsigned n = 0;
    while (!(whole && !lost) && ++n < 40) {
        whole = lose_at(n, false, &lost);
        gave_up += lost;
        failed += !whole && !lost;
    }
    print_message("lost at submissions 1 to %u of every device: %u given up, %u not opened\n",
                  n - 1, gave_up, failed);
    assert_true(n > 2 && n < 40);
    assert_true(gave_up > 0);
    for (unsigned i = 1; i < n; ++i) {
        whole = lose_at(i, true, &lost);
        assert_false(lost);
        mended += whole;
    }
    print_message("of the first device: %u of %u made again\n", mended, n - 1);
    assert_true(mended >= gave_up);
}

/* A large tree is drawn in packets, as a picture of the window's size is, although the engine's
   renderer is made for a small one. */
TEST(large_trees_are_drawn_in_packets)
{
    struct engine_frame frame;
    struct settings settings = settings_of("8k.json");
    struct engine *engine = engine_of(&(struct engine_params){0}, &settings, &frame);
    assert_true(frame.stats.packets == (frame.device.subgroup_size == 8)); /* lavapipe */
    close_engine(engine, &frame);
}

/* ---- At rest ---- */

/* Every 8th, 4th and 2nd pixel are shown before the whole picture, unless that is quick. */
TEST(a_picture_comes_in_steps)
{
    struct engine_frame frame;
    struct settings settings = settings_of("cube.json");
    struct engine *engine = engine_of(&(struct engine_params){0}, &settings, &frame);
    assert_int_equal(frame.number, 4);
    assert_int_equal(frame.first, 1);
    assert_int_equal(frame.divisor, 1);
    close_engine(engine, &frame);
    engine = engine_of(&(struct engine_params){.budget_ms = 1e9}, &settings, &frame);
    uint64_t before = frame.number;
    settings.picture.exposure_ev = 1.0;
    engine_ask(engine, &settings, false);
    take_all(engine, &frame);
    assert_int_equal(frame.number, before + 1);
    close_engine(engine, &frame);
}

/* After the steps of the first sample, pictures of four samples and of all samples of the settings
   are shown, and no sample is drawn twice. */
TEST(samples_of_the_settings_are_added_to_the_first)
{
    struct engine_frame frame;
    struct settings settings = settings_of("cube.json");
    settings.picture.sampling.count = 16;
    struct engine *engine = engine_of(&(struct engine_params){0}, &settings, &frame);
    assert_int_equal(frame.number, 4 + 2);
    assert_int_equal(frame.samples, 16);
    assert_int_equal(frame.estimate_count, 4); /* of 2, 4, 8 and 16: it was not drawn at once */
    assert_int_equal(frame.stats.rays_primary, 16 * WIDTH * HEIGHT);
    assert_int_equal(frame.stats.pixels_by_samples[2], WIDTH * HEIGHT);
    close_engine(engine, &frame);
}

/* A picture that is asked for while another one is refined is drawn at once, and is refined in its
   turn. */
TEST(whoever_moves_on_does_not_wait_for_refining)
{
    struct engine_frame frame;
    struct settings settings = settings_of("cube.json");
    struct engine *engine = engine_of(&(struct engine_params){.refine = true}, &settings, &frame);
    double start_ms = clock_ms();
    while (!frame.refined || frame.samples < 16) {
        (void)take(engine, &frame, start_ms);
        assert_true(frame.refined ? !frame.ids && frame.samples > 1 : frame.samples == 1);
    }
    for (uint32_t depth = 0; depth < 3; ++depth) {
        uint64_t before = frame.number;
        settings.picture.depth = depth + 1;
        engine_ask(engine, &settings, false);
        while (frame.number == before || frame.refined)
            (void)take(engine, &frame, start_ms);
        assert_int_equal(frame.settings.picture.depth, depth + 1);
        assert_int_equal(frame.samples, 1);
        while (!frame.refined)
            (void)take(engine, &frame, start_ms);
        assert_int_equal(frame.settings.picture.depth, depth + 1);
    }
    assert_false(engine_is_refined(engine));
    engine_set_rest(engine, false, false);
    close_engine(engine, &frame);
}

/* ---- Memory ---- */

static pthread_t window_thread;
static atomic_uint fail_at, asked_for; /* fail_at: number of the allocation that fails; 0: none */

WRAPPED(void *, malloc, size_t bytes)
{
    unsigned at = atomic_load(&fail_at);
    if (at > 0 && !pthread_equal(pthread_self(), window_thread) &&
        atomic_fetch_add(&asked_for, 1) + 1 == at)
        return NULL;
    return __real_malloc(bytes);
}

static void draw(struct engine *engine, const struct settings *settings, struct engine_frame *frame)
{
    engine_frame_finish(frame);
    engine_ask(engine, settings, false);
    take_all(engine, frame);
}

/* Draws while the n-th allocation of memory fails: the picture is whole, or the status says why it
   is not. Gives whether there was an n-th allocation. */
static bool draws_without(unsigned n, struct engine *engine, const struct settings *settings,
                          const struct engine_frame *right, bool *said)
{
    struct engine_frame frame = {0};
    struct engine_status status;
    struct settings other = *settings; /* another one each time: the last one is kept */
    snprintf(other.camera, sizeof other.camera, "%g,2,6,0,1,0,0,1,0,40", 0.001 * (double)n);
    draw(engine, &other, &frame);
    assert_true(frame.whole);
    engine_get_status(engine, &status);
    assert_string_equal(status.error, ""); /* a later picture went well */
    atomic_store(&asked_for, 0);
    atomic_store(&fail_at, n);
    draw(engine, settings, &frame);
    atomic_store(&fail_at, 0);
    engine_get_status(engine, &status);
    *said = status.error[0] != '\0';
    bool same = frame.number > 0 && frame.whole &&
                memcmp(frame.rgba, right->rgba, (size_t)WIDTH * HEIGHT * 4) == 0;
    if (!*said && !same)
        print_message("block %u is missing, the picture is %s, and nothing is said\n", n,
                      frame.number ? "another one" : "missing too");
    assert_true(*said || same);
    engine_frame_finish(&frame);
    return atomic_load(&asked_for) >= n;
}

TEST(memory_that_runs_out_is_said)
{
    static const enum settings_paint paints[] = {PAINT_COLOR, PAINT_VISITS};
    window_thread = pthread_self();
    for (int i = 0; i < 2; ++i) {
        struct engine_frame right;
        struct settings settings = settings_of("cube.json");
        uint32_t said_count = 0, blocks = 0;
        bool said = false;
        settings.paint = paints[i];
        struct engine *engine = engine_of(&(struct engine_params){0}, &settings, &right);
        while (draws_without(blocks + 1, engine, &settings, &right, &said) && ++blocks < 1000)
            said_count += said;
        print_message("view %d: %u blocks, %u of them missed and said so\n", (int)paints[i], blocks,
                      said_count);
        assert_true(said_count >= 2 && blocks < 1000);
        close_engine(engine, &right);
    }
}

static atomic_bool device_is_full;

WRAPPED(VkResult, vkAllocateMemory, VkDevice device, const VkMemoryAllocateInfo *info,
        const VkAllocationCallbacks *callbacks, VkDeviceMemory *memory)
{
    if (atomic_load(&device_is_full))
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return __real_vkAllocateMemory(device, info, callbacks, memory);
}

/* Pictures of other depths need other buffers. The engine logs that it cannot make them, and goes
   on. */
TEST(memory_that_runs_out_while_a_change_is_timed_is_said)
{
    struct engine_frame frame;
    struct engine_status status;
    struct settings settings = settings_of("whitted.json");
    settings.picture.depth = 4;
    struct engine *engine = engine_of(&(struct engine_params){0}, &settings, &frame);
    settings.picture.depth = 8;
    draw(engine, &settings, &frame);
    atomic_store(&device_is_full, true);
    engine_set_rest(engine, false, true); /* times the change */
    double start_ms = clock_ms();
    do {
        (void)take(engine, &frame, start_ms);
        engine_get_status(engine, &status);
    } while (!status.change.over);
    assert_int_equal(status.change.number, 1);
    assert_int_equal(status.change.ms.count, 0);
    take_all(engine, &frame);
    engine_get_status(engine, &status);
    assert_string_not_equal(status.error, "");
    atomic_store(&device_is_full, false);
    settings.picture.depth = 4;
    draw(engine, &settings, &frame);
    engine_get_status(engine, &status);
    assert_true(frame.whole);
    assert_string_equal(status.error, "");
    close_engine(engine, &frame);
}

static atomic_bool images_fail;

WRAPPED(whit_result, whit_image_create, uint32_t width, uint32_t height, uint32_t channels,
        const float *pixels, whit_image **out)
{
    *out = NULL;
    return atomic_load(&images_fail)
               ? WHIT_ERROR_MEMORY
               : __real_whit_image_create(width, height, channels, pixels, out);
}

/* A refined picture keeps its samples under another traversal, if there is memory to show them. */
TEST(memory_that_runs_out_for_kept_samples_is_survived)
{
    struct engine_frame frame;
    struct engine_status status;
    struct settings settings = settings_of("cube.json");
    struct engine *engine = engine_of(&(struct engine_params){.refine = true}, &settings, &frame);
    double start_ms = clock_ms();
    while (!frame.refined)
        (void)take(engine, &frame, start_ms);
    engine_set_rest(engine, false, false);
    for (int i = 0; i < 2; ++i) {
        settings.picture.traversal = i == 0 ? WHIT_TRAVERSAL_SIGN : WHIT_TRAVERSAL_BASIC;
        atomic_store(&images_fail, i == 1);
        draw(engine, &settings, &frame);
        atomic_store(&images_fail, false);
        engine_get_status(engine, &status);
        assert_string_equal(status.error, "");
        assert_true(frame.whole && frame.refined == (i == 0));
    }
    close_engine(engine, &frame);
}

/* ---- Moving cameras ---- */

/* Pictures are shown even if the camera turns faster than they are drawn. */
TEST(no_look_is_cut_short)
{
    struct engine_frame frame;
    uint32_t shown = 0, asked = 0;
    struct settings settings = settings_of("default.json");
    settings.picture.width = 160;
    settings.picture.height = 108;
    struct engine *engine = engine_of(&(struct engine_params){.budget_ms = 1e4}, &settings, &frame);
    double picture_ms = frame.draw_ms, start_ms = clock_ms();
    while (shown < 3) { /* if new questions cancelled pictures, none would be shown */
        snprintf(settings.camera, sizeof settings.camera, "%g,2,6,0,1,0,0,1,0,40",
                 0.001 * (double)++asked);
        engine_ask(engine, &settings, true);
        engine_wait(engine, 2.0);
        shown += engine_take(engine, false, &frame);
        assert_true(clock_ms() - start_ms < PATIENCE_MS);
    }
    print_message("%u pictures of %.0f ms for %u questions in %.0f ms\n", shown, picture_ms, asked,
                  clock_ms() - start_ms);
    engine_ask(engine, &settings, false);
    take_all(engine, &frame);
    assert_string_equal(frame.settings.camera, settings.camera); /* the last one is answered */
    assert_true(frame.whole);
    close_engine(engine, &frame);
}

/* While another tree is made the picture stays as it is, and no coarser one is shown. */
TEST(a_switch_keeps_the_picture)
{
    struct engine_frame frame;
    struct settings settings = settings_of("8k.json");
    struct engine *engine = engine_of(&(struct engine_params){0}, &settings, &frame);
    settings.trees.build = WHIT_BUILD_MEDIAN;
    engine_ask(engine, &settings, false);
    double start_ms = clock_ms();
    while (!engine_is_still(engine)) {
        if (take(engine, &frame, start_ms))
            assert_int_equal(frame.settings.trees.build, WHIT_BUILD_MEDIAN);
    }
    struct engine_status status;
    engine_get_status(engine, &status);
    assert_true(frame.whole);
    assert_int_equal(status.change.number, 1);
    assert_int_equal(status.change.difference.other_ids, 0);
    close_engine(engine, &frame);
}

/* Where one of two scenes side by side cannot be read, its error stays when the camera turns and
   the other scene is drawn again. */
TEST(an_error_outlives_the_other_side)
{
    struct engine_frame frame, other = {0};
    struct engine_status status;
    struct settings settings = settings_of("cube.json");
    struct engine *engine = engine_of(&(struct engine_params){0}, &settings, &frame);
    engine_ask_other(engine, &settings);
    take_both(engine, &frame, &other);
    settings = settings_of("nowhere.json");
    engine_ask(engine, &settings, false);
    take_both(engine, &frame, &other);
    uint64_t number = other.number;
    snprintf(settings.camera, sizeof settings.camera, "0,2,6,0,1,0,0,1,0,40");
    struct settings beside = settings_of("cube.json");
    settings_set_camera(&beside, &settings);
    engine_ask_other(engine, &beside);
    take_both(engine, &frame, &other);
    assert_true(other.number > number);
    engine_get_status(engine, &status);
    assert_non_null(strstr(status.error, "nowhere.json"));
    engine_frame_finish(&other);
    close_engine(engine, &frame);
}
