/* Marks every float operation of a module NoContraction, as if every variable of its GLSL were
   `precise`. Otherwise a driver may fuse or reorder operations, differently in each specialised
   variant, and pictures would differ in their last bits (docs/numerics.md). */
#ifndef SHADER_EXACT_H
#define SHADER_EXACT_H

#include <stddef.h>
#include <stdint.h>

enum shader_exact { EXACT_DONE, EXACT_DAMAGED, EXACT_NO_TYPES, EXACT_NO_MEMORY };

/* *out is malloc'ed: the module in `words`, with a decoration for each float operation that had
   none, placed before types as SPIR-V 1.5 section 2.4 says. Used at build time too, by
   tools/spirv_exact.c. */
enum shader_exact shader_exact(const uint32_t *words, size_t count, uint32_t **out,
                               size_t *out_count);

#endif
