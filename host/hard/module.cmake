whit_module(hard
  SOURCES judge.c mesh.c rays.c run.c topology.c view.c
  LINK whit_oracle whit_picture PkgConfig::GMP)
