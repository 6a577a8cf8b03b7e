whit_module(reference
  SOURCES camera.c hits.c light.c lighting.c media.c meet.c optics.c reference.c surface.c texture.c tree.c
  LINK whit_base whit_image whit_scene whit_picture whit_oracle)
