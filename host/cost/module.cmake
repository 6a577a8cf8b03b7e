# Knobs and what they cost, over libwhit's public face: for the program and the viewer.
whit_module(cost
  SOURCES knobs.c price.c effects.c reference.c rays.c row.c measure.c choose.c within.c findings.c strip.c
  LINK whit_settings whit_api m)
