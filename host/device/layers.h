/* A lock for calls of Vulkan while other threads create devices. Vulkan allows that, but
   VK_LAYER_KHRONOS_validation does not: it looks each call's device up in a table without a lock,
   into which vkCreateInstance and vkCreateDevice write (Vulkan-ValidationLayers, issue 4391; seen
   as a segmentation fault with 1.3.239 of Debian 12). So while layers check, calls that create or
   destroy an instance or a device run alone; all other calls share the lock. Without validation
   nothing is locked. Included by device/vulkan.h. */
#ifndef DEVICE_LAYERS_H
#define DEVICE_LAYERS_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Turns the locking on; call it before the first instance with validation is created. */
void layers_expect(void);
/* Take the lock, shared or alone. They return whether it was taken, which layers_leave gets. Not
   recursive. */
bool layers_enter(void);
bool layers_enter_alone(void);
void layers_leave(bool entered);

#ifdef __cplusplus
}
#endif

#define LAYERS_LOCKED(enter, ...)                                                                  \
    __extension__({                                                                                \
        __attribute__((cleanup(layers_cleanup), unused)) bool locked_ = enter();                   \
        __VA_ARGS__;                                                                               \
    })
#define LAYERS_ALONE(...)  LAYERS_LOCKED(layers_enter_alone, __VA_ARGS__)
#define LAYERS_BESIDE(...) LAYERS_LOCKED(layers_enter, __VA_ARGS__)

static inline void layers_cleanup(bool *locked)
{
    layers_leave(*locked);
}

#define vkCreateInstance(...)             LAYERS_ALONE(vkCreateInstance(__VA_ARGS__))
#define vkDestroyInstance(...)            LAYERS_ALONE(vkDestroyInstance(__VA_ARGS__))
#define vkCreateDevice(...)               LAYERS_ALONE(vkCreateDevice(__VA_ARGS__))
#define vkDestroyDevice(...)              LAYERS_ALONE(vkDestroyDevice(__VA_ARGS__))

