#include "base/key_table.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

#include "base/array.h"

struct key_table_slot {
    void *key; /* NULL: empty */
    size_t key_bytes;
    uint64_t hash;
    uint32_t value;
};

/* A key of this process, so that no file can name many keys of one hash. Hashes decide nothing but
   slots, and no result depends on those. */
static uint64_t secret[2];
static pthread_once_t secret_made = PTHREAD_ONCE_INIT;

static void make_secret(void)
{
    if (getrandom(secret, sizeof secret, GRND_NONBLOCK) != (ssize_t)sizeof secret)
        memset(secret, 0, sizeof secret);
}

static uint64_t rotate(uint64_t bits, int by)
{
    return bits << by | bits >> (64 - by);
}

static void mix(uint64_t v[4])
{
    v[0] += v[1];
    v[2] += v[3];
    v[1] = rotate(v[1], 13) ^ v[0];
    v[3] = rotate(v[3], 16) ^ v[2];
    v[0] = rotate(v[0], 32) + v[3];
    v[2] += v[1];
    v[3] = rotate(v[3], 21) ^ v[0];
    v[1] = rotate(v[1], 17) ^ v[2];
    v[2] = rotate(v[2], 32);
}

/* SipHash-1-3 (J.-P. Aumasson, D. J. Bernstein, SipHash: a fast short-input PRF, 2012), with the
   length in a word of its own. hash_bytes is no defence: by its steps keys can be made whose hashes
   are equal from any start. */
static uint64_t hash_key(const void *key, size_t key_bytes)
{
    pthread_once(&secret_made, make_secret);
    uint64_t v[4] = {
        secret[0] ^ UINT64_C(0x736f6d6570736575), secret[1] ^ UINT64_C(0x646f72616e646f6d),
        secret[0] ^ UINT64_C(0x6c7967656e657261), secret[1] ^ UINT64_C(0x7465646279746573)};
    uint64_t word = key_bytes;
    for (size_t at = 0;; at += sizeof word) {
        v[3] ^= word;
        mix(v);
        v[0] ^= word;
        if (at >= key_bytes)
            break;
        word = 0;
        memcpy(&word, (const char *)key + at,
               key_bytes - at < sizeof word ? key_bytes - at : sizeof word);
    }
    v[2] ^= 0xff;
    for (int i = 0; i < 3; ++i)
        mix(v);
    return v[0] ^ v[1] ^ v[2] ^ v[3];
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
    uint64_t hash = hash_key(key, key_bytes);
    const struct key_table_slot *slot = find_slot(table, key, key_bytes, hash);
    if (slot->key)
        *value = slot->value;
    return slot->key;
}

bool key_table_add(struct key_table *table, const void *key, size_t key_bytes, uint32_t value)
{
    if (2 * table->count >= table->slot_count && !grow(table))
        return false;
    void *copy = array_copy(key, key_bytes, 1);
    if (!copy)
        return false;
    uint64_t hash = hash_key(key, key_bytes);
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
