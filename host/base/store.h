/* A cache of data that can be made again, kept from one run to the next: files in
   $XDG_CACHE_HOME/whit or ~/.cache/whit, which only this user may access. No link is followed, only
   plain files of this user are read, and each starts with its length and a checksum: damaged ones
   are removed. Several processes may use it at once. Where it cannot be used, nothing is kept and
   nothing fails. */
#ifndef BASE_STORE_H
#define BASE_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

/* The folder, created if it does not exist; free() it. NULL: it cannot be used, or WHIT_NO_CACHE is
   set. A folder that others own or may write to gives a warning, once in a process. */
char *store_folder(const whit_log *log);

/* Reads what was kept under `name`, with one zero byte behind its size: free() it. False: there is
   nothing, or it was damaged and has been removed. A file that is read counts as recently used. */
bool store_read(const whit_log *log, const char *name, uint8_t **data, size_t *size_bytes);

/* Keeps data under `name`, which identifies contents and version, has no slash and at most 200
   bytes. Then the least recently used files are removed until all together are within the limit:
   512 MiB, or $WHIT_CACHE_LIMIT MiB. */
void store_write(const whit_log *log, const char *name, const void *data, size_t size_bytes);

struct store_info {
    char folder[4096]; /* "": there is no cache folder */
    char why_not[128]; /* the reason where nothing is kept; "" where files are kept */
    uint64_t used_bytes, limit_bytes;
};
void store_get_info(struct store_info *info);

#endif
