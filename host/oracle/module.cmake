whit_module(oracle
  SOURCES conservative.c nearest.c oracle.c rational.c
  LINK whit_twin PkgConfig::GMP)
