whit_module(twin
  SOURCES counters.c epo.c exact.c exact_sphere.c ff_sphere.c ff_triangle.c report.c traverse.c
  LINK whit_accel m)
