#define _GNU_SOURCE /* sched_getaffinity */
#include <sched.h>

#include <vulkan/vulkan_core.h>

#include "affine_fixture.h"
#include "one_device_fixture.h"

#include "../wrapped.h"
#include "base/cores.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "device/pipeline.h"
#include "device_count.h"
#include "device_spin.h"
#include "device_texels.h"
#include "unit.h"

/* Makes spirv_evaluate fail, so that kernels cannot be specialized (-Wl,--wrap). */
static bool cannot_specialize;

WRAPPED(whit_result, spirv_evaluate, const uint32_t *words, size_t word_count, const uint32_t *spec,
        uint32_t spec_count, uint32_t **out, size_t *out_words)
{
    *out = NULL;
    return cannot_specialize
               ? WHIT_ERROR_INPUT
               : __real_spirv_evaluate(words, word_count, spec, spec_count, out, out_words);
}

/* Calls of cores_spread, and how many found the driver's threads (-Wl,--wrap). */
static uint32_t spreads_tried, spreads_done;

WRAPPED(bool, cores_spread, const char name[CORES_NAME_BYTES])
{
    bool done = __real_cores_spread(name);
    ++spreads_tried;
    spreads_done += done;
    return done;
}

/* Runs a kernel with these constants and checks its results; gives the pipeline's info. */
static struct pipeline_info check_constants(const uint32_t spec[3], uint32_t added)
{
    enum { COUNT = 1000 };
    own_buffer *buffer =
        buffer_make(device, 4 * COUNT + 4, BUFFER_STORAGE | BUFFER_ZEROED, "values");
    struct pipeline_params params = affine_params(spec);
    own_kernel run = kernel_make(device, &params, &buffer);
    struct pipeline_info info;
    const uint32_t push[] = {COUNT, added};
    uint32_t values[COUNT + 1];
    kernel_dispatch(device, &run, push, sizeof push, (COUNT + spec[0] - 1) / spec[0]);
    assert_int_equal(buffer_read(buffer, 0, values, sizeof values), WHIT_OK);
    for (uint32_t j = 0; j < COUNT; ++j)
        assert_int_equal(values[j], j * spec[1] + spec[2] + added);
    assert_int_equal(values[COUNT], 0);
    pipeline_get_info(run.pipeline, &info);
    return info;
}

TEST(constants_reach_the_shader)
{
    const uint32_t specs[][3] = {{64, 3, 7}, {16, 0xffffffffu, 5}, {1, 2, 0}};
    for (uint32_t i = 0; i < 3; ++i)
        assert_true(check_constants(specs[i], 1000000 * i).specialized);
}

static int specialize_again(void **state)
{
    (void)state;
    cannot_specialize = false;
    return 0;
}

/* A kernel that cannot be specialized still runs; the pipeline's info says so. */
TEST_IN(kernels_go_to_the_driver_whole, NULL, specialize_again)
{
    const uint32_t spec[] = {64, 3, 7};
    const struct pipeline_params params = affine_params(spec);
    struct pipeline_info info;
    messages = (struct messages){0};
    cannot_specialize = true;
    own_buffer *buffer = buffer_make(device, 4, BUFFER_STORAGE, "values");
    own_kernel run = kernel_make(device, &params, &buffer);
    pipeline_get_info(run.pipeline, &info);
    assert_non_null(strstr(messages.text, "\"affine\": its kernel cannot be specialized"));
    assert_int_equal(messages.errors, 0);
    assert_false(info.specialized);
    assert_int_equal(info.bindings, 1);
    assert_false(pipeline_count(&params, &info));
    check_constants(spec, 5);
}

/* Other tests of this program have submitted work, and none is left to be found. */
TEST(threads_of_lavapipe_have_cores_of_their_own)
{
    const whit_device_info *info = device_get_info(device);
    cpu_set_t cores;
    assert_int_equal(sched_getaffinity(0, sizeof cores, &cores), 0);
    if (info->kind != WHIT_DEVICE_CPU || CPU_COUNT(&cores) < 2 || getenv("LP_NUM_THREADS"))
        skip();
    const uint32_t spec[3] = {64, 3, 7};
    for (int i = 0; i < 4; ++i)
        check_constants(spec, 1);
    uint32_t tried = spreads_tried;
    assert_int_equal(spreads_done, 1);
    check_constants(spec, 1);
    assert_int_equal(spreads_tried, tried);
}

