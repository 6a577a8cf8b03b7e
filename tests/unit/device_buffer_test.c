#include <sched.h>
#include <stdatomic.h>

#include "../wrapped.h"
#include "base/threads.h"
#include "device/vulkan.h"
#include "one_device_fixture.h"
#include "unit.h"

/* Larger than one staging buffer, and not aligned to anything. */
enum { LARGE_BYTES = (33 << 20) + 12345 };

/* Sizes in the last calls of Vulkan. */
static VkDeviceSize created_bytes, viewed_bytes;

WRAPPED(VkResult, vkCreateBuffer, VkDevice vk, const VkBufferCreateInfo *info,
        const VkAllocationCallbacks *allocator, VkBuffer *buffer)
{
    created_bytes = info->size;
    return __real_vkCreateBuffer(vk, info, allocator, buffer);
}

WRAPPED(VkResult, vkCreateBufferView, VkDevice vk, const VkBufferViewCreateInfo *info,
        const VkAllocationCallbacks *allocator, VkBufferView *view)
{
    viewed_bytes = info->range;
    return __real_vkCreateBufferView(vk, info, allocator, view);
}

TEST(sizes_are_rounded_up)
{
    const uint64_t sizes[][2] = {{0, 16}, {1, 16}, {16, 16}, {17, 32}, {4095, 4096}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        own_buffer *buffer = buffer_make(device, sizes[i][0], BUFFER_STORAGE, "size");
        assert_int_equal(buffer_size(buffer), sizes[i][1]);
    }
}

/* lavapipe has a kernel of its own for texel buffers whose bytes are a power of two, and for those
   whose bytes have zeros in bits 8 to 15: no buffer is one of them. Storage buffers, and those of
   devices that are no CPU, are as large as they were asked to be. */
TEST(texel_buffers_are_of_one_kind_for_lavapipe)
{
    bool is_cpu = device_get_info(device)->kind == WHIT_DEVICE_CPU;
    for (uint64_t around = 0; around <= 1 << 18; around += 1 << 15) {
        for (uint64_t size = around; size < around + 1024; size += 16) {
            own_buffer *storage = buffer_make(device, size, BUFFER_STORAGE, "storage");
            assert_int_equal(created_bytes, buffer_size(storage));
            own_buffer *texels = buffer_make(device, size, BUFFER_TEXELS, "texels");
            assert_int_equal(buffer_size(texels), buffer_size(storage));
            assert_int_equal(viewed_bytes, created_bytes);
            assert_true(created_bytes >= buffer_size(texels));
            if (is_cpu) {
                assert_int_not_equal(created_bytes & (created_bytes - 1), 0);
                assert_int_not_equal(created_bytes >> 8 & 0xff, 0);
            } else {
                assert_int_equal(created_bytes, buffer_size(texels));
            }
        }
    }
}

TEST(starts_as_zeros)
{
    uint8_t bytes[4096];
    for (int turn = 0; turn < 8; ++turn) {
        uint32_t uses = (turn & 1 ? BUFFER_HOST : BUFFER_STORAGE) | BUFFER_ZEROED;
        own_buffer *buffer = buffer_make(device, sizeof bytes, uses, "zeros");
        memset(bytes, 0xa5, sizeof bytes);
        assert_int_equal(buffer_read(buffer, 0, bytes, sizeof bytes), WHIT_OK);
        for (size_t i = 0; i < sizeof bytes; ++i)
            assert_int_equal(bytes[i], 0);
        memset(bytes, 0xa5, sizeof bytes); /* the next buffer may get this memory */
        assert_int_equal(buffer_write(buffer, 0, bytes, sizeof bytes), WHIT_OK);
    }
}

/* Buffers without BUFFER_ZEROED are filled with garbage in tests, to show code that relies on
   zeros. */
