#include "app/devices/device_hints.h"

#include <dirent.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PATH_BYTES = 512 };

WHIT_PRINTF(2, 3) static void add(struct device_hints *hints, const char *format, ...)
{
    va_list arguments;
    if (hints->count == DEVICE_HINTS_MAX)
        return;
    va_start(arguments, format);
    vsnprintf(hints->list[hints->count++], DEVICE_HINT_BYTES, format, arguments);
    va_end(arguments);
}

static bool is_there(const char *root, const char *path)
{
    char whole[PATH_BYTES];
    snprintf(whole, sizeof whole, "%s%s", root, path);
    return access(whole, F_OK) == 0;
}

/* "580" of "NVRM version: NVIDIA UNIX x86_64 Kernel Module 580.159.04 ..."; "" where the file
   cannot be read. */
static void read_nvidia_series(const char *root, char series[16])
{
    char path[PATH_BYTES], line[256] = "";
    static const char before[] = "Kernel Module";
    snprintf(path, sizeof path, "%s/proc/driver/nvidia/version", root);
    FILE *from = fopen(path, "r");
    if (from && !fgets(line, sizeof line, from))
        line[0] = 0;
    if (from)
        fclose(from);
    const char *at = strstr(line, before);
    at = at ? strpbrk(at, "0123456789") : NULL;
    size_t length = at ? strspn(at, "0123456789") : 0;
    snprintf(series, 16, "%.*s", (int)(length < 15 ? length : 15), at ? at : "");
}

static void hint_nvidia(const char *root, const char *asked, struct device_hints *hints)
{
    char series[16], shown[64];
    bool shows = asked && (strstr(asked, "all") || strstr(asked, "graphics"));
    read_nvidia_series(root, series);
    if (!shows)
        add(hints,
            "An NVIDIA GPU is here and Vulkan does not list it: a container shows it only when "
            "started with NVIDIA_DRIVER_CAPABILITIES=all, which is %s here.",
            asked && *asked ? whit_text_show(asked, shown, sizeof shown) : "not set");
    add(hints,
        "%s: install its Vulkan driver of the same version as the kernel's (Ubuntu: "
        "libnvidia-gl-%s; Debian: nvidia-vulkan-icd).",
        shows ? "An NVIDIA GPU is here and Vulkan does not list it" : "Where this is no container",
        series[0] ? series : "VERSION");
    if (shows)
        add(hints, "A driver that a container has from its host does not load without libXext.so.6 "
                   "(Ubuntu, Debian: libxext6).");
}

/* Finds the first render node, and whether this user may open it. */
static bool find_render_node(const char *root, char name[64], bool *opens)
{
    char folder[PATH_BYTES], path[PATH_BYTES + 64];
    snprintf(folder, sizeof folder, "%s/dev/dri", root);
    DIR *nodes = opendir(folder);
    name[0] = 0;
    for (struct dirent *entry; nodes && (entry = readdir(nodes));) {
        bool first = !name[0] || strcmp(entry->d_name, name) < 0;
        if (first && strncmp(entry->d_name, "renderD", 7) == 0 && strlen(entry->d_name) < 48)
            snprintf(name, 64, "%.47s", entry->d_name);
    }
    if (nodes)
        closedir(nodes);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    *opens = name[0] && access(path, R_OK | W_OK) == 0;
    return name[0] != 0;
}

static void hint_render_node(const char *root, struct device_hints *hints)
{
    char name[64], shown[64];
    bool opens;
    if (!find_render_node(root, name, &opens))
        return;
    (void)whit_text_show(name, shown, sizeof shown);
    if (opens)
        add(hints,
            "A GPU is here (/dev/dri/%s) and Vulkan does not list it: mesa-vulkan-drivers has the "
            "drivers of AMD's and Intel's.",
            shown);
    else
        add(hints,
            "A GPU is here (/dev/dri/%s), but this user may not open it: members of the group "
            "`render` may.",
            shown);
}

void device_hints_find(const char *root, const char *asked, const whit_device_info *infos,
                       uint32_t count, struct device_hints *hints)
{
    bool any = false, gpu = false, nvidia = false;
    *hints = (struct device_hints){0};
    for (uint32_t i = 0; i < count; ++i) {
        any |= infos[i].usable;
        gpu |= infos[i].kind != WHIT_DEVICE_CPU;
        nvidia |= strstr(infos[i].name, "NVIDIA") != NULL;
    }
    bool has_nvidia = is_there(root, "/dev/nvidiactl") || is_there(root, "/proc/driver/nvidia");
    if (has_nvidia && !nvidia)
        hint_nvidia(root, asked, hints);
    else if (!gpu)
        hint_render_node(root, hints);
    if (!any)
        add(hints, "Without a GPU whit runs on the processor: mesa-vulkan-drivers brings lavapipe, "
                   "which needs nothing else.");
}
