/* whit-ray-pipeline TRIANGLES DEVICE: the side of the driver's own ray tracing
   (VK_KHR_ray_tracing_pipeline) in `whit bench rays` (peer_side.h). DEVICE: its number, as in
   `whit devices`. One way to trace: single. Times are processor time of all threads, and the
   device's own time from rays in device memory to hits in device memory.

   Triangles are one geometry of a bottom-level acceleration structure, built for fast traces, in a
   top-level one with a single instance. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <spirv/ray_pipeline_rchit.h>
#include <spirv/ray_pipeline_rgen.h>
#include <spirv/ray_pipeline_rmiss.h>
#include <vulkan/vulkan.h>

#include "bench/peer_side.h"

enum { DEVICES_MAX = 64, FAMILIES_MAX = 32, GROUPS = 3 };
static const uint64_t wait_ns = 600000000000u;
static const char *const extensions[] = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                         VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
                                         VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
enum { EXTENSIONS = sizeof extensions / sizeof *extensions };

/* A buffer with memory of its own. */
struct block {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceAddress address;
    void *mapped; /* NULL: memory of the device */
};

/* gl_RayFlagsTerminateOnFirstHitEXT and gl_RayFlagsSkipClosestHitShaderEXT. */
enum { FIRST_HIT = 4, NO_CLOSEST_SHADER = 8 };

/* The push constants of ray_pipeline.rgen. */
struct push {
    VkDeviceAddress rays, hits, tree;
    uint32_t flags;
};

/* What a miss, or a hit, leaves (ray_pipeline.rmiss, .rchit). */
struct found {
    float t, u, v;
    uint32_t triangle;
};

struct driver {
    struct peer_side side;
    VkInstance instance;
    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR groups;
    VkPhysicalDeviceAccelerationStructurePropertiesKHR trees;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    bool has_timestamps;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
    VkQueryPool times;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkAccelerationStructureKHR bottom, top;
    struct block bottom_block, top_block, table, rays, hits;
    VkDeviceAddress top_address;
    VkStridedDeviceAddressRegionKHR regions[GROUPS];
};

/* These extend Vulkan, and the loader does not export them. */
#define CALLS(CALL)                                                                                \
    CALL(vkGetAccelerationStructureBuildSizesKHR)                                                  \
    CALL(vkCreateAccelerationStructureKHR)                                                         \
    CALL(vkDestroyAccelerationStructureKHR)                                                        \
    CALL(vkGetAccelerationStructureDeviceAddressKHR)                                               \
    CALL(vkCmdBuildAccelerationStructuresKHR)                                                      \
    CALL(vkCreateRayTracingPipelinesKHR)                                                           \
    CALL(vkGetRayTracingShaderGroupHandlesKHR)                                                     \
    CALL(vkCmdTraceRaysKHR)
#define DECLARE(NAME) static PFN_##NAME call_##NAME;
CALLS(DECLARE)

static void check_at(const struct driver *driver, VkResult vk, const char *call)
{
    if (vk != VK_SUCCESS)
        peer_fail(&driver->side, "%s fails with VkResult %d", call, (int)vk);
}
#define CHECK(driver, call) check_at(driver, call, #call)

/* ---- The device ---- */

/* Ends the program where this machine lacks what it needs, which is no error. */
_Noreturn static void lacks(const char *device, const char *what)
{
    printf("none %s lacks %s\n", device, what);
    exit(0);
}

static void open_instance(struct driver *driver, unsigned long index)
{
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "whit-ray-pipeline",
                                           .apiVersion = VK_API_VERSION_1_2};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pApplicationInfo = &application};
    VkPhysicalDevice found[DEVICES_MAX];
    uint32_t count = DEVICES_MAX;
    CHECK(driver, vkCreateInstance(&info, NULL, &driver->instance));
    CHECK(driver, vkEnumeratePhysicalDevices(driver->instance, &count, found));
    if (index >= count)
        peer_fail(&driver->side, "there is no Vulkan device %lu", index);
    driver->physical = found[index];
    driver->trees = (VkPhysicalDeviceAccelerationStructurePropertiesKHR){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    driver->groups = (VkPhysicalDeviceRayTracingPipelinePropertiesKHR){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR,
        .pNext = &driver->trees};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver->groups};
    vkGetPhysicalDeviceProperties2(driver->physical, &properties);
    vkGetPhysicalDeviceMemoryProperties(driver->physical, &driver->memory);
    driver->properties = properties.properties;
}

