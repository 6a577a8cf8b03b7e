whit_module(hard
  SOURCES judge.c mesh.c rays.c topology.c
  LINK whit_oracle PkgConfig::GMP)
