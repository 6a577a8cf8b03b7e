/* The engine, which draws while the window runs: devices that are lost, memory that runs out, and
   users who ask for the next picture before one is done. */
#include <pthread.h>
#include <stdatomic.h>
#include <vulkan/vulkan.h>

#include "../wrapped.h"
#include "engine_fixture.h"

static void begin(const char *scene)
{
    settings = settings_of(scene);
    engine_begin(&(struct engine_params){0});
}

/* Lets each device be lost at its n-th submission: while the engine is opened, later, or not at
   all. `once`: only the first device is lost. */
static bool lose_at(unsigned n, bool once, bool *gave_up)
{
    char fault[32];
    snprintf(fault, sizeof fault, "vkQueueSubmit:%u", n);
    setenv("WHIT_FAULT", fault, 1);
    frame = (struct engine_frame){0};
    settings = settings_of("cube.json");
    assert_int_equal(engine_create(&(struct engine_params){0}, &engine), WHIT_OK);
    engine_ask(engine, &settings, false);
    if (once) {
        enum session_stage stage;
        do {
            engine_wait(engine, 20.0);
            stage = status_now().stage;
        } while (stage != SESSION_COMPILING && stage != SESSION_DONE);
        unsetenv("WHIT_FAULT");
    }
    take_all();
    const struct engine_status status = status_now();
    bool whole = frame.number > 0 && frame.whole;
    *gave_up = status.device_lost;
    if (!whole)
        assert_true(status.error[0] != '\0'); /* it says why */
    unsetenv("WHIT_FAULT");
    engine_end();
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
    begin("8k.json");
    assert_true(frame.stats.packets == (frame.device.subgroup_size == 8)); /* lavapipe */
    engine_end();
}

/* ---- At rest ---- */

/* Every 8th, 4th and 2nd pixel are shown before the whole picture, unless that is quick. */
TEST(a_picture_comes_in_steps)
{
    begin("cube.json");
    assert_int_equal(frame.number, 4);
    assert_int_equal(frame.first, 1);
    assert_int_equal(frame.divisor, 1);
    engine_end();
    engine_begin(&(struct engine_params){.budget_ms = 1e9});
    uint64_t before = frame.number;
    settings.picture.exposure_ev = 1.0;
    draw();
    assert_int_equal(frame.number, before + 1);
    engine_end();
}

/* After the steps of the first sample, pictures of four samples and of all samples of the settings
   are shown, and no sample is drawn twice. */
TEST(samples_of_the_settings_are_added_to_the_first)
{
    settings = settings_of("cube.json");
    settings.picture.sampling.count = 16;
    engine_begin(&(struct engine_params){0});
    assert_int_equal(frame.number, 4 + 2);
    assert_int_equal(frame.samples, 16);
    assert_int_equal(frame.estimate_count, 4); /* of 2, 4, 8 and 16: it was not drawn at once */
    assert_int_equal(frame.stats.rays_primary, 16 * WIDTH * HEIGHT);
    assert_int_equal(frame.stats.pixels_by_samples[2], WIDTH * HEIGHT);
    engine_end();
}

/* A picture that is asked for while another one is refined is drawn at once, and is refined in its
   turn. */