static void require_extensions(const struct driver *driver)
{
    uint32_t count = 0;
    CHECK(driver, vkEnumerateDeviceExtensionProperties(driver->physical, NULL, &count, NULL));
    VkExtensionProperties *list = peer_alloc(&driver->side, count, sizeof *list);
    CHECK(driver, vkEnumerateDeviceExtensionProperties(driver->physical, NULL, &count, list));
    for (uint32_t i = 0; i < EXTENSIONS; ++i) {
        uint32_t at = 0;
        while (at < count && strcmp(list[at].extensionName, extensions[i]) != 0)
            ++at;
        if (at == count)
            lacks(driver->properties.deviceName, extensions[i]);
    }
    free(list);
}

static void find_family(struct driver *driver)
{
    VkQueueFamilyProperties families[FAMILIES_MAX];
    uint32_t count = FAMILIES_MAX;
    vkGetPhysicalDeviceQueueFamilyProperties(driver->physical, &count, families);
    while (driver->family < count && !(families[driver->family].queueFlags & VK_QUEUE_COMPUTE_BIT))
        ++driver->family;
    if (driver->family == count)
        lacks(driver->properties.deviceName, "a queue that computes");
    driver->has_timestamps = families[driver->family].timestampValidBits > 0;
}

static void open_device(struct driver *driver)
{
    const float priority = 1.0f;
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipelines = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR,
        .rayTracingPipeline = VK_TRUE};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR trees = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
        .pNext = &pipelines,
        .accelerationStructure = VK_TRUE};
    VkPhysicalDeviceVulkan12Features features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .pNext = &trees,
        .bufferDeviceAddress = VK_TRUE};
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = driver->family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = EXTENSIONS,
                                     .ppEnabledExtensionNames = extensions};
    CHECK(driver, vkCreateDevice(driver->physical, &info, NULL, &driver->device));
    vkGetDeviceQueue(driver->device, driver->family, 0, &driver->queue);
#define FIND(NAME) call_##NAME = (PFN_##NAME)vkGetDeviceProcAddr(driver->device, #NAME);
    CALLS(FIND)
#undef FIND
}

static void make_commands(struct driver *driver)
{
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = driver->family};
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    const VkQueryPoolCreateInfo times = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = 2};
    CHECK(driver, vkCreateCommandPool(driver->device, &pool, NULL, &driver->pool));
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = driver->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1};
    CHECK(driver, vkAllocateCommandBuffers(driver->device, &commands, &driver->commands));
    CHECK(driver, vkCreateFence(driver->device, &fence, NULL, &driver->fence));
    CHECK(driver, vkCreateQueryPool(driver->device, &times, NULL, &driver->times));
}

static void begin(const struct driver *driver)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    CHECK(driver, vkBeginCommandBuffer(driver->commands, &info));
}

/* All that was written before is seen by all that follows, and by the host. */
static void add_barrier(const struct driver *driver)
{
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                     .dstAccessMask =
                                         VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    vkCmdPipelineBarrier(driver->commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &barrier, 0, NULL, 0, NULL);
}

static void end(const struct driver *driver)
{
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &driver->commands};
    add_barrier(driver);
    CHECK(driver, vkEndCommandBuffer(driver->commands));
    CHECK(driver, vkQueueSubmit(driver->queue, 1, &info, driver->fence));
    CHECK(driver, vkWaitForFences(driver->device, 1, &driver->fence, VK_TRUE, wait_ns));
    CHECK(driver, vkResetFences(driver->device, 1, &driver->fence));
}

/* ---- Buffers ---- */

static uint32_t find_memory(const struct driver *driver, uint32_t allowed,
                            VkMemoryPropertyFlags wanted)
{
    for (uint32_t i = 0; i < driver->memory.memoryTypeCount; ++i)
        if ((allowed >> i & 1) && (driver->memory.memoryTypes[i].propertyFlags & wanted) == wanted)
            return i;
    peer_fail(&driver->side, "the device has no memory of the kind %#x", (unsigned)wanted);
}

static struct block make_block(const struct driver *driver, uint64_t bytes,
                               VkBufferUsageFlags usage, bool mapped)
{
    struct block block = {0};
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                     .size = bytes ? bytes : 1,
                                     .usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    const VkMemoryAllocateFlagsInfo flags = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                             .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    VkMemoryRequirements needs;
    CHECK(driver, vkCreateBuffer(driver->device, &info, NULL, &block.buffer));
    vkGetBufferMemoryRequirements(driver->device, block.buffer, &needs);
    const VkMemoryAllocateInfo memory = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .pNext = &flags,
        .allocationSize = needs.size,
        .memoryTypeIndex = find_memory(driver, needs.memoryTypeBits,
                                       mapped ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                    VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                              : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    CHECK(driver, vkAllocateMemory(driver->device, &memory, NULL, &block.memory));
    CHECK(driver, vkBindBufferMemory(driver->device, block.buffer, block.memory, 0));
    if (mapped)
        CHECK(driver,
              vkMapMemory(driver->device, block.memory, 0, VK_WHOLE_SIZE, 0, &block.mapped));
    const VkBufferDeviceAddressInfo address = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, .buffer = block.buffer};
    block.address = vkGetBufferDeviceAddress(driver->device, &address);
    return block;
}

