whit_module(accel
  SOURCES accel.c bvh.c bvh_complete.c bvh_validate.c split_binned.c split_few.c split_median.c topdown.c bvh_report.c bvh_epo.c optimize.c pose.c traverse.c oracle.c
  LINK whit_base whit_scene)