TEST(whoever_moves_on_does_not_wait_for_refining)
{
    settings = settings_of("cube.json");
    engine_begin(&(struct engine_params){.refine = true});
    double start_ms = clock_ms();
    while (!frame.refined || frame.samples < 16) {
        (void)take(start_ms);
        assert_true(frame.refined ? !frame.ids && frame.samples > 1 : frame.samples == 1);
    }
    for (uint32_t depth = 0; depth < 3; ++depth) {
        uint64_t before = frame.number;
        settings.picture.depth = depth + 1;
        engine_ask(engine, &settings, false);
        while (frame.number == before || frame.refined)
            (void)take(start_ms);
        assert_int_equal(frame.settings.picture.depth, depth + 1);
        assert_int_equal(frame.samples, 1);
        while (!frame.refined)
            (void)take(start_ms);
        assert_int_equal(frame.settings.picture.depth, depth + 1);
    }
    assert_false(engine_is_refined(engine));
    engine_set_rest(engine, false, false);
    engine_end();
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

/* Draws while the n-th allocation of memory fails: the picture is whole, or the status says why it
   is not. Gives whether there was an n-th allocation. */
static bool draws_without(unsigned n, const struct engine_frame *right, bool *said)
{
    const struct settings kept = settings;
    /* another one each time: the last one is kept */
    snprintf(settings.camera, sizeof settings.camera, "%g,2,6,0,1,0,0,1,0,40", 0.001 * (double)n);
    draw();
    assert_true(frame.whole);
    assert_string_equal(status_now().error, ""); /* a later picture went well */
    settings = kept;
    engine_frame_finish(&frame);
    atomic_store(&asked_for, 0);
    atomic_store(&fail_at, n);
    draw();
    atomic_store(&fail_at, 0);
    *said = status_now().error[0] != '\0';
    bool same = frame.number > 0 && frame.whole &&
                memcmp(frame.rgba, right->rgba, (size_t)WIDTH * HEIGHT * 4) == 0;
    if (!*said && !same)
        print_message("block %u is missing, the picture is %s, and nothing is said\n", n,
                      frame.number ? "another one" : "missing too");
    assert_true(*said || same);
    return atomic_load(&asked_for) >= n;
}

TEST(memory_that_runs_out_is_said)
{
    static const enum settings_paint paints[] = {PAINT_COLOR, PAINT_VISITS};
    window_thread = pthread_self();
    for (int i = 0; i < 2; ++i) {
        uint32_t said_count = 0, blocks = 0;
        bool said = false;
        settings = settings_of("cube.json");
        settings.paint = paints[i];
        engine_begin(&(struct engine_params){0});
        struct engine_frame right = frame;
        frame = (struct engine_frame){0};
        while (draws_without(blocks + 1, &right, &said) && ++blocks < 1000)
            said_count += said;
        print_message("view %d: %u blocks, %u of them missed and said so\n", (int)paints[i], blocks,
                      said_count);
        assert_true(said_count >= 2 && blocks < 1000);
        engine_frame_finish(&right);
        engine_end();
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
    settings = settings_of("whitted.json");
    settings.picture.depth = 4;
    engine_begin(&(struct engine_params){0});
    settings.picture.depth = 8;
    draw();
    atomic_store(&device_is_full, true);
    engine_set_rest(engine, false, true); /* times the change */
    double start_ms = clock_ms();
    do
        (void)take(start_ms);
    while (!status_now().change.over);
    assert_int_equal(status_now().change.number, 1);
    assert_int_equal(status_now().change.ms.count, 0);
    take_all();
    assert_string_not_equal(status_now().error, "");
    atomic_store(&device_is_full, false);
    settings.picture.depth = 4;
    draw();
    assert_true(frame.whole);
    assert_string_equal(status_now().error, "");
    engine_end();
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
    settings = settings_of("cube.json");
    engine_begin(&(struct engine_params){.refine = true});
    double start_ms = clock_ms();
    while (!frame.refined)
        (void)take(start_ms);
    engine_set_rest(engine, false, false);
    for (int i = 0; i < 2; ++i) {
        settings.picture.traversal = i == 0 ? WHIT_TRAVERSAL_SIGN : WHIT_TRAVERSAL_BASIC;
        atomic_store(&images_fail, i == 1);
        draw();
        atomic_store(&images_fail, false);
        assert_string_equal(status_now().error, "");
        assert_true(frame.whole && frame.refined == (i == 0));
    }
    engine_end();
}

/* ---- Probes ---- */

static atomic_bool probe_is_cancelled;

WRAPPED(whit_result, whit_probe, whit_renderer *renderer, uint32_t x, uint32_t y, uint32_t records,
        whit_probe_report **report)
{
    return atomic_exchange(&probe_is_cancelled, false)
               ? WHIT_ERROR_CANCELLED
               : __real_whit_probe(renderer, x, y, records, report);
}

TEST(a_cancelled_probe_is_made_again)
{
    struct engine_probe probe = {0};
    begin("cube.json");
    atomic_store(&probe_is_cancelled, true);
    engine_ask_probe(engine, WIDTH / 2, HEIGHT / 2);
    double start_ms = clock_ms();
    while (!engine_take_probe(engine, &probe))
        (void)take(start_ms);
    assert_non_null(probe.report);
    engine_probe_finish(&probe);
    engine_end();
}

/* ---- Moving cameras ---- */

/* Pictures are shown even if the camera turns faster than they are drawn. */
TEST(no_look_is_cut_short)
{
    uint32_t shown = 0, asked = 0;
    settings = settings_of("default.json");
    settings.picture.width = 160;
    settings.picture.height = 108;
    engine_begin(&(struct engine_params){.budget_ms = 1e4});
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
    draw();
    assert_string_equal(frame.settings.camera, settings.camera); /* the last one is answered */
    assert_true(frame.whole);
    engine_end();
}

/* While another tree is made the picture stays as it is, and no coarser one is shown. */
TEST(a_switch_keeps_the_picture)
{
    begin("8k.json");
    settings.trees.build = WHIT_BUILD_MEDIAN;
    engine_ask(engine, &settings, false);
    double start_ms = clock_ms();
    while (!engine_is_still(engine)) {
        if (take(start_ms))
            assert_int_equal(frame.settings.trees.build, WHIT_BUILD_MEDIAN);
    }
    assert_true(frame.whole);
    assert_int_equal(status_now().change.number, 1);
    assert_int_equal(status_now().change.difference.other_ids, 0);
    engine_end();
}

/* Where one of two scenes side by side cannot be read, its error stays when the camera turns and
   the other scene is drawn again. */
TEST(an_error_outlives_the_other_side)
{
    begin("cube.json");
    engine_ask_other(engine, &settings);
    take_all();
    settings = settings_of("nowhere.json");
    draw();
    uint64_t number = other.number;
    snprintf(settings.camera, sizeof settings.camera, "0,2,6,0,1,0,0,1,0,40");
    struct settings beside = settings_of("cube.json");
    settings_set_camera(&beside, &settings);
    engine_ask_other(engine, &beside);
    take_all();
    assert_true(other.number > number);
    assert_non_null(strstr(status_now().error, "nowhere.json"));
    engine_end();
}
