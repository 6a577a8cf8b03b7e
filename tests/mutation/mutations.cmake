# Sources broken on purpose. Each must turn a test red, and in it the check that RED names:
#     mutation(NAME TEST RED check [GREEN what it prints otherwise] [TARGET to build; default TEST_test])
#     change(FILE FUNCTION [[regular expression]] [[replacement, \1 ... for what was captured]])
#     change(FILE [[text]] [[in place of it]])    every occurrence
# with one or more changes a mutation. What an expression names must be in the function exactly once (see
# change.cmake); it is an operator, a constant or a call rather than local names, so that few edits
# touch it. The second form is for what is in no function, and for shaders and host/render/. Shaders
# and their twins in C are broken alone, where the comparison with the other finds it, and both in the
# same way, where only an oracle can.

# ---- Optics, media, surfaces ----

mutation(cosine_behind render_refraction RED slab_keeps_directions)
change(shaders/lib/optics.glsl [[(1.0 - eta) * (1.0 + eta);]] [[(1.0 - eta);]])

mutation(index_upside_down render_media RED layers_bend_as_snell_says)
change(shaders/hook/scatter.glsl [[refract_dir(ray_dir(), s.ns, o.eta,]]
  [[refract_dir(ray_dir(), s.ns, 1.0 / o.eta,]])

mutation(refraction_by_sine_alone render_refraction RED ball_bends_rays_to_its_focus)
change(shaders/lib/optics.glsl [[(eta * cos_in - sqrt(cos2_out))]] [[(cos_in - sqrt(cos2_out))]])

mutation(directions_drift render_refraction RED directions_stay_unit)
change(shaders/kernel/shade.comp [[normalize(dir)]] [[dir]])

mutation(beer_by_halves render_refraction RED beer_from_nothing_to_infinity)
change(shaders/bind/media.glsl [[return exp(-clamp]] [[return exp2(-clamp]])

mutation(endless_media_clear render_refraction RED endless_media_are_dark)
change(shaders/kernel/closest.comp [[medium_transmittance(ray_media_of[r], hit.t);]] [[vec3(1.0);]])

mutation(radiance_squeezed render_refraction RED paths_are_reversible)
change(shaders/hook/scatter.glsl [[o.refracted * solid;]]
  [[o.refracted * solid * (o.eta * o.eta);]])

mutation(all_refracts render_effects RED only_pixels_that_see_glass_refract)
change(shaders/bind/optics.glsl [[bool glass = max(transmission.r, max(transmission.g, transmission.b)) > 0.0;]]
  [[bool glass = true; transmission += 0.01;]])

mutation(edge_crossed_twice render_media RED edges_are_crossed_once)
change(shaders/bind/crossing.glsl [[media_have(ray.media, s.material + 1u) != inside;]] [[false;]])

mutation(edge_entered_twice render_media RED edges_are_crossed_once)
change(shaders/bind/crossing.glsl [[same != CROSSED_MAX && left == leaves;]] [[false;]])

mutation(averted_normals_kept render_shading RED averted_normals_give_way)
change(shaders/bind/surface.glsl [[if (dot(s.ns, dir) > 0.0)]] [[if (false)]])
change(shaders/hook/met.glsl [[if (dot(met.s.ns, met.ray.dir) > 0.0)]] [[if (false)]])

mutation(second_uvs_unread render_shading RED each_texture_has_its_coordinates)
change(shaders/bind/shading.glsl [[(uv_set != 0u ? frame.uv1_row : frame.uv0_row)]] [[frame.uv0_row]])

mutation(second_uvs_unwritten render_shading RED each_texture_has_its_coordinates)
change(host/render/upload.c [[frame->uv1_row, TRIANGLE_UV_ROWS, fill_second_uvs]]
  [[frame->uv1_row, TRIANGLE_UV_ROWS, fill_first_uvs]])

# ---- Only what is called for ----

mutation(priorities_unseen render_media RED priority_hides_what_is_inside)
change(host/render/variants.c [[!= scene->materials[0].priority)]] [[== 256)]])

mutation(fallback_unsaid device_compute RED kernels_go_to_the_driver_whole)
change(host/device/pipeline.c prepare_kernel [[if \([^()]*specialized\)]] [[if (false)]])

mutation(fallback_without_constants device_compute RED kernels_go_to_the_driver_whole)
change(host/device/pipeline.c make_pipeline [[[^ ]+spec_count > 0 && [^ ]+specialized]] [[false]])

mutation(scan_misses_highlights scene_cube RED "--effects all gives the same picture"
  TARGET picture_check)
change(host/scene/effects.c scan_optics
  [[\([^()]*WHIT_MODEL_PHONG && any\([^()]*specular\)\)]] [[false]])

mutation(effects_not_left_out cli_effects RED "less is another picture" TARGET whit_changed)
change(host/settings/effects.c switch_effect [[: ([^ ;]+)effects_removed\) \|=]] [[: \1effects_added) |=]])

