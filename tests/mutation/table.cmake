# The table of mutations in docs/numerics.md is that of mutations.cmake, and the texts that they change
# are there:
#     cmake -DROOT=<repository> -P table.cmake
cmake_minimum_required(VERSION 3.25)
file(STRINGS ${ROOT}/docs/numerics.md rows ENCODING UTF-8 REGEX "^\\| `[a-z_]+` \\|.*\\| `[a-z_]+`")
list(LENGTH rows row_count)
set(count 0)

function(mutation name test)
  cmake_parse_arguments(ARG "" "RED;GREEN;TARGET" "" ${ARGN})
  math(EXPR count "${count} + 1")
  set(count ${count} PARENT_SCOPE)
  set(mutated ${name} PARENT_SCOPE)
  if(NOT rows MATCHES "\\| `${name}` \\|[^|]*\\| `${test}`")
    message(SEND_ERROR "docs/numerics.md has no row | `${name}` | ... | `${test}` ... |")
  endif()
endfunction()

function(change file from)
  set(text "")
  if(EXISTS ${ROOT}/${file})
    file(READ ${ROOT}/${file} text)
  endif()
  string(FIND "${text}" "${from}" at)
  if(at EQUAL -1)
    message(SEND_ERROR "${mutated}: ${file} has no such text any more: ${from}")
  endif()
endfunction()

include(${CMAKE_CURRENT_LIST_DIR}/mutations.cmake)
if(NOT row_count EQUAL count)
  message(SEND_ERROR "docs/numerics.md has ${row_count} rows of mutations, mutations.cmake ${count}")
endif()
message(STATUS "${count} mutations are in the table")
