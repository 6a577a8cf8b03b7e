/* SPIR-V as text. */
#ifndef SHADER_DISASSEMBLE_H
#define SHADER_DISASSEMBLE_H

#include <stddef.h>
#include <stdint.h>

/* In the form of spirv-dis; free() it. NULL: damaged, or no memory. */
char *shader_disassemble(const uint32_t *words, size_t bytes);

#endif
