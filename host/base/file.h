/* Whole files: read at once, written beside and renamed, so that a reader never sees half a file.
 */
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/log.h"
#include "base/path.h"
#include "base/roots.h"

/* Reads a whole file. *data is malloc'ed, with one zero byte behind its size; free() it. Errors are
   logged with the path. Every file that whit did not write is opened here. `roots`: `path` may not
   lead out of these; NULL for a file that the user named. Refuses folders, devices and files over
   `limit_bytes` (0: no limit). */
WHIT_CHECK whit_result file_read(const whit_log *log, const struct roots *roots, const char *path,
                                 uint64_t limit_bytes, uint8_t **data, size_t *size_bytes);

/* Opens a file that the user named, of any size; NULL, with the reason in *why, also for folders,
   devices and pipes. */
FILE *file_open(const char *path, const char **why);

/* A file under construction: `stream` writes to a hidden sibling of `path`. Commit renames it over
   `path`; abandon removes it. Call exactly one of the two; both accept a zeroed struct. When the
   process is interrupted, file_abandon_all(), which is safe in a signal handler, removes open
   files. Files of a killed process are removed by the next one that writes the same path. */
struct file_write {
    FILE *stream;
    char *path;
    char *temporary_path;
    int slot;
};

WHIT_CHECK whit_result file_write_begin(const whit_log *log, const char *path,
                                        struct file_write *file);
WHIT_CHECK whit_result file_write_commit(const whit_log *log, struct file_write *file);
WHIT_CHECK whit_result file_write_append(const whit_log *log, struct file_write *file,
                                         const void *data, size_t size_bytes);
void file_write_abandon(struct file_write *file);
/* Commits where `result` is WHIT_OK, else abandons and gives `result`. */
WHIT_CHECK whit_result file_write_end(const whit_log *log, struct file_write *file,
                                      whit_result result);
/* Begins the file, appends all of `data` and commits. */
WHIT_CHECK whit_result file_write_whole(const whit_log *log, const char *path, const void *data,
                                        size_t size_bytes);
void file_abandon_all(void);
/* Lets file_abandon_all() remove `path` too, until the slot is given back. 0, which is no slot:
   there is no room, and the file would stay. */
int file_slot_take(const char *path);
void file_slot_give_back(int slot);

bool file_exists(const char *path);

#endif
