/* What can be made again, kept from one run to the next: files in $XDG_CACHE_HOME/whit or
   ~/.cache/whit, which is this user's alone. No link is followed, nothing but a plain file of this
   user is read, and each has its length and a checksum in front: what is damaged is thrown away.
   Two processes may use it at once. Where it cannot be used nothing is kept, and nothing fails. */
#ifndef BASE_STORE_H
#define BASE_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"
#include "whit/whit_program.h"

/* The folder, made when it is not there; free() it. NULL: it is not to be used, or WHIT_NO_CACHE is
   set. A folder that others own or may write to is a warning, once a process. */
char *store_folder(const whit_log *log);

/* What was kept under `name`, with one zero byte behind its size: free() it. False: nothing, or it
   was damaged and is thrown away. What is read counts as new again. */
bool store_read(const whit_log *log, const char *name, uint8_t **data, size_t *size_bytes);

/* Keeps it under `name`, which says of what and in which version it is, without a slash and at most
   200 bytes. Then the files that were used longest ago are removed until all take at most the
   limit: 512 MiB, or $WHIT_CACHE_LIMIT MiB. */
void store_write(const whit_log *log, const char *name, const void *data, size_t size_bytes);

void store_get_info(whit_cache_info *info);

#endif
