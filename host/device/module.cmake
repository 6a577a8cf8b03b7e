whit_module(device
  SOURCES instance.c device.c cache.c buffer.c pipeline.c commands.c
  LINK whit_base Vulkan::Vulkan)
