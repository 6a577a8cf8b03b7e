/* A kernel with its specialization constants filled in and what they switch off taken out, before
   a driver sees it. Drivers do the same, but late: lavapipe spends 630 ms on the whole Whitted
   kernel and 70 ms on what a plain scene leaves of it. */
#ifndef DEVICE_SPECIALIZE_H
#define DEVICE_SPECIALIZE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* `spec[i]` is the value of constant i. *out is malloc()ed, free() it; *out_words counts words.
   Operations keep their order and their NoContraction, so results keep their bits. */

/* One function without calls, in a few ms, of a kernel as glslang makes it (see evaluate.h). False
   and *out NULL when it is no such kernel, or memory runs out. */
bool spirv_evaluate(const uint32_t *words, size_t word_count, const uint32_t *spec,
                    uint32_t spec_count, uint32_t **out, size_t *out_words);

/* By SPIRV-Tools, of any kernel and with its calls, in a hundred times as long. False when the
   optimizer refuses or memory runs out: then the module is to be used as it is. */
bool spirv_specialize(const uint32_t *words, size_t word_count, const uint32_t *spec,
                      uint32_t spec_count, uint32_t **out, size_t *out_words);

/* Of SPIRV-Tools; never NULL. */
const char *spirv_tools_version(void);

/* What a module has in its functions. What is called twice is there twice where calls are gone. */
struct spirv_info {
    uint32_t instructions;
    uint64_t bindings; /* bit i: a function names a variable bound to binding i of set 0 */
};

/* False when it is no SPIR-V, or memory runs out. */
bool spirv_inspect(const uint32_t *words, size_t word_count, struct spirv_info *out);

#ifdef __cplusplus
}
#endif

#endif
