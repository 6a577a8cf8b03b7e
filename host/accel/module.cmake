whit_module(accel
  SOURCES accel.c boxes.c bvh8.c flat.c flat_choice.c hull.c quantized.c material_bits.c pose.c validate.c
  LINK whit_base whit_scene whit_bvh m)
