# The viewer; only with WHIT_VIEWER.
whit_module(view
  SOURCES camera.c choices.c compare.c compare_draw.c difference.c engine.c engine_change.c
    engine_draw.c engine_refine.c engine_reload.c engine_requests.c engine_sessions.c engine_turns.c events.c font.c hud.c input.c keys.c measure.c remembered_cameras.c overlay.c pace.c palette.c panels.c
    pick.c price_panel.c price_plot.c price_strip.c prices.c replay.c
    scenes.c session.c shaders.c skies.c state.c view.c window.c wish.c ui.cpp
    ui_plots.cpp ui_widgets.cpp
  LINK whit_base whit_device whit_render whit_api whit_cost whit_kernels glfw PkgConfig::IMGUI PkgConfig::FONTCONFIG PkgConfig::JANSSON
    Vulkan::Vulkan m)
