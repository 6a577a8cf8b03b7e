# No function of libm whose last bits depend on its version or on the processor, in what is computed
# before it is uploaded, nor in what the reference draws, nor in the bytes that are displayed:
# host/base/same.h has those that give the same bits everywhere.
#     cmake -DROOT=<repository> -P same.cmake
cmake_minimum_required(VERSION 3.25)
set(functions "a?sin|a?cos|a?tan|atan2|sincos|sinh|cosh|tanh|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|cbrt|hypot|fma|tgamma|lgamma")
# What no picture and no verdict depends on: statistics of measured times, figures of differences, and
# scales of heat maps.
set(exceptions base/sample.c image/flip.c image/heat.c image/legend.c)
set(checked 0)
foreach(folder accel api base bvh image load oracle picture reference render scene)
  file(GLOB files ${ROOT}/host/${folder}/*.[ch])
  foreach(file ${files})
    math(EXPR checked "${checked} + 1")
    file(RELATIVE_PATH name ${ROOT}/host ${file})
    if(name IN_LIST exceptions)
      continue()
    endif()
    file(STRINGS ${file} lines REGEX "(^|[^A-Za-z0-9_])(${functions})[fl]?\\(")
    foreach(line ${lines})
      if(NOT line MATCHES "^ *(/\\*|\\*|//)")
        message(SEND_ERROR "${file}: libm gives other bits elsewhere, base/same.h does not: ${line}")
      endif()
    endforeach()
  endforeach()
endforeach()
if(checked LESS 100)
  message(SEND_ERROR "only ${checked} files were looked at")
endif()
message("${checked} files call nothing of libm whose bits may differ")
