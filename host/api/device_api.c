#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>

#include "api/handles.h"

static void describe(const struct device_info *from, whit_device_info *to)
{
    *to = (whit_device_info){
        .index = from->index,
        .memory_bytes = from->memory_bytes,
        .max_storage_range_bytes = from->max_storage_range_bytes,
        .subgroup_size = from->subgroup_size,
        .float64 = from->float64,
        .int64 = from->int64,
        .timestamps = from->timestamps,
        .usable = from->usable,
    };
    snprintf(to->name, sizeof to->name, "%s", from->name);
    snprintf(to->driver, sizeof to->driver, "%s", from->driver);
    snprintf(to->api_version, sizeof to->api_version, "%s", from->api_version);
    const char *kind = device_kind_name(from->kind);
    for (size_t i = 0; kind[i] && i + 1 < sizeof to->kind; ++i)
        to->kind[i] = (char)tolower((unsigned char)kind[i]);
    snprintf(to->why_not, sizeof to->why_not, "%s", from->why_not);
}

/* The rule of "auto": the first usable device of the best kind, and kinds are listed best first. */
static void mark_automatic(const struct device_info *from, whit_device_info *to, uint32_t count)
{
    uint32_t best = count;
    for (uint32_t i = 0; i < count; ++i) {
        if (from[i].usable && (best == count || from[i].kind < from[best].kind))
            best = i;
    }
    if (best < count)
        to[best].automatic = true;
}

whit_result whit_device_list(const whit_log *log, whit_device_info **infos, uint32_t *count)
{
    struct log inner = log_from_public(log);
    struct device_info *found = NULL;
    *infos = NULL;
    *count = 0;
    uint32_t found_count = 0;
    whit_result result = device_list(&inner, &found, &found_count);
    if (result != WHIT_OK)
        return result;
    whit_device_info *described = calloc(found_count ? found_count : 1, sizeof *described);
    if (!described) {
        log_error(&inner, "out of memory");
        free(found);
        return WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < found_count; ++i)
        describe(&found[i], &described[i]);
    mark_automatic(found, described, found_count);
    free(found);
    *infos = described;
    *count = found_count;
    return WHIT_OK;
}

whit_result whit_device_create(const whit_device_params *params, const whit_log *log,
                               whit_device **out)
{
    const whit_device_params defaults = {0};
    if (!params)
        params = &defaults;
    *out = NULL;
    struct log inner = log_from_public(log);
    whit_device *device = calloc(1, sizeof *device);
    if (!device) {
        log_error(&inner, "out of memory");
        return WHIT_ERROR_MEMORY;
    }
    device->log = inner;
    const struct device_params wanted = {
        .selector = params->selector,
        .validation = params->validation,
    };
    whit_result result = device_create(&inner, &wanted, &device->device);
    if (result != WHIT_OK) {
        whit_device_destroy(device);
        return result;
    }
    *out = device;
    return WHIT_OK;
}

void whit_device_destroy(whit_device *device)
{
    if (!device)
        return;
    device_destroy(device->device);
    free(device);
}

void whit_device_get_info(const whit_device *device, whit_device_info *info)
{
    describe(device_get_info(device->device), info);
}

uint32_t whit_device_validation_messages(const whit_device *device)
{
    return device_validation_messages(device->device);
}
