whit_module(device
  SOURCES instance.c device.c vulkan.c layers.c cache.c buffer.c pipeline.c kept.c
    evaluate.c evaluate_read.c evaluate_constants.c evaluate_memory.c evaluate_loops.c evaluate_output.c spirv_ops.c inspect.c
    pipeline_statistics.c commands.c stretch.c swapchain.c swapchain_show.c
  LINK whit_base Vulkan::Vulkan)

