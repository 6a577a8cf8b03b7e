/* Reads the numbers that a driver keeps of its compiled kernels
 * (VK_KHR_pipeline_executable_properties).
 */
#include "device/vulkan.h"

#include <stdio.h>

enum { EXECUTABLES_MAX = 8 };

struct statistics {
    whit_statistic *list;
    uint32_t count;
};

/* `executable`: name of the executable; NULL where the pipeline has only one. */
static void add(struct statistics *to, const char *executable, const char *name, double value)
{
    if (to->count == WHIT_STATISTICS_MAX)
        return;
    whit_statistic *own = &to->list[to->count++];
    snprintf(own->name, sizeof own->name, "%.24s%s%.36s", executable ? executable : "",
             executable ? ": " : "", name);
    own->value = value;
}

static double value_of(const VkPipelineExecutableStatisticKHR *statistic)
{
    switch (statistic->format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
        return statistic->value.b32 ? 1.0 : 0.0;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
        return (double)statistic->value.i64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
        return (double)statistic->value.u64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR:
        return statistic->value.f64;
    default:
        return 0.0;
    }
}

/* A driver with more statistics than fit in answers VK_INCOMPLETE, which is no failure. */
static whit_result read_executable(const struct pipeline *pipeline, uint32_t index,
                                   const char *name, struct statistics *to)
{
    struct device *device = pipeline->device;
    whit_result result = WHIT_OK;
    VkPipelineExecutableStatisticKHR statistics[WHIT_STATISTICS_MAX];
    uint32_t count = WHIT_STATISTICS_MAX;
    for (uint32_t i = 0; i < count; ++i)
        statistics[i] = (VkPipelineExecutableStatisticKHR){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR};
    const VkPipelineExecutableInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
        .pipeline = pipeline->vk,
        .executableIndex = index,
    };
    VK_TRY(device, device->get_executable_statistics(device->vk, &info, &count, statistics));
    for (uint32_t i = 0; i < count; ++i)
        add(to, name, statistics[i].name, value_of(&statistics[i]));
fail:
    return result;
}

whit_result pipeline_get_statistics(const struct pipeline *pipeline, whit_statistic *list,
                                    uint32_t *count)
{
    struct device *device = pipeline->device;
    struct statistics to = {.list = list};
    whit_result result = WHIT_OK;
    VkPipelineExecutablePropertiesKHR executables[EXECUTABLES_MAX];
    uint32_t executable_count = EXECUTABLES_MAX;
    *count = 0;
    if (!pipeline->asks_statistics)
        return WHIT_OK;
    for (uint32_t i = 0; i < EXECUTABLES_MAX; ++i)
        executables[i] = (VkPipelineExecutablePropertiesKHR){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR};
    const VkPipelineInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR,
        .pipeline = pipeline->vk,
    };
    VK_TRY(device, device->get_executables(device->vk, &info, &executable_count, executables));
    for (uint32_t i = 0; result == WHIT_OK && i < executable_count; ++i) {
        const char *name = executable_count > 1 ? executables[i].name : NULL;
        add(&to, name, "lanes of a subgroup", executables[i].subgroupSize);
        result = read_executable(pipeline, i, name, &to);
    }
    *count = to.count;
fail:
    return result;
}
