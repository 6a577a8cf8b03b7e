/* SPIR-V as text. */
#ifndef SHADER_DISASSEMBLE_H
#define SHADER_DISASSEMBLE_H

#include <stddef.h>
#include <stdint.h>

/* SPIR-V as text, as spirv-dis writes it; free() it. NULL: the module is damaged, or no memory. */
char *shader_disassemble(const uint32_t *words, size_t bytes);

#endif
