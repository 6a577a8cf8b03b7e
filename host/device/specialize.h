/* A kernel with its specialization constants filled in and what they switch off taken out, before
   a driver sees it. Drivers do the same, but only after passes of theirs over the whole kernel. */
#ifndef DEVICE_SPECIALIZE_H
#define DEVICE_SPECIALIZE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "whit/whit_base.h"

/* `spec[i]` is the value of constant i. *out is malloc()ed, free() it; *out_words counts words.
   Operations keep their order and their NoContraction, so results keep their bits. */

/* One function without calls, in a few ms, of a kernel as glslang makes it (see evaluate.h).
   WHIT_ERROR_INPUT and *out NULL when it is no such kernel: then it is to be used as it is.
   WHIT_ERROR_MEMORY when memory runs out. Neither is logged. */
WHIT_CHECK whit_result spirv_evaluate(const uint32_t *words, size_t word_count,
                                      const uint32_t *spec, uint32_t spec_count, uint32_t **out,
                                      size_t *out_words);

/* What a module has in its functions. What is called twice is there twice where calls are gone. */
struct spirv_info {
    uint32_t instructions;
    uint64_t bindings; /* bit i: a function names a variable bound to binding i of set 0 */
};

/* False when it is no SPIR-V, or memory runs out. */
bool spirv_inspect(const uint32_t *words, size_t word_count, struct spirv_info *out);

#endif
