# The viewer; only with WHIT_VIEWER.
whit_module(view
  SOURCES camera.c engine.c engine_change.c engine_draw.c events.c hud.c input.c keys.c memory.c overlay.c pick.c replay.c
    session.c settings.c state.c view.c window.c ui.cpp
  LINK whit_base whit_device whit_render whit_api whit_kernels glfw PkgConfig::IMGUI PkgConfig::JANSSON
    Vulkan::Vulkan m)
