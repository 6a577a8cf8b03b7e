/* Hints of `whit devices` about a GPU that Vulkan does not list, with folders that stand for the
   system folders of a machine. */
#include <sys/stat.h>

#include "app/devices/device_hints.h"
#include "folder_fixture.h"

static const whit_device_info lavapipe = {.name = "llvmpipe",
                                          .kind = WHIT_DEVICE_CPU,
                                          .usable = true},
                              nvidia = {.name = "NVIDIA H100",
                                        .kind = WHIT_DEVICE_DISCRETE,
                                        .usable = true};

static const char ask_for_all[] = "NVIDIA_DRIVER_CAPABILITIES=all", package[] = "libnvidia-gl-580";

static void make(const char *path, const char *text)
{
    char whole[256];
    snprintf(whole, sizeof whole, "%s%s", folder, path);
    for (char *at = strchr(whole + strlen(folder) + 1, '/'); at; at = strchr(at + 1, '/')) {
        *at = 0;
        (void)mkdir(whole, 0777);
        *at = '/';
    }
    put_file(whole, text, strlen(text));
}

TEST_IN(what_lacks_is_named, folder_begin, folder_end)
{
    static const char little[] = "compute,utility", steers[] = "\x1b[2J\xff";
    static const struct {
        const char *name, *node;
        bool nvidia;
        const char *asked;
        const whit_device_info *listed;
        uint32_t count;
        const char *first, *also, *second; /* parts of hints */
    } cases[] = {
        {"listed", "D128", true, NULL, &nvidia, 0, NULL, NULL, NULL},
        {"a processor alone", NULL, false, NULL, &lavapipe, 0, NULL, NULL, NULL},
        {"a container", NULL, true, little, &lavapipe, 2, ask_for_all, little, package},
        {"steering", NULL, true, steers, &lavapipe, 2, "\\u001b[2J\\xff", NULL, package},
        {"with all", NULL, true, "all", &lavapipe, 2, package, NULL, "libxext6"},
        {"no driver", "D129", false, NULL, &lavapipe, 1, "D129", "mesa-vulkan-drivers", NULL},
        {"nothing", NULL, false, NULL, NULL, 1, "lavapipe", NULL, NULL},
        {"a module alone", NULL, true, NULL, NULL, 3, NULL, NULL, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        struct device_hints hints;
        char node[64];
        snprintf(node, sizeof node, "/dev/dri/render%s", cases[i].node ? cases[i].node : "");
        if (i > 0)
            assert_int_equal(folder_end(state) | folder_begin(state), 0);
        if (cases[i].node)
            make(node, "");
        if (cases[i].nvidia) {
            make("/dev/nvidiactl", "");
            make("/proc/driver/nvidia/version",
                 "NVRM version: NVIDIA UNIX x86_64 Kernel Module  580.159.04  Tue\n");
        }
        device_hints_find(folder, cases[i].asked, cases[i].listed, cases[i].listed != NULL, &hints);
        if (hints.count != cases[i].count)
            fail_msg("%s: %u hints", cases[i].name, hints.count);
        const char *parts[] = {cases[i].first, cases[i].also, cases[i].second};
        for (uint32_t k = 0; k < 3; ++k) {
            if (parts[k] && !strstr(hints.list[k / 2], parts[k]))
                fail_msg("%s: %s", cases[i].name, hints.list[k / 2]);
        }
        for (uint32_t k = 0; k < hints.count; ++k)
            assert_true(!strchr(hints.list[k], '\x1b') && !strchr(hints.list[k], '\xff'));
    }
}
