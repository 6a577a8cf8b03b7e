# The program. Its library is called libwhit (host/api/module.cmake), so the target has another name.
add_executable(whit_program
  app/main.c app/cache.c app/cli.c app/ends.c app/options.c app/describe.c app/job.c app/document.c app/recipe.c app/stats.c
  app/costs.c app/view_image.c app/frames.c app/settings_json.c
  app/receipt.c app/receipt_output.c app/kernels.c app/listing.c app/listing_output.c app/triangles.c
  app/bench_command.c app/bench_measure.c app/bench_report.c app/bench_builders.c
  app/bench_section.c app/bench_table.c app/bench_child.c app/hard_command.c app/hard_output.c app/compare_command.c
  app/probe_command.c app/probe_output.c
  app/cost_command.c app/cost_table.c app/cost_json.c app/cost_page.c app/cost_compare.c
  app/cost_choice.c
  app/page.c app/plot.c
  app/render_command.c app/scene_command.c app/trace_command.c app/ray_file.c app/bvh_command.c
  app/study.c app/study_rays.c app/study_trace.c app/study_output.c app/devices_command.c app/device_hints.c)
set_target_properties(whit_program PROPERTIES
  OUTPUT_NAME whit RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
# What a program made of these sources links; tests make some more of them.
add_library(whit_program_needs INTERFACE)
target_include_directories(whit_program_needs INTERFACE
  ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/base)
if(WHIT_VIEWER)
  target_sources(whit_program PRIVATE app/bench_view.c app/state_file.c app/view_command.c)
  target_compile_definitions(whit_program_needs INTERFACE WHIT_VIEWER
    WHIT_SCENES_DIR="${PROJECT_SOURCE_DIR}/scenes")
  # In front of the library, whose modules they call.
  target_link_libraries(whit_program_needs INTERFACE $<TARGET_OBJECTS:whit_view> glfw
    PkgConfig::IMGUI stdc++)
  add_dependencies(whit_program_needs whit_view)
endif()
if(WHIT_BENCH) # with what tools/CMakeLists.txt adds
  target_compile_definitions(whit_program PRIVATE WHIT_BENCH)
endif()
# In front of the library, which it calls.
target_link_libraries(whit_program_needs INTERFACE $<TARGET_OBJECTS:whit_settings>
  $<TARGET_OBJECTS:whit_cost>)
add_dependencies(whit_program_needs whit_settings whit_cost)
target_link_libraries(whit_program_needs INTERFACE whit PkgConfig::JANSSON
  $<$<BOOL:${WHIT_VIEWER}>:Vulkan::Vulkan> m)
target_link_libraries(whit_program PRIVATE whit_flags whit_program_needs)
install(TARGETS whit_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# Manual pages, from the tables of options.
if(NOT CMAKE_CROSSCOMPILING) # the program writes them
  add_custom_command(TARGET whit_program POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man
    COMMAND whit_program --manual ${PROJECT_BINARY_DIR}/man)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()
install(FILES app/completion/whit.bash
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME whit)
install(FILES app/completion/_whit DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES app/completion/whit.fish
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/whit
  FILES_MATCHING PATTERN "*.json")
