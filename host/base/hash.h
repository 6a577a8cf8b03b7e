/* A 64-bit hash that tells files and scenes apart; no defence against deliberate collisions. */
#ifndef BASE_HASH_H
#define BASE_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define HASH_START UINT64_C(0xcbf29ce484222325)

/* FNV-1a over 8-byte words with a fold: byte by byte it would be slower than loading the file.
   Every step is a bijection of `value` and of the word, so no change within one word goes
   unnoticed. */
static inline uint64_t hash_bytes(uint64_t value, const void *data, size_t size_bytes)
{
    const uint8_t *bytes = data;
    value = (value ^ size_bytes) * UINT64_C(0x100000001b3);
    while (size_bytes) {
        uint64_t word = 0;
        size_t step = size_bytes < sizeof word ? size_bytes : sizeof word;
        memcpy(&word, bytes, step);
        value = (value ^ word) * UINT64_C(0x100000001b3);
        value ^= value >> 29;
        bytes += step;
        size_bytes -= step;
    }
    return value;
}

#endif
