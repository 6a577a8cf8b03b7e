whit_module(render
  SOURCES adaptive_samples.c animate.c retarget.c async.c bailout_bound.c costs.c effects.c frame_uniform.c hooks.c hook_tests.c hook_expect.c kernels.c lights.c
    pixels.c portable.c probe.c probe_twin.c readback.c reuse.c steps.c tiles.c renderer.c stats.c textures.c trace.c upload.c variants.c views.c
    material_shares.c queues.c stages.c stage_set.c stage_times.c translation.c
  LINK whit_base whit_image whit_scene whit_picture whit_oracle whit_device whit_shader whit_kernels)
