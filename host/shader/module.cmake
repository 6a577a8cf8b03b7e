whit_module(shader
  SOURCES errors.c scan.c text.c expand.c
    module.c returns.c graft.c link.c refuse.c bounds.c repairs.c reach.c inlining.c zeros.c fuel.c exact.c portable.c messages.c glslang.c compile.c
    disassemble.c annotations.c pack.c program.c sliders.c stages.c tests.c dbg.c
  LINK whit_base whit_kernels glslang::glslang glslang::SPIRV glslang::glslang-default-resource-limits
    SPIRV-Tools-opt)
