whit_module(render
  SOURCES adaptive.c animate.c retarget.c async.c bound.c camera.c costs.c effects.c environment.c frame.c kernels.c lights.c
    bodies.c media.c params.c pixels.c probe.c probe_twin.c readback.c render.c renderer.c stats.c textures.c trace.c upload.c variants.c
    material_shares.c queues.c sequence.c stages.c stage_times.c
  LINK whit_base whit_image whit_scene whit_oracle whit_device whit_kernels)
