/* Small numbers by the bytes of a key: what a list of names would be searched for. */
#ifndef BASE_TABLE_H
#define BASE_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct table_slot;

/* A zeroed one is empty; table_finish() it. */
struct table {
    struct table_slot *slots;
    uint32_t count, slot_count;
};

/* False: the key is not in it. */
bool table_find(const struct table *table, const void *key, size_t key_bytes, uint32_t *value);
/* Keeps a copy of a key that is not in it. False when memory runs out, the table intact. */
bool table_add(struct table *table, const void *key, size_t key_bytes, uint32_t value);
void table_finish(struct table *table);

#endif
