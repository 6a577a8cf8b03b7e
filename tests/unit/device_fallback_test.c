/* A kernel that cannot be specialized still runs, and that is said. The linker puts the function
   below in the place of spirv_evaluate. */
#include "affine_fixture.h"

whit_result __wrap_spirv_evaluate(const uint32_t *words, size_t word_count, const uint32_t *spec,
                                  uint32_t spec_count, uint32_t **out, size_t *out_words);

whit_result __wrap_spirv_evaluate(const uint32_t *words, size_t word_count, const uint32_t *spec,
                                  uint32_t spec_count, uint32_t **out, size_t *out_words)
{
    (void)words, (void)word_count, (void)spec, (void)spec_count, (void)out_words;
    *out = NULL;
    return WHIT_ERROR_INPUT;
}

static void kernels_go_to_the_driver_whole(void **state)
{
    (void)state;
    static const uint32_t spec[] = {64, 3, 7};
    const uint32_t push[] = {100, 5};
    const struct pipeline_params params = affine_params(spec);
    struct messages messages;
    assert_int_equal(setenv("WHIT_NO_CACHE", "1", 1), 0);
    struct device *device = device_open(&messages, false);
    struct buffer *buffer = buffer_make(device, 4 * 100, BUFFER_STORAGE, "values");
    struct kernel_run run = kernel_make(device, &params, &buffer);
    assert_non_null(strstr(messages.text, "\"affine\": its kernel cannot be specialized"));
    assert_int_equal(messages.errors, 0);
    struct pipeline_info info;
    pipeline_get_info(run.pipeline, &info);
    assert_false(info.specialized);
    assert_int_equal(info.bindings, 1);
    assert_false(pipeline_count(&params, &info));
    struct commands *commands = commands_make(device);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    commands_bind(commands, run.pipeline, run.set);
    commands_push(commands, push, sizeof push);
    commands_dispatch(commands, 2, 1, 1);
    commands_finish(commands);
    uint32_t values[100];
    assert_int_equal(buffer_read(buffer, 0, values, sizeof values), WHIT_OK);
    for (uint32_t i = 0; i < 100; ++i)
        assert_int_equal(values[i], i * 3 + 7 + 5);
    commands_destroy(commands);
    kernel_free(&run);
    buffer_destroy(buffer);
    device_close(device, &messages);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_go_to_the_driver_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