#define vkAcquireNextImageKHR(...)        LAYERS_BESIDE(vkAcquireNextImageKHR(__VA_ARGS__))
#define vkAllocateCommandBuffers(...)     LAYERS_BESIDE(vkAllocateCommandBuffers(__VA_ARGS__))
#define vkAllocateDescriptorSets(...)     LAYERS_BESIDE(vkAllocateDescriptorSets(__VA_ARGS__))
#define vkAllocateMemory(...)             LAYERS_BESIDE(vkAllocateMemory(__VA_ARGS__))
#define vkBeginCommandBuffer(...)         LAYERS_BESIDE(vkBeginCommandBuffer(__VA_ARGS__))
#define vkBindBufferMemory(...)           LAYERS_BESIDE(vkBindBufferMemory(__VA_ARGS__))
#define vkCmdBeginRenderPass(...)         LAYERS_BESIDE(vkCmdBeginRenderPass(__VA_ARGS__))
#define vkCmdBindDescriptorSets(...)      LAYERS_BESIDE(vkCmdBindDescriptorSets(__VA_ARGS__))
#define vkCmdBindPipeline(...)            LAYERS_BESIDE(vkCmdBindPipeline(__VA_ARGS__))
#define vkCmdClearColorImage(...)         LAYERS_BESIDE(vkCmdClearColorImage(__VA_ARGS__))
#define vkCmdCopyBuffer(...)              LAYERS_BESIDE(vkCmdCopyBuffer(__VA_ARGS__))
#define vkCmdCopyBufferToImage(...)       LAYERS_BESIDE(vkCmdCopyBufferToImage(__VA_ARGS__))
#define vkCmdCopyImageToBuffer(...)       LAYERS_BESIDE(vkCmdCopyImageToBuffer(__VA_ARGS__))
#define vkCmdDispatch(...)                LAYERS_BESIDE(vkCmdDispatch(__VA_ARGS__))
#define vkCmdDispatchIndirect(...)        LAYERS_BESIDE(vkCmdDispatchIndirect(__VA_ARGS__))
#define vkCmdEndRenderPass(...)           LAYERS_BESIDE(vkCmdEndRenderPass(__VA_ARGS__))
#define vkCmdFillBuffer(...)              LAYERS_BESIDE(vkCmdFillBuffer(__VA_ARGS__))
#define vkCmdPipelineBarrier(...)         LAYERS_BESIDE(vkCmdPipelineBarrier(__VA_ARGS__))
#define vkCmdPushConstants(...)           LAYERS_BESIDE(vkCmdPushConstants(__VA_ARGS__))
#define vkCmdResetQueryPool(...)          LAYERS_BESIDE(vkCmdResetQueryPool(__VA_ARGS__))
#define vkCmdWriteTimestamp(...)          LAYERS_BESIDE(vkCmdWriteTimestamp(__VA_ARGS__))
#define vkCreateBuffer(...)               LAYERS_BESIDE(vkCreateBuffer(__VA_ARGS__))
#define vkCreateBufferView(...)           LAYERS_BESIDE(vkCreateBufferView(__VA_ARGS__))
#define vkCreateCommandPool(...)          LAYERS_BESIDE(vkCreateCommandPool(__VA_ARGS__))
#define vkCreateComputePipelines(...)     LAYERS_BESIDE(vkCreateComputePipelines(__VA_ARGS__))
#define vkCreateDescriptorPool(...)       LAYERS_BESIDE(vkCreateDescriptorPool(__VA_ARGS__))
#define vkCreateDescriptorSetLayout(...)  LAYERS_BESIDE(vkCreateDescriptorSetLayout(__VA_ARGS__))
#define vkCreateFence(...)                LAYERS_BESIDE(vkCreateFence(__VA_ARGS__))
#define vkCreateFramebuffer(...)          LAYERS_BESIDE(vkCreateFramebuffer(__VA_ARGS__))
#define vkCreateImageView(...)            LAYERS_BESIDE(vkCreateImageView(__VA_ARGS__))
#define vkCreatePipelineCache(...)        LAYERS_BESIDE(vkCreatePipelineCache(__VA_ARGS__))
#define vkCreatePipelineLayout(...)       LAYERS_BESIDE(vkCreatePipelineLayout(__VA_ARGS__))
#define vkCreateQueryPool(...)            LAYERS_BESIDE(vkCreateQueryPool(__VA_ARGS__))
#define vkCreateRenderPass(...)           LAYERS_BESIDE(vkCreateRenderPass(__VA_ARGS__))
#define vkCreateSemaphore(...)            LAYERS_BESIDE(vkCreateSemaphore(__VA_ARGS__))
#define vkCreateShaderModule(...)         LAYERS_BESIDE(vkCreateShaderModule(__VA_ARGS__))
#define vkCreateSwapchainKHR(...)         LAYERS_BESIDE(vkCreateSwapchainKHR(__VA_ARGS__))
#define vkDestroyBuffer(...)              LAYERS_BESIDE(vkDestroyBuffer(__VA_ARGS__))
#define vkDestroyBufferView(...)          LAYERS_BESIDE(vkDestroyBufferView(__VA_ARGS__))
#define vkDestroyCommandPool(...)         LAYERS_BESIDE(vkDestroyCommandPool(__VA_ARGS__))
#define vkDestroyDescriptorPool(...)      LAYERS_BESIDE(vkDestroyDescriptorPool(__VA_ARGS__))
#define vkDestroyDescriptorSetLayout(...) LAYERS_BESIDE(vkDestroyDescriptorSetLayout(__VA_ARGS__))
#define vkDestroyFence(...)               LAYERS_BESIDE(vkDestroyFence(__VA_ARGS__))
#define vkDestroyFramebuffer(...)         LAYERS_BESIDE(vkDestroyFramebuffer(__VA_ARGS__))
#define vkDestroyImageView(...)           LAYERS_BESIDE(vkDestroyImageView(__VA_ARGS__))
#define vkDestroyPipeline(...)            LAYERS_BESIDE(vkDestroyPipeline(__VA_ARGS__))
#define vkDestroyPipelineCache(...)       LAYERS_BESIDE(vkDestroyPipelineCache(__VA_ARGS__))
#define vkDestroyPipelineLayout(...)      LAYERS_BESIDE(vkDestroyPipelineLayout(__VA_ARGS__))
#define vkDestroyQueryPool(...)           LAYERS_BESIDE(vkDestroyQueryPool(__VA_ARGS__))
#define vkDestroyRenderPass(...)          LAYERS_BESIDE(vkDestroyRenderPass(__VA_ARGS__))
#define vkDestroySemaphore(...)           LAYERS_BESIDE(vkDestroySemaphore(__VA_ARGS__))
#define vkDestroyShaderModule(...)        LAYERS_BESIDE(vkDestroyShaderModule(__VA_ARGS__))
#define vkDestroySurfaceKHR(...)          LAYERS_BESIDE(vkDestroySurfaceKHR(__VA_ARGS__))
#define vkDestroySwapchainKHR(...)        LAYERS_BESIDE(vkDestroySwapchainKHR(__VA_ARGS__))
#define vkDeviceWaitIdle(...)             LAYERS_BESIDE(vkDeviceWaitIdle(__VA_ARGS__))
#define vkEndCommandBuffer(...)           LAYERS_BESIDE(vkEndCommandBuffer(__VA_ARGS__))
#define vkEnumerateDeviceExtensionProperties(...)                                                  \
    LAYERS_BESIDE(vkEnumerateDeviceExtensionProperties(__VA_ARGS__))
