whit_module(base
  SOURCES affine.c array.c clock.c file.c log.c platform.c roots.c store.c text.c threads.c watch.c
  LINK Threads::Threads m)