# ---- Loops that end early ----

mutation(cut_walks_unsaid render_shadow RED cut_walks_through_sheets_are_reported)
change(shaders/bind/traverse.glsl [[if (ref != REF_DONE)
        hit.status |=]] [[if (false)
        hit.status |=]])

# ---- Stages ----

mutation(ray_lost render_energy RED white_furnace)
change(shaders/kernel/shade.comp [[    next++;]] [[]])

mutation(overflow_unnoticed render_picture RED full_queues_end_in_smaller_tiles)
change(shaders/bind/queues.glsl [[if (at + wanted > room || segment_end > segment_room) {]] [[if (false) {]])

mutation(sums_in_another_order render_probe RED rays_are_those_of_the_picture)
change(shaders/kernel/resolve.comp [[own.rgb + child_sum(from.x) + straight + child_sum(from.z)]]
  [[child_sum(from.z) + straight + child_sum(from.x) + own.rgb]])

mutation(lights_in_another_order render_light RED many_lights_are_added_in_their_order)
change(shaders/kernel/shadow.comp [[fetch_light(light_index);]]
  [[fetch_light(end - 1u - (light_index - chunk.light));]])

mutation(undecided_rays_not_left render_direct RED pictures_are_those_of_shadow_stages)
change(shaders/kernel/shade.comp [[left = waits ? 0xffffffffu << i : left;]] [[;]])

mutation(direct_light_blind render_direct RED pictures_are_those_of_shadow_stages)
change(host/render/variants.c [[spec->SPEC_SPHERES = set_spec->SPEC_SPHERES;]] [[(void)set_spec;]])

mutation(class_too_poor render_effects RED only_pixels_that_see_glass_refract)
change(host/render/effects.c [[glass ? SCENE_MATERIALS_GLASS : SCENE_MATERIALS_OPAQUE]]
  [[glass ? SCENE_MATERIALS_OPAQUE : SCENE_MATERIALS_GLASS]])

mutation(loops_cut_unnoticed render_picture RED cut_loops_are_reported)
change(shaders/lib/turn.glsl [[again && gl_WorkGroupID.y == 0u]] [[again]])

# ---- Boxes, triangles, traversal ----

mutation(offset_four_times_too_far render_shadow RED narrow_gaps_stay_dark)
change(shaders/bind/surface.glsl [[s.error = rounding_bound(7.0)]] [[s.error = rounding_bound(28.0)]])

mutation(origins_next_to_zero render_probe RED surfaces_let_rays_pass)
change(shaders/lib/spawn.glsl [[* SPAWN_LEAST]] [[* 0.0]])

mutation(t_min_in_world_units render_scale RED pictures_do_not_depend_on_the_unit)
change(shaders/kernel/closest.comp [[(TRAVERSE_CLOSEST, 0.0,]] [[(TRAVERSE_CLOSEST, 1e-3,]])

mutation(t_min_of_shadows_in_world_units render_scale RED pictures_do_not_depend_on_the_unit)
change(shaders/kernel/shadow.comp [[(TRAVERSE_SHADOW, 0.0,]] [[(TRAVERSE_SHADOW, 1e-3,]])

mutation(contracted_twin hard_mesh RED no_ray_gets_through)
change(host/twin/module.cmake [[LINK whit_accel m)]]
  [[LINK whit_accel m)
set_source_files_properties(twin/traverse.c PROPERTIES COMPILE_OPTIONS
  "-ffp-contract=fast;$<$<STREQUAL:${CMAKE_SYSTEM_PROCESSOR},x86_64>:-mfma>")]])

mutation(contracted_kernels spirv RED ".* float operations may be contracted"
  GREEN ": 0 of [0-9]+ float operations" TARGET kernel_dump)
change(host/shader/exact.c is_float_operation [[op == OP_F_MUL]] [[false]])

# lavapipe rounds fma() twice, so that no picture shows it there.
mutation(fused_edges_in_kernels spirv RED ".* float operations may be contracted"
  GREEN ": 0 of [0-9]+ float operations" TARGET kernel_dump)
change(shaders/lib/intersect.glsl [[precise float ea = c.x * b.y - c.y * b.x;]]
  [[precise float ea = fma(c.x, b.y, -(c.y * b.x));]])

mutation(quotient_uncorrected device_portable RED functions_are_right_within_their_bounds)
change(shaders/lib/portable.glsl [[q += uint(off);]] [[off = 0;]])

mutation(roots_left_to_drivers spirv RED ".* with .*: drivers decide .*Sqrt"
  GREEN ": 0 of [0-9]+ float operations" TARGET kernel_dump)
change(host/shader/portable.c [[{31, RIGHT_DIVISION, "sqrt", NULL},]] [[]])

mutation(fused_edges hard_mesh RED no_ray_gets_through)
change(host/twin/intersect.h shear_triangle
  [[ea = ([^ ;]+) \* ([^ ;]+) - ([^;]+);]] [[ea = fmaf(\1, \2, -(\3));]])
change(host/twin/intersect.h shear_triangle
  [[eb = ([^ ;]+) \* ([^ ;]+) - ([^;]+);]] [[eb = fmaf(\1, \2, -(\3));]])
change(host/twin/intersect.h shear_triangle
  [[ec = ([^ ;]+) \* ([^ ;]+) - ([^;]+);]] [[ec = fmaf(\1, \2, -(\3));]])

mutation(t_of_areas_times_lengths hard_triangle RED size_does_not_matter)
change(host/twin/intersect.h intersect_triangle
  [[\(\(([a-z]+\.)ea \* ([a-z_]+)\) \* ([a-z]+) \+ [^ ]+ \* ([a-z]+)\) \+ [^ ]+ \* ([a-z]+);]] [[((\1ea * \3 + \1eb * \4) + \1ec * \5) * \2;]])

mutation(t_of_areas_times_lengths_in_kernels render_scale RED pictures_do_not_depend_on_the_unit)
change(shaders/lib/intersect.glsl [[(weight_a * z.x + weight_b * z.y) + weight_c * z.z;]]
  [[((edges.x * z.x + edges.y * z.y) + edges.z * z.z) * inv_det;]])

mutation(slab_factor_gone hard_mesh RED no_ray_gets_through)
change(host/twin/intersect.h SLAB_FAR_SCALE [[\(1\.0f .*\)]] [[1.0f]])
change(shaders/lib/intersect.glsl [[SLAB_FAR_SCALE = 1.0 + 1.0 / 1048576.0;]] [[SLAB_FAR_SCALE = 1.0;]])

mutation(slab_factor_gone_in_kernels render_trace RED meshes_equal_twin)
change(shaders/lib/intersect.glsl [[SLAB_FAR_SCALE = 1.0 + 1.0 / 1048576.0;]] [[SLAB_FAR_SCALE = 1.0;]])

mutation(slab_by_fma hard_mesh RED no_ray_gets_through)
change(host/twin/intersect.h slab_axis [[slab_axis\(float]] [[slab_axis(float o, float]])
change(host/twin/intersect.h slab_axis [[= lo \* ([a-z_]+);]] [[= fmaf(lo + o, \1, -(o * \1));]])
change(host/twin/intersect.h slab_axis [[= hi \* ([a-z_]+);]] [[= fmaf(hi + o, \1, -(o * \1));]])
change(host/twin/intersect.h slab_interval
  [[slab_axis\(([a-z.]+x, [a-z.]+x, )([a-z]+->)]] [[slab_axis(\2origin.x, \1\2]])
change(host/twin/intersect.h slab_interval
  [[slab_axis\(([a-z.]+y, [a-z.]+y, )([a-z]+->)]] [[slab_axis(\2origin.y, \1\2]])
change(host/twin/intersect.h slab_interval
  [[slab_axis\(([a-z.]+z, [a-z.]+z, )([a-z]+->)]] [[slab_axis(\2origin.z, \1\2]])

mutation(slab_by_fma_in_kernels render_trace RED meshes_equal_twin)
change(shaders/lib/intersect.glsl [[first * ray.inv_dir;]]
  [[(first + ray.origin) * ray.inv_dir - ray.origin * ray.inv_dir;]])
change(shaders/lib/intersect.glsl [[last * ray.inv_dir;]]
  [[(last + ray.origin) * ray.inv_dir - ray.origin * ray.inv_dir;]])

mutation(quantized_boxes_too_narrow render_quantized RED hits_are_those_of_large_nodes)
change(shaders/bind/quantized.glsl [[QUANTIZED_MARGIN = 1.0 / 524288.0]] [[QUANTIZED_MARGIN = 0.0]])

mutation(quantized_rays_unmoved render_quantized RED hits_are_those_of_large_nodes)
change(shaders/bind/quantized.glsl [[min(t_min, 0.0)]] [[0.0]])

mutation(quantized_boxes_inwards render_quantized RED boxes_are_rounded_outwards)
change(host/accel/quantized.c [[ceil(hi / step)]] [[floor(hi / step)]])

mutation(quantized_boxes_narrow_for_denormal_t render_quantized RED hits_are_those_of_large_nodes)
change(shaders/bind/quantized.glsl [[denormal < float(QUANTIZED_STEPS)]] [[denormal >= 0.0]])

mutation(coarse_grids_quantized render_quantized RED only_trees_that_stay_small_on_the_grid_get_nodes)
change(host/accel/quantized.c [[large < mesh->node_count / 2]] [[large <= mesh->node_count]])

mutation(beam_boxes_too_narrow render_trace RED packets_equal_twin)
change(shaders/bind/beam.glsl [[vec3(box_margin(lo, hi))]] [[vec3(0.0)]])

mutation(beam_of_two_origins render_trace RED packets_equal_twin)
change(shaders/kernel/trace.comp [[floatBitsToUint(ray.origin) == floatBitsToUint(eye) &&]] [[true &&]])

mutation(beam_of_mixed_signs render_trace RED packets_equal_twin)
change(shaders/bind/beam.glsl [[&& group_of(packet_rays[r]) == group]] [[&& true]])

mutation(beam_rays_pass_by render_light RED packets_to_a_light_shade_as_rays_do)
change(shaders/bind/packet_rays.glsl [[+ distance_to_eye(packet_rays[r], eye) / BOUNDS_MARGIN;]] [[;]])

mutation(beam_ends_early render_light RED packets_to_a_light_shade_as_rays_do)
change(shaders/bind/beam.glsl [[= abs(beam_origin[r].z - beam.eye.z);]]
  [[= 0.98 * abs(beam_origin[r].z - beam.eye.z);]])

mutation(no_ray_reads_outside scene_whitted_stored RED "the validation layers had nothing to say" TARGET picture_check)
change(shaders/bind/queues.glsl [[min(at, generation_capacity() - 1u)]] [[at]])

mutation(queues_start_as_they_come cli_render RED "--load-path storage: exit code 0" TARGET whit_program)
change(host/render/queues.c [[BUFFER_TEXELS | BUFFER_ZEROED;]] [[BUFFER_TEXELS;]])

mutation(reciprocals_clamped accel_oracle RED borders_are_met_along_the_axes)
change(host/twin/intersect.h make_ray_setup
  [[vec3_make\(1\.0f / ([a-z]+)\.x, ([^;]+), ([^;]+)\);]]
  [[vec3_make(fmaxf(fminf(1.0f / \1.x, 1e30f), -1e30f), fmaxf(fminf(\2, 1e30f), -1e30f),
      fmaxf(fminf(\3, 1e30f), -1e30f));]])
change(shaders/lib/intersect.glsl [[vec3(1.0) / dir;]] [[clamp(vec3(1.0) / dir, vec3(-1e30), vec3(1e30));]])

mutation(reciprocals_clamped_in_kernels render_trace RED meshes_equal_twin)
change(shaders/lib/intersect.glsl [[vec3(1.0) / dir;]] [[clamp(vec3(1.0) / dir, vec3(-1e30), vec3(1e30));]])

mutation(signs_of_directions accel_oracle RED borders_are_met_along_the_axes)
change(host/twin/intersect.h make_ray_setup [[[a-z]+\.inv_dir\.x < 0]] [[dir.x < 0]])
change(host/twin/intersect.h make_ray_setup [[[a-z]+\.inv_dir\.y < 0]] [[dir.y < 0]])
change(host/twin/intersect.h make_ray_setup [[[a-z]+\.inv_dir\.z < 0]] [[dir.z < 0]])
change(shaders/lib/intersect.glsl [[lessThan(inv_dir, vec3(0.0))]] [[lessThan(dir, vec3(0.0))]])

mutation(signs_of_directions_in_kernels render_trace RED meshes_equal_twin)
change(shaders/lib/intersect.glsl [[lessThan(inv_dir, vec3(0.0))]] [[lessThan(dir, vec3(0.0))]])

mutation(transform_by_a_sum accel_instance RED far_translations_keep_their_precision)
change(host/twin/ray.h accel_local_ray
  [[(\.origin, )(accel_rotate_rows\([^()]*, )[a-z]+\)]] [[\1vec3_sub(\2vec3_load(ray->origin)), \2origin))]])

mutation(transform_by_a_sum_in_kernels render_trace RED instances_equal_twin)
change(shaders/bind/traverse.glsl [[to_object_point(frame, origin)]]
  [[to_object_dir(frame, origin) - to_object_dir(frame, frame.origin)]])

mutation(ties_undecided hard_tree RED the_first_of_equal_triangles_is_hit)
change(host/accel/hit_order.h hit_comes_before [[[a-z]\.t == [a-z]\.t]] [[false]])
change(shaders/bind/traverse.glsl [[(t == farthest(hit) && (instance < hit.instance ||]]
  [[(false && (instance < hit.instance ||]])

mutation(ties_undecided_in_kernels render_trace RED meshes_equal_twin)
change(shaders/bind/traverse.glsl [[(t == farthest(hit) && (instance < hit.instance ||]]
  [[(false && (instance < hit.instance ||]])

mutation(stack_without_end accel_stack RED too_deep_trees_are_reported)
change(host/twin/traverse.c push_ref [[[^( ]+ == STACK_SIZE]] [[false]])

mutation(stack_without_end_in_kernels render_cost RED understated_depth_is_reported)
change(shaders/bind/traverse.glsl [[if (stack.in_memory < SPEC_STACK_SIZE) {]] [[if (true) {]])

# ---- Levels ----

mutation(levels_untold render_numerics RED only_fast_leaks)
change(host/render/variants.c [[spec.SPEC_NUMERICS = renderer->params.numerics;]]
  [[spec.SPEC_NUMERICS = NUMERICS_WATERTIGHT;]])

mutation(fast_with_slack_in_kernels render_numerics RED one_mesh)
change(shaders/lib/moller.glsl [[weight_b >= 0.0 && weight_c >= 0.0 && weights <= 1.0]]
  [[weight_b >= -1e-6 && weight_c >= -1e-6 && weights <= 1.000001]])

mutation(fast_with_an_epsilon hard_triangle RED size_does_not_matter)
change(host/twin/moller.h intersect_moller [[([a-z]+) != 0\.0f]] [[fabsf(\1) > 1e-6f]])
change(shaders/lib/moller.glsl [[det != 0.0]] [[abs(det) > 1e-6]])

mutation(fast_with_an_epsilon_in_kernels render_numerics RED split_triangles)
change(shaders/lib/moller.glsl [[det != 0.0]] [[abs(det) > 1e-6]])

mutation(camera_by_inversesqrt render_cost RED camera_rays_are_those_of_c)
change(shaders/bind/camera.glsl [[inverse_square_root(squared)]] [[inversesqrt(squared)]])

mutation(filter_without_bound accel_hard RED cases_are_what_they_say)
change(host/twin/exact.c exact_filter [[factors_error \* \(]] [[0.0f * (]])
change(shaders/lib/exact.glsl [[factors_error * (]] [[0.0 * (]])

mutation(filter_without_bound_in_kernels render_numerics RED one_mesh)
change(shaders/lib/exact.glsl [[factors_error * (]] [[0.0 * (]])

mutation(filter_with_half_its_bound accel_filter RED errors_stay_within_their_bounds)
change(host/twin/exact.c exact_filter [[factors_error \* \(]] [[0.5f * factors_error * (]])
change(shaders/lib/exact.glsl [[factors_error * (]] [[0.5 * factors_error * (]])

mutation(filter_with_half_its_bound_in_kernels device_filter RED bounds_are_those_of_c)
change(shaders/lib/exact.glsl [[factors_error * (]] [[0.5 * factors_error * (]])

mutation(keys_without_interval accel_hard RED cases_are_what_they_say)
change(host/twin/exact.c exact_filter
  [[= ([a-z_]+ \* \([a-z_]+ - [a-z_]+\) \+ [a-z_]+);]] [[= 0.0f * (\1);]])
change(shaders/lib/exact.glsl [[t_error = weights_error * (z_hi - z_lo) + z_error;]]
  [[t_error = 0.0 * z_error;]])

mutation(keys_unrounded accel_hard RED cases_are_what_they_say)
change(host/twin/traverse.c traverse_ray [[[a-z]+\.lo < [a-z]+\.hi]] [[false]])

mutation(boxes_near_denormals hard_tree RED keys_at_the_ends_of_floats_do_not_depend_on_the_tree)
change(host/twin/traverse.c enters [[bits -= NEAR_STEPS]] [[bits -= 0]])

mutation(instances_without_slack accel_instance RED rays_from_far_away_enter_what_they_hit)
change(host/accel/pose.c instances_slack [[max\.others\[i\] \* WIDENING]] [[0.0]])

mutation(keys_unrounded_in_kernels render_numerics RED one_mesh)
change(shaders/bind/settle.glsl [[bool loose = hit.lo < hit.hi;]] [[bool loose = false;]])

mutation(keys_cut_off accel_hard RED cases_are_what_they_say)
change(host/twin/exact.c round_quotient [[up \?]] [[up && mantissa == 0 ?]])
change(shaders/lib/exact.glsl [[bits += up ? 1u : 0u;]] [[bits += up && mantissa == 0u ? 1u : 0u;]])

mutation(pairs_cut_off_in_kernels render_numerics RED one_mesh)
change(shaders/lib/ff_numbers.glsl [[vec2 both = ff_sum(first, second);]]
  [[vec2 both = ff_sum(first, 0.0);]])

mutation(pairs_without_bound hard_triangle RED triangles_are_met_as_fractions_say)
change(host/twin/ff_triangle.c triple [[FF_RELATIVE]] [[FF_RELATIVE / 128.0f]])
change(shaders/lib/ff_triangle.glsl [[size * FF_RELATIVE + FF_ABSOLUTE]]
  [[size * FF_RELATIVE / 128.0 + FF_ABSOLUTE]])

mutation(spheres_with_half_their_bound hard_sphere RED spheres_are_met_as_fractions_say)
change(host/twin/exact_sphere.c bound_sphere [[82\.0f]] [[41.0f]])
change(host/twin/exact_sphere.c bound_sphere [[18500\.0f]] [[9250.0f]])
change(host/twin/exact_sphere.c bound_sphere [[4\.5f ([^)]*) 2\.5f]] [[2.25f \1 1.25f]])

mutation(spheres_without_bound_in_kernels device_sphere RED spheres_are_met_as_in_c)
change(shaders/lib/exact_sphere.glsl [[foot.room > error;]] [[foot.room > 0.0;]])

mutation(sphere_ties_round_down hard_sphere RED spheres_are_met_as_fractions_say)
change(host/twin/exact_sphere.c is_beyond [[\([a-z]+ == 0 && [^)]*\) != 0\)]] [[false]])

mutation(sphere_ties_round_down_in_kernels device_sphere RED spheres_are_met_as_in_c)
change(shaders/lib/exact_sphere.glsl [[(side == 0 && (middle & 1u) != 0u)]] [[false]])

mutation(sphere_pairs_without_bound hard_sphere RED spheres_are_met_as_fractions_say)
change(host/twin/ff_sphere.c [[FF_RELATIVE + FF_ABSOLUTE]]
  [[FF_RELATIVE / 1024.0f + FF_ABSOLUTE]])

mutation(far_ends_taken_for_near_in_kernels render_numerics RED spheres)
change(shaders/bind/traverse.glsl [[hit.at_exit = at_exit;]] [[hit.at_exit = false;]])

mutation(waiting_rays_forgotten render_deferred RED batches_are_those_of_looks_in_place)
change(shaders/kernel/trace.comp [[list_deferred(waits, index);]] [[;]])

mutation(waiting_pixels_forgotten render_deferred RED pictures_are_those_of_looks_in_place)
change(shaders/kernel/closest.comp [[list_deferred_rays(waits, ray_id);]] [[;]])

mutation(hits_without_keys render_media RED shared_faces_are_found_at_every_level)
change(shaders/bind/queues.glsl [[HIT_HAS_KEY = SPEC_NUMERICS == NUMERICS_EXACT &&]]
  [[HIT_HAS_KEY = SPEC_NUMERICS == NUMERICS_FAST &&]])

mutation(waiting_rays_leave_children render_deferred RED pictures_are_those_of_looks_in_place)
change(shaders/kernel/shade.comp [[alive = alive && !must_wait(status);]] [[;]])

mutation(hits_unsettled accel_hard RED cases_are_what_they_say)
change(host/twin/traverse.c settle [[[a-z]+->lo < [a-z]+->hi]] [[false]])

mutation(hits_unsettled_in_kernels render_numerics RED ties)
change(shaders/bind/settle.glsl [[again = m.met && hit.lo < hit.hi &&]] [[again = false &&]])

mutation(identities_unmet cli_hard RED "the hash is the one that is stored" TARGET whit_leaky)
change(shaders/bind/settle.glsl [[m.met && exact.met && exact.key]] [[m.met && exact.key]])

# ---- whit hard ----

mutation(leaks_uncounted accel_hard RED the_judge_sees)
change(host/hard/judge.c judge_ray [[\+= [^;]*is_leak]] [[+= false && is_leak]])

mutation(promises_always_kept accel_hard RED the_judge_sees)
change(host/hard/judge.c hard_promise_kept [[== NUMERICS_FAST]] [[< 9]])

mutation(differences_unseen accel_hard RED the_judge_sees)
change(host/hard/judge.c hard_count_differing [[sizeof [^)]*]] [[1]])

mutation(identities_unhashed accel_hard RED cases_are_what_they_say)
change(host/hard/judge.c hard_hash [[[^ ]+\.primitive]] [[0]])

mutation(self_hits_unseen accel_hard RED self_hits_are_seen)
change(host/hard/judge.c judge_ray [[[^ (]+truth == HARD_MUST_MISS]] [[false]])

mutation(valleys_as_ridges accel_hull RED valleys_are_seen)
change(host/accel/hull.c is_behind [[distance <= -ROUNDING \* size]] [[true]])

mutation(insides_as_outsides render_shadow RED light_does_not_get_into_a_convex_body)
change(shaders/bind/trees.glsl [[(hull == HULL_CONVEX && outside)]] [[hull == HULL_CONVEX]])

mutation(own_bodies_entered render_shadow RED rays_that_leave_a_convex_body_do_not_enter_it)
change(shaders/bind/traverse.glsl [[skip_primitive == SKIP_ALL ? REF_ONE_PRIMITIVE | skip_instance :]]
  [[false ? REF_ONE_PRIMITIVE | skip_instance :]])

mutation(entered_bodies_left render_media RED mirrored_bodies_share_a_triangle)
change(shaders/bind/crossing.glsl gather_touching [[c.outwards = leaves]] [[c.outwards = true]])

mutation(all_lights_counted_as_one render_light RED lights_that_reach_all_share_hits)
change(shaders/kernel/shadow.comp [[? light_index : 0u);]] [[? chunk.light : 0u);]])

mutation(waiting_hits_counted_twice render_light RED lights_that_reach_all_share_hits)
change(shaders/kernel/shadow.comp [[count_shadow_rays(done);]] [[count_shadow_rays(alive);]])

mutation(timed_lights_share_a_dispatch render_light RED lights_that_reach_all_share_hits)
change(host/render/stages.c [[few && target->stages.times.on ? 1 :]] [[]])

mutation(open_edges_unseen accel_hard RED surfaces_are_described)
change(host/hard/topology.c count_edge [[open_edges \+= [^;]*]] [[open_edges += 0]])

mutation(broken_promises_are_fine cli_hard RED "a twin that loses rays: exit code 1"
  TARGET whit_leaky)
change(host/app/hard/hard_command.c work [[[a-z]+ == EXIT_FINE \? EXIT_DIFFERS : ]] [[]])

# ---- The reference in double ----

mutation(schlick_by_fourth_power reference_effects RED every_effect_agrees_with_the_device)
change(shaders/lib/optics.glsl [[return x2 * x2 * x;]] [[return x2 * x2;]])

mutation(reference_schlick_by_fourth_power reference_formula RED glass_follows_fresnel_and_snell)
change(host/reference/optics.c SCHLICK_POWER [[5\.0]] [[4.0]])

mutation(reference_beer_by_halves reference_formula RED bodies_absorb_by_beer)
change(host/reference/media.c transmitted [[exp\(-]] [[exp(-0.5 * ]])

mutation(reference_without_room reference_formula RED light_falls_with_cosine_and_square)
change(host/reference/surface.c surface_at [[ROOM]] [[0.0 * ROOM]])

mutation(levels_too_coarse reference_minification RED cameras_agree_with_the_reference)
change(shaders/bind/shading.glsl [[0.5 * exponent + (start]] [[0.5 * exponent + 0.01 + (start]])

mutation(way_before_mirrors_forgotten reference_minification RED cameras_agree_with_the_reference)
change(shaders/hook/met.glsl [[ray.way += met.hit.t;]] [[ray.way = met.hit.t;]])

mutation(samples_blur_as_one reference_minification RED one_sample_is_nearer_to_the_truth)
change(shaders/bind/camera.glsl [[(127u - 2u * halvings) << 23]] [[127u << 23]])
change(host/picture/mipmap.c mipmap_sample_share [[0\.25]] [[1.0]])

mutation(magnified_textures_blurred reference_minification RED magnified_textures_keep_their_bytes)
change(shaders/bind/shading.glsl [[(start + slope * along) : 0.0;]] [[(start + slope * along) : 0.01;]])

mutation(minified_without_textures reference_minification RED scenes_without_textures_have_the_same_kernels)
change(host/render/variants.c [[spec.SPEC_MINIFICATION = textures_minify(renderer);]] [[spec.SPEC_MINIFICATION = 1;]])

mutation(odd_sides_cut picture_mipmap RED texels_are_means_of_what_they_cover)
change(host/picture/mipmap.c cover_of [[from % 2 == 0]] [[from > 1]])

mutation(logarithm_of_wrong_slopes picture_mipmap RED level_is_half_the_logarithm)
change(host/picture/mipmap.c mipmap_pieces [[\(i \+ 1\.0\) / ]] [[(i + 0.9) / ]])

mutation(samples_summed_one_by_one render_samples RED samples_are_summed_in_pairs)
change(shaders/kernel/resolve.comp [[waiting = chunk.summed; last ? waiting != 0u : (waiting & 1u) != 0u; waiting >>= 1]]
  [[waiting = min(chunk.summed, 1u); waiting != 0u; waiting = 0u, row -= chunk.sums_step]])

mutation(sums_of_parts_mixed render_samples RED full_queues_do_not_matter)
change(host/render/stages.c [[part.first_block += max, part.tile_slot += max * RENDER_BLOCK_PIXELS]]
  [[part.first_block += max]])

mutation(points_unturned_in_kernels device_sequence RED points_are_those_of_the_host)
change(shaders/lib/sequence.glsl [[0x55555541u]] [[1u]])

mutation(points_at_corners render_sequence RED points_lean_to_no_side)
change(host/picture/sequence.c [[0x55555541u : 1u]] [[0u : 0u]])

mutation(lens_as_pixel render_sequence RED squares_meet_once)
change(host/picture/sequence.c sequence_lens [[reorder\([a-z]+, ([a-z]+)\)]] [[0 * columns[0] + \1]])

mutation(neighbours_alike_in_kernels reference_effects RED every_effect_agrees_with_the_device)
change(shaders/bind/camera.glsl [[pixel.x ^ pixel.y, pixel.x]] [[0u, pixel.x]])

mutation(reference_samples_alike reference_effects RED every_effect_agrees_with_the_device)
change(host/reference/reference.c draw_pixel [[->sample = ([a-z]+->sampling.first [+] [a-z]+);]]
  [[->sample = 0 * (\1);]])

mutation(reference_fresnel_of_two_percent reference_scenes RED default_scenes_agree)
change(host/reference/optics.c fresnel [[return 0\.5]] [[return 0.51]])
