/* The Khronos validation layer is required by the test suite: without it these tests fail. */
#include "affine_fixture.h"

#include "device/buffer.h"
#include "device/commands.h"
#include "device_overrun.h"
#include "unit.h"

static void run_affine(struct device *device, bool with_barrier)
{
    const uint32_t spec[] = {64, 1, 0}, push[] = {64, 0};
    own_buffer *values = buffer_make(device, 256, BUFFER_STORAGE, "values");
    own_buffer *copy = buffer_make(device, 256, BUFFER_HOST, "copy");
    struct pipeline_params params = affine_params(spec);
    own_kernel run = kernel_make(device, &params, &values);
    own_commands *commands = commands_make(device);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    commands_span_begin(commands, "affine");
    commands_bind(commands, run.pipeline, run.set);
    commands_push(commands, push, sizeof push);
    commands_dispatch(commands, 1, 1, 1);
    commands_span_end(commands);
    if (with_barrier)
        commands_barrier(commands);
    commands_copy(commands, values, 0, copy, 0, 256);
    commands_finish(commands);
    uint32_t word = 0;
    assert_int_equal(buffer_read(copy, 4 * 63, &word, sizeof word), WHIT_OK);
    if (with_barrier)
        assert_int_equal(word, 63);
}

TEST(normal_use_is_silent)
{
    for (int staged = 0; staged < 2; ++staged) {
        setenv("WHIT_STAGING", staged ? "1" : "0", 1);
        struct device *device = device_open(&messages, true);
        run_affine(device, true);
        assert_int_equal(device_validation_messages(device), 0);
        device_close(device, &messages);
    }
    unsetenv("WHIT_STAGING");
}

TEST(missing_barrier_is_reported)
{
    struct device *device = device_open(&messages, true);
    run_affine(device, false);
    assert_true(device_validation_messages(device) >= 1);
    assert_int_equal(device_validation_messages(device), (uint32_t)messages.validation);
    assert_non_null(strstr(messages.text, "SYNC-HAZARD-READ"));
    device_destroy(device);
}

TEST(write_outside_is_reported)
{
    for (uint32_t index = 3; index <= 100; index += 97) {
        struct device *device = device_open(&messages, true);
        struct buffer *values = buffer_make(device, 16, BUFFER_STORAGE, "values");
        struct pipeline_params params =
            storage_params(device_overrun, sizeof device_overrun, 1, "overrun");
        params.push_bytes = 4;
        struct kernel_run run = kernel_make(device, &params, &values);
        kernel_dispatch(device, &run, &index, sizeof index, 1);
        assert_int_equal(device_validation_messages(device) > 0, index > 3);
        kernel_free(&run);
        buffer_destroy(values);
        device_destroy(device);
    }
}

TEST(leaks_are_reported)
{
    struct device *device = device_open(&messages, true);
    struct buffer *lost = buffer_make(device, 16, BUFFER_STORAGE, "forgotten");
    device_destroy(device);
    assert_true(messages.validation >= 1);
    assert_non_null(strstr(messages.text, "forgotten")); /* the debug name */
    free(lost);
}

TEST(environment_turns_it_on)
{
    for (int on = 0; on < 2; ++on) {
        setenv("WHIT_VALIDATION", on ? "1" : "0", 1);
        struct device *device = device_open(&messages, false);
        run_affine(device, false);
        assert_int_equal(device_validation_messages(device) > 0, on);
        device_destroy(device);
    }
    unsetenv("WHIT_VALIDATION");
}

/* The last test, since it hides the layer. */
TEST(absence_is_an_error)
{
    whit_log log = messages_log(&messages);
    whit_device_params params = {.validation = true};
    struct device *device;
    setenv("VK_LAYER_PATH", "/nonexistent", 1);
    assert_int_equal(device_create(&log, &params, NULL, &device), WHIT_ERROR_DEVICE);
    assert_null(device);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.text, "vulkan-validationlayers"));
    unsetenv("VK_LAYER_PATH");
}

int main(void)
{
    setenv("WHIT_NO_CACHE", "1", 1);
    unsetenv("WHIT_VALIDATION");
    return unit_run(NULL, NULL);
}