TEST(others_are_poisoned_in_tests)
{
    uint8_t bytes[256] = {0};
    assert_non_null(getenv("WHIT_POISON"));
    own_buffer *buffer = buffer_make(device, sizeof bytes, BUFFER_STORAGE, "poisoned");
    assert_int_equal(buffer_read(buffer, 0, bytes, sizeof bytes), WHIT_OK);
    for (size_t i = 0; i < sizeof bytes; ++i)
        assert_int_equal(bytes[i], 0xa5);
}

TEST(keeps_what_is_written_where)
{
    const uint32_t uses[] = {BUFFER_STORAGE, BUFFER_STORAGE | BUFFER_HOST};
    own_memory uint8_t *bytes = malloc(LARGE_BYTES), *back = malloc(LARGE_BYTES);
    assert_true(bytes && back);
    for (size_t i = 0; i < LARGE_BYTES; ++i)
        bytes[i] = (uint8_t)(i * 2654435761u >> 13);
    for (size_t i = 0; i < 2; ++i) {
        own_buffer *buffer = buffer_make(device, LARGE_BYTES, uses[i], "large");
        assert_int_equal(buffer_write(buffer, 0, bytes, LARGE_BYTES), WHIT_OK);
        memset(back, 0, LARGE_BYTES);
        assert_int_equal(buffer_read(buffer, 0, back, LARGE_BYTES), WHIT_OK);
        assert_memory_equal(bytes, back, LARGE_BYTES);
        /* A part in the middle, at odd places, leaves its neighbours alone. */
        assert_int_equal(buffer_write(buffer, 1001, bytes, 20 << 20), WHIT_OK);
        assert_int_equal(buffer_read(buffer, 77, back, LARGE_BYTES - 77), WHIT_OK);
        assert_memory_equal(back, bytes + 77, 1001 - 77);
        assert_memory_equal(back + 1001 - 77, bytes, 20 << 20);
        size_t end = 1001 + (20 << 20);
        assert_memory_equal(back + end - 77, bytes + end, LARGE_BYTES - end);
    }
}

TEST(refuses_access_outside)
{
    own_buffer *buffer = buffer_make(device, 64, BUFFER_STORAGE, "small");
    uint8_t bytes[65] = {0};
    assert_int_equal(buffer_write(buffer, 0, bytes, 65), WHIT_ERROR_USAGE);
    assert_int_equal(buffer_write(buffer, 63, bytes, 2), WHIT_ERROR_USAGE);
    assert_int_equal(buffer_read(buffer, 65, bytes, 0), WHIT_ERROR_USAGE);
    assert_int_equal(buffer_read(buffer, UINT64_MAX, bytes, 2), WHIT_ERROR_USAGE);
    assert_int_equal(buffer_read(buffer, 2, bytes, UINT64_MAX), WHIT_ERROR_USAGE);
    assert_int_equal(buffer_read(buffer, 64, bytes, 0), WHIT_OK);
    assert_int_equal(buffer_write(buffer, 60, bytes, 4), WHIT_OK);
}

