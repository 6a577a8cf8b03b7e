# clang-format 14 has nothing to change: cmake -DROOT=<repository> -P format.cmake
# The tables of shaders/abi/ are laid out by hand. Other versions format differently, so that
# they count as none.
cmake_minimum_required(VERSION 3.25)
find_program(CLANG_FORMAT NAMES clang-format-14 clang-format)
set(version "")
if(CLANG_FORMAT)
  execute_process(COMMAND ${CLANG_FORMAT} --version OUTPUT_VARIABLE version)
endif()
if(NOT version MATCHES "version 14[.]")
  message("SKIPPED: no clang-format 14 here (Debian 12: apt-get install clang-format)")
  return()
endif()
file(GLOB_RECURSE files ${ROOT}/host/*.[ch] ${ROOT}/host/*.cpp ${ROOT}/host/*.hpp ${ROOT}/tests/*.[ch]
  ${ROOT}/tools/*.[ch])
list(LENGTH files count)
execute_process(COMMAND ${CLANG_FORMAT} --dry-run --Werror ${files}
  RESULT_VARIABLE result ERROR_VARIABLE text)
if(NOT result EQUAL 0 OR count LESS 20)
  message(FATAL_ERROR "${text}\n${count} files: run clang-format -i on those above")
endif()
message("${count} files are formatted")