static void free_block(const struct driver *driver, struct block *block)
{
    vkDestroyBuffer(driver->device, block->buffer, NULL);
    vkFreeMemory(driver->device, block->memory, NULL);
    *block = (struct block){0};
}

static void copy(const struct driver *driver, const struct block *from, const struct block *to,
                 uint64_t bytes)
{
    const VkBufferCopy region = {.size = bytes};
    begin(driver);
    if (bytes)
        vkCmdCopyBuffer(driver->commands, from->buffer, to->buffer, 1, &region);
    end(driver);
}

/* Makes a buffer in memory of the device, with these contents. */
static struct block upload(const struct driver *driver, const void *data, uint64_t bytes,
                           VkBufferUsageFlags usage)
{
    struct block staging = make_block(driver, bytes, 0, true);
    struct block block = make_block(driver, bytes, usage, false);
    memcpy(staging.mapped, data, (size_t)bytes);
    copy(driver, &staging, &block, bytes);
    free_block(driver, &staging);
    return block;
}

/* ---- Acceleration structures ---- */

static VkAccelerationStructureKHR
build_structure(const struct driver *driver, VkAccelerationStructureTypeKHR type,
                const VkAccelerationStructureGeometryKHR *geometry, uint32_t count,
                struct block *block)
{
    VkAccelerationStructureBuildGeometryInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
        .type = type,
        .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR,
        .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
        .geometryCount = 1,
        .pGeometries = geometry};
    VkAccelerationStructureBuildSizesInfoKHR sizes = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    call_vkGetAccelerationStructureBuildSizesKHR(
        driver->device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &count, &sizes);
    *block = make_block(driver, sizes.accelerationStructureSize,
                        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR, false);
    const VkAccelerationStructureCreateInfoKHR create = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
        .buffer = block->buffer,
        .size = sizes.accelerationStructureSize,
        .type = type};
    CHECK(driver, call_vkCreateAccelerationStructureKHR(driver->device, &create, NULL,
                                                        &info.dstAccelerationStructure));
    uint64_t align = driver->trees.minAccelerationStructureScratchOffsetAlignment;
    struct block scratch = make_block(driver, sizes.buildScratchSize + align,
                                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, false);
    info.scratchData.deviceAddress = (scratch.address + align - 1) / align * align;
    const VkAccelerationStructureBuildRangeInfoKHR range = {.primitiveCount = count};
    const VkAccelerationStructureBuildRangeInfoKHR *const ranges = &range;
    begin(driver);
    call_vkCmdBuildAccelerationStructuresKHR(driver->commands, 1, &info, &ranges);
    end(driver);
    free_block(driver, &scratch);
    return info.dstAccelerationStructure;
}

static VkDeviceAddress structure_address(const struct driver *driver,
                                         VkAccelerationStructureKHR structure)
{
    const VkAccelerationStructureDeviceAddressInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
        .accelerationStructure = structure};
    return call_vkGetAccelerationStructureDeviceAddressKHR(driver->device, &info);
}

static void build_bottom(struct driver *driver)
{
    enum { BYTES = sizeof driver->side.triangles->vertices };
    uint32_t count = (uint32_t)driver->side.triangle_count;
    uint8_t *positions = peer_alloc(&driver->side, count, BYTES);
    for (uint32_t i = 0; i < count; ++i)
        memcpy(positions + (size_t)i * BYTES, driver->side.triangles[i].vertices, BYTES);
    struct block vertices =
        upload(driver, positions, (uint64_t)count * BYTES,
               VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
    free(positions);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR,
        .geometry.triangles =
            {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR,
             .vertexFormat = VK_FORMAT_R32G32B32_SFLOAT,
             .vertexData.deviceAddress = vertices.address,
             .vertexStride = 12,
             .maxVertex = 3 * count - 1,
             .indexType = VK_INDEX_TYPE_NONE_KHR},
        .flags = VK_GEOMETRY_OPAQUE_BIT_KHR};
    driver->bottom = build_structure(driver, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
                                     &geometry, count, &driver->bottom_block);
    free_block(driver, &vertices);
}

