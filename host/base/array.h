/* Growing arrays: a pointer, a count and a capacity kept by the owner.

       struct item *items = NULL; uint32_t count = 0, capacity = 0;
       if (!ARRAY_PUSH(items, count, capacity, item)) -> out of memory, array intact
*/
#ifndef BASE_ARRAY_H
#define BASE_ARRAY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Makes room for one element more. False when memory runs out or the count would pass 2^32 - 1. */
bool array_reserve(void **items, uint32_t count, uint32_t *capacity, size_t element_bytes);

#define ARRAY_PUSH(items, count, capacity, ...)                                                    \
    (array_reserve((void **)&(items), (count), &(capacity), sizeof *(items))                       \
         ? ((items)[(count)++] = (__VA_ARGS__), true)                                              \
         : false)

/* calloc/malloc of count * bytes with the product checked; at least one byte. */
void *array_alloc(size_t count, size_t element_bytes);
void *array_alloc_zeroed(size_t count, size_t element_bytes);
/* A copy of `count` elements; NULL gives NULL. */
void *array_copy(const void *data, size_t count, size_t element_bytes);
/* Aligned to cache lines of 64 bytes, or to large pages, for which large arrays ask; release with
   free(). The first is not zeroed, so that parts that stay unused take no memory. */
void *array_alloc_lines(size_t count, size_t element_bytes);
void *array_alloc_aligned(size_t count, size_t element_bytes); /* zeroed */
char *string_copy(const char *text);                           /* NULL gives NULL */
char *string_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
