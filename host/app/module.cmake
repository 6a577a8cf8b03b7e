# Embeds the HTML pages of reports as arrays, so that no file is searched for at run time.
foreach(command check cost)
  set(head ${CMAKE_CURRENT_SOURCE_DIR}/app/page_head.html)
  set(page ${CMAKE_CURRENT_SOURCE_DIR}/app/${command}/page.html)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${head} ${page})
  file(READ ${head} head_html HEX)
  file(READ ${page} page_html HEX)
  string(REGEX REPLACE "(..)" "0x\\1," page_html "${head_html}${page_html}")
  set(page_source ${PROJECT_BINARY_DIR}/${command}_page_html.c)
  file(CONFIGURE OUTPUT ${page_source} @ONLY CONTENT
    "extern const char ${command}_page_html[];\nconst char ${command}_page_html[] = {@page_html@0};\n")
  list(APPEND page_sources ${page_source})
endforeach()
# The program. Its library is called libwhit (host/api/module.cmake), so the target has another name.
add_executable(whit_program
  app/arguments.c app/cache.c app/cli.c app/describe.c app/document.c app/ends.c app/job.c app/main.c
  app/page.c app/settings_json.c ${page_sources}
  app/bench/bench_command.c app/bench/request.c
  app/bvh/bvh_command.c app/bvh/study.c app/bvh/study_output.c app/bvh/study_rays.c
  app/bvh/study_trace.c
  app/check/accept.c app/check/accept_from.c app/check/base.c app/check/case_options.c
  app/check/cause.c app/check/check_command.c app/check/describe.c
  app/check/draw.c app/check/expect.c app/check/expect_check.c app/check/golden.c
  app/check/junit.c app/check/lanes.c app/check/page.c
  app/check/pictures.c
  app/check/report.c app/check/search.c app/check/strength.c app/check/suite.c
  app/check/thumbnails.c app/check/vacuous.c app/check/verdict.c
  app/check/worktree.c
  app/compare/compare_command.c
  app/cost/cost_choice.c app/cost/cost_command.c app/cost/cost_compare.c app/cost/cost_json.c
  app/cost/cost_kept.c app/cost/cost_page.c app/cost/cost_table.c
  app/devices/device_hints.c app/devices/devices_command.c
  app/batch/batch_command.c app/batch/lines.c app/batch/outputs.c app/merge/merge_command.c app/merge/merge.c
  app/hard/hard_command.c app/hard/hard_output.c
  app/probe/probe_command.c app/probe/probe_output.c
  app/render/frames.c app/render/layers.c app/render/part.c app/render/recipe.c app/render/refine.c
  app/render/render_command.c app/render/repeat.c app/render/resume.c
  app/render/stats.c app/render/view_image.c app/render/cameras.c
  app/scene/kernels.c app/scene/listing.c app/scene/listing_output.c app/scene/effect_report.c
  app/scene/scene_command.c app/scene/triangles.c
  app/shader/attempt.c app/shader/extract.c app/shader/shader_command.c
  app/trace/ray_file.c app/trace/trace_command.c)
set_target_properties(whit_program PROPERTIES
  OUTPUT_NAME whit RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
# The libraries that a program made of these sources links; tests make further such programs.
add_library(whit_program_needs INTERFACE)
target_include_directories(whit_program_needs INTERFACE
  ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/base)
if(WHIT_VIEWER)
  target_sources(whit_program PRIVATE app/view/state_file.c app/view/view_command.c)
  target_compile_definitions(whit_program_needs INTERFACE WHIT_VIEWER)
  # These come before the library in the link order, because they call its modules.
  target_link_libraries(whit_program_needs INTERFACE $<TARGET_OBJECTS:whit_view> glfw
    PkgConfig::IMGUI PkgConfig::FONTCONFIG stdc++)
  add_dependencies(whit_program_needs whit_view)
endif()
# These come before the library in the link order, because they call it.
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
# Files for file managers and desktops.
install(FILES app/desktop/whit.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers)
install(FILES app/desktop/whit.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
if(WHIT_VIEWER)
  install(FILES app/desktop/whit.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/whit
  FILES_MATCHING PATTERN "*.json" PATTERN "*.png")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders/examples
  DESTINATION ${CMAKE_INSTALL_DATADIR}/whit/shaders)
# Documents and scenes refer to each other, and to the examples of shaders, by paths of a checkout.
# What the folder has of that name stays.
function(whit_install_link folder name to)
  if(IS_ABSOLUTE "${folder}" OR IS_ABSOLUTE "${to}" OR "${folder}/${name}" STREQUAL "${to}")
    return()
  endif()
  file(RELATIVE_PATH target "/${folder}" "/${to}")
  install(CODE "set(link \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}/${name}\")
    if(IS_SYMLINK \"\${link}\" OR NOT EXISTS \"\${link}\")
      file(CREATE_LINK \"${target}\" \"\${link}\" SYMBOLIC)
    endif()")
endfunction()
whit_install_link(${CMAKE_INSTALL_DATADIR}/whit docs ${CMAKE_INSTALL_DOCDIR}/docs)
whit_install_link(${CMAKE_INSTALL_DOCDIR} scenes ${CMAKE_INSTALL_DATADIR}/whit/scenes)
whit_install_link(${CMAKE_INSTALL_DOCDIR} shaders ${CMAKE_INSTALL_DATADIR}/whit/shaders)