static void build_top(struct driver *driver)
{
    const VkAccelerationStructureInstanceKHR instance = {
        .transform.matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
        .mask = 0xff,
        .flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR,
        .accelerationStructureReference = structure_address(driver, driver->bottom)};
    struct block instances =
        upload(driver, &instance, sizeof instance,
               VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
        .geometry.instances = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
            .data.deviceAddress = instances.address}};
    driver->top = build_structure(driver, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, &geometry,
                                  1, &driver->top_block);
    driver->top_address = structure_address(driver, driver->top);
    free_block(driver, &instances);
}

/* ---- The pipeline ---- */

static VkPipelineShaderStageCreateInfo make_stage(const struct driver *driver,
                                                  VkShaderStageFlagBits stage,
                                                  const uint32_t *words, size_t bytes)
{
    VkPipelineShaderStageCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                            .stage = stage,
                                            .pName = "main"};
    const VkShaderModuleCreateInfo module = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = bytes, .pCode = words};
    CHECK(driver, vkCreateShaderModule(driver->device, &module, NULL, &info.module));
    return info;
}

static VkRayTracingShaderGroupCreateInfoKHR make_group(uint32_t general, uint32_t closest)
{
    return (VkRayTracingShaderGroupCreateInfoKHR){
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
        .type = general == VK_SHADER_UNUSED_KHR
                    ? VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR
                    : VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR,
        .generalShader = general,
        .closestHitShader = closest,
        .anyHitShader = VK_SHADER_UNUSED_KHR,
        .intersectionShader = VK_SHADER_UNUSED_KHR};
}

static void make_pipeline(struct driver *driver)
{
    const VkPipelineShaderStageCreateInfo stages[GROUPS] = {
        make_stage(driver, VK_SHADER_STAGE_RAYGEN_BIT_KHR, ray_pipeline_rgen,
                   sizeof ray_pipeline_rgen),
        make_stage(driver, VK_SHADER_STAGE_MISS_BIT_KHR, ray_pipeline_rmiss,
                   sizeof ray_pipeline_rmiss),
        make_stage(driver, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, ray_pipeline_rchit,
                   sizeof ray_pipeline_rchit)};
    const VkRayTracingShaderGroupCreateInfoKHR groups[GROUPS] = {
        make_group(0, VK_SHADER_UNUSED_KHR), make_group(1, VK_SHADER_UNUSED_KHR),
        make_group(VK_SHADER_UNUSED_KHR, 2)};
    const VkPushConstantRange push = {.stageFlags = VK_SHADER_STAGE_RAYGEN_BIT_KHR,
                                      .size = sizeof(struct push)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &push};
    CHECK(driver, vkCreatePipelineLayout(driver->device, &layout, NULL, &driver->layout));
    const VkRayTracingPipelineCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR,
        .stageCount = GROUPS,
        .pStages = stages,
        .groupCount = GROUPS,
        .pGroups = groups,
        .maxPipelineRayRecursionDepth = 1,
        .layout = driver->layout};
    CHECK(driver,
          call_vkCreateRayTracingPipelinesKHR(driver->device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1,
                                              &info, NULL, &driver->pipeline));
    for (uint32_t i = 0; i < GROUPS; ++i)
        vkDestroyShaderModule(driver->device, stages[i].module, NULL);
}

/* Each group is a table of one record, at the alignment that tables need. */
static void make_table(struct driver *driver)
{
    enum { ROOM = 1024 };
    uint32_t size = driver->groups.shaderGroupHandleSize,
             align = driver->groups.shaderGroupBaseAlignment;
    uint32_t stride = (size + align - 1) / align * align;
    uint8_t handles[ROOM], table[ROOM] = {0};
    if (GROUPS * stride > ROOM)
        peer_fail(&driver->side, "the device has shader groups of %u bytes", stride);
    CHECK(driver, call_vkGetRayTracingShaderGroupHandlesKHR(
                      driver->device, driver->pipeline, 0, GROUPS, (size_t)GROUPS * size, handles));
    for (uint32_t i = 0; i < GROUPS; ++i)
        memcpy(table + i * stride, handles + i * size, size);
    driver->table = upload(driver, table, (uint64_t)GROUPS * stride,
                           VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR);
    if (driver->table.address % align)
        peer_fail(&driver->side, "a buffer is not aligned to the %u bytes of shader groups", align);
    for (uint32_t i = 0; i < GROUPS; ++i)
        driver->regions[i] = (VkStridedDeviceAddressRegionKHR){
            .deviceAddress = driver->table.address + (uint64_t)i * stride,
            .stride = stride,
            .size = stride};
}

/* ---- Rays ---- */