TEST(texels_equal_storage)
{
    enum { ROWS = 4096 };
    static uint32_t rows[ROWS][4], sums[ROWS][4];
    for (uint32_t i = 0; i < 4 * ROWS; ++i)
        rows[i / 4][i % 4] = i * 2654435761u; /* all bit patterns, also of NaNs */
    own_buffer *in = buffer_make(device, sizeof rows, BUFFER_STORAGE | BUFFER_TEXELS, "rows");
    own_buffer *out = buffer_make(device, sizeof sums, BUFFER_STORAGE, "sums");
    assert_int_equal(buffer_write(in, 0, rows, sizeof rows), WHIT_OK);

    const enum binding_kind bindings[] = {BINDING_STORAGE, BINDING_NONE, BINDING_TEXELS,
                                          BINDING_STORAGE};
    struct buffer *const buffers[] = {in, NULL, in, out};
    struct pipeline_params params = {.spirv = device_texels,
                                     .spirv_bytes = sizeof device_texels,
                                     .bindings = bindings,
                                     .binding_count = 4,
                                     .name = "texels"};
    own_kernel run = kernel_make(device, &params, buffers);
    kernel_dispatch(device, &run, NULL, 0, ROWS / 64);
    assert_int_equal(buffer_read(out, 0, sums, sizeof sums), WHIT_OK);
    for (uint32_t i = 0; i < 4 * ROWS; ++i)
        assert_int_equal(sums[i / 4][i % 4], rows[i / 4][i % 4] * 2 + 1);
}

static struct pipeline_params count_params(void)
{
    return storage_params(device_count, sizeof device_count, 1, "count");
}

static struct kernel_run count_make(struct buffer *buffer)
{
    struct pipeline_params params = count_params();
    return kernel_make(device, &params, &buffer);
}

static uint32_t read_word(struct buffer *buffer, uint64_t offset_bytes)
{
    uint32_t word = 0xdeadbeefu;
    assert_int_equal(buffer_read(buffer, offset_bytes, &word, sizeof word), WHIT_OK);
    return word;
}

/* The arguments of the dispatch are written on the device in the same submission, at an offset. */
TEST(indirect_dispatch_takes_its_arguments)
{
    own_buffer *count = buffer_make(device, 16, BUFFER_STORAGE | BUFFER_ZEROED, "count");
    own_buffer *arguments = buffer_make(device, 64, BUFFER_INDIRECT, "arguments");
    own_kernel run = count_make(count);
    own_commands *commands = commands_make(device);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    commands_fill(commands, arguments, 16, 12, 3);
    commands_barrier(commands);
    commands_fill(commands, arguments, 16, 4, 5);
    commands_barrier(commands);
    commands_bind(commands, run.pipeline, run.set);
    commands_dispatch_indirect(commands, arguments, 16);
    commands_finish(commands);
    assert_int_equal(read_word(count, 0), 5 * 3 * 3);
}

TEST(fill_and_copy_keep_to_their_range)
{
    own_buffer *a = buffer_make(device, 64, BUFFER_STORAGE | BUFFER_ZEROED, "a");
    own_buffer *b = buffer_make(device, 64, BUFFER_HOST | BUFFER_ZEROED, "b");
    own_commands *commands = commands_make(device);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    commands_fill(commands, a, 8, 16, 0x12345678u);
    commands_barrier(commands);
    commands_copy(commands, a, 4, b, 32, 16);
    commands_finish(commands);
    uint32_t words[16];
    assert_int_equal(buffer_read(a, 0, words, sizeof words), WHIT_OK);
    for (size_t i = 0; i < 16; ++i)
        assert_int_equal(words[i], i >= 2 && i < 6 ? 0x12345678u : 0);
    assert_int_equal(buffer_read(b, 0, words, sizeof words), WHIT_OK);
    for (size_t i = 0; i < 16; ++i)
        assert_int_equal(words[i], i >= 9 && i < 12 ? 0x12345678u : 0);
}

static struct kernel_run spin_make(struct buffer *buffer)
{
    struct pipeline_params params = storage_params(device_spin, sizeof device_spin, 1, "spin");
    params.push_bytes = 4;
    return kernel_make(device, &params, &buffer);
}

