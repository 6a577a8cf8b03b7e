#include <stdio.h>
#include <stdlib.h>

#include "app/arguments.h"
#include "app/cache.h"
#include "app/commands.h"
#include "app/devices/device_hints.h"
#include "app/document.h"

struct devices {
    bool json;
};

static const struct setting options[] = {
    {"json", 0, NULL, "everything as JSON", SETTING_AT_FLAG(struct devices, json)},
    {0},
};

/* Finds the device's float behaviour. False: the device cannot be opened. */
static bool find_floats(const whit_device_info *info, whit_device_floats *floats)
{
    char selector[16];
    whit_device *device = NULL;
    snprintf(selector, sizeof selector, "%u", info->index);
    const whit_device_params params = {.selector = selector};
    whit_result result =
        info->usable ? whit_device_create(&params, NULL, &device) : WHIT_ERROR_DEVICE;
    if (result == WHIT_OK)
        result = whit_device_find_floats(device, floats);
    whit_device_destroy(device);
    return result == WHIT_OK;
}

static json_t *floats_document(const whit_device_info *info)
{
    whit_device_floats floats;
    if (!find_floats(info, &floats))
        return json_null();
    json_t *document = document_object();
    document_flag(document, "own_division", floats.own_division);
    document_flag(document, "own_comparison", floats.own_comparison);
    document_flag(document, "keeps_denormals", floats.keeps_denormals);
    document_flag(document, "rounds_nearest", floats.rounds_nearest);
    return document;
}

static void print_floats(const whit_device_info *info)
{
    whit_device_floats floats;
    if (!find_floats(info, &floats))
        return;
    bool portable = floats.keeps_denormals && floats.rounds_nearest;
    printf("     portable  %s, division by %s, comparison by %s%s%s\n",
           portable ? "pictures" : "no pictures", floats.own_division ? "itself" : "whit",
           floats.own_comparison ? "itself" : "whit",
           floats.keeps_denormals ? "" : ", denormals are 0 to it",
           floats.rounds_nearest ? "" : ", sums are not rounded to nearest");
}

static void put_device(json_t *device, const whit_device_info *info)
{
    document_count(device, "index", info->index);
    document_text(device, "name", info->name);
    document_text(device, "kind", whit_device_kind_name(info->kind));
    document_text(device, "driver", info->driver);
    document_text(device, "api_version", info->api_version);
    document_count(device, "memory_bytes", info->memory_bytes);
    document_count(device, "max_storage_range_bytes", info->max_storage_range_bytes);
    document_count(device, "subgroup_size", info->subgroup_size);
    document_flag(device, "float64", info->float64);
    document_flag(device, "int64", info->int64);
    document_flag(device, "timestamps", info->timestamps);
    document_flag(device, "usable", info->usable);
    document_text(device, "why_not", info->usable ? NULL : info->why_not);
    document_flag(device, "automatic", info->automatic);
    document_put(device, "floats", floats_document(info));
}

static void print_device(const whit_device_info *info)
{
    printf("%c %u  %s\n", info->automatic ? '*' : ' ', info->index, cli_shown(info->name));
    printf("     kind      %s, Vulkan %s\n", whit_device_kind_name(info->kind), info->api_version);
    printf("     driver    %s\n", cli_shown(info->driver));
    printf("     memory    %.1f GiB, storage buffers to %.0f MiB\n",
           (double)info->memory_bytes / 1073741824.0,
           (double)info->max_storage_range_bytes / 1048576.0);
    printf("     subgroup  %u\n", info->subgroup_size);
    printf("     has       %s%s%s\n", info->timestamps ? "timestamps" : "no timestamps",
           info->float64 ? ", float64" : "", info->int64 ? ", int64" : "");
    print_floats(info);
    if (!info->usable)
        printf("     not usable: %s\n", cli_shown(info->why_not));
}

static int print_json(const whit_device_info *infos, uint32_t count,
                      const struct device_hints *hints)
{
    json_t *root = document_root(), *list = document_list(root, "devices");
    for (uint32_t i = 0; i < count; ++i)
        put_device(document_entry(list), &infos[i]);
    list = document_list(root, "hints");
    for (uint32_t i = 0; i < hints->count; ++i)
        document_append(list, json_string(hints->list[i]));
    document_put(root, "cache", cache_document());
    return cli_print_json(root);
}

static int print_text(const whit_device_info *infos, uint32_t count,
                      const struct device_hints *hints)
{
    for (uint32_t i = 0; i < count; ++i)
        print_device(&infos[i]);
    if (count > 0)
        puts("\n* is what `--device auto` takes.");
    for (uint32_t i = 0; i < hints->count; ++i)
        printf("%s%s\n", i == 0 && count > 0 ? "\n" : "", hints->list[i]);
    cache_print();
    return cli_finish_stdout(EXIT_FINE);
}

static bool any_usable(const whit_device_info *infos, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (infos[i].usable)
            return true;
    }
    return false;
}

static int list(bool json)
{
    whit_device_info *infos;
    uint32_t count;
    struct device_hints hints;
    whit_result result = whit_device_list(&cli_log, &infos, &count);
    if (result != WHIT_OK && result != WHIT_ERROR_NO_DEVICE)
        return cli_exit_of(result);
    device_hints_find("", getenv("NVIDIA_DRIVER_CAPABILITIES"), infos, count, &hints);
    int status = json ? print_json(infos, count, &hints) : print_text(infos, count, &hints);
    if (status == EXIT_FINE && count > 0 && !any_usable(infos, count))
        cli_error("none of these devices is usable");
    if (status == EXIT_FINE && !any_usable(infos, count))
        status = EXIT_DEVICE;
    whit_memory_destroy(infos);
    return status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct devices devices = {0};
    cli_reader_init(&reader, command, argc, argv);
    if (!cli_read(&reader, &devices, NULL))
        return reader.status;
    if (reader.positional)
        return CLI_MISUSE(&reader, "`%s` is one argument too many", reader.positional);
    cache_prepare(false);
    return list(devices.json);
}

const struct cli_command command_devices = {
    .name = "devices",
    .arguments = "[options]",
    .summary = "Lists what Vulkan offers here, and what whit will use.",
    .options = options,
    .run = run,
};
