#include "device/pipeline.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "device/buffer.h"
#include "device/kept.h"

/* The words of a kernel that the driver gets. */
struct kernel_words {
    uint32_t *whole; /* owned, the rewritten kernel; NULL: it is not rewritten */
    size_t whole_count;
    uint32_t *specialized; /* owned; NULL: the kernel cannot be specialized */
    size_t word_count;
    struct spirv_info info;
};

static VkDescriptorType descriptor_type(enum binding_kind kind)
{
    return kind == BINDING_TEXELS ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                  : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static whit_result check_kernel(const struct pipeline *pipeline,
                                const struct pipeline_params *params)
{
    if (params->spirv && params->spirv_bytes > 0 && params->spirv_bytes % 4 == 0 &&
        params->push_bytes % 4 == 0)
        return WHIT_OK;
    return log_usage(&pipeline->device->log,
                     "pipeline \"%s\": SPIR-V or push constants of a broken size", pipeline->name);
}

static whit_result check_limits(const struct pipeline *pipeline)
{
    const struct device *device = pipeline->device;
    const VkPhysicalDeviceLimits *limits = &device->properties.limits;
    if (pipeline->push_bytes > limits->maxPushConstantsSize ||
        pipeline->storage_count > limits->maxPerStageDescriptorStorageBuffers ||
        pipeline->texels_count > limits->maxPerStageDescriptorSampledImages)
        return log_failure(
            &device->log, WHIT_ERROR_DEVICE,
            "pipeline \"%s\": %u storage buffers, %u texel buffers and %u bytes of push "
            "constants; the device's limits are %u, %u and %u",
            pipeline->name, pipeline->storage_count, pipeline->texels_count, pipeline->push_bytes,
            limits->maxPerStageDescriptorStorageBuffers, limits->maxPerStageDescriptorSampledImages,
            limits->maxPushConstantsSize);
    return WHIT_OK;
}

static whit_result make_set_layout(struct pipeline *pipeline)
{
    struct device *device = pipeline->device;
    whit_result result = WHIT_OK;
    VkDescriptorSetLayoutBinding *bindings =
        array_alloc_zeroed(pipeline->binding_count, sizeof *bindings);
    if (!bindings)
        return log_failure(&device->log, WHIT_ERROR_MEMORY, "pipeline \"%s\": out of memory",
                           pipeline->name);
    uint32_t count = 0;
    for (uint32_t i = 0; i < pipeline->binding_count; ++i)
        if (pipeline->bindings[i] != BINDING_NONE)
            bindings[count++] = (VkDescriptorSetLayoutBinding){
                .binding = i,
                .descriptorType = descriptor_type(pipeline->bindings[i]),
                .descriptorCount = 1,
                .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
            };
    VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = count,
        .pBindings = bindings,
    };
    VK_TRY(device, vkCreateDescriptorSetLayout(device->vk, &info, NULL, &pipeline->set_layout));
    device_name_object(device, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, (uint64_t)pipeline->set_layout,
                       pipeline->name);
fail:
    free(bindings);
    return result;
}

static whit_result make_layout(struct pipeline *pipeline)
{
    struct device *device = pipeline->device;
    whit_result result = WHIT_OK;
    VkPushConstantRange push = {
        .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        .size = pipeline->push_bytes,
    };
    VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &pipeline->set_layout,
        .pushConstantRangeCount = pipeline->push_bytes > 0 ? 1 : 0,
        .pPushConstantRanges = &push,
    };
    VK_TRY(device, vkCreatePipelineLayout(device->vk, &info, NULL, &pipeline->layout));
    device_name_object(device, VK_OBJECT_TYPE_PIPELINE_LAYOUT, (uint64_t)pipeline->layout,
                       pipeline->name);
fail:
    return result;
}

/* Calls params->rewrite, if there is one. If there is none, out->whole stays NULL. */
static whit_result rewrite_kernel(const struct pipeline_params *params, struct kernel_words *out,
                                  char why[REWRITE_WHY_BYTES])
{
    why[0] = '\0';
    *out = (struct kernel_words){.whole_count = params->spirv_bytes / sizeof *out->whole};
    return params->rewrite ? params->rewrite(params->rewrite_user, params->spirv, out->whole_count,
                                             &out->whole, &out->whole_count, why)
                           : WHIT_OK;
}

static const uint32_t *whole_kernel(const struct pipeline_params *params,
                                    const struct kernel_words *kernel)
{
    return kernel->whole ? kernel->whole : params->spirv;
}