TEST(refuses_what_is_over_the_limits)
{
    const struct device_limits *limits = device_get_limits(device);
    const struct {
        uint64_t size_bytes;
        uint32_t uses;
        const char *what;
    } cases[] = {
        {device_get_info(device)->max_storage_range_bytes + 1, BUFFER_STORAGE, "a storage buffer"},
        {limits->max_texel_elements * 16 + 1, BUFFER_TEXELS, "a texel buffer"},
        {limits->max_allocation_bytes + 1, BUFFER_HOST, "one allocation"},
        {UINT64_MAX, BUFFER_HOST, "one allocation"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        struct buffer *buffer = (struct buffer *)&messages;
        messages = (struct messages){0};
        assert_int_equal(
            buffer_create(device, cases[i].size_bytes, cases[i].uses, "nodes", &buffer),
            WHIT_ERROR_DEVICE);
        assert_null(buffer);
        assert_int_equal(messages.errors, 1);
        assert_non_null(strstr(messages.text, "buffer \"nodes\": "));
        assert_non_null(strstr(messages.text, "over the device's limit of "));
        assert_non_null(strstr(messages.text, cases[i].what));
    }
    messages = (struct messages){0};
}

TEST(names_sizes_in_mebibytes)
{
    struct buffer *buffer;
    uint64_t size = (device_get_info(device)->max_storage_range_bytes + 1 + (1 << 20)) >> 20 << 20;
    char expected[64];
    snprintf(expected, sizeof expected, "buffer \"nodes\": %llu MiB is over",
             (unsigned long long)size >> 20);
    messages = (struct messages){0};
    assert_int_equal(buffer_create(device, size, BUFFER_STORAGE, "nodes", &buffer),
                     WHIT_ERROR_DEVICE);
    assert_non_null(strstr(messages.text, expected));
}

TEST(destroy_accepts_null)
{
    buffer_destroy(NULL);
    pipeline_destroy(NULL);
    binding_set_destroy(NULL);
    commands_destroy(NULL);
}

/* Two threads were in a call that Vulkan allows one at a time. */
static atomic_bool overlapped;

WRAPPED(VkResult, vkQueueSubmit, VkQueue queue, uint32_t count, const VkSubmitInfo *infos,
        VkFence fence)
{
    static atomic_flag inside = ATOMIC_FLAG_INIT;
    if (atomic_flag_test_and_set(&inside))
        overlapped = true;
    sched_yield();
    VkResult result = __real_vkQueueSubmit(queue, count, infos, fence);
    atomic_flag_clear(&inside);
    return result;
}

enum { USERS = 3, ROUNDS = 100, WORDS = 4096 };

struct user {
    uint32_t mark;
    bool kept; /* all words were read back as they were written */
    struct commands *commands;
    struct thread *thread;
};

/* Writes a buffer of its own, then its second half by its own commands. */
static bool write_and_read(struct user *user, uint32_t round)
{
    static const uint64_t half_bytes = WORDS / 2 * sizeof(uint32_t);
    uint32_t words[WORDS], back[WORDS];
    own_buffer *buffer = NULL;
    for (uint32_t i = 0; i < WORDS; ++i)
        words[i] = user->mark + round + (i < WORDS / 2 ? i : 0);
    if (buffer_create(device, sizeof words, BUFFER_STORAGE | BUFFER_ZEROED, "shared", &buffer) !=
            WHIT_OK ||
        buffer_write(buffer, 0, words, half_bytes) != WHIT_OK ||
        commands_begin(user->commands) != WHIT_OK)
        return false;
    commands_fill(user->commands, buffer, half_bytes, half_bytes, user->mark + round);
    return commands_run(user->commands) == WHIT_OK &&
           buffer_read(buffer, 0, back, sizeof back) == WHIT_OK &&
           memcmp(words, back, sizeof words) == 0;
}

static void use(void *context)
{
    struct user *user = context;
    user->kept = true;
    for (uint32_t round = 0; user->kept && round < ROUNDS; ++round)
        user->kept = write_and_read(user, round);
}

TEST(threads_share_a_device)
{
    struct user users[USERS] = {{0}};
    for (uint32_t i = 0; i < USERS; ++i) {
        users[i].mark = i << 24;
        users[i].commands = commands_make(device);
        users[i].thread = thread_start(use, &users[i]);
        assert_non_null(users[i].thread);
    }
    for (uint32_t i = 0; i < USERS; ++i) {
        thread_join(users[i].thread);
        commands_destroy(users[i].commands);
    }
    for (uint32_t i = 0; i < USERS; ++i)
        assert_true(users[i].kept);
    assert_false(overlapped);
}

int main(void)
{
    setenv("WHIT_NO_CACHE", "1", 1);
    int failed = unit_run(device_begin, device_end);
    setenv("WHIT_STAGING", "1", 1);
    return failed + unit_run(device_begin, device_end);
}
