# Sources broken on purpose. Each must turn a test red, and in it the check that RED names:
#     mutation(NAME TEST RED check [GREEN what it prints otherwise] [TARGET to build; default TEST_test])
#     change(FILE [[text]] [[in place of it]])    every occurrence; one or more a mutation
# A text that is no longer there is a failure: texts are short, so that few edits touch them. Shaders
# and their twins in C are broken alone, where the comparison with the other finds it, and both in the
# same way, where only an oracle can.

# ---- Optics, media, surfaces ----

mutation(cosine_behind render_refraction RED slab_keeps_directions)
change(shaders/lib/optics.glsl [[(1.0 - eta) * (1.0 + eta);]] [[(1.0 - eta);]])

mutation(index_upside_down render_refraction RED slab_moves_rays_aside)
change(shaders/kernel/whitted.comp [[refract_dir(ray.dir, s.ns, o.eta,]]
  [[refract_dir(ray.dir, s.ns, 1.0 / o.eta,]])

mutation(refraction_by_sine_alone render_refraction RED ball_bends_rays_to_its_focus)
change(shaders/lib/optics.glsl [[(eta * cos_in - sqrt(cos2_out))]] [[(cos_in - sqrt(cos2_out))]])

mutation(directions_drift render_refraction RED directions_stay_unit)
change(shaders/kernel/whitted.comp [[normalize(dir)]] [[dir]])

mutation(beer_by_halves render_refraction RED beer_from_nothing_to_infinity)
change(shaders/bind/media.glsl [[return exp(-clamp]] [[return exp2(-clamp]])

mutation(endless_media_clear render_refraction RED endless_media_are_dark)
change(shaders/kernel/whitted.comp [[medium_transmittance(ray.media, hit.t)]]
  [[(hit.primitive == HIT_NONE ? vec3(1.0) : medium_transmittance(ray.media, hit.t))]])

mutation(radiance_squeezed render_refraction RED paths_are_reversible)
change(shaders/kernel/whitted.comp [[ray.weight * o.refracted * solid;]]
  [[ray.weight * o.refracted * solid * (o.eta * o.eta);]])

mutation(all_refracts render_effects RED only_pixels_that_see_glass_refract)
change(shaders/bind/optics.glsl [[bool glass = max(transmission.r, max(transmission.g, transmission.b)) > 0.0;]]
  [[bool glass = true; transmission += 0.01;]])

mutation(edge_crossed_twice render_media RED edges_are_crossed_once)
change(shaders/bind/crossing.glsl [[media_have(ray.media, s.material + 1u) != inside;]] [[false;]])

mutation(edge_entered_twice render_media RED edges_are_crossed_once)
change(shaders/bind/crossing.glsl [[same != CROSSED_MOST && left == leaves;]] [[false;]])

mutation(averted_normals_kept render_shading RED averted_normals_give_way)
change(shaders/bind/crossing.glsl [[if (dot(s.ns, dir) > 0.0)]] [[if (false)]])
change(shaders/kernel/whitted.comp [[if (dot(s.ns, ray.dir) > 0.0)]] [[if (false)]])

mutation(second_uvs_unread render_shading RED each_texture_has_its_coordinates)
change(shaders/bind/shading.glsl [[(uv_set != 0u ? frame.uv1_row : frame.uv0_row)]] [[frame.uv0_row]])

mutation(second_uvs_unwritten render_shading RED each_texture_has_its_coordinates)
change(host/render/upload.c [[frame->uv1_row, TRIANGLE_UV_ROWS, fill_second_uvs]]
  [[frame->uv1_row, TRIANGLE_UV_ROWS, fill_first_uvs]])

# ---- Only what is called for ----

mutation(fallback_unsaid device_fallback RED kernels_go_to_the_driver_whole)
change(host/device/pipeline.c [[if (!info->specialized) {]] [[if (false) {]])

mutation(fallback_without_constants device_fallback RED kernels_go_to_the_driver_whole)
change(host/device/pipeline.c [[params->spec_count > 0 && !kernel->specialized]] [[false]])

mutation(scan_misses_highlights render_default_scenes RED default_scenes_are_the_same)
change(host/scene/effects.c [[(m->model == SCENE_MODEL_PHONG && any(m->specular))]] [[false]])

mutation(effects_not_left_out cli_effects RED "less is another picture" TARGET whit_program)
change(host/api/renderer_api.c [[? &out->effects_added : &out->effects_removed]]
  [[? &out->effects_added : &out->effects_added]])

# ---- Loops that end early ----

mutation(cut_walks_unsaid render_shadow RED cut_walks_through_sheets_are_reported)
change(shaders/bind/traverse.glsl [[if (ref != REF_DONE)
        hit.status |=]] [[if (false)
        hit.status |=]])
