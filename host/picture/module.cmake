# What every picture has, with or without a device.
whit_module(picture
  SOURCES bodies.c camera.c environment.c grid.c media.c mipmap.c params.c sequence.c
  LINK whit_base whit_scene whit_twin m)
