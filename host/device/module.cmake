whit_module(device
  SOURCES instance.c device.c layers.c cache.c kernel_cache.c buffer.c pipeline.c specialize.cpp
    evaluate.c evaluate_read.c evaluate_memory.c evaluate_output.c spirv_ops.c commands.c
    swapchain.c swapchain_show.c
  LINK whit_base Vulkan::Vulkan SPIRV-Tools-opt)

# Containers of the C++ library cross into a library that was built without sanitizers.
if(WHIT_SANITIZE)
  set_source_files_properties(device/specialize.cpp PROPERTIES COMPILE_OPTIONS -fno-sanitize=all)
endif()
