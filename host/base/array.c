#include "base/array.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/platform.h"
#include "base/text.h"

enum { LARGE_BYTES = 4 << 20 };

static void *expect_much(void *memory, size_t bytes)
{
    if (memory && bytes >= LARGE_BYTES)
        platform_expect_much(memory, bytes);
    return memory;
}

bool array_reserve(void **items, uint32_t count, uint32_t *capacity, size_t element_bytes)
{
    if (count < *capacity)
        return true;
    if (count == UINT32_MAX)
        return false;
    uint32_t grown = *capacity < 8 ? 8 : *capacity > UINT32_MAX / 2 ? UINT32_MAX : *capacity * 2;
    if (element_bytes && grown > SIZE_MAX / element_bytes)
        return false;
    size_t bytes = grown * element_bytes;
    void *moved = expect_much(realloc(*items, bytes), bytes);
    if (!moved)
        return false;
    *items = moved;
    *capacity = grown;
    return true;
}

static bool product(size_t count, size_t element_bytes, size_t *bytes)
{
    if (element_bytes && count > (SIZE_MAX / 2) / element_bytes)
        return false;
    *bytes = count * element_bytes;
    if (*bytes == 0)
        *bytes = 1;
    return true;
}

void *array_alloc(size_t count, size_t element_bytes)
{
    size_t bytes;
    return product(count, element_bytes, &bytes) ? expect_much(malloc(bytes), bytes) : NULL;
}

void *array_alloc_zeroed(size_t count, size_t element_bytes)
{
    size_t bytes;
    return product(count, element_bytes, &bytes) ? expect_much(calloc(1, bytes), bytes) : NULL;
}

void *array_copy(const void *data, size_t count, size_t element_bytes)
{
    void *copy = data ? array_alloc(count, element_bytes) : NULL;
    return copy ? memcpy(copy, data, count * element_bytes) : NULL;
}

/* A large page is given only where all of it is inside a block: blocks of half a page and more are
   made that large. */
void *array_alloc_lines(size_t count, size_t element_bytes)
{
    size_t bytes;
    if (!product(count, element_bytes, &bytes))
        return NULL;
    bool large = bytes >= LARGE_PAGE_BYTES / 2;
    size_t line = large ? LARGE_PAGE_BYTES : 64; /* C wants a multiple of it */
    void *memory = aligned_alloc(line, (bytes + line - 1) & ~(line - 1));
    if (memory && large)
        platform_expect_much(memory, bytes < LARGE_PAGE_BYTES ? LARGE_PAGE_BYTES : bytes);
    return memory;
}

void *array_alloc_aligned(size_t count, size_t element_bytes)
{
    void *memory = array_alloc_lines(count, element_bytes);
    return memory ? memset(memory, 0, (count * element_bytes + 63) & ~(size_t)63) : NULL;
}

char *string_copy(const char *text)
{
    return array_copy(text, text ? strlen(text) + 1 : 0, 1);
}

char *string_format(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    int length = text_print(NULL, 0, format, args);
    va_end(args);
    if (length < 0)
        return NULL;
    char *text = malloc((size_t)length + 1);
    if (!text)
        return NULL;
    va_start(args, format);
    text_print(text, (size_t)length + 1, format, args);
    va_end(args);
    return text;
}
