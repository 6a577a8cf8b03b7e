/* Fills in a kernel's specialization constants and takes out what they switch off, before a driver
   sees it. Drivers do the same, but only after passes over the whole kernel. */
#ifndef DEVICE_SPECIALIZE_H
#define DEVICE_SPECIALIZE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "whit/whit_base.h"

/* `spec[i]` is the value of constant i. *out is malloc()ed, free() it; *out_words counts words.
   Operations keep their order and their NoContraction, so results keep their bits. */

/* Makes one function without calls of a kernel as glslang writes it (see evaluate.h), in a few ms.
   WHIT_ERROR_INPUT and *out NULL for any other kernel, which is then to be used as it is.
   WHIT_ERROR_MEMORY when memory runs out. Neither is logged. */
WHIT_CHECK whit_result spirv_evaluate(const uint32_t *words, size_t word_count,
                                      const uint32_t *spec, uint32_t spec_count, uint32_t **out,
                                      size_t *out_words);

/* Contents of the functions of a module. Where calls were inlined, a function that was called twice
   counts twice. */
struct spirv_info {
    uint32_t instructions;
    uint64_t bindings; /* bit i: a function names a variable bound to binding i of set 0 */
};

/* False when the words are no SPIR-V, or memory runs out. */
bool spirv_inspect(const uint32_t *words, size_t word_count, struct spirv_info *out);

#endif
