whit_module(scene
  SOURCES scene.c freeze.c hash.c clean.c defaults.c viewpoint.c emitters.c exposure.c pose.c effects.c shapes.c
  LINK whit_base m)