static void spin(struct commands *commands, const struct kernel_run *run, uint32_t groups)
{
    const uint32_t turns = 20000;
    commands_bind(commands, run->pipeline, run->set);
    commands_push(commands, &turns, sizeof turns);
    commands_dispatch(commands, groups, 1, 1);
}

/* Time stamps that replace those of the device, if not NULL (-Wl,--wrap). */
static const uint64_t *stamps;

WRAPPED(VkResult, vkGetQueryPoolResults, VkDevice vk, VkQueryPool pool, uint32_t first,
        uint32_t count, size_t bytes, void *data, VkDeviceSize stride, VkQueryResultFlags flags)
{
    VkResult result =
        __real_vkGetQueryPoolResults(vk, pool, first, count, bytes, data, stride, flags);
    if (stamps)
        memcpy(data, stamps, count * sizeof *stamps);
    return result;
}

/* Two spans, of one workgroup each. */
static void time_two_spans(struct commands *commands, const struct kernel_run *run)
{
    assert_int_equal(commands_begin(commands), WHIT_OK);
    for (int i = 0; i < 2; ++i) {
        commands_span_begin(commands, "span");
        spin(commands, run, 1);
        commands_span_end(commands);
        commands_barrier(commands);
    }
    commands_finish(commands);
    assert_int_equal(commands_span_count(commands), 2);
    assert_true(commands_span_ms(commands, 2) < 0.0);
}

TEST(spans_are_timed)
{
    own_buffer *buffer = buffer_make(device, 256, BUFFER_STORAGE | BUFFER_ZEROED, "values");
    own_kernel run = spin_make(buffer);
    own_commands *commands = commands_make(device);
    assert_int_equal(commands_span_count(commands), 0);
    assert_true(commands_span_ms(commands, 0) < 0.0);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    spin(commands, &run, 1); /* drivers may compile at the first use */
    commands_finish(commands);
    assert_int_equal(commands_span_count(commands), 0);

    time_two_spans(commands, &run);
    if (device_get_info(device)->timestamps) {
        for (uint32_t i = 0; i < 2; ++i)
            assert_true(commands_span_ms(commands, i) > 0.0);
        stamps = (const uint64_t[]){7, 17, 20, 1020};
        time_two_spans(commands, &run);
        stamps = NULL;
        double tick_ms = commands_span_ms(commands, 0) / 10.0;
        assert_true(tick_ms > 0.0 && tick_ms < 1.0);
        assert_true(fabs(commands_span_ms(commands, 1) / tick_ms - 1000.0) < 1e-6);
    }

    assert_int_equal(commands_begin(commands), WHIT_OK);
    for (int i = 0; i < COMMANDS_SPANS; ++i) {
        commands_span_begin(commands, "empty");
        commands_span_end(commands);
    }
    commands_finish(commands);
    assert_int_equal(commands_span_count(commands), COMMANDS_SPANS);
}

/* Stands for a device that does not finish its work (-Wl,--wrap): waiting for it times out. */
static bool is_busy;
static uint64_t limit_ns; /* the timeout that the call was given */

WRAPPED(VkResult, vkWaitForFences, VkDevice vk, uint32_t count, const VkFence *fences, VkBool32 all,
        uint64_t timeout)
{
    limit_ns = timeout;
    return is_busy ? VK_TIMEOUT : __real_vkWaitForFences(vk, count, fences, all, timeout);
}

TEST(wait_obeys_its_limit)
{
    own_buffer *buffer = buffer_make(device, 256, BUFFER_STORAGE | BUFFER_ZEROED, "values");
    own_kernel run = spin_make(buffer);
    own_commands *commands = commands_make(device);
    assert_int_equal(commands_wait(commands, 0.0), WHIT_OK); /* nothing to wait for */
    assert_int_equal(commands_begin(commands), WHIT_OK);
    spin(commands, &run, 1);
    assert_int_equal(commands_submit(commands), WHIT_OK);
    is_busy = true;
    assert_int_equal(commands_wait(commands, 1.5), WHIT_ERROR_TIME_LIMIT);
    is_busy = false;
    assert_int_equal(limit_ns, 1500000);
    messages = (struct messages){0};
    assert_int_equal(commands_begin(commands), WHIT_ERROR_USAGE); /* still in flight */
    assert_int_equal(messages.errors, 1);
    assert_int_equal(commands_wait(commands, -1.0), WHIT_OK);
    assert_int_equal(limit_ns, UINT64_MAX);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    spin(commands, &run, 64);
    assert_int_equal(commands_submit(commands), WHIT_OK); /* its destruction waits */
}

