whit_module(bvh
  SOURCES bvh.c clip.c complete.c optimize.c records.c sweep_small.c spatial.c spatial_object.c spatial_split.c split_binned.c split_median.c sweep.c topdown.c
  LINK whit_base m)