static whit_result specialize_kernel(const struct pipeline_params *params, struct kernel_words *out)
{
    whit_result result = spirv_evaluate(whole_kernel(params, out), out->whole_count, params->spec,
                                        params->spec_count, &out->specialized, &out->word_count);
    if (result == WHIT_OK && !spirv_inspect(out->specialized, out->word_count, &out->info))
        result = WHIT_ERROR_MEMORY;
    return result;
}

static void kernel_words_finish(struct kernel_words *kernel)
{
    free(kernel->whole);
    free(kernel->specialized);
}

static bool specializing_is_off(void)
{
    return environment_on("WHIT_NO_SPECIALIZE");
}

/* Fills the constants in, and drops those of the pipeline's bindings that are not used then. */
static whit_result prepare_kernel(struct pipeline *pipeline, const struct pipeline_params *params,
                                  struct kernel_words *kernel)
{
    struct pipeline_info *info = &pipeline->info;
    char why[REWRITE_WHY_BYTES];
    whit_result result = rewrite_kernel(params, kernel, why);
    if (result == WHIT_ERROR_INPUT) {
        log_error(&pipeline->device->log, "pipeline \"%s\": %s", pipeline->name, why);
        return result;
    }
    if (result == WHIT_OK)
        result = specializing_is_off() ? WHIT_ERROR_INPUT : specialize_kernel(params, kernel);
    if (result == WHIT_ERROR_MEMORY) {
        log_error(&pipeline->device->log, "pipeline \"%s\": out of memory", pipeline->name);
        return result;
    }
    info->specialized = result == WHIT_OK;
    if (!info->specialized) {
        struct spirv_info found;
        if (!specializing_is_off())
            log_warning(&pipeline->device->log,
                        "pipeline \"%s\": its kernel cannot be specialized and goes to the driver "
                        "whole: slower to compile, no slower to run",
                        pipeline->name);
        if (spirv_inspect(whole_kernel(params, kernel), kernel->whole_count, &found))
            kernel->info.instructions = found.instructions;
        kernel->info.bindings = UINT64_MAX;
    }
    info->instructions = kernel->info.instructions;
    for (uint32_t i = 0; i < pipeline->binding_count; ++i) {
        bool used = i >= 64 || (kernel->info.bindings >> i & 1);
        if (!used)
            pipeline->bindings[i] = BINDING_NONE;
        pipeline->storage_count += pipeline->bindings[i] == BINDING_STORAGE;
        pipeline->texels_count += pipeline->bindings[i] == BINDING_TEXELS;
        if (i < 64 && pipeline->bindings[i] != BINDING_NONE)
            info->bindings |= UINT64_C(1) << i;
    }
    return WHIT_OK;
}

/* Specializes a kernel without a pipeline. False: it cannot be specialized. Either way the caller
   calls kernel_words_finish. */
static bool specialize_alone(const struct pipeline_params *params, struct kernel_words *kernel)
{
    char why[REWRITE_WHY_BYTES];
    return rewrite_kernel(params, kernel, why) == WHIT_OK &&
           specialize_kernel(params, kernel) == WHIT_OK;
}

bool pipeline_count(const struct pipeline_params *params, struct pipeline_info *info)
{
    struct kernel_words kernel;
    *info = (struct pipeline_info){0};
    bool counted = specialize_alone(params, &kernel);
    kernel_words_finish(&kernel);
    if (!counted)
        return false;
    *info = (struct pipeline_info){
        .specialized = true,
        .instructions = kernel.info.instructions,
        .bindings = kernel.info.bindings,
    };
    return true;
}

bool pipeline_is_same(const struct pipeline_params *a, const struct pipeline_params *b)
{
    struct kernel_words of_a, of_b;
    bool a_fine = specialize_alone(a, &of_a), b_fine = specialize_alone(b, &of_b);
    bool same = a_fine && b_fine && of_a.word_count == of_b.word_count &&
                memcmp(of_a.specialized, of_b.specialized, of_a.word_count * sizeof(uint32_t)) == 0;
    kernel_words_finish(&of_a);
    kernel_words_finish(&of_b);
    return same;
}

static whit_result make_module(const struct pipeline *pipeline,
                               const struct pipeline_params *params,
                               const struct kernel_words *kernel, VkShaderModule *module)
{
    struct device *device = pipeline->device;
    whit_result result = WHIT_OK;
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize =
            (kernel->specialized ? kernel->word_count : kernel->whole_count) * sizeof(uint32_t),
        .pCode = kernel->specialized ? kernel->specialized : whole_kernel(params, kernel),
    };
    VK_TRY(device, vkCreateShaderModule(device->vk, &info, NULL, module));
    device_name_object(device, VK_OBJECT_TYPE_SHADER_MODULE, (uint64_t)*module, pipeline->name);
fail:
    return result;
}

