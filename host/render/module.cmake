whit_module(render
  SOURCES render.c camera.c upload.c variants.c trace.c
  LINK whit_base whit_image whit_scene whit_accel whit_device whit_kernels)