TEST(recording_errors_surface_at_submit)
{
    own_buffer *buffer = buffer_make(device, 256, BUFFER_STORAGE | BUFFER_ZEROED, "values");
    own_kernel run = count_make(buffer);
    own_commands *commands = commands_make(device);
    const uint32_t word = 0;
    for (int fault = 0; fault < 9; ++fault) {
        messages = (struct messages){0};
        assert_int_equal(commands_begin(commands), WHIT_OK);
        if (fault != 0)
            commands_bind(commands, run.pipeline, run.set);
        switch (fault) {
        case 0: /* no pipeline */
            commands_dispatch(commands, 1, 1, 1);
            break;
        case 1: /* any device takes the first of them */
            commands_dispatch(commands, 65535, 1, 1);
            commands_dispatch(commands, UINT32_MAX, 1, 1);
            break;
        case 2: /* none declared */
            commands_push(commands, &word, sizeof word);
            break;
        case 3: /* no BUFFER_INDIRECT */
            commands_dispatch_indirect(commands, buffer, 0);
            break;
        case 4:
            commands_fill(commands, buffer, 252, 8, 0);
            break;
        case 5: /* overlap */
            commands_copy(commands, buffer, 0, buffer, 60, 64);
            break;
        case 6:
            commands_span_begin(commands, "outer");
            commands_span_begin(commands, "inner");
            break;
        case 7:
            commands_span_end(commands);
            break;
        case 8:
            for (int i = 0; i <= COMMANDS_SPANS; ++i) {
                commands_span_begin(commands, "many");
                commands_span_end(commands);
            }
            break;
        }
        assert_int_equal(commands_submit(commands),
                         fault == 1 ? WHIT_ERROR_DEVICE : WHIT_ERROR_USAGE);
        assert_int_equal(messages.errors, 1);
        assert_int_equal(commands_wait(commands, -1.0), WHIT_OK);
    }
    /* Nothing was run, and the object can be used again. */
    assert_int_equal(read_word(buffer, 0), 0);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    commands_bind(commands, run.pipeline, run.set);
    commands_dispatch(commands, 7, 1, 1);
    commands_finish(commands);
    assert_int_equal(read_word(buffer, 0), 7);
}

TEST(later_submissions_see_earlier_ones)
{
    own_buffer *buffer = buffer_make(device, 16, BUFFER_STORAGE | BUFFER_ZEROED, "count");
    own_kernel run = count_make(buffer);
    struct commands *commands[2] = {commands_make(device), commands_make(device)};
    for (int i = 0; i < 20; ++i) {
        struct commands *one = commands[i & 1];
        assert_int_equal(commands_wait(one, -1.0), WHIT_OK);
        assert_int_equal(commands_begin(one), WHIT_OK);
        commands_bind(one, run.pipeline, run.set);
        commands_dispatch(one, 10, 1, 1);
        assert_int_equal(commands_submit(one), WHIT_OK);
    }
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(commands_wait(commands[i], -1.0), WHIT_OK);
        commands_destroy(commands[i]);
    }
    assert_int_equal(read_word(buffer, 0), 200);
}

TEST(refuses_wrong_pipelines_and_sets)
{
    struct pipeline_params params = count_params();
    struct pipeline *pipeline;
    params.spirv_bytes = 7;
    assert_int_equal(pipeline_create(device, &params, &pipeline), WHIT_ERROR_USAGE);
    assert_null(pipeline);
    params = count_params();
    params.push_bytes = 1 << 20;
    assert_int_equal(pipeline_create(device, &params, &pipeline), WHIT_ERROR_DEVICE);
    assert_null(pipeline);

    params = count_params();
    assert_int_equal(pipeline_create(device, &params, &pipeline), WHIT_OK);
    own_buffer *texels = buffer_make(device, 16, BUFFER_TEXELS, "texels");
    struct buffer *none = NULL;
    struct binding_set *set;
    messages = (struct messages){0};
    assert_int_equal(binding_set_create(pipeline, &texels, 1, &set), WHIT_ERROR_USAGE);
    assert_null(set);
    assert_int_equal(binding_set_create(pipeline, &none, 1, &set), WHIT_ERROR_USAGE);
    assert_int_equal(binding_set_create(pipeline, &texels, 0, &set), WHIT_ERROR_USAGE);
    assert_int_equal(messages.errors, 3);
    pipeline_destroy(pipeline);
}