static whit_result make_pipeline(struct pipeline *pipeline, const struct pipeline_params *params,
                                 const struct kernel_words *kernel)
{
    struct device *device = pipeline->device;
    VkShaderModule module = VK_NULL_HANDLE;
    whit_result result = make_module(pipeline, params, kernel, &module);
    if (result != WHIT_OK)
        return result;
    VkSpecializationMapEntry *entries = array_alloc_zeroed(params->spec_count, sizeof *entries);
    if (!entries) {
        result = log_failure(&device->log, WHIT_ERROR_MEMORY, "pipeline \"%s\": out of memory",
                             pipeline->name);
        goto fail;
    }
    for (uint32_t i = 0; i < params->spec_count; ++i)
        entries[i] =
            (VkSpecializationMapEntry){.constantID = i, .offset = 4 * i, .size = sizeof(uint32_t)};
    VkSpecializationInfo spec = {
        .mapEntryCount = params->spec_count,
        .pMapEntries = entries,
        .dataSize = params->spec_count * sizeof(uint32_t),
        .pData = params->spec,
    };
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .flags = pipeline->asks_statistics ? VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR : 0,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo =
                      params->spec_count > 0 && !kernel->specialized ? &spec : NULL},
        .layout = pipeline->layout,
    };
    ++device->pipelines_made;
    VK_TRY(device,
           vkCreateComputePipelines(device->vk, device->cache, 1, &info, NULL, &pipeline->vk));
    device_name_object(device, VK_OBJECT_TYPE_PIPELINE, (uint64_t)pipeline->vk, pipeline->name);
fail:
    LAYERS_BESIDE(vkDestroyShaderModule(device->vk, module, NULL));
    free(entries);
    return result;
}

/* Keeps a copy of the bindings, which later sets are checked against. */
static bool copy_bindings(struct pipeline *pipeline, const struct pipeline_params *params)
{
    pipeline->bindings = array_alloc_zeroed(params->binding_count, sizeof *pipeline->bindings);
    pipeline->offered = array_alloc_zeroed(params->binding_count, sizeof *pipeline->offered);
    if (!pipeline->bindings || !pipeline->offered)
        return false;
    pipeline->binding_count = params->binding_count;
    for (uint32_t i = 0; i < params->binding_count; ++i) {
        pipeline->bindings[i] = params->bindings[i];
        pipeline->offered[i] = params->bindings[i] != BINDING_NONE;
    }
    return true;
}

/* *same: a kept pipeline of the same code, where there is one; then none is made. */
static whit_result fill_pipeline(struct pipeline *pipeline, const struct pipeline_params *params,
                                 struct pipeline **same)
{
    struct kernel_words kernel = {0};
    whit_result result = check_kernel(pipeline, params);
    if (result != WHIT_OK)
        return result;
    result = prepare_kernel(pipeline, params, &kernel);
    if (result == WHIT_OK && pipeline->info.specialized)
        *same = kept_take_code(pipeline, params, kernel.specialized, kernel.word_count);
    if (*same) {
        kernel_words_finish(&kernel);
        return WHIT_OK;
    }
    if (result == WHIT_OK)
        result = check_limits(pipeline);
    if (result == WHIT_OK)
        result = make_set_layout(pipeline);
    if (result == WHIT_OK)
        result = make_layout(pipeline);
    if (result == WHIT_OK)
        result = make_pipeline(pipeline, params, &kernel);
    kernel_words_finish(&kernel);
    return result;
}

whit_result pipeline_create(struct device *device, const struct pipeline_params *params,
                            struct pipeline **out)
{
    *out = NULL;
    if (kept_take(device, params, !specializing_is_off(), out))
        return WHIT_OK;
    struct pipeline *same = NULL, *pipeline = array_alloc_zeroed(1, sizeof *pipeline);
    whit_result result = pipeline ? WHIT_OK : WHIT_ERROR_MEMORY;
    if (pipeline) {
        pipeline->device = device;
        pipeline->push_bytes = params->push_bytes;
        pipeline->asks_statistics = params->asks_statistics && device->get_executables;
        snprintf(pipeline->name, sizeof pipeline->name, "%s", params->name ? params->name : "");
        if (!copy_bindings(pipeline, params))
            result = WHIT_ERROR_MEMORY;
    }
    if (result != WHIT_OK)
        log_error(&device->log, "out of memory for a pipeline");
    if (result == WHIT_OK)
        result = fill_pipeline(pipeline, params, &same);
    if (result != WHIT_OK || same) {
        pipeline_destroy(pipeline);
        *out = same;
        return result;
    }
    kept_add(pipeline, params, !specializing_is_off());
    *out = pipeline;
    return WHIT_OK;
}

void pipeline_get_info(const struct pipeline *pipeline, struct pipeline_info *info)
{
    *info = pipeline->info;
}

