/* What `whit devices` says of a GPU that Vulkan does not list: machines are folders here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/devices/device_hints.h"

static const whit_device_info lavapipe = {.name = "llvmpipe", .kind = "cpu", .usable = true},
                              nvidia = {.name = "NVIDIA H100", .kind = "discrete", .usable = true};

struct machine {
    char root[64];
};

static void make(const struct machine *machine, const char *path, const char *text)
{
    char whole[256];
    snprintf(whole, sizeof whole, "%s%s", machine->root, path);
    for (char *at = strchr(whole + strlen(machine->root) + 1, '/'); at; at = strchr(at + 1, '/')) {
        *at = 0;
        (void)mkdir(whole, 0777);
        *at = '/';
    }
    FILE *to = fopen(whole, "w");
    assert_non_null(to);
    assert_true(fputs(text, to) >= 0 && fclose(to) == 0);
}

static struct machine make_machine(void)
{
    struct machine machine = {"/tmp/whit-hints-XXXXXX"};
    assert_non_null(mkdtemp(machine.root));
    return machine;
}

static void remove_machine(const struct machine *machine)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", machine->root);
    assert_int_equal(system(command), 0);
}

static void put_nvidia(const struct machine *machine)
{
    make(machine, "/dev/nvidiactl", "");
    make(machine, "/proc/driver/nvidia/version",
         "NVRM version: NVIDIA UNIX x86_64 Kernel Module  580.159.04  Tue\n");
}

static void a_listed_gpu_needs_no_hint(void **state)
{
    (void)state;
    struct machine machine = make_machine();
    struct device_hints hints;
    put_nvidia(&machine);
    make(&machine, "/dev/dri/renderD128", "");
    device_hints_find(machine.root, NULL, &nvidia, 1, &hints);
    assert_int_equal(hints.count, 0);
    remove_machine(&machine);
}

static void a_processor_without_a_gpu_needs_no_hint(void **state)
{
    (void)state;
    struct machine machine = make_machine();
    struct device_hints hints;
    device_hints_find(machine.root, NULL, &lavapipe, 1, &hints);
    assert_int_equal(hints.count, 0);
    remove_machine(&machine);
}

static void a_container_is_told_what_it_was_started_with(void **state)
{
    (void)state;
    struct machine machine = make_machine();
    struct device_hints hints;
    put_nvidia(&machine);
    device_hints_find(machine.root, "compute,utility", &lavapipe, 1, &hints);
    assert_int_equal(hints.count, 2);
    assert_non_null(strstr(hints.list[0], "NVIDIA_DRIVER_CAPABILITIES=all"));
    assert_non_null(strstr(hints.list[0], "compute,utility"));
    assert_non_null(strstr(hints.list[1], "libnvidia-gl-580"));
    device_hints_find(machine.root, "\x1b[2J\xff", &lavapipe, 1, &hints);
    assert_null(strchr(hints.list[0], '\x1b'));
    assert_null(strchr(hints.list[0], '\xff'));
    device_hints_find(machine.root, "all", &lavapipe, 1, &hints);
    assert_int_equal(hints.count, 1);
    assert_non_null(strstr(hints.list[0], "libnvidia-gl-580"));
    remove_machine(&machine);
}

static void a_gpu_without_its_mesa_driver_is_named(void **state)
{
    (void)state;
    struct machine machine = make_machine();
    struct device_hints hints;
    make(&machine, "/dev/dri/renderD129", "");
    device_hints_find(machine.root, NULL, &lavapipe, 1, &hints);
    assert_int_equal(hints.count, 1);
    assert_non_null(strstr(hints.list[0], "renderD129"));
    assert_non_null(strstr(hints.list[0], "mesa-vulkan-drivers"));
    remove_machine(&machine);
}

static void without_any_device_lavapipe_is_named(void **state)
{
    (void)state;
    struct machine machine = make_machine();
    struct device_hints hints;
    device_hints_find(machine.root, NULL, NULL, 0, &hints);
    assert_int_equal(hints.count, 1);
    assert_non_null(strstr(hints.list[0], "lavapipe"));
    put_nvidia(&machine);
    device_hints_find(machine.root, NULL, NULL, 0, &hints);
    assert_int_equal(hints.count, 3);
    remove_machine(&machine);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_listed_gpu_needs_no_hint),
        cmocka_unit_test(a_processor_without_a_gpu_needs_no_hint),
        cmocka_unit_test(a_container_is_told_what_it_was_started_with),
        cmocka_unit_test(a_gpu_without_its_mesa_driver_is_named),
        cmocka_unit_test(without_any_device_lavapipe_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