/* Makes a pipeline with constant `value` and destroys it at once; the pointer is only compared. */
static struct pipeline *make_and_drop(struct device *keeper, uint32_t value)
{
    const uint32_t spec[] = {64, value, 7};
    const struct pipeline_params params = affine_params(spec);
    struct pipeline *pipeline;
    assert_int_equal(pipeline_create(keeper, &params, &pipeline), WHIT_OK);
    pipeline_destroy(pipeline);
    return pipeline;
}

/* A pipeline_rewrite that leaves everything as it is. */
static whit_result copy_kernel(const void *user, const uint32_t *words, size_t word_count,
                               uint32_t **out, size_t *out_words, char why[REWRITE_WHY_BYTES])
{
    (void)user;
    (void)why;
    *out = malloc(word_count * sizeof **out);
    assert_non_null(*out);
    memcpy(*out, words, word_count * sizeof **out);
    *out_words = word_count;
    return WHIT_OK;
}

TEST(a_device_that_keeps_pipelines_makes_each_once)
{
    enum { MANY = 140 }; /* more pipelines than a device keeps */
    struct messages said;
    struct device *keeper = device_open(&said, true);
    const uint32_t spec[] = {64, 3, 7}, copy[] = {64, 3, 7};
    const struct pipeline_params params = affine_params(spec), same = affine_params(copy);
    struct pipeline *held, *again, *used[MANY];
    device_keep_pipelines(keeper);
    assert_int_equal(pipeline_create(keeper, &params, &held), WHIT_OK);
    assert_int_equal(pipeline_create(keeper, &same, &again), WHIT_OK);
    assert_ptr_equal(held, again);
    pipeline_destroy(again);
    struct pipeline *other = make_and_drop(keeper, 4);
    assert_ptr_not_equal(held, other);
    assert_ptr_equal(other, make_and_drop(keeper, 4));
    struct pipeline_params wider = params;
    wider.push_bytes += 4;
    assert_int_equal(pipeline_create(keeper, &wider, &again), WHIT_OK);
    assert_ptr_not_equal(held, again);
    pipeline_destroy(again);
    for (uint32_t as = 1; as < 3; ++as) {
        struct pipeline_params rewritten = params;
        rewritten.rewrite = copy_kernel;
        rewritten.rewrite_as = as;
        assert_int_equal(pipeline_create(keeper, &rewritten, &again), WHIT_OK);
        assert_ptr_equal(held, again); /* of the same code */
        pipeline_destroy(again);
    }
    for (uint32_t i = 0; i < MANY; ++i) {
        const uint32_t values[] = {64, 100 + i, 7};
        const struct pipeline_params another = affine_params(values);
        assert_int_equal(pipeline_create(keeper, &another, &used[i]), WHIT_OK);
    }
    for (uint32_t i = 0; i < MANY; ++i)
        pipeline_destroy(used[i]);
    make_and_drop(keeper, 100 + MANY);
    uint64_t made = device_pipelines_made(keeper);
    make_and_drop(keeper, 99 + MANY);
    assert_int_equal(device_pipelines_made(keeper), made);
    make_and_drop(keeper, 100); /* is not kept any more */
    assert_int_equal(device_pipelines_made(keeper), made + 1);
    assert_int_equal(pipeline_create(keeper, &params, &again), WHIT_OK);
    assert_ptr_equal(held, again); /* the oldest of all, and used */
    pipeline_destroy(held);
    pipeline_destroy(again);
    device_close(keeper, &said);
}

int main(void)
{
    setenv("WHIT_NO_CACHE", "1", 1);
    return unit_run(device_begin, device_end);
}
