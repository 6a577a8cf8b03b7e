whit_module(render
  SOURCES adaptive.c animate.c beside.c bound.c brute.c camera.c costs.c environment.c lights.c media.c render.c textures.c trace.c upload.c effects.c variants.c
  LINK whit_base whit_image whit_scene whit_accel whit_device whit_kernels)
