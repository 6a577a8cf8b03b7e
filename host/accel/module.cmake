whit_module(accel
  SOURCES accel.c bvh.c bvh_complete.c bvh_validate.c bvh_validate_parts.c split_binned.c records.c small.c split_median.c sweep.c sweep_naive.c topdown.c spatial.c spatial_split.c spatial_object.c clip.c bvh_report.c bvh_epo.c bvh_file.c optimize.c pose.c flat.c material_bits.c traverse.c oracle.c
  LINK whit_base whit_scene)
