whit_module(api
  SOURCES handles.c scene_api.c parts_api.c accel_api.c device_api.c renderer_api.c shader_api.c probe_api.c probe_rows.c probe_why.c reference_api.c refine_api.c stats_api.c hard_api.c judge_api.c image_api.c library_api.c
  LINK whit_base whit_image whit_scene whit_load whit_hard whit_picture whit_device whit_render whit_reference)

# libwhit: the objects of all modules in one archive. Its users link `whit`; its headers are found
# as <whit/whit.h>, and as "whit.h".
set(library_modules base image scene load bvh accel twin oracle picture hard device shader render reference api kernels)
list(TRANSFORM library_modules REPLACE "(.+)" "$<TARGET_OBJECTS:whit_\\1>"
  OUTPUT_VARIABLE library_objects)
add_library(whit STATIC ${library_objects})
add_library(whit::whit ALIAS whit)
# The same as a shared library, which exports whit_* and nothing else. Its name changes with the minor
# version, as names in whit.h may.
add_library(whit_shared SHARED ${library_objects})
set(version_script ${CMAKE_CURRENT_SOURCE_DIR}/api/whit.map)
set_target_properties(whit_shared PROPERTIES OUTPUT_NAME whit VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LINK_DEPENDS ${version_script})
target_link_options(whit_shared PRIVATE -Wl,--version-script=${version_script})
foreach(library whit whit_shared)
  set_target_properties(${library} PROPERTIES LINKER_LANGUAGE C)
  target_link_libraries(${library}
    PUBLIC $<$<BOOL:${WHIT_SANITIZE}>:-fsanitize=address,undefined>
    PRIVATE assimp::assimp PNG::PNG JPEG::JPEG OpenEXR::OpenEXRCore PkgConfig::JANSSON PkgConfig::GMP
      PkgConfig::SECCOMP glslang::glslang glslang::SPIRV glslang::glslang-default-resource-limits
      SPIRV-Tools-opt Vulkan::Vulkan stdc++
      Threads::Threads m)
endforeach()

file(GLOB public_headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/whit/*.h)
foreach(header ${public_headers})
  get_filename_component(name ${header} NAME)
  configure_file(${header} ${PROJECT_BINARY_DIR}/include/whit/${name} COPYONLY)
endforeach()
foreach(library whit whit_shared)
  target_include_directories(${library} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include/whit>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/whit>)
endforeach()

# find_package(whit)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/whit)
configure_package_config_file(api/cmake/whitConfig.cmake.in
  ${PROJECT_BINARY_DIR}/cmake/whitConfig.cmake INSTALL_DESTINATION ${package_dir}
  PATH_VARS CMAKE_INSTALL_BINDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/whitConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(TARGETS whit whit_shared EXPORT whitTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
# The installed archive is one object, in which only whit_* are global: its other names may be its user's too. The
# linkers of LLVM cannot resolve the groups of sanitized objects there, so that it needs those of GNU,
# which are for the host alone.
if(NOT CMAKE_CROSSCOMPILING)
  find_program(WHIT_GNU_LD ld.bfd)
  find_program(WHIT_GNU_OBJCOPY objcopy)
endif()
if(WHIT_GNU_LD AND WHIT_GNU_OBJCOPY)
  install(CODE "set(archive \"${CMAKE_INSTALL_LIBDIR}/$<TARGET_FILE_NAME:whit>\")
    cmake_path(ABSOLUTE_PATH archive BASE_DIRECTORY \"\${CMAKE_INSTALL_PREFIX}\")
    set(archive \"\$ENV{DESTDIR}\${archive}\")
    function(whit_run)
      execute_process(COMMAND \${ARGV} COMMAND_ERROR_IS_FATAL ANY)
    endfunction()
    whit_run(\"${WHIT_GNU_LD}\" -r --force-group-allocation --whole-archive \"\${archive}\" -o \"\${archive}.o\")
    whit_run(\"${WHIT_GNU_OBJCOPY}\" --wildcard --keep-global-symbol=whit_* \"\${archive}.o\")
    file(REMOVE \"\${archive}\")
    whit_run(\"${CMAKE_AR}\" qcs \"\${archive}\" \"\${archive}.o\")
    file(REMOVE \"\${archive}.o\")")
endif()
# pkg-config
include(api/cmake/pkgconfig.cmake)
install(FILES ${PROJECT_BINARY_DIR}/cmake/whit.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md
  ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES api/python/whit.py api/python/pytest_whit.py
  DESTINATION ${CMAKE_INSTALL_DATADIR}/whit/python)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tests/example_check
  DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)
install(EXPORT whitTargets NAMESPACE whit:: DESTINATION ${package_dir})
install(FILES ${PROJECT_BINARY_DIR}/cmake/whitConfig.cmake
  ${PROJECT_BINARY_DIR}/cmake/whitConfigVersion.cmake
  ${CMAKE_CURRENT_SOURCE_DIR}/api/cmake/whitChecks.cmake DESTINATION ${package_dir})
list(FILTER public_headers EXCLUDE REGEX whit_program)
install(FILES ${public_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/whit)
