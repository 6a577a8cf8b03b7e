/* A hash table from keys, strings of bytes, to numbers. */
#ifndef BASE_KEY_TABLE_H
#define BASE_KEY_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct key_table_slot;

/* A zeroed table is empty; release it by key_table_finish(). */
struct key_table {
    struct key_table_slot *slots;
    uint32_t count, slot_count;
};

/* False: the key is not in it. */
bool key_table_find(const struct key_table *table, const void *key, size_t key_bytes,
                    uint32_t *value);
/* Keeps a copy of a key that is not in it. False when memory runs out, the table intact. */
bool key_table_add(struct key_table *table, const void *key, size_t key_bytes, uint32_t value);
void key_table_finish(struct key_table *table);

#endif
