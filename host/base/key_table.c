#include "base/key_table.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/hash.h"

struct key_table_slot {
    void *key; /* NULL: empty */
    size_t key_bytes;
    uint64_t hash;
    uint32_t value;
};

/* Mixes the bits of a hash: the lower bits of hash_bytes alone hardly tell numbered names apart. */
static uint64_t spread(uint64_t hash)
{
    hash = (hash ^ hash >> 33) * UINT64_C(0xff51afd7ed558ccd);
    hash = (hash ^ hash >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
    return hash ^ hash >> 33;
}

/* The slot that has the key, or the empty slot where it would go. There is always an empty slot. */
static struct key_table_slot *find_slot(const struct key_table *table, const void *key,
                                        size_t key_bytes, uint64_t hash)
{
    for (uint32_t i = (uint32_t)hash;; ++i) {
        struct key_table_slot *slot = &table->slots[i & (table->slot_count - 1)];
        if (!slot->key || (slot->hash == hash && slot->key_bytes == key_bytes &&
                           memcmp(slot->key, key, key_bytes) == 0))
            return slot;
    }
}

static bool grow(struct key_table *table)
{
    struct key_table larger = {.slot_count = table->slot_count ? 2 * table->slot_count : 16};
    larger.slots = array_alloc_zeroed(larger.slot_count, sizeof *larger.slots);
    if (!larger.slots)
        return false;
    for (uint32_t i = 0; i < table->slot_count; ++i) {
        const struct key_table_slot *slot = &table->slots[i];
        if (slot->key)
            *find_slot(&larger, slot->key, slot->key_bytes, slot->hash) = *slot;
    }
    free(table->slots);
    table->slots = larger.slots;
    table->slot_count = larger.slot_count;
    return true;
}

bool key_table_find(const struct key_table *table, const void *key, size_t key_bytes,
                    uint32_t *value)
{
    if (!table->count)
        return false;
    uint64_t hash = spread(hash_bytes(HASH_START, key, key_bytes));
    const struct key_table_slot *slot = find_slot(table, key, key_bytes, hash);
    if (slot->key)
        *value = slot->value;
    return slot->key;
}

bool key_table_add(struct key_table *table, const void *key, size_t key_bytes, uint32_t value)
{
    if (2 * table->count >= table->slot_count && !grow(table))
        return false;
    void *copy = array_alloc(key_bytes, 1);
    if (!copy)
        return false;
    memcpy(copy, key, key_bytes);
    uint64_t hash = spread(hash_bytes(HASH_START, key, key_bytes));
    *find_slot(table, key, key_bytes, hash) = (struct key_table_slot){copy, key_bytes, hash, value};
    table->count++;
    return true;
}

void key_table_finish(struct key_table *table)
{
    for (uint32_t i = 0; i < table->slot_count; ++i)
        free(table->slots[i].key);
    free(table->slots);
    *table = (struct key_table){0};
}
