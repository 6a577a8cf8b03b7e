/* A file in the cache. The first byte says whether its length and checksum are mended, and which
   bit is flipped then. What is read is what was kept, and all else is thrown away. */
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/store.h"

enum { MAGIC_BYTES = 8, HEADER_BYTES = 24 };
static const char name[] = "entry";
static const char magic[] = "whitkep1";

static void prepare(void)
{
    fuzz_check(setenv("XDG_CACHE_HOME", fuzz_folder(), 1) == 0, "no environment");
    free(store_folder(&fuzz_log));
    umask(077);
}

/* The checksum in the header of a kept file (store.h): of its name and its content. */
static uint64_t checksum_of(const uint8_t *data, size_t size_bytes)
{
    return hash_bytes(hash_bytes(HASH_START, name, strlen(name)), data, size_bytes);
}

static void sign(uint8_t *file, size_t size_bytes)
{
    uint64_t words[2] = {size_bytes - HEADER_BYTES,
                         checksum_of(file + HEADER_BYTES, size_bytes - HEADER_BYTES)};
    memcpy(file, magic, MAGIC_BYTES);
    memcpy(file + MAGIC_BYTES, words, sizeof words);
}

static bool is_whole(const uint8_t *file, size_t size_bytes)
{
    uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    fuzz_check(copy, "out of memory");
    memcpy(copy, file, size_bytes);
    if (size_bytes >= HEADER_BYTES)
        sign(copy, size_bytes);
    bool whole = size_bytes >= HEADER_BYTES && memcmp(copy, file, size_bytes) == 0;
    free(copy);
    return whole;
}

static void check(const uint8_t *file, size_t size_bytes)
{
    uint8_t *data;
    size_t read_bytes;
    const char *path = fuzz_file("whit/entry", file, size_bytes);
    bool whole = is_whole(file, size_bytes), read = store_read(&fuzz_log, name, &data, &read_bytes);
    fuzz_check(read == whole, "%s file is %s", whole ? "a whole" : "a damaged",
               read ? "read" : "not read");
    fuzz_check(read == (access(path, F_OK) == 0), "a file that is %s",
               read ? "gone" : "still there");
    fuzz_check(read == (data != NULL), "a result without its data");
    if (read)
        fuzz_check(read_bytes == size_bytes - HEADER_BYTES &&
                       memcmp(data, file + HEADER_BYTES, read_bytes) == 0 && data[read_bytes] == 0,
                   "other data than was kept");
    free(data);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    if (size_bytes == 0)
        return;
    size_t bytes = size_bytes - 1;
    uint8_t mode = data[0], *file = malloc(size_bytes);
    fuzz_check(file, "out of memory");
    memcpy(file, data + 1, bytes);
    if (mode && bytes >= HEADER_BYTES)
        sign(file, bytes);
    if (mode > 1 && bytes)
        file[(size_t)(mode >> 3) * 7 % bytes] ^= (uint8_t)(1u << (mode & 7));
    check(file, bytes);
    free(file);
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(1) << 20};
