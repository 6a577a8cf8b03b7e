/* Every checked Vulkan call is made to fail in turn; and the pipeline cache's file is damaged. */
#include <dirent.h>

#include "../wrapped.h"
#include "affine_fixture.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "device/pipeline.h"
#include "folder_fixture.h"
#include "unit.h"

/* Objects of one cycle of everything that can be done with a device. */
struct cycle {
    struct device *device;
    struct buffer *buffer;
    struct pipeline *pipeline;
    struct binding_set *set;
    struct commands *commands;
    uint32_t words[64];
};

static whit_result cycle_prepare(struct cycle *cycle)
{
    static const uint32_t spec[] = {64, 3, 1};
    struct pipeline_params params = affine_params(spec);
    whit_result result = buffer_create(cycle->device, sizeof cycle->words,
                                       BUFFER_STORAGE | BUFFER_TEXELS, "values", &cycle->buffer);
    if (result == WHIT_OK)
        result = buffer_write(cycle->buffer, 0, cycle->words, sizeof cycle->words);
    if (result == WHIT_OK)
        result = pipeline_create(cycle->device, &params, &cycle->pipeline);
    if (result == WHIT_OK)
        result = binding_set_create(cycle->pipeline, &cycle->buffer, 1, &cycle->set);
    if (result == WHIT_OK)
        result = commands_create(cycle->device, "cycle", &cycle->commands);
    return result;
}

static whit_result cycle_dispatch(struct cycle *cycle)
{
    const uint32_t push[] = {64, 0};
    whit_result result = commands_begin(cycle->commands);
    if (result != WHIT_OK)
        return result;
    commands_span_begin(cycle->commands, "affine");
    commands_bind(cycle->commands, cycle->pipeline, cycle->set);
    commands_push(cycle->commands, push, sizeof push);
    commands_dispatch(cycle->commands, 1, 1, 1);
    commands_span_end(cycle->commands);
    result = commands_submit(cycle->commands);
    if (result == WHIT_OK)
        result = commands_wait(cycle->commands, -1.0);
    if (result == WHIT_OK)
        result = buffer_read(cycle->buffer, 0, cycle->words, sizeof cycle->words);
    return result;
}

static whit_result cycle_run(struct messages *told, bool validation)
{
    whit_log log = messages_log(told);
    whit_device_params params = {.validation = validation};
    struct cycle cycle = {0};
    whit_result result = device_create(&log, &params, NULL, &cycle.device);
    if (result == WHIT_OK)
        result = cycle_prepare(&cycle);
    if (result == WHIT_OK)
        result = cycle_dispatch(&cycle);
    if (result == WHIT_OK)
        assert_int_equal(cycle.words[63], 190);
    commands_destroy(cycle.commands);
    binding_set_destroy(cycle.set);
    pipeline_destroy(cycle.pipeline);
    buffer_destroy(cycle.buffer);
    device_destroy(cycle.device);
    return result;
}

/* Lets the first, second, ... checked call fail in one cycle each, until a cycle has no such
   call. */
static void fail_each_call(bool staged, bool validation)
{
    whit_result result = WHIT_ERROR_FAILED;
    unsigned call = 0;
    setenv("WHIT_STAGING", staged ? "1" : "0", 1);
    while (result != WHIT_OK && ++call < 200) {
        char fault[32];
        snprintf(fault, sizeof fault, "*:%u", call);
        setenv("WHIT_FAULT", fault, 1);
        result = cycle_run(&messages, validation);
        if (result != WHIT_OK) {
            assert_true(result == WHIT_ERROR_MEMORY || result == WHIT_ERROR_DEVICE);
            assert_int_equal(messages.errors - messages.validation, 1);
        }
        /* Validation reports leaked objects when the device is destroyed. */
        if (messages.validation > 0)
            print_message("call %u: %s", call, messages.text);
        assert_int_equal(messages.validation, 0);
    }
    unsetenv("WHIT_FAULT");
    unsetenv("WHIT_STAGING");
    assert_int_equal(result, WHIT_OK);
    print_message("%u checked calls\n", call - 1);
    assert_true(call > (staged ? 50 : 28)); /* calls did fail */
}

TEST(each_call_may_fail)
{
    fail_each_call(false, false);
}

TEST(each_call_may_fail_with_staging)
{
    fail_each_call(true, false);
}

TEST(nothing_is_left_behind)
{
    fail_each_call(true, true);
}

TEST(memory_running_out_is_told_apart)
{
    setenv("WHIT_FAULT", "vkAllocateMemory:2", 1);
    struct device *device = device_open(&messages, false);
    unsetenv("WHIT_FAULT");
    struct buffer *first = buffer_make(device, 16, BUFFER_STORAGE, "first");
    struct buffer *second = NULL;
    messages = (struct messages){0};
    assert_int_equal(buffer_create(device, 16, BUFFER_STORAGE, "second", &second),
                     WHIT_ERROR_MEMORY);
    assert_null(second);
    assert_non_null(strstr(messages.text, "VK_ERROR_OUT_OF_DEVICE_MEMORY"));
    assert_non_null(strstr(messages.text, "buffer.c:"));
    /* The device lives on. */
    second = buffer_make(device, 16, BUFFER_STORAGE, "second");
    buffer_destroy(first);
    buffer_destroy(second);
    device_destroy(device);
}

