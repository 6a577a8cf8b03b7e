/* A device whose messages are collected, and small pipelines, for tests of devices. */
#ifndef DEVICE_FIXTURE_H
#define DEVICE_FIXTURE_H

#include "device/buffer.h"
#include "device/commands.h"
#include "device/device.h"
#include "device/pipeline.h"
#include "messages_fixture.h"
#include "unit.h"

/* Opens a device. Without one the test fails, or is skipped with WHIT_TEST_NO_DEVICE=skip. */
static inline struct device *device_open(struct messages *told, bool validation)
{
    whit_log log = messages_log(told);
    whit_device_params params = {.validation = validation};
    struct device *device;
    whit_result result = device_create(&log, &params, NULL, &device);
    const char *no_device = getenv("WHIT_TEST_NO_DEVICE");
    if (result == WHIT_ERROR_NO_DEVICE && no_device && strcmp(no_device, "skip") == 0)
        skip();
    if (result != WHIT_OK)
        print_message("%s", told->text);
    assert_int_equal(result, WHIT_OK);
    return device;
}

/* Destroys the device; with validation, leaked objects are reported here and fail the test. */
static inline void device_close(struct device *device, struct messages *told)
{
    device_destroy(device);
    if (told->validation > 0)
        print_message("%s", told->text);
    assert_int_equal(told->validation, 0);
}

/* Params of a kernel with one or two storage buffers as bindings; callers add other fields. */
static inline struct pipeline_params storage_params(const uint32_t *spirv, size_t spirv_bytes,
                                                    uint32_t binding_count, const char *name)
{
    static const enum binding_kind bindings[] = {BINDING_STORAGE, BINDING_STORAGE};
    assert_true(binding_count <= 2);
    return (struct pipeline_params){.spirv = spirv,
                                    .spirv_bytes = spirv_bytes,
                                    .bindings = bindings,
                                    .binding_count = binding_count,
                                    .name = name};
}

struct kernel_run {
    struct pipeline *pipeline;
    struct binding_set *set;
};

static inline struct kernel_run kernel_make(struct device *device,
                                            const struct pipeline_params *params,
                                            struct buffer *const *buffers)
{
    struct kernel_run run;
    assert_int_equal(pipeline_create(device, params, &run.pipeline), WHIT_OK);
    assert_int_equal(binding_set_create(run.pipeline, buffers, params->binding_count, &run.set),
                     WHIT_OK);
    return run;
}

static inline void kernel_free(struct kernel_run *run)
{
    binding_set_destroy(run->set);
    pipeline_destroy(run->pipeline);
}

/* Freed at the end of its block, where its buffers must still exist: own_kernel run = ...; */
#define own_kernel __attribute__((cleanup(kernel_free), unused)) struct kernel_run

static inline void drop_buffer(struct buffer **at)
{
    buffer_destroy(*at);
}

/* Freed at the end of its block, where its device must still exist:
   own_buffer *buffer = buffer_make(...); */
#define own_buffer __attribute__((cleanup(drop_buffer), unused)) struct buffer

static inline struct buffer *buffer_make(struct device *device, uint64_t size_bytes, uint32_t uses,
                                         const char *name)
{
    struct buffer *buffer;
    assert_int_equal(buffer_create(device, size_bytes, uses, name, &buffer), WHIT_OK);
    return buffer;
}

static inline struct commands *commands_make(struct device *device)
{
    struct commands *commands;
    assert_int_equal(commands_create(device, "test", &commands), WHIT_OK);
    return commands;
}

static inline void drop_commands(struct commands **at)
{
    commands_destroy(*at);
}

/* Waited for and freed at the end of its block, where its kernels must still exist. */
#define own_commands __attribute__((cleanup(drop_commands), unused)) struct commands

static inline void commands_finish(struct commands *commands)
{
    assert_int_equal(commands_submit(commands), WHIT_OK);
    assert_int_equal(commands_wait(commands, -1.0), WHIT_OK);
}

/* Dispatches `groups` workgroups once, and waits for the end. */
static inline void kernel_dispatch(struct device *device, const struct kernel_run *run,
                                   const void *push, uint32_t push_bytes, uint32_t groups)
{
    own_commands *commands = commands_make(device);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    commands_bind(commands, run->pipeline, run->set);
    if (push_bytes > 0)
        commands_push(commands, push, push_bytes);
    commands_dispatch(commands, groups, 1, 1);
    commands_finish(commands);
}

/* Runs a kernel that reads `count` cases from its first buffer and writes an answer for each to its
   second, with 64 cases per workgroup. `spec`: `spec_count` specialization constants. */
static inline void kernel_answer_as(struct device *device, const uint32_t *spec,
                                    uint32_t spec_count, const uint32_t *spirv, size_t spirv_bytes,
                                    uint32_t count, const void *cases, size_t case_bytes,
                                    void *answers, size_t answer_bytes)
{
    own_buffer *in = buffer_make(device, count * case_bytes, BUFFER_STORAGE, "cases");
    own_buffer *out = buffer_make(device, count * answer_bytes, BUFFER_STORAGE, "answers");
    assert_int_equal(buffer_write(in, 0, cases, count * case_bytes), WHIT_OK);
    struct pipeline_params params = storage_params(spirv, spirv_bytes, 2, "answers");
    params.spec = spec;
    params.spec_count = spec_count;
    own_kernel run = kernel_make(device, &params, (struct buffer *const[]){in, out});
    kernel_dispatch(device, &run, NULL, 0, (count + 63) / 64);
    assert_int_equal(buffer_read(out, 0, answers, count * answer_bytes), WHIT_OK);
}

static inline void kernel_answer(struct device *device, const uint32_t *spirv, size_t spirv_bytes,
                                 uint32_t count, const void *cases, size_t case_bytes,
                                 void *answers, size_t answer_bytes)
{
    kernel_answer_as(device, NULL, 0, spirv, spirv_bytes, count, cases, case_bytes, answers,
                     answer_bytes);
}

#endif
