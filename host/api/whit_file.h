/* Part of whit.h: files that appear whole or not at all; clocks. */
#ifndef WHIT_FILE_H
#define WHIT_FILE_H

#include "whit_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A file under construction, hidden beside `path`: commit renames it over `path`, abandon removes
   it. Exactly one of the two ends it. */
typedef struct whit_file whit_file;
WHIT_CHECK whit_result whit_file_begin(const char *path, const whit_log *log, whit_file **out);
WHIT_CHECK whit_result whit_file_append(whit_file *file, const void *data, size_t size_bytes);
WHIT_CHECK whit_result whit_file_commit(whit_file *file);
void whit_file_abandon(whit_file *file);

/* Writes a whole file beside `path` and renames it. */
WHIT_CHECK whit_result whit_file_write(const char *path, const void *data, size_t size_bytes,
                                       const whit_log *log);
/* Where whit keeps what it can make again: $XDG_CACHE_HOME/whit or ~/.cache/whit, made when it is
   not there; free() it. NULL: there is none, or WHIT_NO_CACHE is set. */
char *whit_cache_folder(void);
/* Removes unfinished output; safe in a signal handler. */
void whit_file_abandon_all(void);
uint64_t whit_peak_memory_bytes(void);
double whit_clock_ms(void);
double whit_clock_cpu_ms(void); /* used by all threads of this process */

#ifdef __cplusplus
}
#endif

#endif
