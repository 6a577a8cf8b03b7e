/* Which files the names in foreign files may reach: those below the folder of the file that the
   user named, and below folders that the user allowed. */
#ifndef BASE_ROOTS_H
#define BASE_ROOTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

/* The thing that a name leads to. */
enum reach {
    REACH_FILE,       /* a regular file below one of the folders, with links resolved */
    REACH_MISSING,    /* below one of the folders, but not there or not readable */
    REACH_OUTSIDE,    /* anywhere else, whether it exists or not */
    REACH_URI,        /* a name with a scheme: nothing is fetched */
    REACH_NOT_A_FILE, /* a folder, a device, a pipe or a socket */
};

enum { REACH_REASON_BYTES = 768 };

/* Initialised by roots_init, released by roots_finish; a zeroed struct reaches nothing. */
struct roots {
    char *named;    /* the file that the user named, which may lie anywhere */
    bool is_input;  /* `named` stands for standard input, which has no folder */
    char **folders; /* without links, absolute */
    uint32_t count, capacity;
    char reason[REACH_REASON_BYTES]; /* of roots_why_not */
    uint32_t refused_count;          /* how often a path outside was refused */
    char *refused_folder;            /* the folder of the first of these; NULL: none */
    /* Gets each path that leads to a file below one of the folders, or would if it were there;
       NULL: not wanted. */
    void (*found)(void *user, const char *path);
    void *found_user;
};

/* Starts with the folder of `named`, a file that the user named. WHIT_ERROR_MEMORY. A folder that
   does not exist allows nothing. */
WHIT_CHECK whit_result roots_init(struct roots *roots, const char *named);
/* Starts without folders: `named` is the name of standard input. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result roots_init_input(struct roots *roots, const char *named);
/* Whether `path` is that name of standard input. False for NULL roots. */
bool roots_is_input(const struct roots *roots, const char *path);
/* Allows one more folder; errors are logged. */
WHIT_CHECK whit_result roots_allow(const whit_log *log, struct roots *roots, const char *folder);
void roots_finish(struct roots *roots);

/* The path of `relative`, a name in the file `from`, taken from the folder of `from`. Absolute
   names are kept, and so are names with a scheme, which then reach nothing. Release with free(). */
char *roots_join(const char *from, const char *relative);

/* Finds out what `path` leads to: a file below one of the roots, or why not. Opens only the folders
   on the way. */
enum reach roots_reach(const struct roots *roots, const char *path);
/* NULL for REACH_FILE; else why the file cannot be read, as text to stand behind `name: `. For
   REACH_MISSING the reason comes from errno. */
const char *reach_words(enum reach reach);
/* Why `path` cannot be read, with the option that would allow it. The text lasts until the next
   call. Remembers what was refused. */
const char *roots_why_not(struct roots *roots, const char *path);
/* Opens `path` for reading: a descriptor to close(), or -1 with *reach, and errno for
   REACH_MISSING. Only a REACH_FILE is opened, and no link is followed on the way to the file that
   was checked. NULL roots are for files that the user or whit named, which may lie anywhere. */
int roots_open(const struct roots *roots, const char *path, enum reach *reach);

#endif
