# Writes FOLDER/records.h, a table of every record and member of shaders/abi/, and
# FOLDER/abi_check.comp, which holds each of them in a buffer:
#     cmake -DABI=<shaders/abi> -DFOLDER=<to> -P records.cmake
cmake_minimum_required(VERSION 3.25)
file(RELATIVE_PATH abi ${FOLDER} ${ABI}) # glslang takes no absolute ones
set(table "")
set(buffers "")
set(includes "")
set(binding 0)
foreach(header bvh shade queues)
  file(READ ${ABI}/${header}.h text)
  string(APPEND includes "#include \"${abi}/${header}.h\"\n")
  string(REPLACE ";" "," text "${text}")
  string(REPLACE "[" "(" text "${text}")
  string(REPLACE "]" ")" text "${text}")
  string(REGEX REPLACE "/[*]([^*]|[*][^/])*[*]+/" "" text "${text}")
  string(REGEX MATCHALL "struct gpu_[a-z_0-9]+ {[^}]*}" records "${text}")
  foreach(record ${records})
    string(REGEX REPLACE "^struct (gpu_[a-z_0-9]+) .*" "\\1" name "${record}")
    string(REGEX REPLACE "^[^{]*{|[ \n]*}$" "" members "${record}")
    string(REGEX REPLACE "gpu_(float|uvec4|uint|vec[234]|items) " "" members "${members}")
    string(REGEX REPLACE "[(][A-Z_]+[)]" "" members "${members}")
    string(REGEX MATCHALL "[a-z_0-9]+" members "${members}")
    string(APPEND table "    RECORD(${name}) \\\n")
    foreach(member ${members})
      string(APPEND table "    MEMBER(${name}, ${member}) \\\n")
    endforeach()
    string(APPEND buffers "layout(set = 0, binding = ${binding}, std430) "
      "buffer Block${binding} { ${name} records${binding}[]; };\n")
    math(EXPR binding "${binding} + 1")
  endforeach()
endforeach()
file(WRITE ${FOLDER}/records.h "#define RECORDS(RECORD, MEMBER) \\\n${table}\n")
file(WRITE ${FOLDER}/abi_check.comp "#version 460
#extension GL_GOOGLE_include_directive : require
${includes}#include \"${abi}/spec.h\"
layout(local_size_x_id = 0) in;
${buffers}void main()
{
}
")
