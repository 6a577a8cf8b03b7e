whit_module(base
  SOURCES affine.c array.c child.c clock.c cores.c file.c foreign.c input.c keep.c key_table.c lock.c log.c path.c platform.c roots.c same.c sample.c sandbox.c shortage.c
    store.c text.c threads.c watch.c
  LINK Threads::Threads PkgConfig::SECCOMP m)