void pipeline_destroy(struct pipeline *pipeline)
{
    if (!pipeline || kept_give_back(pipeline))
        return;
    VkDevice vk = pipeline->device->vk;
    LAYERS_BESIDE(vkDestroyPipeline(vk, pipeline->vk, NULL));
    LAYERS_BESIDE(vkDestroyPipelineLayout(vk, pipeline->layout, NULL));
    LAYERS_BESIDE(vkDestroyDescriptorSetLayout(vk, pipeline->set_layout, NULL));
    free(pipeline->bindings);
    free(pipeline->offered);
    free(pipeline);
}

static whit_result check_buffers(const struct pipeline *pipeline, struct buffer *const *buffers,
                                 uint32_t count)
{
    const whit_log *log = &pipeline->device->log;
    if (count != pipeline->binding_count)
        return log_usage(log, "pipeline \"%s\": %u buffers for %u bindings", pipeline->name, count,
                         pipeline->binding_count);
    for (uint32_t i = 0; i < count; ++i) {
        enum binding_kind kind = pipeline->bindings[i];
        uint32_t use = kind == BINDING_TEXELS ? BUFFER_TEXELS : BUFFER_STORAGE;
        if (kind == BINDING_NONE ? pipeline->offered[i] || !buffers[i]
                                 : buffers[i] && (buffers[i]->uses & use))
            continue;
        return log_usage(log, "pipeline \"%s\": binding %u cannot take buffer \"%s\"",
                         pipeline->name, i, buffers[i] ? buffers[i]->name : "(none)");
    }
    return WHIT_OK;
}

static whit_result make_set(struct binding_set *set, const struct pipeline *pipeline)
{
    struct device *device = set->device;
    whit_result result = WHIT_OK;
    VkDescriptorPoolSize sizes[2];
    uint32_t size_count = 0;
    if (pipeline->storage_count > 0)
        sizes[size_count++] =
            (VkDescriptorPoolSize){VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, pipeline->storage_count};
    if (pipeline->texels_count > 0)
        sizes[size_count++] =
            (VkDescriptorPoolSize){VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, pipeline->texels_count};
    VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 1,
        .poolSizeCount = size_count,
        .pPoolSizes = sizes,
    };
    VK_TRY(device, vkCreateDescriptorPool(device->vk, &pool, NULL, &set->pool));
    device_name_object(device, VK_OBJECT_TYPE_DESCRIPTOR_POOL, (uint64_t)set->pool, pipeline->name);
    VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = set->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &pipeline->set_layout,
    };
    VK_TRY(device, vkAllocateDescriptorSets(device->vk, &info, &set->vk));
    device_name_object(device, VK_OBJECT_TYPE_DESCRIPTOR_SET, (uint64_t)set->vk, pipeline->name);
fail:
    return result;
}

static void write_set(struct binding_set *set, const struct pipeline *pipeline,
                      struct buffer *const *buffers)
{
    for (uint32_t i = 0; i < pipeline->binding_count; ++i) {
        if (pipeline->bindings[i] == BINDING_NONE)
            continue;
        VkDescriptorBufferInfo range = {.buffer = buffers[i]->vk, .range = buffers[i]->size_bytes};
        VkWriteDescriptorSet write = {
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = set->vk,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = descriptor_type(pipeline->bindings[i]),
            .pBufferInfo = &range,
            .pTexelBufferView = &buffers[i]->texels,
        };
        LAYERS_BESIDE(vkUpdateDescriptorSets(set->device->vk, 1, &write, 0, NULL));
    }
}

whit_result binding_set_create(struct pipeline *pipeline, struct buffer *const *buffers,
                               uint32_t count, struct binding_set **out)
{
    *out = NULL;
    struct device *device = pipeline->device;
    if (device->lost)
        return WHIT_ERROR_DEVICE;
    whit_result result = check_buffers(pipeline, buffers, count);
    if (result != WHIT_OK)
        return result;
    struct binding_set *set = array_alloc_zeroed(1, sizeof *set);
    if (!set)
        return log_failure(&device->log, WHIT_ERROR_MEMORY, "out of memory for a binding set");
    set->device = device;
    if (pipeline->storage_count + pipeline->texels_count > 0) {
        result = make_set(set, pipeline);
        if (result != WHIT_OK) {
            binding_set_destroy(set);
            return result;
        }
        write_set(set, pipeline, buffers);
    }
    *out = set;
    return WHIT_OK;
}

void binding_set_destroy(struct binding_set *set)
{
    if (!set)
        return;
    LAYERS_BESIDE(vkDestroyDescriptorPool(set->device->vk, set->pool, NULL));
    free(set);
}
