whit_module(render
  SOURCES adaptive.c animate.c retarget.c async.c bailout_bound.c camera.c costs.c effects.c environment.c frame_uniform.c kernels.c lights.c
    bodies.c media.c params.c pixels.c probe.c probe_twin.c readback.c draw.c renderer.c stats.c textures.c trace.c upload.c variants.c
    material_shares.c queues.c sequence.c stages.c stage_times.c
  LINK whit_base whit_image whit_scene whit_oracle whit_device whit_kernels)
