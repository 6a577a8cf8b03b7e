whit_module(device
  SOURCES device.c buffer.c pipeline.c commands.c
  LINK whit_base Vulkan::Vulkan)