static void load(void *user)
{
    struct driver *driver = user;
    const struct peer_side *side = &driver->side;
    free_block(driver, &driver->rays);
    free_block(driver, &driver->hits);
    driver->rays = upload(driver, side->rays, side->count * sizeof *side->rays,
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    driver->hits = make_block(driver, side->count * sizeof(struct found),
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, false);
}

static void record_trace(const struct driver *driver)
{
    const VkStridedDeviceAddressRegionKHR none = {0};
    const struct push push = {.rays = driver->rays.address,
                              .hits = driver->hits.address,
                              .tree = driver->top_address,
                              .flags = driver->side.any ? FIRST_HIT | NO_CLOSEST_SHADER : 0};
    vkCmdResetQueryPool(driver->commands, driver->times, 0, 2);
    vkCmdBindPipeline(driver->commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, driver->pipeline);
    vkCmdPushConstants(driver->commands, driver->layout, VK_SHADER_STAGE_RAYGEN_BIT_KHR, 0,
                       sizeof push, &push);
    if (driver->has_timestamps)
        vkCmdWriteTimestamp(driver->commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, driver->times, 0);
    call_vkCmdTraceRaysKHR(driver->commands, &driver->regions[0], &driver->regions[1],
                           &driver->regions[2], &none, (uint32_t)driver->side.count, 1, 1);
    if (driver->has_timestamps)
        vkCmdWriteTimestamp(driver->commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, driver->times,
                            1);
}

static void fetch_hits(const struct driver *driver)
{
    uint64_t bytes = driver->side.count * sizeof(struct found);
    struct block staging = make_block(driver, bytes, 0, true);
    const struct found *found = staging.mapped;
    copy(driver, &driver->hits, &staging, bytes);
    for (uint64_t i = 0; i < driver->side.count; ++i)
        peer_keep_hit(&driver->side, i, found[i].t, found[i].triangle);
    free_block(driver, &staging);
}

static bool trace(void *user, const char *way, bool back, bool coherent, double ms[2])
{
    struct driver *driver = user;
    uint64_t ticks[2] = {0};
    (void)coherent;
    if (back || strcmp(way, "single") != 0)
        return false;
    double wall = peer_wall_ms(), cpu = peer_cpu_ms();
    begin(driver);
    if (driver->side.count)
        record_trace(driver);
    end(driver);
    ms[0] = peer_cpu_ms() - cpu;
    ms[1] = peer_wall_ms() - wall;
    if (driver->has_timestamps && driver->side.count) {
        CHECK(driver, vkGetQueryPoolResults(driver->device, driver->times, 0, 2, sizeof ticks,
                                            ticks, sizeof ticks[0],
                                            VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
        ms[1] = (double)(ticks[1] - ticks[0]) * (double)driver->properties.limits.timestampPeriod *
                1e-6;
    }
    fetch_hits(driver);
    return true;
}

/* ---- The program ---- */

static void close_all(struct driver *driver)
{
    struct block *blocks[] = {&driver->bottom_block, &driver->top_block, &driver->table,
                              &driver->rays, &driver->hits};
    call_vkDestroyAccelerationStructureKHR(driver->device, driver->top, NULL);
    call_vkDestroyAccelerationStructureKHR(driver->device, driver->bottom, NULL);
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; ++i)
        free_block(driver, blocks[i]);
    vkDestroyPipeline(driver->device, driver->pipeline, NULL);
    vkDestroyPipelineLayout(driver->device, driver->layout, NULL);
    vkDestroyQueryPool(driver->device, driver->times, NULL);
    vkDestroyFence(driver->device, driver->fence, NULL);
    vkDestroyCommandPool(driver->device, driver->pool, NULL);
    vkDestroyDevice(driver->device, NULL);
    vkDestroyInstance(driver->instance, NULL);
}

int main(int argc, char **argv)
{
    static struct driver driver = {
        .side = {.name = "whit-ray-pipeline", .load = load, .trace = trace}};
    driver.side.user = &driver;
    if (argc != 3)
        peer_fail(&driver.side, "usage: whit-ray-pipeline TRIANGLES DEVICE, see `whit bench rays "
                                "--help`");
    open_instance(&driver, strtoul(argv[2], NULL, 10));
    require_extensions(&driver);
    find_family(&driver);
    peer_read_triangles(&driver.side, argv[1]);
    open_device(&driver);
    make_commands(&driver);
    build_bottom(&driver);
    build_top(&driver);
    make_pipeline(&driver);
    make_table(&driver);
    peer_serve(&driver.side, driver.properties.deviceName);
    close_all(&driver);
    return 0;
}
