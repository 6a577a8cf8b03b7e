# whit_add_checks(SUITE [PREFIX prefix] [ROOT folder] [WORKING_DIRECTORY folder] [LABELS label...]
#                 [TIMEOUT seconds] [OPTIONS option...])
#
# One test of ctest for each case of SUITE, a file of `whit check`: it passes where whit's exit code is 0, and fails
# with whit's own lines otherwise, without a device (3) and without a golden (4) too. SUITE is named from the current
# source folder. PREFIX stands before the name of each case; by itself `NAME.` of NAME.whit. ROOT is what the suite's
# scenes lie below, as --root has it. Tests run in WORKING_DIRECTORY, by itself the current binary folder. OPTIONS are
# further ones of `whit check`. Names of the tests are left in whit_CHECKS.
#
# The cases are those that the suite has when CMake runs, which it does again where the suite is other; what its cases
# name need not be there by then: a test that others depend on, a fixture, may make it.
function(whit_add_checks suite)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "PREFIX;ROOT;WORKING_DIRECTORY;TIMEOUT" "LABELS;OPTIONS")
  if(DEFINED ARG_UNPARSED_ARGUMENTS OR DEFINED ARG_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "whit_add_checks(${suite}):\n  no keyword, or one without its value: "
      "${ARG_UNPARSED_ARGUMENTS} ${ARG_KEYWORDS_MISSING_VALUES}")
  endif()
  get_filename_component(suite "${suite}" ABSOLUTE)
  if(NOT DEFINED ARG_PREFIX)
    get_filename_component(ARG_PREFIX "${suite}" NAME_WLE)
    string(APPEND ARG_PREFIX ".")
  endif()
  if(NOT DEFINED ARG_WORKING_DIRECTORY)
    set(ARG_WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
  endif()
  if(DEFINED ARG_ROOT)
    get_filename_component(ARG_ROOT "${ARG_ROOT}" ABSOLUTE)
    list(APPEND ARG_OPTIONS --root "${ARG_ROOT}")
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${suite}")
  execute_process(COMMAND "${whit_PROGRAM}" check "${suite}" --list ${ARG_OPTIONS}
    WORKING_DIRECTORY "${ARG_WORKING_DIRECTORY}"
    OUTPUT_VARIABLE names ERROR_VARIABLE said RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    string(REPLACE "\n" "\n  " said "\n${said}") # indented, lines stay whole
    message(FATAL_ERROR "whit_add_checks(${suite}):\n  ${whit_PROGRAM} ends with ${status}${said}")
  endif()
  string(REGEX MATCHALL "[^\n]+" names "${names}")
  list(TRANSFORM names PREPEND "${ARG_PREFIX}" OUTPUT_VARIABLE tests)
  foreach(name test IN ZIP_LISTS names tests)
    add_test(NAME "${test}" COMMAND "${whit_PROGRAM}" check "${suite}" --only "${name}" ${ARG_OPTIONS}
      WORKING_DIRECTORY "${ARG_WORKING_DIRECTORY}")
    set_tests_properties("${test}" PROPERTIES LABELS "${ARG_LABELS}")
    if(DEFINED ARG_TIMEOUT)
      set_tests_properties("${test}" PROPERTIES TIMEOUT "${ARG_TIMEOUT}")
    endif()
  endforeach()
  set(whit_CHECKS ${tests} PARENT_SCOPE)
endfunction()
