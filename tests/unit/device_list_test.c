#include <sys/wait.h>
#include <unistd.h>

#include <vulkan/vulkan_core.h>

#include "../wrapped.h"
#include "base/child.h"
#include "device_fixture.h"

/* Whether processes may be forked, and how often drivers were loaded while they might. */
static bool held;
static uint32_t loads, loads_unheld;

WRAPPED(void, child_hold_forks, void)
{
    held = true;
    __real_child_hold_forks();
}

WRAPPED(void, child_release_forks, void)
{
    held = false;
    __real_child_release_forks();
}

WRAPPED(VkResult, vkCreateInstance, const VkInstanceCreateInfo *info,
        const VkAllocationCallbacks *allocator, VkInstance *out)
{
    ++loads;
    loads_unheld += !held;
    return __real_vkCreateInstance(info, allocator, out);
}

static whit_device_info *infos;
static uint32_t info_count;

static int list_devices(void **state)
{
    (void)state;
    whit_log log = messages_log(&messages);
    whit_result result = device_list(&log, &infos, &info_count);
    const char *no_device = getenv("WHIT_TEST_NO_DEVICE");
    if (result == WHIT_ERROR_NO_DEVICE && no_device && strcmp(no_device, "skip") == 0)
        return 0;
    return result == WHIT_OK ? 0 : -1;
}

static int free_list(void **state)
{
    (void)state;
    free(infos);
    return 0;
}

static whit_result create_with(const char *selector, struct messages *told, struct device **device)
{
    whit_log log = messages_log(told);
    whit_device_params params = {.selector = selector};
    return device_create(&log, &params, NULL, device);
}

TEST(lists_what_there_is)
{
    if (info_count == 0)
        skip();
    for (uint32_t i = 0; i < info_count; ++i) {
        assert_int_equal(infos[i].index, i);
        assert_true(infos[i].name[0] != '\0' && infos[i].api_version[0] == '1');
        assert_true(infos[i].usable == (infos[i].why_not[0] == '\0'));
        if (!infos[i].usable)
            continue;
        /* The least that Vulkan promises. */
        assert_true(infos[i].max_storage_range_bytes >= 1 << 27);
        assert_true(infos[i].subgroup_size >= 1);
        assert_true(infos[i].memory_bytes > 0 && infos[i].driver[0] != '\0');
        if (strstr(infos[i].name, "llvmpipe")) {
            assert_int_equal(infos[i].kind, WHIT_DEVICE_CPU);
            assert_non_null(strstr(infos[i].driver, "Mesa "));
        }
    }
}

TEST(limits_are_those_of_the_device)
{
    if (info_count == 0)
        skip();
    for (uint32_t i = 0; i < info_count; ++i) {
        char number[16];
        struct device *device;
        snprintf(number, sizeof number, "%u", i);
        if (!infos[i].usable)
            continue;
        assert_int_equal(create_with(number, &messages, &device), WHIT_OK);
        const struct device_limits *limits = device_get_limits(device);
        const char *mesa =
            strstr(infos[i].name, "llvmpipe") ? strstr(infos[i].driver, "Mesa ") : NULL;
        /* The least that Vulkan promises. */
        assert_true(limits->max_texel_elements >= 65536);
        assert_true(limits->max_allocation_bytes >= 1 << 30);
        assert_true(limits->loop_limited == (mesa && strtoul(mesa + 5, NULL, 10) < 25));
        device_destroy(device);
    }
}

TEST(chooses_by_number_and_name)
{
    if (info_count == 0)
        skip();
    for (uint32_t i = 0; i < info_count; ++i) {
        if (!infos[i].usable)
            continue;
        char number[16], shouted[256];
        snprintf(number, sizeof number, "%u", i);
        struct device *device;
        assert_int_equal(create_with(number, &messages, &device), WHIT_OK);
        assert_int_equal(device_get_info(device)->index, i);
        device_destroy(device);

        snprintf(shouted, sizeof shouted, "%s", infos[i].name + 1);
        for (char *at = shouted; *at; ++at)
            if (*at >= 'a' && *at <= 'z')
                *at = (char)(*at - 'a' + 'A');
        assert_int_equal(create_with(shouted, &messages, &device), WHIT_OK);
        assert_string_equal(device_get_info(device)->name, infos[i].name);
        device_destroy(device);
    }
}

TEST(automatic_prefers_the_better_kind)
{
    if (info_count == 0)
        skip();
    const char *const selectors[] = {NULL, "auto", ""};
    for (size_t i = 0; i < 3; ++i) {
        struct device *device;
        assert_int_equal(create_with(selectors[i], &messages, &device), WHIT_OK);
        assert_true(device_get_info(device)->automatic);
        for (uint32_t j = 0; j < info_count; ++j)
            assert_true(!infos[j].usable || infos[j].kind >= device_get_info(device)->kind);
        device_destroy(device);
    }
}

TEST(refuses_what_is_not_there)
{
    if (info_count == 0)
        skip();
    char past[16];
    snprintf(past, sizeof past, "%u", info_count);
    const char *const selectors[] = {past, "99999999999999999999", "no such device", "-1"};
    for (size_t i = 0; i < 4; ++i) {
        struct device *device = (struct device *)&messages;
        assert_int_equal(create_with(selectors[i], &messages, &device), WHIT_ERROR_NO_DEVICE);
        assert_null(device);
        assert_int_equal(messages.errors, 1);
        assert_non_null(strstr(messages.text, selectors[i]));
        assert_non_null(strstr(messages.text, infos[0].name));
    }
}

/* Runs in a child process, since drivers stay loaded. Gives 0 for success. */
static int without_driver(void)
{
    whit_log log = messages_log(&messages);
    whit_device_info *list = NULL;
    uint32_t count = 1;
    struct device *device;
    if (device_list(&log, &list, &count) != WHIT_ERROR_NO_DEVICE || list || count != 0)
        return 1;
    if (messages.errors != 1 || !strstr(messages.text, "mesa-vulkan-drivers"))
        return 2;
    if (create_with(NULL, &messages, &device) != WHIT_ERROR_NO_DEVICE || device)
        return 3;
    return messages.errors == 1 && strstr(messages.text, "mesa-vulkan-drivers") ? 0 : 4;
}

TEST(no_driver_says_what_to_install)
{
    pid_t child = fork();
    if (child == 0) {
        setenv("VK_DRIVER_FILES", "/nonexistent", 1);
        setenv("VK_ICD_FILENAMES", "/nonexistent", 1);
        execl("/proc/self/exe", "device_list_test", "--without-driver", (char *)NULL);
        _exit(99);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

TEST(silent_log_is_fine)
{
    whit_device_params params = {.selector = "no such device"};
    struct device *device;
    assert_int_equal(device_create(NULL, &params, NULL, &device), WHIT_ERROR_NO_DEVICE);
    assert_null(device);
    device_destroy(NULL);
}

/* The last test: drivers take locks, which a child would find held for ever. */
TEST(no_process_is_forked_while_drivers_load)
{
    assert_true(loads > 1); /* by the list, and by devices */
    assert_int_equal(loads_unheld, 0);
    assert_false(held);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--without-driver") == 0)
        return without_driver();
    setenv("WHIT_NO_CACHE", "1", 1);
    return unit_run(list_devices, free_list);
}