TEST(loss_is_for_good)
{
    setenv("WHIT_FAULT", "vkWaitForFences:1", 1);
    struct device *device = device_open(&messages, false);
    unsetenv("WHIT_FAULT");
    struct buffer *buffer = buffer_make(device, 64, BUFFER_HOST, "values");
    struct commands *commands = commands_make(device);
    assert_int_equal(commands_begin(commands), WHIT_OK);
    commands_fill(commands, buffer, 0, 64, 1);
    assert_int_equal(commands_submit(commands), WHIT_OK);
    assert_int_equal(commands_wait(commands, -1.0), WHIT_ERROR_DEVICE);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.text, "VK_ERROR_DEVICE_LOST"));

    uint32_t word = 0;
    struct buffer *other_buffer;
    struct commands *other;
    assert_int_equal(commands_wait(commands, -1.0), WHIT_ERROR_DEVICE);
    assert_int_equal(buffer_read(buffer, 0, &word, sizeof word), WHIT_ERROR_DEVICE);
    assert_int_equal(buffer_write(buffer, 0, &word, sizeof word), WHIT_ERROR_DEVICE);
    assert_int_equal(buffer_create(device, 16, BUFFER_HOST, "b", &other_buffer), WHIT_ERROR_DEVICE);
    assert_int_equal(commands_create(device, "c", &other), WHIT_ERROR_DEVICE);
    assert_int_equal(messages.lines, 1); /* said once */
    commands_destroy(commands);
    buffer_destroy(buffer);
    device_destroy(device);
}

TEST(fifty_devices_in_turn)
{
    for (int i = 0; i < 50; ++i)
        assert_int_equal(cycle_run(&messages, false), WHIT_OK);
}

/* The path of the only cache file whose name starts with `begin`; "" when there is none. */
static void cache_file(const char *begin, char *path, size_t path_bytes)
{
    const char *cache = in_folder("whit");
    path[0] = '\0';
    DIR *dir = opendir(cache);
    if (!dir)
        return;
    int count = 0;
    for (struct dirent *entry; (entry = readdir(dir));)
        if (strncmp(entry->d_name, begin, strlen(begin)) == 0 && ++count)
            snprintf(path, path_bytes, "%s/%s", cache, entry->d_name);
    closedir(dir);
    assert_int_equal(count, 1);
}

static size_t read_all(const char *path, uint8_t *data, size_t data_bytes)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t bytes = fread(data, 1, data_bytes, file);
    fclose(file);
    return bytes;
}

/* Damages the file in several ways; each time the next run rewrites it silently. */
static void damage_and_run(const char *path)
{
    static uint8_t good[1 << 20], broken[1 << 20], now[1 << 20];
    size_t bytes = read_all(path, good, sizeof good);
    assert_true(bytes > 32 && bytes < sizeof good);
    for (int damage = 0; damage < 5; ++damage) {
        size_t broken_bytes = damage == 2 ? bytes / 2 : damage == 3 ? 0 : bytes;
        memcpy(broken, good, bytes);
        broken[bytes - 1] ^= damage == 0;
        broken[0] ^= damage == 1;
        broken[24] ^= damage == 4; /* the driver's first byte, which only the checksum guards */
        put_file(path, broken, broken_bytes);
        assert_int_equal(cycle_run(&messages, false), WHIT_OK);
        assert_int_equal(messages.lines, 0);
        assert_int_equal(read_all(path, now, sizeof now), bytes);
        assert_true(broken_bytes != bytes || memcmp(now, broken, bytes) != 0);
        assert_memory_equal(now, good, 8); /* whit's header again, and the same size */
    }
}

TEST_IN(damaged_cache_files_are_replaced, folder_begin, folder_end)
{
    char path[512], *cache = in_folder("whit");
    setenv("XDG_CACHE_HOME", folder, 1);
    assert_int_equal(cycle_run(&messages, false), WHIT_OK); /* WHIT_NO_CACHE is on */
    cache_file("", path, sizeof path);
    assert_string_equal(path, "");

    unsetenv("WHIT_NO_CACHE");
    assert_int_equal(cycle_run(&messages, false), WHIT_OK);
    cache_file("pipelines-", path, sizeof path);
    assert_true(path[0] != '\0');
    damage_and_run(path);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(cache), 0);
    /* A file where the folder should be: no cache, and no complaint. */
    put_file(cache, (const uint8_t[]){0}, 1);
    assert_int_equal(cycle_run(&messages, false), WHIT_OK);
    assert_int_equal(messages.lines, 0);
    assert_int_equal(unlink(cache), 0);
    setenv("WHIT_NO_CACHE", "1", 1);
    unsetenv("XDG_CACHE_HOME");
}

static bool is_short;

WRAPPED(bool, threads_have_room, uint32_t count)
{
    return !is_short && __real_threads_have_room(count);
}

/* Without room for its threads a CPU driver would wait for ever. */
TEST(no_device_without_room_for_its_threads)
{
    whit_log log = messages_log(&messages);
    struct device *device = device_open(&messages, false);
    bool on_cpu = device_get_info(device)->kind == WHIT_DEVICE_CPU;
    device_close(device, &messages);
    is_short = true;
    whit_result result = device_create(&log, &(whit_device_params){0}, NULL, &device);
    is_short = false;
    assert_int_equal(result, on_cpu ? WHIT_ERROR_MEMORY : WHIT_OK);
    assert_int_equal(strstr(messages.text, ": out of memory for its threads") != NULL, on_cpu);
    device_destroy(device);
}

/* Unsets variables of the environment that change numbers of calls or messages, which tests
   count. */
static int plain_environment(void **state)
{
    (void)state;
    unsetenv("WHIT_VALIDATION");
    setenv("WHIT_NO_CACHE", "1", 1);
    device_destroy(device_open(&messages, false));
    return 0;
}

int main(void)
{
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    return unit_run(plain_environment, NULL);
}
