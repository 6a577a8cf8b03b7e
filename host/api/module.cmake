whit_module(api
  SOURCES scene_api.c accel_api.c device_api.c renderer_api.c image_api.c file_api.c
  LINK whit_base whit_image whit_scene whit_load whit_accel whit_device whit_render)
target_include_directories(whit_api PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/base>)