#define vkEnumeratePhysicalDevices(...)    LAYERS_BESIDE(vkEnumeratePhysicalDevices(__VA_ARGS__))
#define vkFreeMemory(...)                  LAYERS_BESIDE(vkFreeMemory(__VA_ARGS__))
#define vkGetBufferMemoryRequirements(...) LAYERS_BESIDE(vkGetBufferMemoryRequirements(__VA_ARGS__))
#define vkGetDeviceProcAddr(...)           LAYERS_BESIDE(vkGetDeviceProcAddr(__VA_ARGS__))
#define vkGetDeviceQueue(...)              LAYERS_BESIDE(vkGetDeviceQueue(__VA_ARGS__))
#define vkGetInstanceProcAddr(...)         LAYERS_BESIDE(vkGetInstanceProcAddr(__VA_ARGS__))
#define vkGetPhysicalDeviceFeatures(...)   LAYERS_BESIDE(vkGetPhysicalDeviceFeatures(__VA_ARGS__))
#define vkGetPhysicalDeviceFormatProperties(...)                                                   \
    LAYERS_BESIDE(vkGetPhysicalDeviceFormatProperties(__VA_ARGS__))
#define vkGetPhysicalDeviceMemoryProperties(...)                                                   \
    LAYERS_BESIDE(vkGetPhysicalDeviceMemoryProperties(__VA_ARGS__))
#define vkGetPhysicalDeviceProperties(...) LAYERS_BESIDE(vkGetPhysicalDeviceProperties(__VA_ARGS__))
#define vkGetPhysicalDeviceProperties2(...)                                                        \
    LAYERS_BESIDE(vkGetPhysicalDeviceProperties2(__VA_ARGS__))
#define vkGetPhysicalDeviceQueueFamilyProperties(...)                                              \
    LAYERS_BESIDE(vkGetPhysicalDeviceQueueFamilyProperties(__VA_ARGS__))
#define vkGetPhysicalDeviceSurfaceCapabilitiesKHR(...)                                             \
    LAYERS_BESIDE(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(__VA_ARGS__))
#define vkGetPhysicalDeviceSurfaceFormatsKHR(...)                                                  \
    LAYERS_BESIDE(vkGetPhysicalDeviceSurfaceFormatsKHR(__VA_ARGS__))
#define vkGetPhysicalDeviceSurfacePresentModesKHR(...)                                             \
    LAYERS_BESIDE(vkGetPhysicalDeviceSurfacePresentModesKHR(__VA_ARGS__))
#define vkGetPhysicalDeviceSurfaceSupportKHR(...)                                                  \
    LAYERS_BESIDE(vkGetPhysicalDeviceSurfaceSupportKHR(__VA_ARGS__))
#define vkGetPipelineCacheData(...)  LAYERS_BESIDE(vkGetPipelineCacheData(__VA_ARGS__))
#define vkGetQueryPoolResults(...)   LAYERS_BESIDE(vkGetQueryPoolResults(__VA_ARGS__))
#define vkGetSwapchainImagesKHR(...) LAYERS_BESIDE(vkGetSwapchainImagesKHR(__VA_ARGS__))
#define vkMapMemory(...)             LAYERS_BESIDE(vkMapMemory(__VA_ARGS__))
#define vkQueuePresentKHR(...)       LAYERS_BESIDE(vkQueuePresentKHR(__VA_ARGS__))
#define vkQueueSubmit(...)           LAYERS_BESIDE(vkQueueSubmit(__VA_ARGS__))
#define vkQueueWaitIdle(...)         LAYERS_BESIDE(vkQueueWaitIdle(__VA_ARGS__))
#define vkResetCommandPool(...)      LAYERS_BESIDE(vkResetCommandPool(__VA_ARGS__))
#define vkResetFences(...)           LAYERS_BESIDE(vkResetFences(__VA_ARGS__))
#define vkUpdateDescriptorSets(...)  LAYERS_BESIDE(vkUpdateDescriptorSets(__VA_ARGS__))
#define vkWaitForFences(...)         LAYERS_BESIDE(vkWaitForFences(__VA_ARGS__))

#endif
