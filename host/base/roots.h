/* How far the names in foreign files reach: no further than the folder of the file that the user
   named, and the folders that the user allowed. */
#ifndef BASE_ROOTS_H
#define BASE_ROOTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

/* Where a name leads. */
enum reach {
    REACH_FILE,       /* a regular file below one of the folders, links resolved */
    REACH_MISSING,    /* nothing that can be had, below one of the folders */
    REACH_OUTSIDE,    /* anything elsewhere, whether there is something or not */
    REACH_URI,        /* a name with a scheme: nothing is fetched */
    REACH_NOT_A_FILE, /* a folder, a device, a pipe or a socket */
};

enum { REACH_REASON_BYTES = 768 };

/* Made by roots_init, ended by roots_finish; a zeroed one reaches nothing. */
struct roots {
    char *named;    /* the file that the user named: it is opened wherever it is */
    bool is_input;  /* that name stands for standard input, which has no folder */
    char **folders; /* without links, absolute */
    uint32_t count, capacity;
    char reason[REACH_REASON_BYTES]; /* of roots_why_not */
    uint32_t refused_count;          /* how often something outside was asked for */
    char *refused_folder;            /* the folder of the first of these; NULL: none */
};

/* The folder of `named`, a file that the user named. WHIT_ERROR_MEMORY; a folder that is not there
   reaches nothing. */
WHIT_CHECK whit_result roots_init(struct roots *roots, const char *named);
/* None: `named` is what standard input is called. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result roots_init_input(struct roots *roots, const char *named);
/* Whether `path` is standard input by that name. NULL roots have none. */
bool roots_is_input(const struct roots *roots, const char *path);
/* One more folder; logs why it cannot be had. */
WHIT_CHECK whit_result roots_allow(const whit_log *log, struct roots *roots, const char *folder);
void roots_finish(struct roots *roots);

/* `relative`, as the file `from` names it, taken from the folder of `from`. Absolute names are
   kept, and those with a scheme, which then lead nowhere. Release with free(). */
char *roots_join(const char *from, const char *relative);

/* Opens nothing but folders on the way. */
enum reach roots_reach(const struct roots *roots, const char *path);
/* NULL for REACH_FILE; else why a file cannot be read, for behind `name: `. Of REACH_MISSING errno
   tells why. */
const char *reach_words(enum reach reach);
/* The same of `path`, with the option that would allow it. The text lasts until the next call.
   Remembers what was refused. */
const char *roots_why_not(struct roots *roots, const char *path);
/* A descriptor to read from, close() it; or -1 with *reach, and errno with REACH_MISSING. Nothing
   is opened that is not REACH_FILE, and no link is followed on the way to what was checked. NULL
   roots are for files that the user named, or whit itself: they may lie anywhere. */
int roots_open(const struct roots *roots, const char *path, enum reach *reach);

#endif
