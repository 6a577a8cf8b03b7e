whit_module(scene
  SOURCES scene.c freeze.c pose.c effects.c shapes.c
  LINK whit_base)
