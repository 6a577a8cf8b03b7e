whit_module(scene
  SOURCES scene.c afford.c freeze.c hash.c clean.c defaults.c viewpoint.c soup.c narrow.c sketch.c emitters.c exposure.c lit.c pose.c effects.c
    shaper.c shapes.c shapes_atrium.c shapes_strands.c small.c parts.c names.c mix.c fields.c change.c fault.c
  LINK whit_base m)
