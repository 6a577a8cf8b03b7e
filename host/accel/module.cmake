whit_module(accel
  SOURCES accel.c boxes.c bvh.c bvh8.c bvh_complete.c bvh_epo.c bvh_report.c bvh_validate.c
    bvh_validate_parts.c clip.c cost.c exact.c exact_sphere.c flat.c flat_choice.c hard_judge.c
    hard_mesh.c hard_rays.c hard_topology.c material_bits.c nearest.c optimize.c oracle.c ff_triangle.c ff_sphere.c pose.c
    rational.c records.c small.c spatial.c spatial_object.c spatial_split.c split_binned.c
    split_median.c sweep.c topdown.c traverse.c conservative.c
  LINK whit_base whit_scene PkgConfig::GMP)
